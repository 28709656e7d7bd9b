/* SPDX-License-Identifier: BSD-3-Clause
 * Private. fmin and fmax are calls where NaN must be minded; here it has been. */
#ifndef NANOTOUCH_CORE_CLAMP_H
#define NANOTOUCH_CORE_CLAMP_H

static inline double lesser(double a, double b)
{
    return a < b ? a : b;
}
static inline double greater(double a, double b)
{
    return a > b ? a : b;
}
static inline double clamp(double value, double minimum, double maximum)
{
    return lesser(greater(value, minimum), maximum);
}

#endif
