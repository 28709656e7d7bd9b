/* SPDX-License-Identifier: BSD-3-Clause
 * Loops over arrays for several instruction sets; private to the library. A function after NT_VARIANTS is compiled for
 * each where the toolchain can, and the machine picks one when it loads the library. There is no fused multiply-add in
 * any (-ffp-contract=off), so that all give the same bits. */
#ifndef NANOTOUCH_CORE_VARIANTS_H
#define NANOTOUCH_CORE_VARIANTS_H

/* glibc resolves the variants at load time; sanitizers come too late for that. */
#if !defined(NANOTOUCH_ONE_VARIANT) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12 &&                   \
    defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define NT_TARGETS(...) __attribute__((target_clones(__VA_ARGS__)))
#else
#define NT_TARGETS(...)
#endif
#define NT_VARIANTS NT_TARGETS("default", "arch=x86-64-v3")

/* Sums are kept by place in blocks of so many values and added up at the end, in the same order on every machine: a
 * compiler may not change the order of a plain sum, and so leaves it scalar. More than a compiler unrolls. */
enum { NT_LANES = 32 };

/* What is left of count from i on, a block at most. */
static inline int nt_lanes_from(long i, long count)
{
    return count - i < NT_LANES ? (int)(count - i) : NT_LANES;
}

static inline double nt_lanes_sum(double lanes[NT_LANES])
{
    for (int width = NT_LANES / 2; width > 0; width /= 2)
        for (int j = 0; j < width; j++)
            lanes[j] += lanes[j + width];
    return lanes[0];
}

static inline double nt_lanes_highest(double lanes[NT_LANES])
{
    for (int width = NT_LANES / 2; width > 0; width /= 2)
        for (int j = 0; j < width; j++)
            lanes[j] = lanes[j + width] > lanes[j] ? lanes[j + width] : lanes[j];
    return lanes[0];
}

#endif
