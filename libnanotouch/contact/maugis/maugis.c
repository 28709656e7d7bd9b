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
#include "internal/contact.h"
#include "nanotouch/contact.h"

#include <math.h>
#include <stddef.h>

#include "contact/maugis/apart.h"
#include "contact/maugis/folds.h"
#include "contact/maugis/solve.h"
#include "nanotouch/material.h"

static nt_reduced_units units_of(const nt_maugis *maugis)
{
    return (nt_reduced_units){maugis->load_scale, maugis->radius_scale, maugis->indentation_scale};
}

/* (non-contact) at d between the fold and the end of the branch, the smaller c. */
static nt_law_value unstable_apart_eval(const nt_maugis *maugis, double d)
{
    const double c_fold = nt_maugis_apart_fold(maugis->lambda);
    const double beyond_onset = d - maugis->folds.onset_indentation;
    const double root = sqrt(fmax(c_fold * c_fold + 2.0 * beyond_onset, 0.0));
    return nt_maugis_apart_value(maugis, -2.0 * beyond_onset / (c_fold + root), -root);
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

double nt_maugis_lambda(const nt_contact *contact)
{
    const nt_reduced_units units = nt_reduced_units_of(contact);
    return contact->work_of_adhesion == 0.0 ? (double)INFINITY : nt_reduced_lambda(contact, &units);
}

/* Scales and folds of a checked contact. */
static nt_status prepare(nt_maugis *maugis, const nt_contact *contact, const nt_reduced_units *units, double lambda)
{
    const int adheres = contact->work_of_adhesion > 0.0;
    if (adheres && !(lambda >= NT_MAUGIS_LAMBDA_MIN && lambda <= NT_MAUGIS_LAMBDA_MAX))
        return NT_E_RANGE;
    maugis->lambda = adheres ? lambda : HUGE_VAL;
    maugis->load_scale = units->load;
    maugis->radius_scale = units->radius;
    maugis->indentation_scale = units->indentation;
    maugis->contact = *contact; /* perhaps its own */
    if (adheres)
        nt_maugis_folds_find(maugis);
    else {
        maugis->folds = (nt_maugis_folds){0};
        maugis->fold_y = maugis->load_fold_y = 0.0;
    }
    return NT_OK;
}

nt_status nt_maugis_init(nt_maugis *maugis, const nt_contact *contact)
{
    const nt_status status = nt_contact_check(contact, NULL);
    if (status != NT_OK)
        return status;
    const nt_reduced_units units = nt_reduced_units_of(contact);
    return prepare(maugis, contact, &units, nt_reduced_lambda(contact, &units));
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
    const nt_reduced_units units = nt_reduced_units_of(&complete);
    complete.cohesive_stress = lambda / nt_reduced_lambda(&complete, &units);
    return prepare(maugis, &complete, &units, lambda);
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
        reduced = stable ? nt_maugis_apart_stable(maugis, d) : unstable_apart_eval(maugis, d);
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
