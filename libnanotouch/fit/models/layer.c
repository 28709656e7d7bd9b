/* SPDX-License-Identifier: BSD-3-Clause
 * A paraboloid on a thin layer: s = delta. */
#include "fit/models/layer.h"
#include "fit/models/paraboloid.h"

static const nt_fit_layer layer = {
    .c = NT_LAYER_PARABOLOID_C,
    .a = NT_LAYER_PARABOLOID_A,
    .last = NT_LAYER_PARABOLOID_LAST,
    .m = 0.5,
};

static nt_status prepare(const nt_fit_options *options, const double *value, nt_fit_branch *branch)
{
    const nt_status status = nt_fit_layer_check(value);
    if (status != NT_OK)
        return status;
    *branch = (nt_fit_branch){
        .modulus = value[NT_FIT_EFFECTIVE_MODULUS],
        .size = options->radius,
        .thickness = value[NT_FIT_FOURTH],
        .lambda = NAN,
        .unit = options->radius,
    };
    branch->prefactor = 4.0 / 3.0 * branch->modulus * sqrt(branch->size);
    return NT_OK;
}

static nt_fit_state at(const nt_fit_branch *branch, double s)
{
    return nt_fit_layer_at(&layer, branch, 1.5, s);
}

/* F grows with every power of delta between those of half-space and thin layer: by logarithms. */
static nt_status indentation_at(const nt_fit_branch *branch, double force, double *indentation)
{
    return nt_fit_layer_indentation(at, branch, force, indentation);
}

static nt_law_value contact(const nt_fit_branch *branch, double indentation)
{
    const nt_fit_state state = at(branch, indentation);
    const double a = sqrt(branch->size * indentation) * nt_fit_layer_wider(&layer, branch, indentation);
    return (nt_law_value){.U = NAN, .F = state.F, .k = state.F1, .a = a};
}

static double shape(const nt_fit_branch *branch, double indentation)
{
    return at(branch, indentation).F;
}

static unsigned doubts(const nt_fit_options *options, const nt_fit_result *result)
{
    const int wide = result->contact_radius > NT_FIT_WIDEST * options->radius;
    return wide ? (unsigned)NT_FIT_WIDE : nt_fit_layer_doubts(options, result);
}

static const nt_fit_quantity parameters[NT_FIT_OWN] = {NT_FIT_MODULUS, [NT_FIT_FOURTH] = NT_FIT_OF_LAYER};
NT_FIT_ROW(layer, .words.name = "layer", .words.title = "paraboloid on a layer",
           .words.law = "4/3 E* sqrt(R) delta^(3/2) C(sqrt(R delta)/t)", .words.valid = "paraboloid, " NT_FIT_BONDED,
           .words.scaling = "E* goes as 1/sqrt(R) or faster", .words.tip = "paraboloid", .words.sides = -1,
           .words.exponent = 0.0, .words.pull_off = 0.0, .words.lambda = 0.0, .parameter = parameters,
           .held = 1U << NT_FIT_FOURTH, .prepare = prepare, .at = at, .many = NULL, .derive = nt_fit_layer_derive,
           .indentation = indentation_at, .contact = contact, .shape = shape, .doubts = doubts);
