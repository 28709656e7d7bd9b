/* SPDX-License-Identifier: BSD-3-Clause
 * A cone on a thin layer: s = delta. */
#include "fit/models/layer.h"
#include "nanotouch/material.h"

static const nt_fit_layer layer = {
    .c = NT_LAYER_CONE_C,
    .a = NT_LAYER_CONE_A,
    .last = NT_LAYER_CONE_LAST,
    .m = 1.0,
};

static nt_status prepare(const nt_fit_options *options, const double *value, nt_fit_branch *branch)
{
    const nt_status status = nt_fit_layer_check(value);
    if (status != NT_OK)
        return status;
    *branch = (nt_fit_branch){
        .modulus = value[NT_FIT_EFFECTIVE_MODULUS],
        .size = tan(options->half_angle),
        .thickness = value[NT_FIT_FOURTH],
        .lambda = NAN,
        .unit = 1e-8,
    };
    branch->prefactor = 2.0 / NT_PI * branch->modulus * branch->size;
    return NT_OK;
}

static nt_fit_state at(const nt_fit_branch *branch, double s)
{
    return nt_fit_layer_at(&layer, branch, 2.0, s);
}

/* F grows with every power of delta between those of half-space and thin layer: by logarithms. */
static nt_status indentation_at(const nt_fit_branch *branch, double force, double *indentation)
{
    return nt_fit_layer_indentation(at, branch, force, indentation);
}

static nt_law_value contact(const nt_fit_branch *branch, double indentation)
{
    const nt_fit_state state = at(branch, indentation);
    const double a = 2.0 / NT_PI * branch->size * indentation * nt_fit_layer_wider(&layer, branch, indentation);
    return (nt_law_value){.U = NAN, .F = state.F, .k = state.F1, .a = a};
}

static double shape(const nt_fit_branch *branch, double indentation)
{
    return at(branch, indentation).F;
}

static const nt_fit_quantity parameters[NT_FIT_OWN] = {NT_FIT_MODULUS, [NT_FIT_FOURTH] = NT_FIT_OF_LAYER};
NT_FIT_ROW(layer_cone, .words.name = "layer_cone", .words.title = "cone on a layer",
           .words.law = "2/pi E* tan(psi) delta^2 C(delta tan(psi)/t)", .words.valid = "sharp cone, " NT_FIT_BONDED,
           .words.scaling = "E* goes as 1/tan of it or faster", .words.tip = "cone", .words.sides = 0,
           .words.exponent = 0.0, .words.pull_off = 0.0, .words.lambda = 0.0, .parameter = parameters,
           .held = 1U << NT_FIT_FOURTH, .prepare = prepare, .at = at, .many = NULL, .derive = nt_fit_layer_derive,
           .indentation = indentation_at, .contact = contact, .shape = shape, .doubts = nt_fit_layer_doubts);
