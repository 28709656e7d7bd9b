/* SPDX-License-Identifier: BSD-3-Clause
 * One motion of a tapping lever for a target, by Newton's method in the plane of swing and depth; what the harmonics
 * that are left out would change; whether it stays. All motions: curve.c. Which of them a lever comes to: branches.c.
 */
#include "internal/balance.h"

#include <math.h>
#include <stddef.h>

#include "core/same_bits.h"
#include "motion.h"
#include "nanotouch/material.h"
#include "scan/balance.h"
#include "scene/parts.h"

#define PROBE 1e-5    /* of the finite differences, over A0 */
#define BALANCED 1e-9 /* of the drive, squared, and of the target over A0 */
#define OVERSIGHT 2.0 /* the harmonics left out, at most over what they are told to be */
#define GRAIN 2e-4    /* what quadrature leaves of the amplitude, over A0: forces turn it, by up to Q */
#define FLOOR 2e-5    /* what quadrature and kinks of the force move the lowest point by, over A0 */
#define STEEP 1.5     /* dA/dz_b beyond which a fold may be near: the amplitude does not answer in proportion */
enum { NEWTON_MAX = 40, HALVINGS = 8, RETREATS = 8 };

int nt_motion_find(const nt_balance *b, const nt_balance_state *at, motion *f)
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

static double aimed(const motion *f, nt_balance_aim aim)
{
    return aim == NT_AIM_HEIGHT ? f->height : aim == NT_AIM_AMPLITUDE ? f->amplitude : f->phase;
}

int nt_motion_slopes(const nt_balance *b, const motion *f, nt_balance_aim aim, slopes *s)
{
    const double step = PROBE * b->lever->free_amplitude, capture = nt_plan_capture_gap(b->plan, b->place);
    for (int i = 0; i < 2; i++) {
        const int is_near = f->o.at.depth <= capture && capture < f->o.at.depth + step; /* not across a jump */
        const double d = i == 1 && is_near ? -step : step;
        motion moved = {.o.evaluations = 0};
        nt_balance_state at = f->o.at;
        *(i == 0 ? &at.swing : &at.depth) += d;
        if (!nt_motion_find(b, &at, &moved))
            return 0;
        s->strength[i] = (moved.strength - f->strength) / d;
        s->height[i] = (moved.height - f->height) / d;
        s->aim[i] = (aimed(&moved, aim) - aimed(f, aim)) / d;
        s->taken[i] = (moved.drive[1] - f->drive[1]) / d;
    }
    return 1;
}

/* How far a motion is from balance and target, in one number. */
static double off_by(const nt_balance *b, const motion *f, const nt_balance_target *target)
{
    const double unit = target->aim == NT_AIM_PHASE ? 1.0 : b->lever->free_amplitude;
    return hypotenuse(f->strength, (aimed(f, target->aim) - target->value) / unit);
}

/* Newton's step towards the target, bounded and halved until it helps; 0 where none does. */
static int approach(const nt_balance *b, const nt_balance_target *target, const slopes *s, motion *f)
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
        motion next = {.o.evaluations = f->o.evaluations};
        if (nt_motion_find(b, &at, &next) && off_by(b, &next, target) < off_by(b, f, target)) {
            *f = next;
            return 1;
        }
        f->o.evaluations = next.o.evaluations;
    }
    return 0;
}

int nt_motion_keeps(const nt_balance *b, const nt_balance_value *value)
{
    return value->amplitude_bound <= b->accuracy * b->lever->free_amplitude &&
           value->force_bound <= b->accuracy * fmax(fabs(value->peak_force), b->plan->pull_off_force);
}

/* Its sign changes where the height turns along the curve. */
static double fold_of(const slopes *s)
{
    return s->strength[0] * s->height[1] - s->strength[1] * s->height[0];
}

static nt_status meet(const nt_balance *b, const nt_balance_target *target, motion *f, slopes *s)
{
    for (int i = 0; i < NEWTON_MAX; i++) {
        if (!nt_motion_slopes(b, f, target->aim, s))
            return NT_E_NO_CONVERGENCE;
        if (off_by(b, f, target) < BALANCED || !approach(b, target, s, f))
            break;
    }
    return off_by(b, f, target) < 100.0 * BALANCED ? NT_OK : NT_E_NO_CONVERGENCE;
}

