/* SPDX-License-Identifier: BSD-3-Clause
 * Hertz, J. reine angew. Math. 92 (1881) 156: a paraboloid without adhesion, s = delta. */
#include "fit/models/paraboloid.h"
#include "internal/contact.h"

static nt_status prepare(const nt_fit_options *options, const double *value, nt_fit_branch *branch)
{
    const nt_contact contact = {options->radius, value[NT_FIT_EFFECTIVE_MODULUS], 0.0, 0.0};
    const nt_status status = nt_fit_paraboloid(NT_HERTZ, &contact, branch);
    branch->prefactor = 4.0 / 3.0 * contact.effective_modulus * sqrt(contact.radius);
    branch->unit = contact.radius;
    return status;
}

static void derive(const nt_fit_state *state, double stiffness, double own[NT_FIT_OWN])
{
    own[NT_FIT_EFFECTIVE_MODULUS] = stiffness * state->indentation / 1.5;
}

static nt_status indentation_at(const nt_fit_branch *branch, double force, double *indentation)
{
    *indentation = nt_hertz_indentation(&branch->law.maugis.contact, force);
    return isfinite(*indentation) ? NT_OK : NT_E_NO_SOLUTION;
}

static double shape(const nt_fit_branch *branch, double indentation)
{
    const nt_contact *contact = &branch->law.maugis.contact;
    return 4.0 / 3.0 * contact->effective_modulus * indentation * sqrt(contact->radius * indentation);
}

static const nt_fit_quantity parameters[NT_FIT_OWN] = {NT_FIT_MODULUS};
NT_FIT_ROW(hertz, .words.name = "hertz", .words.title = "Hertz", .words.law = "4/3 E* sqrt(R) delta^(3/2)",
           .words.valid = "paraboloid, no adhesion, " NT_FIT_SMALL, .words.scaling = "E* goes as 1/sqrt(R), w as 1/R",
           .words.tip = "paraboloid", .words.sides = -1, .words.exponent = 1.5, .words.pull_off = 0.0,
           .words.lambda = 0.0, .parameter = parameters, .held = 0U, .prepare = prepare, .at = nt_fit_power_at,
           .many = nt_fit_power_many, .derive = derive, .indentation = indentation_at,
           .contact = nt_fit_paraboloid_contact, .shape = shape, .doubts = nt_fit_paraboloid_doubts);
