/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale (Maugis, J. Colloid Interface Sci. 150 (1992) 243; paper, Eq. 11 with errata E9, E10): a paraboloid of
 * radius R on an elastic half-space, attracted by a constant stress sigma0 wherever the gap is below h0 = w/sigma0. One
 * parameter, lambda = 2 sigma0 (R/(pi w K^2))^(1/3), leads from DMT (0) to JKR (infinity). Valid for a << R.
 *
 * The contact branch is that of maugis/branch.c. At its end, a = 0, the surfaces part but remain inside the range of
 * the stress over a disc of radius c; there, in reduced units,
 *
 *     d = c^2/2 - 8 lambda c/(3 pi) - 2/(pi lambda)       P = -pi/2 lambda c^2                     (non-contact)
 *     U = -pi/8 lambda c^4 + 4/9 lambda^2 c^3
 *
 * down to c = 0, the onset of attraction at gap h0. Force, stiffness and energy are continuous across a = 0. The
 * displacement fold lies on the contact branch for lambda > 0.9379 and at c* = 8 lambda/(3 pi) otherwise. */
#include "nanotouch/contact.h"

#include <math.h>
#include <stddef.h>

#include "contact/maugis/apart.h"
#include "contact/maugis/solve.h"
#include "core/same_bits.h"
#include "nanotouch/material.h"

static nt_reduced_units units_of(const nt_maugis *maugis)
{
    return (nt_reduced_units){maugis->load_scale, maugis->radius_scale, maugis->indentation_scale};
}

/* (non-contact) at d between the fold and the end of the branch; the larger c is the stable one. */
static nt_law_value non_contact_eval(const nt_maugis *maugis, double d, int stable)
{
    const double c_fold = nt_maugis_apart_fold(maugis->lambda);
    const double beyond_onset = d - maugis->folds.onset_indentation;
    const double root = sqrt(fmax(c_fold * c_fold + 2.0 * beyond_onset, 0.0));
    const double c = stable ? c_fold + root : -2.0 * beyond_onset / (c_fold + root);
    return nt_maugis_apart_value(maugis, c, stable ? root : -root);
}

nt_law_value nt_maugis_value_of(const nt_maugis *maugis, const nt_maugis_equilibrium *point, int stable)
{
    nt_maugis_equilibrium slope = *point;
    const double resolution = (stable ? NT_FOLD_RESOLUTION : -NT_FOLD_RESOLUTION) * maugis->fold_y;
    if (fabs(point->y - maugis->fold_y) < fabs(resolution))
        nt_maugis_equilibrium_at(maugis->lambda, maugis->fold_y + resolution, &slope);
    return (nt_law_value){
        .U = nt_maugis_equilibrium_energy(maugis->lambda, point),
        .F = point->P,
        .k = slope.P1 / slope.d1,
        .a = point->a,
    };
}

nt_maugis_start nt_maugis_start_of(const nt_maugis *maugis)
{
    const nt_maugis_folds *folds = &maugis->folds;
    return (nt_maugis_start){maugis->lambda, maugis->fold_y, folds->grip_radius,
                             folds->grip_in_contact ? folds->grip_indentation : folds->touch_indentation};
}

nt_status nt_maugis_contact_find(const nt_maugis *maugis, double d, int stable, nt_maugis_equilibrium *point,
                                 nt_solve_info *info)
{
    const nt_maugis_start start = nt_maugis_start_of(maugis);
    if (stable)
        return nt_maugis_stable_find(&start, d, point, info);
    const nt_maugis_equilibrium fold = {.y = start.y, .a = start.a, .d = start.d};
    const nt_maugis_goal goal = {NT_GIVEN_INDENTATION, d, &fold, 1, 0.0};
    return nt_maugis_point_find(maugis->lambda, &goal, point, info);
}

static nt_status contact_eval(const nt_maugis *maugis, double d, int stable, nt_law_value *reduced, nt_solve_info *info)
{
    nt_maugis_equilibrium point;
    const nt_status status = nt_maugis_contact_find(maugis, d, stable, &point, info);
    if (status != NT_OK)
        return status;
    const nt_maugis_start start = nt_maugis_start_of(maugis);
    const nt_maugis_rest rest = nt_maugis_rest_of(&start, &point, d, NT_FOLD_RESOLUTION * start.y);
    *reduced = nt_maugis_value_of(maugis, &point, stable);
    reduced->U += rest.U;
    reduced->F += rest.P;
    reduced->a += rest.a;
    return NT_OK;
}

static nt_status zero_load_find(nt_maugis *maugis, const nt_maugis_equilibrium *load_fold)
{
    const nt_maugis_goal goal = {NT_GIVEN_LOAD, 0.0, load_fold, 0, 0.0};
    nt_maugis_equilibrium point;
    const nt_status status = nt_maugis_point_find(maugis->lambda, &goal, &point, NULL);
    if (status != NT_OK)
        return status;
    maugis->folds.zero_load_radius = point.a;
    maugis->folds.zero_load_indentation = point.d;
    return NT_OK;
}

