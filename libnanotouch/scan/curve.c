/* SPDX-License-Identifier: BSD-3-Clause
 * All motions of a tapping lever, with one harmonic: the curve |(1 - r^2 + i r/Q) A - F_1/k_c| = D is followed through
 * the plane of swing and depth (Euler and Newton, Allgower and Georg 1990). Which of them a lever comes to: branches.c.
 */
#include <math.h>
#include <stddef.h>

#include "core/same_bits.h"
#include "motion.h"
#include "scene/parts.h"

#define COARSE 1e-5   /* of the drive, squared, on the traced curve */
#define AWAY 20e-9    /* and twice A0: where the curve begins [m] */
#define ASIDE 1e-13   /* of a jump of the force [m] */
#define SMALLEST 0.02 /* swing where it ends, over A0 */
enum { CORRECTIONS = 12, SWINGS = 60, LAP = 5 };

typedef struct walk {
    nt_balance one; /* with one harmonic */
    motion f;
    slopes s;
    double way[2]; /* the last step, in units of the longest ones */
} walk;

static void units_at(const walk *w, double unit[2])
{
    unit[0] = WIDE * w->one.lever->free_amplitude;
    unit[1] = fmax(SHORT, FAR * fabs(w->f.o.at.depth));
}

/* Below the gap where a meniscus or contact takes hold the force is another one, and so is the curve. */
static int is_captured(const walk *w, double depth)
{
    return depth <= nt_plan_capture_gap(w->one.plan, w->one.place);
}

/* Back onto the curve the shortest way. */
static int correct(walk *w)
{
    const int captured = is_captured(w, w->f.o.at.depth);
    for (int i = 0; i < CORRECTIONS; i++) {
        if (!nt_motion_slopes(&w->one, &w->f, NT_AIM_HEIGHT, &w->s))
            return 0;
        if (fabs(w->f.strength) < COARSE)
            return 1;
        double unit[2];
        units_at(w, unit);
        const double x = w->s.strength[0] * unit[0], y = w->s.strength[1] * unit[1];
        const double share = -w->f.strength / (x * x + y * y);
        nt_balance_state at = w->f.o.at;
        at.swing += fmax(-3.0, fmin(3.0, share * x)) * unit[0];
        at.depth += fmax(-3.0, fmin(3.0, share * y)) * unit[1];
        if (is_captured(w, at.depth) != captured || !nt_motion_find(&w->one, &at, &w->f))
            return 0;
    }
    return 0;
}

/* One step of this share of the longest one; 0 where there is no curve, with the walk as it was. */
static int step_on(walk *w, double share)
{
    double unit[2];
    units_at(w, unit);
    double x = -w->s.strength[1] * unit[1], y = w->s.strength[0] * unit[0];
    const double size = hypotenuse(x, y), sign = x * w->way[0] + y * w->way[1] < 0.0 ? -1.0 : 1.0;
    x *= sign / size;
    y *= sign / size;
    const walk before = *w;
    nt_balance_state at = w->f.o.at;
    at.swing += share * x * unit[0];
    at.depth += share * y * unit[1];
    w->way[0] = x;
    w->way[1] = y;
    const int captured = is_captured(w, before.f.o.at.depth);
    if (is_captured(w, at.depth) == captured && nt_motion_find(&w->one, &at, &w->f) && correct(w)) {
        const double dA = (w->f.o.at.swing - before.f.o.at.swing) / unit[0];
        const double dg = (w->f.o.at.depth - before.f.o.at.depth) / unit[1];
        if (dA * x + dg * y > 0.5 * share)
            return 1;
    }
    *w = before;
    return 0;
}

/* Of small changes at one height (Krylov, Bogoliubov): they neither grow steadily, beyond a fold, nor swing up. */
static int is_stable(const motion *f, const slopes *s)
{
    const double fold = s->strength[0] * s->height[1] - s->strength[1] * s->height[0];
    const double damping = s->taken[0] - s->taken[1] * s->height[0] / s->height[1] + f->drive[1] / f->o.at.swing;
    return fold > 0.0 && damping > 0.0;
}

static void keep(const walk *w, nt_balance_curve *curve, int piece)
{
    const motion *f = &w->f;
    const slopes *s = &w->s;
    nt_balance_point *point = &curve->at[curve->count++];
    *point = (nt_balance_point){.swing = f->o.at.swing,
                                .depth = f->o.at.depth,
                                .base_height = f->height,
                                .amplitude = f->amplitude,
                                .phase = f->phase,
                                .peak_force = f->o.peak,
                                .piece = piece,
                                .stable = is_stable(f, s)};
}