/* How far the amplitude goes if the base is higher or lower by this; infinite where no such motion is left there. */
static double answer_to(const nt_balance *b, const motion *f, double fold, double moved)
{
    double most = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        const nt_balance_target target = {NT_AIM_HEIGHT, f->height + side * moved, 0};
        motion there = *f;
        slopes s;
        if (meet(b, &target, &there, &s) != NT_OK || fold_of(&s) * fold <= 0.0)
            return HUGE_VAL;
        most = fmax(most, fabs(there.amplitude - f->amplitude));
    }
    return most;
}

/* What the harmonics left out would change at the lowest point, and how the amplitude answers. Completes the orbit. */
static void add_bounds(const nt_balance *b, motion *f, double fold, nt_balance_value *value)
{
    const nt_tapping *t = b->lever;
    const nt_interaction_state history = {f->o.captured, 0.0, 0.0};
    const motion begun = *f;
    double moved = 0.0;
    nt_orbit_complete(&f->o);
    for (int n = b->harmonics + 1; n <= f->o.orders; n++)
        moved += hypotenuse(f->o.force[n][0], f->o.force[n][1]) / (n * n * t->ratio * t->ratio - 1.0);
    moved = OVERSIGHT * moved + FLOOR * t->free_amplitude;
    const double here = nt_interaction_eval_gap(b->plan, &history, b->place, f->o.lowest).F;
    const double down = nt_interaction_eval_gap(b->plan, &history, b->place, f->o.lowest - moved).F;
    const double up = nt_interaction_eval_gap(b->plan, &history, b->place, f->o.lowest + moved).F;
    value->force_bound = fmax(fabs(down - here), fabs(up - here));
    const double answer = fabs(value->gain) < STEEP ? fabs(value->gain) * moved : answer_to(b, &begun, fold, moved);
    value->amplitude_bound = fmax(moved, answer) + GRAIN * t->free_amplitude;
    const int may_catch = fabs(f->o.lowest - nt_plan_capture_gap(b->plan, b->place)) <= moved;
    const int may_hold = f->o.captured && f->o.top - b->plan->release_gap <= moved;
    if (may_catch || may_hold || !(answer < HUGE_VAL)) /* or the branch ends */
        value->amplitude_bound = value->force_bound = HUGE_VAL;
}

static nt_balance_value value_of(const nt_balance *b, motion *f, const slopes *s)
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
                              .harmonics = b->harmonics};
    add_bounds(b, f, fold_of(s), &value);
    value.stable = nt_orbit_returns(&f->o);
    value.evaluations = f->o.evaluations;
    return value;
}

nt_status nt_balance_solve(const nt_balance *balance, const nt_balance_target *target, nt_balance_state *state,
                           nt_balance_value *value)
{
    if (balance == NULL || balance->lever == NULL || balance->plan == NULL || balance->harmonics < 1 ||
        balance->harmonics > NT_HARMONICS_MAX || target == NULL || state == NULL || value == NULL)
        return NT_E_ARGUMENT;
    motion f = {.o.evaluations = 0};
    nt_balance_state begun = *state;
    for (int i = 0; !nt_motion_find(balance, &begun, &f); i++) { /* too deep: its harmonics may have no balance there */
        if (i == RETREATS)
            return NT_E_NO_CONVERGENCE;
        begun = *state;
        begun.depth += (i + 1) * (0.05 * fabs(begun.depth) + 0.5 * SHORT);
    }
    slopes s;
    const nt_status status = meet(balance, target, &f, &s);
    if (status != NT_OK)
        return status;
    *value = value_of(balance, &f, &s);
    *state = f.o.at;
    state->lag = atan2(f.drive[1], f.drive[0]);
    for (int n = balance->harmonics + 1; n <= NT_HARMONICS_MAX; n++) { /* as the force would drive them */
        const double stiffness = 1.0 - n * n * balance->lever->ratio * balance->lever->ratio;
        state->real[n] = n <= f.o.orders ? f.o.force[n][0] / stiffness : 0.0;
        state->imaginary[n] = n <= f.o.orders ? f.o.force[n][1] / stiffness : 0.0;
    }
    return NT_OK;
}
