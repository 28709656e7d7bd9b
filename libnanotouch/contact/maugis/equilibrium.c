/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale at a given load, contact radius or branch parameter. */
#include <math.h>
#include <stddef.h>

#include "contact/contact_equilibrium.h"
#include "contact/maugis/apart.h"
#include "contact/maugis/functions.h"
#include "contact/maugis/solve.h"
#include "core/roots.h"
#include "internal/contact.h"
#include "internal/contact_equilibrium.h"
#include "nanotouch/advanced/contact_equilibrium.h"

static nt_contact_state state_of(const nt_maugis *maugis, double d, const nt_law_value *reduced)
{
    const nt_reduced_units units = {maugis->load_scale, maugis->radius_scale, maugis->indentation_scale};
    return (nt_contact_state){d * units.indentation, nt_reduced_to_si(reduced, &units)};
}

static nt_contact_state contact_state(const nt_maugis *maugis, const nt_maugis_equilibrium *point)
{
    const nt_law_value value = nt_maugis_value_of(maugis, point, point->y >= maugis->fold_y);
    return state_of(maugis, point->d, &value);
}

static nt_contact_state hertz_state(const nt_contact *contact, double indentation)
{
    return (nt_contact_state){indentation, nt_hertz_eval(contact, indentation)};
}

/* The point of the contact branch at a reduced load between the folds and Hertz. */
static nt_status load_find(const nt_maugis *maugis, double P, int unstable, nt_maugis_equilibrium *point,
                           nt_solve_info *info)
{
    const nt_maugis_folds *folds = &maugis->folds;
    const nt_maugis_equilibrium fold = {
        .y = maugis->load_fold_y, .a = folds->pull_off_radius, .P = folds->pull_off_load};
    const nt_maugis_goal goal = {NT_GIVEN_LOAD, P, &fold, unstable, 0.0};
    return nt_maugis_point_find(maugis->lambda, &goal, point, info);
}

/* What a load is: refused, Hertz, a point of the non-contact branch or of the contact branch. */
typedef enum { REFUSED, HERTZ, NON_CONTACT, CONTACT } load_kind;

static load_kind load_kind_of(const nt_maugis *maugis, double force, nt_branch branch, nt_status *status)
{
    const int unstable = branch == NT_BRANCH_UNSTABLE;
    if (!nt_branch_is_known(branch))
        *status = NT_E_ARGUMENT;
    else if (!isfinite(force))
        *status = NT_E_NOT_FINITE;
    else if (force < -nt_maugis_pull_off_force(maugis) || (unstable && force >= 0.0))
        *status = NT_E_NO_SOLUTION;
    else
        *status = NT_OK;
    if (*status != NT_OK)
        return REFUSED;
    if (maugis->load_scale == 0.0 || force / maugis->load_scale > NT_REDUCED_HERTZ * sqrt(NT_REDUCED_HERTZ))
        return HERTZ;
    return unstable && force / maugis->load_scale > maugis->folds.touch_load ? NON_CONTACT : CONTACT;
}

nt_status nt_maugis_indentation(const nt_maugis *maugis, double force, nt_branch branch, double *indentation,
                                nt_solve_info *info)
{
    if (info != NULL)
        *info = (nt_solve_info){0};
    nt_status status;
    const load_kind kind = load_kind_of(maugis, force, branch, &status);
    const double P = fmax(force / maugis->load_scale, maugis->folds.pull_off_load); /* rounding only */
    nt_maugis_equilibrium point;
    if (kind == HERTZ)
        *indentation = nt_hertz_indentation(&maugis->contact, force);
    else if (kind == NON_CONTACT)
        *indentation =
            nt_maugis_apart_indentation(maugis, nt_maugis_apart_radius(maugis, P)) * maugis->indentation_scale;
    else if (kind == CONTACT) {
        status = load_find(maugis, P, branch == NT_BRANCH_UNSTABLE, &point, info);
        if (status == NT_OK)
            *indentation = point.d * maugis->indentation_scale;
    }
    return status;
}

nt_status nt_maugis_at_load(const nt_maugis *maugis, double force, nt_branch branch, nt_contact_state *state)
{
    nt_status status;
    const load_kind kind = load_kind_of(maugis, force, branch, &status);
    const double P = fmax(force / maugis->load_scale, maugis->folds.pull_off_load); /* rounding only */
    nt_maugis_equilibrium point;
    if (kind == HERTZ)
        *state = hertz_state(&maugis->contact, nt_hertz_indentation(&maugis->contact, force));
    else if (kind == NON_CONTACT) {
        const double c = nt_maugis_apart_radius(maugis, P);
        const nt_law_value value = nt_maugis_apart_value(maugis, c, c - nt_maugis_apart_fold(maugis->lambda));
        *state = state_of(maugis, nt_maugis_apart_indentation(maugis, c), &value);
    } else if (kind == CONTACT) {
        status = load_find(maugis, P, branch == NT_BRANCH_UNSTABLE, &point, NULL);
        if (status == NT_OK)
            *state = contact_state(maugis, &point);
    }
    return status;
}

typedef struct {
    double lambda, a;
} radius_context;

static double radius_excess(double y, const void *context)
{
    const radius_context *wanted = context;
    nt_maugis_equilibrium point;
    nt_maugis_equilibrium_at(wanted->lambda, y, &point);
    return point.a / wanted->a - 1.0;
}

/* Reduced radius below which the state is that at a = 0, to a part in 1e100, and squares would underflow. */
#define LEAST_RADIUS 1e-100

nt_status nt_maugis_at_radius(const nt_maugis *maugis, double radius, nt_contact_state *state)
{
    if (!isfinite(radius))
        return NT_E_NOT_FINITE;
    if (radius < 0.0)
        return NT_E_RANGE;
    const double a = radius / maugis->radius_scale;
    if (maugis->load_scale == 0.0 || a * a > NT_REDUCED_HERTZ) {
        *state = hertz_state(&maugis->contact, radius * (radius / maugis->contact.radius));
        return NT_OK;
    }
    double y = 0.0;
    if (a > LEAST_RADIUS) {
        const radius_context context = {maugis->lambda, a};
        const double guess = nt_maugis_parameter_guess(maugis->lambda, a); /* within 30 % */
        const double bracket[2] = {0.25 * guess, 4.0 * guess};
        const nt_status status = nt_root_find(radius_excess, &context, bracket, &y, NULL);
        if (status != NT_OK)
            return status;
    }
    const nt_status status = nt_maugis_at_parameter(maugis, y, state);
    if (status == NT_OK && a <= LEAST_RADIUS)
        state->value.a = radius;
    return status;
}

nt_status nt_maugis_at_parameter(const nt_maugis *maugis, double y, nt_contact_state *state)
{
    if (!isfinite(y))
        return NT_E_NOT_FINITE;
    if (y < 0.0 || maugis->load_scale == 0.0)
        return NT_E_RANGE;
    nt_maugis_equilibrium point;
    nt_maugis_equilibrium_at(maugis->lambda, y, &point);
    *state = contact_state(maugis, &point);
    return NT_OK;
}
