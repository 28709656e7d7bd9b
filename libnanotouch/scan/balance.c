/* SPDX-License-Identifier: BSD-3-Clause
 * The motions of a tapping lever as the points of a curve, |(1 - r^2 + i r/Q) A - F_1/k_c| = D in the plane of swing
 * and depth: one of them for a target by Newton's method, all of them by following the curve (Euler and Newton,
 * Allgower and Georg 1990), and those that a lever comes to from above or from below. A motion is stable where the
 * base's height falls along the curve as it does far from the surface; at a fold it turns. Which of them a lever comes
 * to: branches.c.
 */
#include "nanotouch/balance.h"

#include <math.h>
#include <stddef.h>

#include "core/same_bits.h"
#include "nanotouch/material.h"
#include "orbit.h"
#include "scene/parts.h"

#define PROBE 1e-5    /* of the finite differences, over A0 */
#define BALANCED 1e-9 /* of the drive, squared, and of the target over A0 */
#define COARSE 1e-5   /* of the drive, squared, on the traced curve */
#define WIDE 0.02     /* longest step along the curve in the swing, over A0 */
#define SHORT 0.02e-9 /* in the depth near the surface [m] */
#define FAR 0.1       /* over the depth */
#define OVERSIGHT 2.0 /* the harmonics left out, at most over what they are told to be */
#define GRAIN 2e-4    /* what quadrature leaves of the amplitude, over A0: forces turn it, by up to Q */
#define FLOOR 2e-5    /* what quadrature and kinks of the force move the lowest point by, over A0 */
#define AWAY 20e-9    /* and twice A0: where the curve begins [m] */
#define ASIDE 1e-13   /* of a jump of the force [m] */
#define SMALLEST 0.02 /* swing where it ends, over A0 */
enum { NEWTON_MAX = 40, HALVINGS = 8, CORRECTIONS = 12, SWINGS = 60, LAP = 5, RETREATS = 8 };

static double capture_of(const nt_balance *b)
{
    return nt_plan_capture_gap(b->plan, b->place);
}

/* What an orbit is like as a motion. */
typedef struct found {
    orbit o;
    double drive[2]; /* what would drive it, in the frame of its first harmonic [m] */
    double strength; /* |drive|^2/D^2 - 1 [-] */
    double height;   /* of the base [m] */
    double deflection[2], amplitude, phase;
} found;

static int find(const nt_balance *b, const nt_balance_state *at, found *f)
{
    const nt_tapping *t = b->lever;
    f->o = (orbit){.balance = b, .at = *at, .evaluations = f->o.evaluations};
    if (!nt_orbit_find(&f->o))
        return 0;
    const double r = t->ratio, A = at->swing;
    double taken = f->o.loss; /* from the first harmonic, by the contact and by the harmonics above */
    for (int n = 2; n <= b->harmonics; n++)
        taken +=
            n * n * r / t->quality * (f->o.at.real[n] * f->o.at.real[n] + f->o.at.imaginary[n] * f->o.at.imaginary[n]);
    f->drive[0] = A * (1.0 - r * r) - f->o.force[1][0];
    f->drive[1] = A * r / t->quality + taken / A;
    const double *E = f->drive;
    f->strength = (E[0] * E[0] + E[1] * E[1]) / (t->strength * t->strength) - 1.0;
    const double x = A - (t->at_base ? E[0] : 0.0), y = t->at_base ? -E[1] : 0.0;
    f->amplitude = hypotenuse(x, y);
    f->phase = atan2(E[1] * x - E[0] * y, E[0] * x + E[1] * y);
    f->height = f->o.middle - 0.5 * t->cosine * f->o.force[0][0] + (b->place != NULL ? b->place->surface.z : 0.0);
    return 1;
}

static double aimed(const found *f, nt_balance_aim aim)
{
    return aim == NT_AIM_HEIGHT ? f->height : aim == NT_AIM_AMPLITUDE ? f->amplitude : f->phase;
}

/* Derivatives by swing and depth. */
typedef struct slopes {
    double strength[2], height[2], aim[2], taken[2]; /* taken: of drive[1] */
} slopes;

