/* SPDX-License-Identifier: BSD-3-Clause
 * What the laws of a paraboloid share; private to fit/. */
#ifndef NANOTOUCH_FIT_MODELS_PARABOLOID_H
#define NANOTOUCH_FIT_MODELS_PARABOLOID_H

#include "core/variants.h"
#include "fit/models/row.h"

#define NT_FIT_SMALL "contact radius much smaller than R, elastic half-space"
#define NT_FIT_WIDEST 0.5 /* contact radius over R, from where a tip is no paraboloid on a half-space */

static inline nt_status nt_fit_paraboloid(nt_model model, const nt_contact *contact, nt_fit_branch *branch)
{
    *branch = (nt_fit_branch){.lambda = NAN, .unit = 1.0};
    const nt_status status = nt_contact_law_init(&branch->law, model, contact);
    if (status == NT_OK)
        branch->pull_off = nt_contact_law_pull_off_force(&branch->law);
    return status;
}

/* Hertz and DMT: s = delta. */
static inline nt_fit_state nt_fit_power_at(const nt_fit_branch *branch, double s)
{
    const double slope = branch->prefactor * sqrt(s); /* F/delta */
    return (nt_fit_state){.F = slope * s - branch->pull_off, .indentation = s, .F1 = 1.5 * slope, .indentation1 = 1.0};
}

NT_VARIANTS static inline void nt_fit_power_many(const nt_fit_branch *branch, nt_fit_block *at)
{
    const double prefactor = branch->prefactor, pull_off = branch->pull_off;
    const int count = at->count;
    for (int i = 0; i < count; i++) {
        const double s = at->s[i], slope = prefactor * sqrt(s); /* F/delta */
        at->F[i] = slope * s - pull_off;
        at->indentation[i] = s;
        at->F1[i] = 1.5 * slope;
        at->indentation1[i] = 1.0;
    }
}

/* The derivatives of docs/evidence/fit.md; the third is 0 but for Maugis-Dugdale. */
static inline void nt_fit_derive_adhesive(const nt_fit_state *state, double stiffness, double own[NT_FIT_OWN])
{
    const double elastic = (stiffness * state->indentation - state->range) / 1.5;
    own[NT_FIT_EFFECTIVE_MODULUS] = elastic;
    own[NT_FIT_WORK_OF_ADHESION] = state->F - elastic;
    own[NT_FIT_COHESIVE_RANGE] = -state->range;
}

static inline nt_law_value nt_fit_paraboloid_contact(const nt_fit_branch *branch, double indentation)
{
    nt_law_value there = {0.0, 0.0, 0.0, 0.0};
    (void)nt_contact_law_eval(&branch->law, indentation, NT_BRANCH_STABLE, &there);
    return there;
}

static inline unsigned nt_fit_paraboloid_doubts(const nt_fit_options *options, const nt_fit_result *result)
{
    return result->contact_radius > NT_FIT_WIDEST * options->radius ? (unsigned)NT_FIT_WIDE : 0U;
}

#endif
