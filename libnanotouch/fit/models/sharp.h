/* SPDX-License-Identifier: BSD-3-Clause
 * Sneddon's cone, Int. J. Eng. Sci. 3 (1965) 47, and a pyramid as a cone of equivalent angle: s = delta,
 * F = 2/pi E* tan(psi) delta^2; private to fit/. */
#ifndef NANOTOUCH_FIT_MODELS_SHARP_H
#define NANOTOUCH_FIT_MODELS_SHARP_H

#include "fit/models/row.h"
#include "internal/contact.h"
#include "nanotouch/advanced/geometry.h"
#include "nanotouch/material.h"

static inline nt_status nt_fit_sharp(double angle, double effective_modulus, nt_fit_branch *branch)
{
    if (!isfinite(effective_modulus) || effective_modulus <= 0.0)
        return isfinite(effective_modulus) ? NT_E_RANGE : NT_E_NOT_FINITE;
    *branch = (nt_fit_branch){
        .modulus = effective_modulus,
        .size = angle,
        .lambda = NAN,
        .prefactor = 2.0 / NT_PI * effective_modulus * tan(angle),
        .unit = 1e-8, /* where the search begins */
    };
    return NT_OK;
}

static inline nt_fit_state nt_fit_sharp_at(const nt_fit_branch *branch, double s)
{
    const double slope = branch->prefactor * s; /* F/delta */
    return (nt_fit_state){.F = slope * s, .indentation = s, .F1 = 2.0 * slope, .indentation1 = 1.0};
}

static inline void nt_fit_sharp_derive(const nt_fit_state *state, double stiffness, double own[NT_FIT_OWN])
{
    own[NT_FIT_EFFECTIVE_MODULUS] = stiffness * state->indentation / 2.0;
}

static inline nt_status nt_fit_sharp_indentation(const nt_fit_branch *branch, double force, double *indentation)
{
    *indentation = sqrt(force / branch->prefactor);
    return force >= 0.0 ? NT_OK : NT_E_NO_SOLUTION;
}

static inline nt_law_value nt_fit_sharp_contact(const nt_fit_branch *branch, double indentation)
{
    return nt_cone_eval(branch->modulus, branch->size, indentation);
}

static inline double nt_fit_sharp_shape(const nt_fit_branch *branch, double indentation)
{
    return nt_cone_eval(branch->modulus, branch->size, indentation).F;
}

#endif