static int slopes_at(const nt_balance *b, const found *f, nt_balance_aim aim, slopes *s)
{
    const double step = PROBE * b->lever->free_amplitude, capture = capture_of(b);
    for (int i = 0; i < 2; i++) {
        const int is_near = f->o.at.depth <= capture && capture < f->o.at.depth + step; /* not across a jump */
        const double d = i == 1 && is_near ? -step : step;
        found moved = {.o.evaluations = 0};
        nt_balance_state at = f->o.at;
        *(i == 0 ? &at.swing : &at.depth) += d;
        if (!find(b, &at, &moved))
            return 0;
        s->strength[i] = (moved.strength - f->strength) / d;
        s->height[i] = (moved.height - f->height) / d;
        s->aim[i] = (aimed(&moved, aim) - aimed(f, aim)) / d;
        s->taken[i] = (moved.drive[1] - f->drive[1]) / d;
    }
    return 1;
}

/* How far a motion is from balance and target, in one number. */
static double off_by(const nt_balance *b, const found *f, const nt_balance_target *target)
{
    const double unit = target->aim == NT_AIM_PHASE ? 1.0 : b->lever->free_amplitude;
    return hypotenuse(f->strength, (aimed(f, target->aim) - target->value) / unit);
}

/* Newton's step towards the target, bounded and halved until it helps; 0 where none does. */
static int approach(const nt_balance *b, const nt_balance_target *target, const slopes *s, found *f)
{
    const double away = aimed(f, target->aim) - target->value, A0 = b->lever->free_amplitude;
    const double determinant = s->strength[0] * s->aim[1] - s->strength[1] * s->aim[0];
    const double dA = -(s->aim[1] * f->strength - s->strength[1] * away) / determinant;
    const double dg = -(s->strength[0] * away - s->aim[0] * f->strength) / determinant;
    const double longest =
        fmax(fabs(dA) / (5.0 * WIDE * A0), fabs(dg) / fmax(5.0 * SHORT, 2.0 * FAR * fabs(f->o.at.depth)));
    double share = longest > 1.0 ? 1.0 / longest : 1.0;
    if (!isfinite(longest))
        return 0;
    for (int i = 0; i < HALVINGS; i++, share *= 0.5) {
        nt_balance_state at = f->o.at;
        at.swing += share * dA;
        at.depth += share * dg;
        found next = {.o.evaluations = f->o.evaluations};
        if (find(b, &at, &next) && off_by(b, &next, target) < off_by(b, f, target)) {
            *f = next;
            return 1;
        }
        f->o.evaluations = next.o.evaluations;
    }
    return 0;
}

/* What the harmonics left out would change at the lowest point, and how the amplitude answers. */
static void add_bounds(const nt_balance *b, found *f, nt_balance_value *value)
{
    const nt_tapping *t = b->lever;
    const nt_interaction_state history = {f->o.captured, 0.0, 0.0};
    double moved = 0.0;
    nt_orbit_complete(&f->o);
    for (int n = b->harmonics + 1; n <= f->o.orders; n++)
        moved += hypotenuse(f->o.force[n][0], f->o.force[n][1]) / (n * n * t->ratio * t->ratio - 1.0);
    moved = OVERSIGHT * moved + FLOOR * t->free_amplitude;
    const double here = nt_interaction_eval_gap(b->plan, &history, b->place, f->o.lowest).F;
    const double down = nt_interaction_eval_gap(b->plan, &history, b->place, f->o.lowest - moved).F;
    const double up = nt_interaction_eval_gap(b->plan, &history, b->place, f->o.lowest + moved).F;
    value->force_bound = fmax(fabs(down - here), fabs(up - here));
    value->amplitude_bound = moved * fmax(1.0, fabs(value->gain)) + GRAIN * t->free_amplitude;
    if (fabs(f->o.lowest - capture_of(b)) <= moved) /* it may take hold, or not */
        value->amplitude_bound = value->force_bound = HUGE_VAL;
}

/* Of small changes at one height (Krylov, Bogoliubov): they neither grow steadily, beyond a fold, nor swing up. */
static int is_stable(const found *f, const slopes *s)
{
    const double fold = s->strength[0] * s->height[1] - s->strength[1] * s->height[0];
    const double damping = s->taken[0] - s->taken[1] * s->height[0] / s->height[1] + f->drive[1] / f->o.at.swing;
    return fold > 0.0 && damping > 0.0;
}

