/* SPDX-License-Identifier: BSD-3-Clause
 * Newton's steps and derivatives of many points: see many.h. */
#include "fit/many.h"

#include <stdint.h>

#include "core/variants.h"

static const double straight = 1e-7; /* of s: over such a step the force bends by 1e-14 of itself */
static const double rounding = 1e-15;

NT_VARIANTS int nt_fit_many_step(nt_fit_many *many)
{
    const nt_fit_block *at = &many->at;
    const double compliance = many->lever.compliance;
    const int count = at->count;
    int64_t far = 0;
    for (int i = 0; i < count; i++) {
        const double excess = at->indentation[i] + compliance * at->F[i] - many->base[i];
        const double step = -excess / (at->indentation1[i] + compliance * at->F1[i]);
        const int64_t moves = fabs(step) > straight * fabs(at->s[i]);
        const int64_t is_off = fabs(excess) > rounding * (fabs(at->indentation[i]) + fabs(many->base[i]));
        many->step[i] = step;
        far |= moves & is_off;
    }
    return far != 0;
}

int nt_fit_many_moves(const nt_fit_many *many, int i)
{
    const double depth = many->at.indentation[i],
                 excess = depth + many->lever.compliance * many->at.F[i] - many->base[i];
    return !(fabs(many->step[i]) <= straight * fabs(many->at.s[i]) ||
             fabs(excess) <= rounding * (fabs(depth) + fabs(many->base[i])));
}

NT_VARIANTS void nt_fit_many_move(nt_fit_many *many, double lowest)
{
    const int count = many->at.count;
    for (int i = 0; i < count; i++) {
        const double next = many->at.s[i] + many->step[i];
        many->at.s[i] = next > lowest ? next : lowest;
    }
}

NT_VARIANTS void nt_fit_many_show(nt_fit_many *many)
{
    nt_fit_block *at = &many->at;
    const double compliance = many->lever.compliance, inverse = 1.0 / many->lever.sensitivity,
                 offset = many->lever.offset, tilt = many->lever.tilt;
    const int count = at->count;
    for (int i = 0; i < count; i++) {
        const double F = at->F[i] + at->F1[i] * many->step[i];
        const double depth = at->indentation[i] + at->indentation1[i] * many->step[i];
        const double stiffness = at->F1[i] / at->indentation1[i], softening = inverse / (1.0 + compliance * stiffness);
        const double elastic = (stiffness * depth - at->range[i]) / 1.5;
        at->F[i] = F;
        at->indentation[i] = depth;
        many->by_modulus[i] = softening * elastic;
        many->by_work[i] = softening * (F - elastic);
        many->by_range[i] = -softening * at->range[i];
        many->by_place[i] = -softening * stiffness;
        many->by_sensitivity[i] = -F * inverse;
        many->force[i] = F * inverse + (offset + tilt * many->from[i]);
    }
}
