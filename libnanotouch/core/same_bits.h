/* SPDX-License-Identifier: BSD-3-Clause
 * Private. What C libraries round differently: glibc's cbrt, hypot and exp2 differ between x86-64 and aarch64 in their
 * last bit, and so would a session. These are made of what IEEE 754 rounds alike everywhere, and of exp, which glibc
 * has made alike. */
#ifndef NANOTOUCH_CORE_SAME_BITS_H
#define NANOTOUCH_CORE_SAME_BITS_H

#include <math.h>

#define LN_2 0.693147180559945309

/* sqrt(a^2 + b^2) to 2^-52; both below 1e150, and at least one of them above 1e-146 or the result is less exact. */
static inline double hypotenuse(double a, double b)
{
    return sqrt(a * a + b * b);
}

/* To 2^-52; NaN of NaN. Of 2^(3n) m with m in 1/8 .. 1: 2^n times the root of m, by a parabola within 1.7e-2 and two of
 * Halley's steps, each of which cubes the error. */
static inline double cube_root(double x)
{
    int exponent;
    double m = frexp(fabs(x), &exponent);
    if (x == 0.0 || !isfinite(x))
        return x;
    while (exponent % 3 != 0) {
        m *= 0.5;
        ++exponent;
    }
    double y = 0.381 + (1.072 - 0.469 * m) * m;
    for (int i = 0; i < 2; ++i) {
        const double cube = y * y * y;
        y -= y * (cube - m) / (2.0 * cube + m);
    }
    return copysign(ldexp(y, exponent / 3), x);
}

/* 2^x, exact where x is whole; a compiler may make exp2 of pow(2, x). NaN of NaN; 0 or infinity beyond what a double
 * holds, where the conversion to int would be undefined. */
static inline double power_of_two(double x)
{
    if (!(fabs(x) < 2000.0))
        return isnan(x) ? x : x > 0.0 ? HUGE_VAL : 0.0;
    const double whole = floor(x);
    return ldexp(exp(LN_2 * (x - whole)), (int)whole);
}

#endif
