/* SPDX-License-Identifier: BSD-3-Clause
 * Sneddon's sphere, Int. J. Eng. Sci. 3 (1965) 47, the whole of it and not its paraboloid: s = delta. At a = R/2 Hertz
 * presses 2.8 % harder. By the series of geometry.h, off by 1e-10 of F at delta = R/3 and by 7e-7 at delta = R. */
#include "fit/models/paraboloid.h"
#include "internal/geometry.h"
#include "nanotouch/advanced/geometry.h"

static nt_status prepare(const nt_fit_options *options, const double *value, nt_fit_branch *branch)
{
    const double E = value[NT_FIT_EFFECTIVE_MODULUS];
    if (!isfinite(E) || E <= 0.0)
        return isfinite(E) ? NT_E_RANGE : NT_E_NOT_FINITE;
    *branch = (nt_fit_branch){.modulus = E, .size = options->radius, .lambda = NAN, .unit = options->radius};
    return NT_OK;
}

static nt_law_value contact(const nt_fit_branch *branch, double indentation)
{
    return nt_sphere_series_eval(branch->size, branch->modulus, indentation);
}

static nt_fit_state at(const nt_fit_branch *branch, double s)
{
    const nt_law_value law = contact(branch, s);
    return (nt_fit_state){.F = law.F, .indentation = s, .F1 = law.k, .indentation1 = 1.0};
}

static nt_status indentation_at(const nt_fit_branch *branch, double force, double *indentation)
{
    const nt_shape sphere = {.kind = NT_SHAPE_SPHERE, .radius = branch->size};
    *indentation = nt_shape_indentation(&sphere, branch->modulus, force);
    return isfinite(*indentation) ? NT_OK : NT_E_NO_SOLUTION;
}

static double shape(const nt_fit_branch *branch, double indentation)
{
    return contact(branch, indentation).F;
}

static const nt_fit_quantity parameters[NT_FIT_OWN] = {NT_FIT_MODULUS};
NT_FIT_ROW(sphere, .words.name = "sphere", .words.title = "Sneddon's sphere",
           .words.law = "E* ((a^2 + R^2)/2 ln((R + a)/(R - a)) - a R), delta = a/2 ln((R + a)/(R - a))",
           .words.valid = "sphere, no adhesion, contact radius up to R/2 (strains of 10 %), elastic half-space",
           .words.scaling = "E* goes as 1/sqrt(R)", .words.tip = "sphere", .words.sides = -1, .words.exponent = 1.5,
           .words.pull_off = 0.0, .words.lambda = 0.0, .parameter = parameters, .held = 0U, .prepare = prepare,
           .at = at, .many = NULL, .derive = nt_fit_derive_linear, .indentation = indentation_at, .contact = contact,
           .shape = shape, .doubts = nt_fit_paraboloid_doubts);
