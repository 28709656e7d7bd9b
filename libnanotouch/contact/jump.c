/* SPDX-License-Identifier: BSD-3-Clause
 * Where contact laws jump under a spring, and every law at a given load.
 *
 * Equilibrium in stage indentation: D = delta + F/k_c. With kappa = k_c in reduced units both ends kappa = 0 (dead
 * weight) and infinity (grips) are reached through G = (kappa d + P)/(1 + kappa), whose folds are those of D.
 *
 * Maugis-Dugdale: G' = 0 on the contact branch, between its two folds; for small lambda and stiff springs on the
 * non-contact branch, where G is a parabola in c. Approach is apart until the onset of attraction; from there no spring
 * holds it, because the attraction starts with its full stress, and it lands where G is the same again.
 * JKR is Maugis-Dugdale at the largest lambda, right to the last bit; DMT and Hertz have no fold but first touch. */
#include <float.h>
#include <math.h>
#include <stddef.h>

#include "contact/contact_equilibrium.h"
#include "contact/maugis/apart.h"
#include "contact/maugis/solve.h"
#include "core/roots.h"
#include "internal/contact.h"
#include "internal/contact_equilibrium.h"
#include "nanotouch/advanced/contact_equilibrium.h"

/* G = stage d + load P. */
typedef struct {
    const nt_maugis *maugis;
    double stage, load;
    double target; /* of G */
} spring_context;

static spring_context spring_of(const nt_maugis *maugis, double spring)
{
    const double kappa = spring * maugis->indentation_scale / maugis->load_scale;
    if (isinf(kappa))
        return (spring_context){maugis, 1.0, 0.0, 0.0};
    return (spring_context){maugis, kappa / (1.0 + kappa), 1.0 / (1.0 + kappa), 0.0};
}

/* (dG/dy)/y */
static double spring_slope(double y, const void *context)
{
    const spring_context *spring = context;
    nt_maugis_equilibrium at;
    nt_maugis_equilibrium_at(spring->maugis->lambda, y, &at);
    return spring->stage * at.d1 + spring->load * at.P1;
}

static double spring_excess(double y, const void *context)
{
    const spring_context *spring = context;
    nt_maugis_equilibrium at;
    nt_maugis_equilibrium_at(spring->maugis->lambda, y, &at);
    return spring->stage * at.d + spring->load * at.P - spring->target;
}

/* c of the fold of G on the non-contact branch, at most that of its end: G' = stage (c - c_fold) - load pi lambda c. */
static double apart_fold(const spring_context *spring)
{
    const double lambda = spring->maugis->lambda;
    return spring->stage * nt_maugis_apart_fold(lambda) / (spring->stage - spring->load * NT_PI * lambda);
}

static nt_contact_state apart_state(const nt_maugis *maugis, double c)
{
    const nt_reduced_units units = {maugis->load_scale, maugis->radius_scale, maugis->indentation_scale};
    const nt_law_value value = nt_maugis_apart_value(maugis, c, c - nt_maugis_apart_fold(maugis->lambda));
    return (nt_contact_state){nt_maugis_apart_indentation(maugis, c) * units.indentation,
                              nt_reduced_to_si(&value, &units)};
}

/* y of the fold of G; 0 where it is not in contact. */
static nt_status fold_parameter(const spring_context *spring, double *y)
{
    const nt_maugis *maugis = spring->maugis;
    if (spring->load == 0.0)
        *y = maugis->fold_y;
    else if (spring->stage == 0.0)
        *y = maugis->load_fold_y;
    else if (spring_slope(maugis->fold_y, spring) >= 0.0) /* not in contact, or too stiff to tell from grips */
        *y = maugis->fold_y;
    else {
        const double bracket[2] = {maugis->fold_y, maugis->load_fold_y};
        return nt_root_find(spring_slope, spring, bracket, y, NULL);
    }
    return NT_OK;
}

static nt_status spring_check(const nt_maugis *maugis, double spring)
{
    if (isnan(spring))
        return NT_E_NOT_FINITE;
    return spring >= 0.0 && maugis->load_scale > 0.0 ? NT_OK : NT_E_RANGE;
}

nt_status nt_maugis_spring_fold(const nt_maugis *maugis, double spring, nt_contact_state *state)
{
    nt_status status = spring_check(maugis, spring);
    if (status != NT_OK)
        return status;
    const spring_context context = spring_of(maugis, spring);
    double y;
    status = fold_parameter(&context, &y);
    if (status != NT_OK)
        return status;
    if (y > 0.0)
        status = nt_maugis_at_parameter(maugis, y, state);
    else
        *state = apart_state(maugis, apart_fold(&context));
    if (status == NT_OK && isfinite(spring))
        state->value.k = -spring; /* what makes it the fold; from the state itself it has fewer digits */
    return status;
}

