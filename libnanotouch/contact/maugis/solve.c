/* SPDX-License-Identifier: BSD-3-Clause
 * Inverting the contact branch of Maugis-Dugdale.
 *
 * Load and indentation turn round at their folds, where dP/dy or dd/dy vanishes and Newton's method on P or d crawls.
 * Z = sqrt(d - d_fold) goes straight through the fold, and above it d(y) is convex: Newton on Z needs about five
 * evaluations anywhere. On the part below the fold Z is smooth in y^2, because d and P are even in y to leading order
 * at y = 0. A bracket is kept throughout: convergence does not rest on convexity, which is measured, not proved. */
#include "contact/maugis/solve.h"

#include <math.h>
#include <stddef.h>

#include "contact/maugis/newton.h"
#include "core/same_bits.h"

/* Start above the fold, from the contact radius: exact for JKR and DMT under load, within 25 % otherwise. */
static double guess_above(double lambda, const nt_maugis_goal *goal, double Z)
{
    const double a_fold = goal->fold->a;
    const double radius = goal->given == NT_GIVEN_LOAD ? cube_root(a_fold * sqrt(a_fold) + Z) : 0.0;
    return nt_maugis_parameter_guess(lambda, goal->given == NT_GIVEN_LOAD ? radius * radius : a_fold + Z);
}

/* Start below the fold: Z falls about linearly in y^2 from the end of the branch at y = 0 to the fold. */
static double guess_below(double lambda, const nt_maugis_goal *goal, double Z)
{
    nt_maugis_equilibrium end;
    nt_maugis_equilibrium_at(lambda, 0.0, &end);
    const double reach = goal->given == NT_GIVEN_LOAD ? end.P - goal->fold->P : end.d - goal->fold->d;
    return goal->fold->y * sqrt(fmax(1.0 - Z / sqrt(fmax(reach, 0.0)), 0.0));
}

/* Newton's next y for a change of Z^2: in y above the fold, in y^2 below it. */
static double newton_y(const nt_maugis_goal *goal, const nt_maugis_equilibrium *point, double dZ2)
{
    const double y = point->y, slope = goal->given == NT_GIVEN_LOAD ? point->P1 : point->d1;
    return goal->below ? sqrt(y * y + 2.0 * dZ2 / slope) : y + dZ2 / (slope * y);
}

/* Where Newton leaves the bracket: its geometric middle. */
static double bisected_y(double y, const double bracket[2])
{
    if (isinf(bracket[1]))
        return 4.0 * y;
    return bracket[0] > 0.0 ? sqrt(bracket[0]) * sqrt(bracket[1]) : 0.5 * bracket[1];
}

nt_status nt_maugis_point_find(double lambda, const nt_maugis_goal *goal, nt_maugis_equilibrium *point,
                               nt_solve_info *info)
{
    const int load = goal->given == NT_GIVEN_LOAD;
    const double fold = load ? goal->fold->P : goal->fold->d, y_fold = goal->fold->y;
    const double Z = sqrt(fmax(goal->target - fold, 0.0));
    double bracket[2] = {goal->below ? 0.0 : y_fold, goal->below ? y_fold : HUGE_VAL};
    double y = y_fold;
    if (goal->guess > 0.0)
        y = goal->guess;
    else if (Z > 0.0)
        y = goal->below ? guess_below(lambda, goal, Z) : fmax(guess_above(lambda, goal, Z), 1.000001 * y_fold);
    double best = HUGE_VAL, scale = 1.0, step = HUGE_VAL;
    for (int i = 1; i <= NT_NEWTON_MAX; i++) {
        const nt_maugis_equilibrium here = nt_maugis_equilibrium_of(lambda, nt_maugis_functions_at(y));
        const double value = load ? here.P : here.d, residual = value - goal->target;
        const int stalled = fabs(residual) >= best && best <= NT_NEWTON_FLOOR * scale;
        if (fabs(residual) < best) {
            best = fabs(residual);
            scale = load ? 2.0 * here.a * here.a * here.a - here.P : 2.0 * here.a * here.a - here.d;
            *point = here;
        }
        bracket[(residual > 0.0) != goal->below] = y;
        const double Z_here = sqrt(fmax(value - fold, 0.0));
        double next = newton_y(goal, &here, -residual / (Z_here + Z) * 2.0 * Z_here);
        const int resolved =
            best <= NT_NEWTON_FLOOR * scale && (step <= NT_NEWTON_QUADRATIC * y || fabs(next - y) <= DBL_EPSILON * y);
        if (info != NULL)
            *info = (nt_solve_info){i, best / scale};
        if (best <= 0.5 * DBL_EPSILON * scale || stalled || resolved || Z == 0.0)
            return NT_OK;
        if (!(next > bracket[0] && next < bracket[1]))
            next = bisected_y(y, bracket);
        step = fabs(next - y);
        y = next;
    }
    return NT_E_NO_CONVERGENCE;
}

nt_status nt_maugis_stable_find(const nt_maugis_start *start, double d, nt_maugis_equilibrium *point,
                                nt_solve_info *info)
{
    nt_maugis_newton at = nt_maugis_newton_start(start, d);
    for (int i = 1; i <= NT_NEWTON_MAX; i++) {
        int64_t outside;
        const double y = at.y;
        const int64_t done = nt_maugis_newton_next(start, &at, &outside);
        if (info != NULL)
            *info = (nt_solve_info){i, at.best / at.scale};
        if (done) {
            nt_maugis_equilibrium_at(start->lambda, at.best_y, point);
            return NT_OK;
        }
        if (outside)
            nt_maugis_newton_bisect(&at, y);
    }
    return NT_E_NO_CONVERGENCE;
}