static nt_balance_value value_of(const nt_balance *b, found *f, const slopes *s)
{
    const double way[2] = {-s->strength[1], s->strength[0]}; /* along the curve */
    const double height = s->height[0] * way[0] + s->height[1] * way[1];
    const nt_tapping *t = b->lever;
    nt_balance_value value = {.base_height = f->height,
                              .amplitude = f->amplitude,
                              .phase = f->phase,
                              .mean = 0.5 * f->o.force[0][0],
                              .peak_force = f->o.peak,
                              .lowest_gap = f->o.lowest,
                              .contact_time = f->o.contact_time,
                              .tip_loss = NT_PI * t->spring_constant * f->o.loss,
                              .gain = height != 0.0 ? way[0] / height : (double)NAN,
                              .stable = is_stable(f, s),
                              .harmonics = b->harmonics};
    add_bounds(b, f, &value);
    value.evaluations = f->o.evaluations;
    return value;
}

static int is_sound(const nt_balance *b)
{
    return b != NULL && b->lever != NULL && b->plan != NULL && b->harmonics >= 1 && b->harmonics <= NT_HARMONICS_MAX;
}

nt_status nt_balance_solve(const nt_balance *balance, const nt_balance_target *target, nt_balance_state *state,
                           nt_balance_value *value)
{
    if (!is_sound(balance) || target == NULL || state == NULL || value == NULL)
        return NT_E_ARGUMENT;
    found f = {.o.evaluations = 0};
    nt_balance_state begun = *state;
    for (int i = 0; !find(balance, &begun, &f); i++) { /* too deep for its harmonics: they may have no balance there */
        if (i == RETREATS)
            return NT_E_NO_CONVERGENCE;
        begun = *state;
        begun.depth += (i + 1) * (0.05 * fabs(begun.depth) + 0.5 * SHORT);
    }
    slopes s;
    for (int i = 0; i < NEWTON_MAX; i++) {
        if (!slopes_at(balance, &f, target->aim, &s))
            return NT_E_NO_CONVERGENCE;
        if (off_by(balance, &f, target) < BALANCED || !approach(balance, target, &s, &f))
            break;
    }
    if (!(off_by(balance, &f, target) < 100.0 * BALANCED))
        return NT_E_NO_CONVERGENCE;
    *value = value_of(balance, &f, &s);
    *state = f.o.at;
    state->lag = atan2(f.drive[1], f.drive[0]);
    return NT_OK;
}

/* --- The curve --- */

typedef struct walk {
    nt_balance one; /* with one harmonic */
    found f;
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
    return depth <= capture_of(&w->one);
}

/* Back onto the curve the shortest way. */
static int correct(walk *w)
{
    const int captured = is_captured(w, w->f.o.at.depth);
    for (int i = 0; i < CORRECTIONS; i++) {
        if (!slopes_at(&w->one, &w->f, NT_AIM_HEIGHT, &w->s))
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
        if (is_captured(w, at.depth) != captured || !find(&w->one, &at, &w->f))
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
    if (is_captured(w, at.depth) == captured && find(&w->one, &at, &w->f) && correct(w)) {
        const double dA = (w->f.o.at.swing - before.f.o.at.swing) / unit[0];
        const double dg = (w->f.o.at.depth - before.f.o.at.depth) / unit[1];
        if (dA * x + dg * y > 0.5 * share)
            return 1;
    }
    *w = before;
    return 0;
}

static void keep(const walk *w, nt_balance_curve *curve, int piece)
{
    const found *f = &w->f;
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
        if (!find(&w->one, &at, &w->f))
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

/* Whether a piece that is there already passes this swing and depth. */
static int is_traced(const nt_balance_curve *curve, const nt_balance_state *at, double near)
{
    for (int i = 1; i < curve->count; i++) {
        const nt_balance_point *a = &curve->at[i - 1], *b = &curve->at[i];
        const double way = b->depth - a->depth, share = way != 0.0 ? (at->depth - a->depth) / way : 0.0;
        if (a->piece == b->piece && share > -0.5 && share < 1.5 &&
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
    if (!is_sound(balance) || curve == NULL)
        return NT_E_ARGUMENT;
    walk w = {.one = *balance};
    w.one.harmonics = 1;
    curve->count = 0;
    int piece = 0;
    const double A0 = balance->lever->free_amplitude, capture = capture_of(balance);
    for (double depth = 2.0 * A0 + AWAY, next; depth > -A0 && curve->count < NT_BALANCE_POINTS; depth = next) {
        if (swing_at(&w, depth) && !is_traced(curve, &w.f.o.at, WIDE * A0))
            follow_piece(&w, curve, piece++);
        next = depth - fmax(SHORT, FAR * fabs(depth));
        if (depth > capture && next <= capture)
            next = capture - ASIDE;
    }
    return curve->count > 1 ? NT_OK : NT_E_NO_CONVERGENCE;
}
