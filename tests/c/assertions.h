/* SPDX-License-Identifier: BSD-3-Clause
 * Assertions on doubles that say by how much they fail. */
#ifndef NANOTOUCH_TEST_ASSERTIONS_H
#define NANOTOUCH_TEST_ASSERTIONS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* NaN is within nothing. */
static inline void assert_within(double value, double expected, double bound)
{
    if (!(fabs(value - expected) <= bound))
        fail_msg("%.17g differs from %.17g by %g, bound %g", value, expected, fabs(value - expected), bound);
}

#endif