/* Folds and ends of both branches; lambda is set. */
static nt_status folds_find(nt_maugis *maugis)
{
    const double lambda = maugis->lambda;
    nt_maugis_folds *folds = &maugis->folds;
    nt_maugis_equilibrium touch, grip, pull_off;
    nt_maugis_equilibrium_at(lambda, 0.0, &touch);
    nt_status status = nt_maugis_fold_find(lambda, NT_GIVEN_INDENTATION, &grip);
    if (status == NT_OK)
        status = nt_maugis_fold_find(lambda, NT_GIVEN_LOAD, &pull_off);
    if (status != NT_OK)
        return status;
    maugis->fold_y = grip.y;
    maugis->load_fold_y = pull_off.y;
    const double onset = -2.0 / (NT_PI * lambda), c = nt_maugis_apart_fold(lambda);
    *folds = (nt_maugis_folds){
        .pull_off_load = pull_off.P,
        .pull_off_radius = pull_off.a,
        .pull_off_indentation = pull_off.d,
        .grip_in_contact = grip.y > 0.0,
        .grip_load = grip.y > 0.0 ? grip.P : -0.5 * NT_PI * lambda * c * c,
        .grip_radius = grip.a,
        .grip_indentation = grip.y > 0.0 ? grip.d : onset - 0.5 * c * c,
        .touch_load = touch.P,
        .touch_indentation = touch.d,
        .onset_indentation = onset,
    };
    return zero_load_find(maugis, &pull_off);
}

double nt_maugis_lambda(const nt_contact *contact)
{
    if (contact->work_of_adhesion == 0.0)
        return INFINITY;
    const double K = 4.0 / 3.0 * contact->effective_modulus;
    const double root_K = cube_root(K);
    return 2.0 * contact->cohesive_stress / (root_K * root_K) * cube_root(contact->radius) /
           cube_root(NT_PI * contact->work_of_adhesion);
}

/* Scales and folds of a checked contact. */
static nt_status prepare(nt_maugis *maugis, const nt_contact *contact, double lambda)
{
    const nt_reduced_units units = nt_reduced_units_of(contact);
    nt_maugis made = {
        .lambda = lambda,
        .load_scale = units.load,
        .radius_scale = units.radius,
        .indentation_scale = units.indentation,
        .contact = *contact,
    };
    if (contact->work_of_adhesion > 0.0) {
        if (!(lambda >= NT_MAUGIS_LAMBDA_MIN && lambda <= NT_MAUGIS_LAMBDA_MAX))
            return NT_E_RANGE;
        const nt_status status = folds_find(&made);
        if (status != NT_OK)
            return status;
    }
    *maugis = made;
    return NT_OK;
}

nt_status nt_maugis_init(nt_maugis *maugis, const nt_contact *contact)
{
    const nt_status status = nt_contact_check(contact, NULL);
    return status == NT_OK ? prepare(maugis, contact, nt_maugis_lambda(contact)) : status;
}

nt_status nt_maugis_init_lambda(nt_maugis *maugis, const nt_contact *contact, double lambda)
{
    nt_contact complete = *contact;
    complete.cohesive_stress = 1.0; /* read by nothing before it is known */
    const nt_status status = nt_contact_check(&complete, NULL);
    if (status != NT_OK)
        return status;
    if (!isfinite(lambda))
        return NT_E_NOT_FINITE;
    complete.cohesive_stress = lambda / nt_maugis_lambda(&complete);
    return prepare(maugis, &complete, complete.work_of_adhesion > 0.0 ? lambda : HUGE_VAL);
}

/* Hertz: w = 0, or so far in that adhesion is below the last bit. */
static nt_status hertz_eval(const nt_maugis *maugis, double indentation, nt_branch branch, nt_law_value *value)
{
    if (branch == NT_BRANCH_UNSTABLE)
        return NT_E_NO_SOLUTION;
    *value = nt_hertz_eval(&maugis->contact, indentation);
    return NT_OK;
}

nt_status nt_maugis_eval(const nt_maugis *maugis, double indentation, nt_branch branch, nt_law_value *value,
                         nt_solve_info *info)
{
    const nt_maugis_folds *folds = &maugis->folds;
    const int stable = branch != NT_BRANCH_UNSTABLE;
    if (info != NULL)
        *info = (nt_solve_info){0};
    if (!nt_branch_is_known(branch))
        return NT_E_ARGUMENT;
    if (!isfinite(indentation))
        return NT_E_NOT_FINITE;
    if (maugis->load_scale == 0.0 || indentation > NT_REDUCED_HERTZ * maugis->indentation_scale)
        return hertz_eval(maugis, indentation, branch, value);

    const int before_grip = indentation < folds->grip_indentation * maugis->indentation_scale;
    const int before_onset = indentation < folds->onset_indentation * maugis->indentation_scale;
    if (!stable && (before_grip || !before_onset))
        return NT_E_NO_SOLUTION;
    if (before_grip || (branch == NT_BRANCH_APPROACH && before_onset)) {
        *value = (nt_law_value){0};
        return NT_OK;
    }
    const double d = fmax(indentation / maugis->indentation_scale, folds->grip_indentation); /* rounding only */
    nt_law_value reduced;
    if (folds->grip_in_contact ? !stable && d >= folds->touch_indentation : !stable || d < folds->touch_indentation)
        reduced = non_contact_eval(maugis, d, stable);
    else {
        const nt_status status = contact_eval(maugis, d, stable, &reduced, info);
        if (status != NT_OK)
            return status;
    }
    const nt_reduced_units units = units_of(maugis);
    *value = nt_reduced_to_si(&reduced, &units);
    return NT_OK;
}

double nt_maugis_pull_off_force(const nt_maugis *maugis)
{
    return -maugis->folds.pull_off_load * maugis->load_scale;
}

double nt_maugis_onset_gap(const nt_maugis *maugis)
{
    return -maugis->folds.onset_indentation * maugis->indentation_scale;
}
