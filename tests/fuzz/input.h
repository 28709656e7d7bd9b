/* SPDX-License-Identifier: BSD-3-Clause
 * Takes numbers out of a fuzzer's bytes. */
#ifndef FUZZ_INPUT_H
#define FUZZ_INPUT_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A wrong result ends the run as a crash does: the fuzzer keeps the input. */
#define REQUIRE(condition)                                                                                             \
    do {                                                                                                               \
        if (!(condition))                                                                                              \
            abort();                                                                                                   \
    } while (0)

typedef struct fuzz_input {
    const uint8_t *data;
    size_t size;
} fuzz_input;

/* The next bytes, zeros once they have run out. */
static inline void fuzz_take(fuzz_input *in, void *to, size_t size)
{
    const size_t n = size < in->size ? size : in->size;
    memset(to, 0, size);
    memcpy(to, in->data, n);
    in->data += n;
    in->size -= n;
}

/* Mostly a number within the range, over its decades; every eighth is any double: NaN, infinite, out of range. */
static inline double fuzz_double(fuzz_input *in, double minimum, double maximum)
{
    uint8_t kind;
    uint32_t bits;
    double any;
    fuzz_take(in, &kind, sizeof kind);
    if (kind % 8 == 0) {
        fuzz_take(in, &any, sizeof any);
        return any;
    }
    fuzz_take(in, &bits, sizeof bits);
    const double u = bits / 4294967295.0;
    if (minimum > 0.0)
        return minimum * pow(maximum / minimum, u);
    return minimum + u * u * u * u * (maximum - minimum);
}

#endif
