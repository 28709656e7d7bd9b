/* SPDX-License-Identifier: BSD-3-Clause
 * Newton's method for the stable contact branch of Maugis-Dugdale at an indentation; private to contact/. One text for
 * the scalar solver and for blocks, so that both give the same bits, without a jump, so that a loop over it can be
 * vectorised. solve.c says why it is done in Z = sqrt(d - d_fold). */
#ifndef NANOTOUCH_CONTACT_MAUGIS_NEWTON_H
#define NANOTOUCH_CONTACT_MAUGIS_NEWTON_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "contact/maugis/functions.h"

/* Residuals below this, relative to the larger term of d or P, are rounding: no improvement there ends it. */
#define NT_NEWTON_FLOOR (64.0 * DBL_EPSILON)

/* After a step this small, relative to y, the error of Newton's method is below rounding. */
#define NT_NEWTON_QUADRATIC 3e-9

enum { NT_NEWTON_MAX = 100 };

/* The end of the branch that it starts from: its fold, or a = 0 where that is none. */
typedef struct nt_maugis_start {
    double lambda, y, a, d;
} nt_maugis_start;

/* Where the method stands. */
typedef struct nt_maugis_newton {
    double d, Z;         /* what is wanted */
    double y, step;      /* of this evaluation, and how far it is from the one before */
    double low, high;    /* bracket */
    double best, best_y; /* smallest residual, and where */
    double scale;        /* of the terms of d there */
} nt_maugis_newton;

/* x^(1/3) to 4 %, x >= 0: a third of the exponent, and of the bits behind it. */
static inline double nt_cube_root_guess(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits = (((bits >> 32) * 0x55555556u >> 32) + 0x2a9f7893u) << 32;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* y at a contact radius, within some 30 %. (Griffith) with g1 ~ 4/(3 (y + 0.85)), g2 ~ 1/(2 (y + 0.85)), right at both
 * ends: y^3 + 0.85 y^2 = 2 p y + 3 q. */
static inline double nt_maugis_newton_guess(double lambda, double a)
{
    const double p = lambda * lambda * a / 3.0, q = 2.0 / 9.0 * lambda * a * a;
    const double cubic = nt_cube_root_guess(3.0 * q), square = sqrt(3.0 * q / 0.85);
    double y = 4.0 * p / (0.85 + sqrt(0.7225 + 8.0 * p)) + (cubic < square ? cubic : square);
    for (int i = 0; i < 2; i++) /* Newton, convex: from above */
        y = (2.0 * y * y * y + 0.85 * y * y + 3.0 * q) / (3.0 * y * y + 1.7 * y - 2.0 * p);
    return y;
}

static inline nt_maugis_newton nt_maugis_newton_start(const nt_maugis_start *start, double d)
{
    const double above = d - start->d, Z = sqrt(above > 0.0 ? above : 0.0), least = 1.000001 * start->y;
    const double guess = nt_maugis_newton_guess(start->lambda, start->a + Z);
    return (nt_maugis_newton){
        .d = d,
        .Z = Z,
        .y = Z > 0.0 ? (guess > least ? guess : least) : start->y,
        .step = HUGE_VAL,
        .low = start->y,
        .high = HUGE_VAL,
        .best = HUGE_VAL,
        .scale = 1.0,
    };
}

/* One evaluation. Returns 1 (all bits) where it is done, and best_y is the answer. Where the next y has left the
 * bracket, *outside is set: it is to be replaced by nt_maugis_newton_bisect. */
static inline int64_t nt_maugis_newton_next(const nt_maugis_start *start, nt_maugis_newton *at, int64_t *outside)
{
    const double y = at->y;
    const nt_maugis_equilibrium here = nt_maugis_equilibrium_of(start->lambda, nt_maugis_functions_at(y));
    const double residual = here.d - at->d, size = fabs(residual), above = here.d - start->d;
    const double stalled = at->best <= NT_NEWTON_FLOOR * at->scale ? at->best : HUGE_VAL; /* from this size on */
    const double best = size < at->best ? size : at->best;
    at->best_y = size < at->best ? y : at->best_y;
    at->scale = size < at->best ? 2.0 * here.a * here.a - here.d : at->scale;
    at->best = best;
    at->low = residual > 0.0 ? at->low : y;
    at->high = residual > 0.0 ? y : at->high;
    const double Z = sqrt(above > 0.0 ? above : 0.0);
    const double next = y - residual * (2.0 * Z) / ((Z + at->Z) * (here.d1 * y)), change = fabs(next - y);
    /* At or below 0 where it ends: rounding is reached, or the last step was so small that this one is below it. */
    const double rounding = best - 0.5 * DBL_EPSILON * at->scale, floor = best - NT_NEWTON_FLOOR * at->scale;
    const double last = at->step - NT_NEWTON_QUADRATIC * y, now = change - DBL_EPSILON * y;
    const double is_near = last < now ? last : now, resolved = floor > is_near ? floor : is_near;
    const double least = rounding < resolved ? rounding : resolved;
    const int64_t is_left = -(int64_t)(next <= at->low), is_right = -(int64_t)(next >= at->high);
    at->step = change;
    at->y = next;
    *outside = is_left | is_right;
    return -(int64_t)(least <= 0.0) | -(int64_t)(size >= stalled) | -(int64_t)(at->Z == 0.0);
}

/* The geometric middle of the bracket. `from` is where Newton's method left it. */
static inline void nt_maugis_newton_bisect(nt_maugis_newton *at, double from)
{
    if (isinf(at->high))
        at->y = 4.0 * from;
    else
        at->y = at->low > 0.0 ? sqrt(at->low) * sqrt(at->high) : 0.5 * at->high;
    at->step = fabs(at->y - from);
}

/* What rounding of y has left of the indentation, to first order in Z: added to the load and the radius of `point`.
 * Within `resolution` of the fold, where the slope is infinite, it is left. */
typedef struct nt_maugis_rest {
    double U, P, a;
} nt_maugis_rest;

static inline nt_maugis_rest nt_maugis_rest_of(const nt_maugis_start *start, const nt_maugis_equilibrium *point,
                                               double d, double resolution)
{
    const double to = d - start->d, above = point->d - start->d;
    const double Z = sqrt(above > 0.0 ? above : 0.0), sum = Z + sqrt(to > 0.0 ? to : 0.0);
    const double rest = d - point->d;
    const double shift = rest * (2.0 * Z), slope = sum * (point->d1 * point->y), beyond = point->y - start->y;
    const double by_y = (beyond > resolution ? shift : 0.0) / (beyond > resolution ? slope : 1.0); /* change of y */
    return (nt_maugis_rest){.U = point->P * rest, .P = point->P1 * point->y * by_y, .a = point->a1 * by_y};
}

#endif
