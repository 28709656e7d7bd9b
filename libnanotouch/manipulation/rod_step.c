/* SPDX-License-Identifier: BSD-3-Clause
 * A step of a rod: the minimum over its pose, and over x and y of a tip on a lever, of what the springs along the line
 * of contact store or make heat of, and of the energy of the tip's contact and of the lever. Turns count as lengths at
 * half of the rod. */
#include "manipulation/rod_step.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "internal/manipulation.h"
#include "manipulation/balance.h"
#include "manipulation/rod.h"

enum { ROUNDS = 3000, TRIES = 40 };
#define EXACT 1e-8   /* of all forces: how closely they balance */
#define ENOUGH 1e-5  /* where no step goes down any more */
#define FAINT 1e-18  /* [N] */
#define LONGEST 0.05 /* of the smaller radius: the largest motion in one of Newton's steps */
#define DEEPEST 0.5  /* of the smaller radius */
#define DAMPING 1e-12
#define RETRIED 1e-5 /* the least damping that makes a difference, where a step has failed */
#define FAIR 0.1     /* of what a step promises */
#define UNSEEN 1e-16 /* of the cost: it cannot show what a step of less brings */

/* x and y of the rod, half of its length times its turn; x, y and z of the tip. */
enum { TURN = 2, OF_ROD = 3, TIP_Z = 5, WAYS = 6 };

rod_touch rod_touch_at(const nt_rod *rod, const double tip[3], const double pose[3])
{
    const double axis[2] = {cos(pose[2]), sin(pose[2])}, half = 0.5 * rod->length;
    const double along = fmin(fmax((tip[0] - pose[0]) * axis[0] + (tip[1] - pose[1]) * axis[1], -half), half);
    const double away[2] = {pose[0] + along * axis[0] - tip[0], pose[1] + along * axis[1] - tip[1]};
    const double rho = sqrt(away[0] * away[0] + away[1] * away[1]), h = rod->radius - rod->tip_radius - tip[2];
    const double sine = sin(rod->tip_half_angle), cosine = cos(rod->tip_half_angle);
    const double reach = rod->radius + rod->tip_radius;
    rod_touch found = {.rho = rho, .slope = {cosine, -sine}, .normal = {0.0, 1.0}, .along = along};
    double distance = rho * cosine - h * sine; /* of the flank */
    if (rho * sine + h * cosine <= 0.0) {      /* of the sphere */
        distance = sqrt(rho * rho + h * h);
        const double n[2] = {distance > 0.0 ? rho / distance : 1.0, distance > 0.0 ? h / distance : 0.0};
        const double bend = distance > 0.0 ? 1.0 / distance : 0.0;
        found.slope[0] = n[0];
        found.slope[1] = n[1];
        found.bend[0] = bend * n[1] * n[1];
        found.bend[1] = -bend * n[0] * n[1];
        found.bend[2] = bend * n[0] * n[0];
    }
    found.depth = fmax(reach - distance, 0.0);
    if (rho > 0.0) {
        found.normal[0] = away[0] / rho;
        found.normal[1] = away[1] / rho;
    }
    return found;
}

/* Counted from where the rod's middle is as the step begins, so that little is rounded however far from the origin. */
typedef struct rod_place {
    double way[3]; /* of the middle [m]; turn [rad] */
    double tip[3]; /* z is that over the substrate [m] */
} rod_place;

typedef struct rod_step {
    const nt_rod *rod;
    const nt_rod_state *from;
    const double *base; /* where it ends [m] ... */
    double aside[2];    /* ... and counted as above */
    int freedoms;
    double k, limit; /* of each piece [N/m], [N] */
    double give;     /* 1/k [m/N] */
    double arm;      /* half of the length [m] */
    double axis[2];  /* as it begins */
    double finest;   /* what forces need not be closer to 0 than: places are known to 1e-16 of them [N] */
} rod_step;

typedef struct rod_value {
    double cost;                /* stored and made heat of [J] */
    double gradient[WAYS];      /* [N] */
    double hessian[WAYS][WAYS]; /* its lower half [N/m] */
    double size;                /* of all forces [N] */
} rod_value;