/* Where the jump-in lands: G as at the onset of attraction, where P = 0. */
static nt_status landing_find(const nt_maugis *maugis, double spring, nt_contact_state *state)
{
    spring_context context = spring_of(maugis, spring);
    context.target = context.stage * maugis->folds.onset_indentation;
    double fold, zero[2] = {0.0, 0.0};
    const nt_status status = fold_parameter(&context, &fold);
    if (status != NT_OK)
        return status;
    if (spring_excess(0.0, &context) >= 0.0 && fold == 0.0) {
        *state = apart_state(maugis, 2.0 * apart_fold(&context)); /* G(c) is a parabola through c = 0 */
        return NT_OK;
    }
    zero[0] = fold;
    zero[1] = 1.0 + 2.0 * maugis->load_fold_y;
    while (spring_excess(zero[1], &context) < 0.0)
        zero[1] *= 2.0; /* G rises with y beyond every bound */
    double y;
    const nt_status found = nt_root_find(spring_excess, &context, zero, &y, NULL);
    return found == NT_OK ? nt_maugis_at_parameter(maugis, y, state) : found;
}

static double stage_gap(const nt_contact_state *state, double spring)
{
    if (spring == 0.0)
        return NAN;
    return -(state->indentation + state->value.F / spring);
}

static nt_status maugis_jump(const nt_maugis *maugis, double spring, nt_jump *jump)
{
    nt_jump found = {.jump_in_gap = nt_maugis_onset_gap(maugis)};
    nt_status status = nt_maugis_spring_fold(maugis, spring, &found.last);
    if (status == NT_OK)
        status = landing_find(maugis, spring, &found.landed);
    if (status != NT_OK)
        return status;
    found.pull_off_gap = stage_gap(&found.last, spring);
    *jump = found;
    return NT_OK;
}

/* The larger root delta of k_c delta + Hertz(delta) = adhesion: DMT just after first touch. */
typedef struct {
    const nt_contact *contact;
    double spring;
} landing_context;

static double landing_excess(double delta, const void *context)
{
    const landing_context *landing = context;
    return landing->spring * delta + nt_dmt_force(landing->contact, delta);
}

static nt_status dmt_jump(const nt_contact *contact, double spring, nt_jump *jump)
{
    nt_jump found = {.last.value = nt_dmt_eval(contact, 0.0)};
    double delta = 0.0;
    if (!isinf(spring)) {
        const landing_context context = {contact, spring};
        /* A little wider: without a spring the end is the root, and the rounding of a libm's cbrt may lie below it. */
        const double bracket[2] = {0.0, (1.0 + 16.0 * DBL_EPSILON) * nt_dmt_indentation(contact, 0.0)};
        const nt_status status =
            bracket[1] > 0.0 ? nt_root_find(landing_excess, &context, bracket, &delta, NULL) : NT_OK;
        if (status != NT_OK)
            return status;
    }
    found.landed = (nt_contact_state){delta, nt_dmt_eval(contact, delta)};
    found.pull_off_gap = stage_gap(&found.last, spring);
    *jump = found;
    return NT_OK;
}

nt_status nt_contact_law_jump(const nt_contact_law *law, double spring, nt_jump *jump)
{
    const nt_contact *contact = &law->maugis.contact;
    if (isnan(spring))
        return NT_E_NOT_FINITE;
    if (!(spring >= 0.0))
        return NT_E_RANGE;
    if (law->model == NT_HERTZ || contact->work_of_adhesion == 0.0) {
        *jump = (nt_jump){.jump_in_gap = 0.0};
        return NT_OK;
    }
    if (law->model == NT_DMT)
        return dmt_jump(contact, spring, jump);
    nt_maugis jkr;
    const nt_status status = law->model == NT_JKR ? nt_maugis_init_lambda(&jkr, contact, NT_MAUGIS_LAMBDA_MAX) : NT_OK;
    return status == NT_OK ? maugis_jump(law->model == NT_JKR ? &jkr : &law->maugis, spring, jump) : status;
}

nt_status nt_contact_law_at_load(const nt_contact_law *law, double force, nt_branch branch, nt_contact_state *state)
{
    const nt_contact *contact = &law->maugis.contact;
    if (law->model == NT_MAUGIS)
        return nt_maugis_at_load(&law->maugis, force, branch, state);
    if (law->model == NT_JKR) {
        nt_maugis jkr;
        const nt_status status = nt_maugis_init_lambda(&jkr, contact, NT_MAUGIS_LAMBDA_MAX);
        return status == NT_OK ? nt_maugis_at_load(&jkr, force, branch, state) : status;
    }
    if (!nt_branch_is_known(branch))
        return NT_E_ARGUMENT;
    if (!isfinite(force))
        return NT_E_NOT_FINITE;
    const double delta =
        law->model == NT_DMT ? nt_dmt_indentation(contact, force) : nt_hertz_indentation(contact, force);
    if (branch == NT_BRANCH_UNSTABLE || isnan(delta))
        return NT_E_NO_SOLUTION;
    *state =
        (nt_contact_state){delta, law->model == NT_DMT ? nt_dmt_eval(contact, delta) : nt_hertz_eval(contact, delta)};
    return NT_OK;
}
