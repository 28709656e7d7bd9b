/* SPDX-License-Identifier: BSD-3-Clause
 * Inverting the contact branch of Maugis-Dugdale.
 *
 * Load and indentation turn round at their folds, where dP/dy or dd/dy vanishes and Newton's method on P or d crawls.
 * Z = sqrt(d - d_fold) goes straight through the fold, and above it d(y) is convex: Newton on Z needs about five
 * evaluations anywhere. On the part below the fold Z is smooth in y^2, because d and P are even in y to leading order at
 * y = 0. A bracket is kept throughout, so that convergence does not rest on convexity, which is measured, not proved. */
#include "contact/maugis_solve.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "core/roots.h"

enum { MAX_ITERATIONS = 100 };

typedef struct {
    double lambda;
    nt_maugis_given given;
} fold_context;

static double fold_slope(double y, const void *context)
{
    const fold_context *fold = context;
    nt_maugis_equilibrium point;
    nt_maugis_equilibrium_at(fold->lambda, y, &point);
    return fold->given == NT_GIVEN_LOAD ? point.P1 : point.d1;
}

nt_status nt_maugis_fold_find(double lambda, nt_maugis_given given, nt_maugis_equilibrium *fold)
{
    const fold_context context = {lambda, given};
    double y = 0.0;
    if (fold_slope(0.0, &context) < 0.0) {
        double bracket[2] = {0.0, nt_maugis_parameter_guess(lambda, 1.5)};
        for (int i = 0; i < MAX_ITERATIONS && fold_slope(bracket[1], &context) < 0.0; i++)
            bracket[1] *= 2.0;
        const nt_status status = nt_root_find(fold_slope, &context, bracket, &y, NULL);
        if (status != NT_OK)
            return status;
    }
    nt_maugis_equilibrium_at(lambda, y, fold);
    return NT_OK;
}

/* Start above the fold, from the contact radius: exact for JKR and DMT under load, within 25 % otherwise. */
static double guess_above(double lambda, const nt_maugis_goal *goal, double Z)
{
    const double a_fold = goal->fold->a;
    const double radius = goal->given == NT_GIVEN_LOAD ? cbrt(a_fold * sqrt(a_fold) + Z) : 0.0;
    return nt_maugis_parameter_guess(lambda, goal->given == NT_GIVEN_LOAD ? radius * radius : a_fold + Z);
}

/* The next y: Newton on Z, in y above and in y^2 below the fold; bisection where that leaves the bracket. */
static double next_y(const nt_maugis_goal *goal, const nt_maugis_equilibrium *point, const double bracket[2], double dZ2)
{
    const double y = point->y, slope = goal->given == NT_GIVEN_LOAD ? point->P1 : point->d1;
    const double next = goal->below ? sqrt(y * y + 2.0 * dZ2 / slope) : y + dZ2 / (slope * y);
    if (next > bracket[0] && next < bracket[1])
        return next;
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
    double y = Z == 0.0 ? y_fold : goal->below ? 0.5 * y_fold : fmax(guess_above(lambda, goal, Z), y_fold * 1.000001);
    double best = INFINITY;
    for (int i = 1; i <= MAX_ITERATIONS; i++) {
        nt_maugis_equilibrium here;
        nt_maugis_equilibrium_at(lambda, y, &here);
        const double value = load ? here.P : here.d, residual = value - goal->target;
        const double scale = load ? 2.0 * here.a * here.a * here.a - here.P : 2.0 * here.a * here.a - here.d;
        const int stalled = fabs(residual) >= best && best <= 64.0 * DBL_EPSILON * scale;
        if (fabs(residual) < best) {
            best = fabs(residual);
            *point = here;
        }
        const double Z_here = sqrt(fmax(value - fold, 0.0));
        bracket[(residual > 0.0) != goal->below] = y;
        const double next = next_y(goal, &here, bracket, -residual / (Z_here + Z) * 2.0 * Z_here);
        if (info != NULL)
            *info = (nt_solve_info){i, best / scale};
        if (best <= 0.5 * DBL_EPSILON * scale || stalled || next == y || Z == 0.0)
            return NT_OK;
        y = next;
    }
    return NT_E_NO_CONVERGENCE;
}
