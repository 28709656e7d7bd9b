/* SPDX-License-Identifier: BSD-3-Clause
 * What the laws of a gap share: the hold below the minimum gap, and the form for arrays; private to the
 * library. */
#ifndef NANOTOUCH_FORCES_LAW_H
#define NANOTOUCH_FORCES_LAW_H

#include "core/strided.h"

/* The gap at which a law is evaluated; NaN stays NaN. */
static inline double nt_law_gap(double gap, double minimum_gap)
{
    return gap < minimum_gap ? minimum_gap : gap;
}

/* The law closer than its minimum gap by `depth`: F stays, U goes on linearly, so that F = -dU/dh still holds.
 * Where depth is not above 0, the law as it is. */
static inline nt_law_value nt_law_hold(nt_law_value at_minimum, double depth)
{
    if (!(depth > 0.0))
        return at_minimum;
    if (at_minimum.F != 0.0) /* 0 times an infinite depth is no energy */
        at_minimum.U += at_minimum.F * depth;
    at_minimum.k = 0.0;
    return at_minimum;
}

/* Defines eval_n, the law `eval` of the parameters `type` over arrays. */
#define NT_LAW_ARRAY(type, eval)                                                                                       \
    void eval##_n(const type *law, const nt_strided *arrays)                                                           \
    {                                                                                                                  \
        for (long i = 0; i < arrays->count; i++)                                                                       \
            nt_strided_store(arrays, i, eval(law, arrays->in[i * arrays->in_stride]));                                 \
    }

#endif
