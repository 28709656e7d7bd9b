/* SPDX-License-Identifier: BSD-3-Clause
 * The larger and the smaller of two, NaN where either is: a test must not lose a NaN, as fmax and fmin do. */
#ifndef NANOTOUCH_TEST_LARGER_H
#define NANOTOUCH_TEST_LARGER_H

#include <math.h>

static inline double larger(double a, double b)
{
    return isnan(a) || a > b ? a : b;
}

static inline double smaller(double a, double b)
{
    return isnan(a) || a < b ? a : b;
}

#endif