static rod_step step_to(const nt_rod *rod, const nt_rod_state *from, const double base[3])
{
    const double share = rod->length / rod->elements;
    const double size = rod->length + rod->radius + rod->tip_radius;
    return (rod_step){.rod = rod,
                      .from = from,
                      .base = base,
                      .aside = {base[0] - from->pose[0], base[1] - from->pose[1]},
                      .freedoms = rod->lever > 0.0 ? TIP_Z : OF_ROD,
                      .k = nt_rod_stiffness(rod) * share,
                      .limit = nt_rod_friction(rod) * share,
                      .give = 1.0 / (nt_rod_stiffness(rod) * share),
                      .arm = 0.5 * rod->length,
                      .axis = {cos(from->pose[2]), sin(from->pose[2])},
                      .finest = FAINT + 4e-16 * size * (rod->lever + rod->tip_stiffness)};
}

static double place_of(const nt_rod *rod, int i)
{
    return ((i + 0.5) / rod->elements - 0.5) * rod->length;
}

/* By how much the axis has changed. */
static void swing_of(const rod_step *step, const rod_place *place, double swing[2])
{
    const double sine = sin(place->way[TURN]), half = sin(0.5 * place->way[TURN]), less = 2.0 * half * half;
    swing[0] = -less * step->axis[0] - sine * step->axis[1];
    swing[1] = -less * step->axis[1] + sine * step->axis[0];
}

/* How far the spring of a piece is stretched if it does not give way; its length. */
static double stretch_of(const rod_step *step, int i, const rod_place *place, const double swing[2], double stretch[2])
{
    const double s = place_of(step->rod, i);
    for (int k = 0; k < 2; ++k)
        stretch[k] = step->from->pulls[i][k] * step->give + place->way[k] + s * swing[k];
    return sqrt(stretch[0] * stretch[0] + stretch[1] * stretch[1]);
}

static rod_touch touch_of(const rod_step *step, const rod_place *place)
{
    const double pose[3] = {place->way[0], place->way[1], step->from->pose[TURN] + place->way[TURN]};
    return rod_touch_at(step->rod, place->tip, pose);
}

/* turn: the way of the piece with a turn. */
static void add_piece(const rod_step *step, const double stretch[2], double length, const double turn[2],
                      rod_value *value)
{
    const int gives = step->k * length > step->limit;
    const double across = gives ? step->limit / length : step->k;
    const double unit[2] = {gives ? stretch[0] / length : 0.0, gives ? stretch[1] / length : 0.0};
    const double xx = across * (1.0 - unit[0] * unit[0]), yx = -across * unit[0] * unit[1],
                 yy = across * (1.0 - unit[1] * unit[1]);
    const double x = xx * turn[0] + yx * turn[1], y = yx * turn[0] + yy * turn[1];
    value->cost += gives ? step->limit * (length - 0.5 * step->limit / step->k) : 0.5 * step->k * length * length;
    value->size += across * (fabs(stretch[0]) + fabs(stretch[1]));
    value->gradient[0] += across * stretch[0];
    value->gradient[1] += across * stretch[1];
    value->gradient[TURN] += across * (turn[0] * stretch[0] + turn[1] * stretch[1]);
    value->hessian[0][0] += xx;
    value->hessian[1][0] += yx;
    value->hessian[1][1] += yy;
    value->hessian[TURN][0] += x;
    value->hessian[TURN][1] += y;
    value->hessian[TURN][TURN] += x * turn[0] + y * turn[1];
}

/* A side that turns moves its normal, too; force: of the contact, seen from above [N]. */
static void add_turning(const rod_step *step, const rod_touch *at, const double side[2], double force, rod_value *value)
{
    const double sideways = side[0] * at->normal[0] + side[1] * at->normal[1];
    const double bend = copysign(force / step->arm, sideways);
    value->hessian[TURN][0] += bend * side[1];
    value->hessian[TURN][1] -= bend * side[0];
    value->hessian[OF_ROD][TURN] -= bend * side[1];
    value->hessian[OF_ROD + 1][TURN] += bend * side[0];
    value->hessian[TURN][TURN] += force * at->rho / (step->arm * step->arm);
}

static void add_tip(const rod_step *step, const rod_place *place, const double side[2], rod_value *value)
{
    const rod_touch at = touch_of(step, place);
    const double stiff = step->rod->tip_stiffness, sideways = side[0] * at.normal[0] + side[1] * at.normal[1];
    const double rho[WAYS] = {at.normal[0],  at.normal[1],  at.along * sideways / step->arm,
                              -at.normal[0], -at.normal[1], 0.0};
    if (!(at.depth > 0.0))
        return;
    const double push = stiff * at.depth;
    value->cost += 0.5 * push * at.depth;
    value->size += push;
    for (int i = 0; i < WAYS; ++i) {
        const double h = i == TIP_Z ? -1.0 : 0.0, of = at.slope[0] * rho[i] + at.slope[1] * h;
        value->gradient[i] -= push * of;
        for (int j = 0; j <= i; ++j)
            value->hessian[i][j] +=
                stiff * of * at.slope[0] * rho[j] - push * (at.bend[0] * rho[i] + at.bend[1] * h) * rho[j];
    }
    value->hessian[TIP_Z][TIP_Z] += stiff * at.slope[1] * at.slope[1] - push * at.bend[2];
    if (fabs(at.along) < step->arm)
        add_turning(step, &at, side, push * at.slope[0], value);
}

