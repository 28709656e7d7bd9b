/* SPDX-License-Identifier: BSD-3-Clause
 * Sneddon's flat punch, Int. J. Eng. Sci. 3 (1965) 47, whose radius is the tip's: s = delta. The force rises from the
 * contact point with a kink, so that contact point and modulus show apart. */
#include "fit/models/row.h"
#include "internal/contact.h"

static nt_status prepare(const nt_fit_options *options, const double *value, nt_fit_branch *branch)
{
    const double E = value[NT_FIT_EFFECTIVE_MODULUS];
    if (!isfinite(E) || E <= 0.0)
        return isfinite(E) ? NT_E_RANGE : NT_E_NOT_FINITE;
    *branch = (nt_fit_branch){
        .modulus = E,
        .size = options->radius,
        .lambda = NAN,
        .prefactor = 2.0 * E * options->radius,
        .unit = options->radius,
    };
    return NT_OK;
}

static nt_fit_state at(const nt_fit_branch *branch, double s)
{
    return (nt_fit_state){.F = branch->prefactor * s, .indentation = s, .F1 = branch->prefactor, .indentation1 = 1.0};
}

static void derive(const nt_fit_state *state, double stiffness, double own[NT_FIT_OWN])
{
    own[NT_FIT_EFFECTIVE_MODULUS] = stiffness * state->indentation;
}

static nt_status indentation_at(const nt_fit_branch *branch, double force, double *indentation)
{
    *indentation = force / branch->prefactor;
    return force >= 0.0 ? NT_OK : NT_E_NO_SOLUTION;
}

static nt_law_value contact(const nt_fit_branch *branch, double indentation)
{
    return nt_punch_eval(branch->modulus, branch->size, indentation);
}

static double shape(const nt_fit_branch *branch, double indentation)
{
    return branch->prefactor * indentation;
}

static const nt_fit_quantity parameters[NT_FIT_OWN] = {NT_FIT_MODULUS};
NT_FIT_ROW(punch, .words.name = "punch", .words.title = "Sneddon's flat punch", .words.law = "2 E* a delta",
           .words.valid = "rigid flat punch of radius a, square to the sample, no adhesion, elastic half-space",
           .words.scaling = "E* goes as 1/R", .words.tip = "punch", .words.sides = -1, .words.exponent = 1.0,
           .words.pull_off = 0.0, .words.lambda = 0.0, .parameter = parameters, .held = 0U, .prepare = prepare,
           .at = at, .many = NULL, .derive = derive, .indentation = indentation_at, .contact = contact, .shape = shape,
           .doubts = nt_fit_no_doubt);