/* From the walk's place to an end of its piece of the curve, or round to where it began: 1. */
static int follow(walk *w, nt_balance_curve *curve, int piece)
{
    const double A0 = w->one.lever->free_amplitude;
    const nt_balance_state begun = w->f.o.at;
    double unit[2];
    double way = 0.0; /* in longest steps */
    for (double share = 1.0; curve->count < NT_BALANCE_POINTS && share > 1e-3;) {
        if (w->f.o.at.swing < SMALLEST * A0 || w->f.o.at.depth > 2.0 * A0 + 2.0 * AWAY)
            return 0;
        if (step_on(w, share)) {
            keep(w, curve, piece);
            way += share;
            share = fmin(1.0, 2.0 * share);
        } else {
            share *= 0.5;
        }
        units_at(w, unit);
        const double dA = (w->f.o.at.swing - begun.swing) / unit[0], dg = (w->f.o.at.depth - begun.depth) / unit[1];
        if (way > LAP && hypotenuse(dA, dg) < 1.0)
            return 1;
    }
    return 0;
}

/* The swing of a depth, the larger of two: |A (a + i c) - fc + i fs| = D again and again for the forces of the last
 * one. 0: the drive is too weak to go there. */
static int swing_at(walk *w, double depth)
{
    const nt_tapping *t = w->one.lever;
    const double a = 1.0 - t->ratio * t->ratio, c = t->ratio / t->quality, square = a * a + c * c;
    nt_balance_state at = {.swing = t->strength / sqrt(square), .depth = depth};
    for (int i = 0; i < SWINGS; i++) {
        if (!nt_motion_find(&w->one, &at, &w->f))
            return 0;
        const double fc = a * at.swing - w->f.drive[0], fs = w->f.drive[1] - c * at.swing, half = a * fc - c * fs;
        const double root = half * half - square * (fc * fc + fs * fs - t->strength * t->strength);
        const double swing = (half + sqrt(fmax(root, 0.0))) / square;
        if (root < 0.0 || !(swing > 0.0))
            return 0;
        if (fabs(swing - at.swing) < 1e-6 * t->free_amplitude)
            return correct(w);
        at.swing = 0.5 * (at.swing + swing);
    }
    return 0;
}

static void turn_round(nt_balance_point *points, int count)
{
    for (int i = 0, j = count - 1; i < j; i++, j--) {
        const nt_balance_point kept = points[i];
        points[i] = points[j];
        points[j] = kept;
    }
}

/* Whether a piece that is there already passes the walk's place, on its side of the gap of capture. */
static int is_traced(const walk *w, const nt_balance_curve *curve)
{
    const nt_balance_state *at = &w->f.o.at;
    const double near = WIDE * w->one.lever->free_amplitude;
    const int captured = is_captured(w, at->depth);
    for (int i = 1; i < curve->count; i++) {
        const nt_balance_point *a = &curve->at[i - 1], *b = &curve->at[i];
        const double way = b->depth - a->depth, share = way != 0.0 ? (at->depth - a->depth) / way : 0.0;
        if (a->piece == b->piece && is_captured(w, b->depth) == captured && share > -0.5 && share < 1.5 &&
            fabs(a->swing + share * (b->swing - a->swing) - at->swing) < near)
            return 1;
    }
    return 0;
}

/* The whole piece through the walk's place, from its end above. */
static void follow_piece(walk *w, nt_balance_curve *curve, int piece)
{
    const int first = curve->count;
    const walk begun = *w;
    w->way[0] = 0.0;
    w->way[1] = 1.0;
    const int is_closed = follow(w, curve, piece);
    turn_round(&curve->at[first], curve->count - first);
    *w = begun;
    if (curve->count < NT_BALANCE_POINTS)
        keep(w, curve, piece);
    if (is_closed)
        return;
    w->way[0] = 0.0;
    w->way[1] = -1.0;
    follow(w, curve, piece);
}

nt_status nt_balance_trace(const nt_balance *balance, nt_balance_curve *curve)
{
    if (balance == NULL || balance->lever == NULL || balance->plan == NULL || balance->harmonics < 1 ||
        balance->harmonics > NT_HARMONICS_MAX || curve == NULL)
        return NT_E_ARGUMENT;
    walk w = {.one = *balance};
    w.one.harmonics = 1;
    curve->count = 0;
    int piece = 0;
    const double A0 = balance->lever->free_amplitude, capture = nt_plan_capture_gap(balance->plan, balance->place);
    for (double depth = 2.0 * A0 + AWAY, next; depth > -A0 && curve->count < NT_BALANCE_POINTS; depth = next) {
        if (swing_at(&w, depth) && !is_traced(&w, curve))
            follow_piece(&w, curve, piece++);
        next = depth - fmax(SHORT, FAR * fabs(depth));
        if (depth > capture && next <= capture)
            next = capture - ASIDE;
    }
    return curve->count > 1 ? NT_OK : NT_E_NO_CONVERGENCE;
}
