/* SPDX-License-Identifier: BSD-3-Clause
 * A pyramid of four sides, psi between axis and face, as a cone (nt_pyramid_equivalent_angle). */
#include "fit/models/sharp.h"

static nt_status prepare(const nt_fit_options *options, const double *value, nt_fit_branch *branch)
{
    const double angle = nt_pyramid_equivalent_angle(4, options->half_angle);
    return nt_fit_sharp(angle, value[NT_FIT_EFFECTIVE_MODULUS], branch);
}

static const nt_fit_quantity parameters[NT_FIT_OWN] = {NT_FIT_MODULUS};
NT_FIT_ROW(pyramid, .words.name = "pyramid", .words.title = "four-sided pyramid",
           .words.law = "2/pi E* tan(psi') delta^2, psi' of the equivalent cone",
           .words.valid = "sharp pyramid of four sides, no adhesion, elastic half-space",
           .words.scaling = "E* goes as 1/tan of it", .words.tip = "cone", .words.sides = 4, .words.exponent = 2.0,
           .words.pull_off = 0.0, .words.lambda = 0.0, .parameter = parameters, .held = 0U, .prepare = prepare,
           .at = nt_fit_sharp_at, .many = NULL, .derive = nt_fit_sharp_derive, .indentation = nt_fit_sharp_indentation,
           .contact = nt_fit_sharp_contact, .shape = nt_fit_sharp_shape, .doubts = nt_fit_no_doubt);
