/* SPDX-License-Identifier: BSD-3-Clause
 * Private. Three components. */
#ifndef NANOTOUCH_MANIPULATION_VECTOR_H
#define NANOTOUCH_MANIPULATION_VECTOR_H

#include <math.h>

static inline double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double norm(const double a[3])
{
    return sqrt(dot(a, a));
}

static inline void cross(const double a[3], const double b[3], double out[3])
{
    const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

#endif
