/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis, J. Colloid Interface Sci. 150 (1992) 243: s = y^2 (contact/maugis/branch.c), because load and indentation
 * leave the end of the contact branch, y = 0, quadratically; below it, where the surfaces are apart but a disc r < c
 * still attracts, s = c/c0 - 1 with c0 the c of y = 0 and
 *
 *     P = -(pi/2) lambda c^2       d = c^2/2 - 8 lambda c/(3 pi) - 2/(pi lambda)                        (apart)
 *
 * whose displacement fold is at c = 8 lambda/(3 pi). */
#include "contact/maugis/functions.h"
#include "fit/models/paraboloid.h"
#include "internal/contact.h"
#include "nanotouch/material.h"

static nt_status prepare(const nt_fit_options *options, const double *value, nt_fit_branch *branch)
{
    const double w = value[NT_FIT_WORK_OF_ADHESION];
    const nt_contact contact = {options->radius, value[NT_FIT_EFFECTIVE_MODULUS], w, w / value[NT_FIT_COHESIVE_RANGE]};
    const nt_status status = nt_fit_paraboloid(NT_MAUGIS, &contact, branch);
    if (status != NT_OK)
        return status;
    const nt_maugis *maugis = &branch->law.maugis;
    branch->lambda = maugis->lambda;
    branch->load = maugis->load_scale;
    branch->indentation = maugis->indentation_scale;
    branch->load_fold = maugis->load_fold_y * maugis->load_fold_y;
    branch->touch_c = nt_maugis_equilibrium_of(maugis->lambda, nt_maugis_functions_at(0.0)).b;
    branch->grip_fold = maugis->folds.grip_in_contact ? maugis->fold_y * maugis->fold_y
                                                      : 8.0 * maugis->lambda / (3.0 * NT_PI * branch->touch_c) - 1.0;
    return NT_OK;
}

static inline nt_fit_state in_contact(const nt_fit_branch *branch, double s)
{
    const double lambda = branch->lambda;
    const nt_maugis_functions f = nt_maugis_functions_at(sqrt(s));
    const nt_maugis_equilibrium at = nt_maugis_equilibrium_of(lambda, f);
    const double exact = 4.0 / 3.0 * lambda * lambda * f.g2 * at.b, q = exact < 1.0 ? exact : 1.0; /* rounding only */
    const double r = (1.0 + q) / (2.0 - q), a2 = at.a * at.a;
    const double load =
        at.P * (1.0 - 2.0 * r) - a2 * at.a * (1.0 + r); /* lambda dP/dlambda, dd/dlambda at constant y */
    const double depth = at.d * (1.0 - r) - a2 * (1.0 + r);
    return (nt_fit_state){
        .F = branch->load * at.P,
        .indentation = branch->indentation * at.d,
        .F1 = branch->load * 0.5 * at.P1,
        .indentation1 = branch->indentation * 0.5 * at.d1,
        .range = branch->load * (load - at.P1 / at.d1 * depth),
    };
}

static nt_fit_state apart(const nt_fit_branch *branch, double s)
{
    const double lambda = branch->lambda, c = branch->touch_c * (1.0 + s);
    const double linear = 8.0 * lambda / (3.0 * NT_PI), constant = 2.0 / (NT_PI * lambda);
    const double P = -0.5 * NT_PI * lambda * c * c, dP_dc = -NT_PI * lambda * c, dd_dc = c - linear;
    return (nt_fit_state){
        .F = branch->load * P,
        .indentation = branch->indentation * (0.5 * c * c - linear * c - constant),
        .F1 = branch->load * dP_dc * branch->touch_c,
        .indentation1 = branch->indentation * dd_dc * branch->touch_c,
        .range = branch->load * (P - dP_dc / dd_dc * (constant - linear * c)),
    };
}

static nt_fit_state at(const nt_fit_branch *branch, double s)
{
    return s < 0.0 ? apart(branch, s) : in_contact(branch, s);
}

static inline void put(const nt_fit_state *state, nt_fit_block *block, int i)
{
    block->F[i] = state->F;
    block->indentation[i] = state->indentation;
    block->F1[i] = state->F1;
    block->indentation1[i] = state->indentation1;
    block->range[i] = state->range;
}

/* As if all were in contact. */
NT_VARIANTS static void many_in_contact(const nt_fit_branch *of, nt_fit_block *block)
{
    const nt_fit_branch branch = {.lambda = of->lambda, .load = of->load, .indentation = of->indentation};
    const int count = block->count;
    for (int i = 0; i < count; i++) {
        const nt_fit_state state = in_contact(&branch, block->s[i] > 0.0 ? block->s[i] : 0.0);
        put(&state, block, i);
    }
}

static void many(const nt_fit_branch *branch, nt_fit_block *block)
{
    many_in_contact(branch, block);
    for (int i = 0; i < block->count; i++)
        if (block->s[i] < 0.0) {
            const nt_fit_state state = apart(branch, block->s[i]);
            put(&state, block, i);
        }
}

static nt_status indentation_at(const nt_fit_branch *branch, double force, double *indentation)
{
    return nt_maugis_indentation(&branch->law.maugis, force, NT_BRANCH_STABLE, indentation, NULL);
}

static const nt_fit_quantity parameters[NT_FIT_OWN] = {NT_FIT_MODULUS, NT_FIT_ADHESION, NT_FIT_RANGE};
NT_FIT_ROW(maugis, .words.name = "maugis", .words.title = "Maugis-Dugdale",
           .words.law = "Maugis' equations for a constant stress over a range h0",
           .words.valid = "paraboloid, every lambda, " NT_FIT_SMALL, .words.scaling = "E* goes as 1/sqrt(R), w as 1/R",
           .words.tip = "paraboloid", .words.sides = -1, .words.exponent = 1.5, .words.pull_off = 1.75,
           .words.lambda = 0.0, .parameter = parameters, .held = 1U << NT_FIT_COHESIVE_RANGE, .prepare = prepare,
           .at = at, .many = many, .derive = nt_fit_derive_adhesive, .indentation = indentation_at,
           .contact = nt_fit_paraboloid_contact, .shape = NULL, .doubts = nt_fit_paraboloid_doubts);