static void add_lever(const rod_step *step, const double tip[3], rod_value *value)
{
    const double lever = step->rod->lever;
    for (int i = 0; i < 2; ++i) {
        const double bent = tip[i] - step->aside[i];
        value->cost += 0.5 * lever * bent * bent;
        value->size += lever * fabs(bent);
        value->gradient[OF_ROD + i] += lever * bent;
        value->hessian[OF_ROD + i][OF_ROD + i] += lever;
    }
}

static rod_value value_at(const rod_step *step, const rod_place *place)
{
    const int count = (int)step->rod->elements;
    rod_value value = {0};
    double swing[2];
    swing_of(step, place, swing);
    const double side[2] = {-step->axis[1] - swing[1], step->axis[0] + swing[0]};
    for (int i = 0; i < count; ++i) {
        double stretch[2];
        const double length = stretch_of(step, i, place, swing, stretch), s = place_of(step->rod, i) / step->arm;
        add_piece(step, stretch, length, (double[2]){s * side[0], s * side[1]}, &value);
    }
    add_tip(step, place, side, &value);
    add_lever(step, place->tip, &value);
    return value;
}

static double largest(const double values[], int count)
{
    double most = 0.0;
    for (int i = 0; i < count; ++i)
        most = fmax(most, fabs(values[i]));
    return most;
}

/* Newton's way, no longer than allowed; how steep it goes down: 0 where it does not. */
static double newton(const rod_step *step, const rod_value *value, double damping, double way[WAYS])
{
    const double longest = LONGEST * fmin(step->rod->radius, step->rod->tip_radius);
    const int n = step->freedoms;
    balance_matrix hessian;
    double slope = 0.0, size = 0.0;
    for (int i = 0; i < n; ++i) {
        memcpy(hessian[i], value->hessian[i], (size_t)(i + 1) * sizeof hessian[i][0]);
        size += fabs(hessian[i][i]);
    }
    for (int i = 0; i < n; ++i) /* a tip that slips off the top has stiffnesses below 0 */
        hessian[i][i] += damping * size;
    if (!balance_solve(hessian, n, 0.0, value->gradient, way))
        return 0.0;
    for (int i = 0; i < n; ++i)
        slope += value->gradient[i] * way[i];
    const double share = fmin(1.0, longest / largest(way, n));
    for (int i = 0; i < n; ++i)
        way[i] *= share;
    return slope < 0.0 ? share * slope : 0.0;
}

/* A step that goes down; 0: none does. */
static int go_down(const rod_step *step, rod_place *place, rod_value *value, double *damping)
{
    const int n = step->freedoms;
    for (int tries = 0; tries < TRIES; ++tries, *damping = fmax(8.0 * *damping, RETRIED)) {
        double way[WAYS] = {0.0};
        const double slope = newton(step, value, *damping, way);
        if (slope == 0.0)
            continue;
        if (tries > 0 && -slope < UNSEEN * value->cost)
            return 0;
        rod_place trial = *place;
        for (int i = 0; i < 2; ++i) {
            trial.way[i] += way[i];
            trial.tip[i] += way[OF_ROD + i];
        }
        trial.way[TURN] += way[TURN] / step->arm;
        const rod_value found = value_at(step, &trial);
        const int closer = largest(found.gradient, n) < 0.9 * largest(value->gradient, n);
        const int lower = found.cost < value->cost && found.cost <= value->cost + 1e-4 * slope;
        if (lower || (closer && found.cost <= value->cost * (1.0 + 1e-13))) {
            const int fits = closer || value->cost - found.cost > FAIR * -slope; /* else it swings from side to side */
            *place = trial;
            *value = found;
            *damping = fits ? fmax(*damping / 100.0, DAMPING) : fmax(8.0 * *damping, RETRIED);
            return 1;
        }
    }
    return 0;
}

