/* SPDX-License-Identifier: BSD-3-Clause
 * Derjaguin, Muller and Toporov, J. Colloid Interface Sci. 53 (1975) 314, as Maugis has it: Hertz less a constant. */
#include "fit/models/paraboloid.h"
#include "internal/contact.h"

static nt_status prepare(const nt_fit_options *options, const double *value, nt_fit_branch *branch)
{
    const nt_contact contact = {options->radius, value[NT_FIT_EFFECTIVE_MODULUS], value[NT_FIT_WORK_OF_ADHESION], 0.0};
    const nt_status status = nt_fit_paraboloid(NT_DMT, &contact, branch);
    branch->prefactor = 4.0 / 3.0 * contact.effective_modulus * sqrt(contact.radius);
    branch->unit = contact.radius;
    return status;
}

static nt_status indentation_at(const nt_fit_branch *branch, double force, double *indentation)
{
    *indentation = nt_dmt_indentation(&branch->law.maugis.contact, force);
    return isfinite(*indentation) ? NT_OK : NT_E_NO_SOLUTION;
}

static const nt_fit_quantity parameters[NT_FIT_OWN] = {NT_FIT_MODULUS, NT_FIT_ADHESION};
NT_FIT_ROW(dmt, .words.name = "dmt", .words.title = "DMT", .words.law = "4/3 E* sqrt(R) delta^(3/2) - 2 pi w R",
           .words.valid = "paraboloid, stiff with a long range of adhesion (lambda below 0.05), " NT_FIT_SMALL,
           .words.scaling = "E* goes as 1/sqrt(R), w as 1/R", .words.tip = "paraboloid", .words.sides = -1,
           .words.exponent = 1.5, .words.pull_off = 2.0, .words.lambda = 0.001, .parameter = parameters, .held = 0U,
           .prepare = prepare, .at = nt_fit_power_at, .many = nt_fit_power_many, .derive = nt_fit_derive_adhesive,
           .indentation = indentation_at, .contact = nt_fit_paraboloid_contact, .shape = NULL,
           .doubts = nt_fit_paraboloid_doubts);
