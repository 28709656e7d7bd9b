/* SPDX-License-Identifier: BSD-3-Clause
 * Laws below their minimum gap; private to forces/. */
#ifndef NANOTOUCH_FORCES_HOLD_H
#define NANOTOUCH_FORCES_HOLD_H

#include "nanotouch/types.h"

/* The law closer than its minimum gap, by `depth` > 0: F stays, U goes on linearly, so that F = -dU/dh still holds. */
static inline nt_law_value nt_law_hold(nt_law_value at_minimum, double depth)
{
    at_minimum.U += at_minimum.F * depth;
    at_minimum.k = 0.0;
    return at_minimum;
}

#endif