static nt_status find(const rod_step *step, rod_place *place, rod_value *value)
{
    double damping = DAMPING;
    const int n = step->freedoms;
    *value = value_at(step, place);
    for (int i = 0; i < ROUNDS; ++i) {
        if (largest(value->gradient, n) <= EXACT * value->size + step->finest)
            return NT_OK;
        if (!go_down(step, place, value, &damping))
            break;
    }
    return largest(value->gradient, n) <= ENOUGH * value->size + step->finest ? NT_OK : NT_E_NO_CONVERGENCE;
}

/* What is left of the stiffness along z when all else gives way: the last pivot. */
static double resistance_of(const rod_step *step, const rod_value *value)
{
    const int n = step->freedoms;
    balance_matrix hessian;
    for (int i = 0; i <= n; ++i)
        memcpy(hessian[i], value->hessian[i < n ? i : TIP_Z], (size_t)(n + 1) * sizeof hessian[i][0]);
    hessian[n][n] = value->hessian[TIP_Z][TIP_Z];
    return balance_factor(hessian, n + 1, 0.0) ? hessian[n][n] * hessian[n][n] : 0.0;
}

/* Pulls after the step; the way by which all have given [m]. */
static double give_way(const rod_step *step, const rod_place *place, nt_rod_state *to)
{
    double given = 0.0, swing[2];
    swing_of(step, place, swing);
    for (int i = 0; i < (int)step->rod->elements; ++i) {
        double stretch[2];
        const double length = stretch_of(step, i, place, swing, stretch);
        const double beyond = fmax(length - step->limit / step->k, 0.0);
        const double k = beyond > 0.0 ? step->limit / length : step->k;
        given += beyond;
        to->pulls[i][0] = k * stretch[0];
        to->pulls[i][1] = k * stretch[1];
        to->stored += 0.5 * k * k * length * length / step->k;
    }
    return given;
}

/* stored + dissipated = work; a step's work lies between the forces at its two ends times its way, or a jump was heat.
 */
static void keep_account(const rod_step *step, double slipped, nt_rod_state *to)
{
    const nt_rod_state *from = step->from;
    double ways[2] = {0.0, 0.0};
    for (int k = 0; k < 3; ++k) {
        ways[0] -= from->force[k] * (to->base[k] - from->base[k]);
        ways[1] -= to->force[k] * (to->base[k] - from->base[k]);
    }
    const double kept = to->stored - from->stored + slipped;
    const double jump = fmax(fmin(ways[0], ways[1]) - kept, 0.0);
    to->dissipated = from->dissipated + slipped + jump;
    to->work = from->work + kept + jump;
}

static void end_at(const rod_step *step, const rod_place *place, const rod_value *value, nt_rod_state *to)
{
    const nt_rod *rod = step->rod;
    const rod_touch at = touch_of(step, place);
    const double push = rod->tip_stiffness * at.depth;
    memcpy(to->base, step->base, sizeof to->base);
    memcpy(to->tip, step->base, sizeof to->tip);
    to->stored = 0.5 * push * at.depth;
    for (int k = 0; k < 3; ++k)
        to->pose[k] = step->from->pose[k] + place->way[k];
    for (int k = 0; k < 2; ++k) {
        const double bent = place->tip[k] - step->aside[k];
        to->tip[k] += bent;
        to->force[k] = -push * at.slope[0] * at.normal[k];
        to->stored += 0.5 * rod->lever * bent * bent;
    }
    to->force[2] = -push * at.slope[1];
    to->resistance = at.depth > 0.0 ? resistance_of(step, value) : 0.0;
    keep_account(step, rod->length / rod->elements * nt_rod_friction(rod) * give_way(step, place, to), to);
}

nt_status rod_take_step(const nt_rod *rod, nt_rod_state *state, const double base[3])
{
    const rod_step step = step_to(rod, state, base);
    const int was_free = !nt_rod_touches(state);
    rod_place place = {.tip = {step.aside[0], step.aside[1], base[2]}};
    rod_value value;
    nt_rod_state to;
    if (was_free && touch_of(&step, &place).depth == 0.0) { /* nothing moves but the tip */
        memcpy(state->base, base, sizeof state->base);
        memcpy(state->tip, base, sizeof state->tip);
        return NT_OK;
    }
    for (int k = 0; k < 2 && rod->lever > 0.0 && !was_free; ++k)
        place.tip[k] = state->tip[k] - state->pose[k];
    const nt_status status = find(&step, &place, &value);
    if (status != NT_OK)
        return status;
    if (touch_of(&step, &place).depth > DEEPEST * fmin(rod->radius, rod->tip_radius))
        return NT_E_RANGE;
    end_at(&step, &place, &value, &to);
    rod_copy(rod, state, &to);
    return NT_OK;
}
