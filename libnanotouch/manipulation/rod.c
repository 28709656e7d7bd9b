/* SPDX-License-Identifier: BSD-3-Clause
 * A rod that a tip pushes: see rod.h. A step ends in the minimum over the pose of what the springs along the line of
 * contact store or make heat of, and of the energy of the tip's contact. Turns count as lengths at half of the rod. */
#include "nanotouch/rod.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/problem.h"
#include "core/same_bits.h"
#include "nanotouch/material.h"

enum { ROUNDS = 3000, HALVINGS = 40, WAYS = 3 };
#define EXACT 1e-9   /* of all forces: how closely they balance */
#define ENOUGH 1e-5  /* where no step goes down any more */
#define FAINT 1e-18  /* [N] */
#define LONGEST 0.05 /* of the smaller radius: the largest motion in one of Newton's steps */
#define DAMPING 1e-12
#define MOST_STEPS 1e7

#define FIELD(path, ...) NT_FIELD(nt_rod, path, __VA_ARGS__)
static const nt_field rod_fields[] = {
    FIELD(length, "m", 1e-9, 1e-2, "L of the rod"),
    FIELD(radius, "m", 1e-10, 1e-3, "R of the rod"),
    FIELD(effective_modulus, "Pa", 1e3, 1e13, "E* of rod and substrate"),
    FIELD(effective_shear_modulus, "Pa", 1e2, 1e13, "G* of rod and substrate"),
    FIELD(work_of_adhesion, "J/m^2", 1e-9, 1e6, "w of rod and substrate"),
    FIELD(shear_strength, "Pa", 1e-3, 1e12, "tau, friction per contact area"),
    FIELD(tip_radius, "m", 1e-10, 1e-3, "of the tip where it touches"),
    FIELD(tip_stiffness, "N/m", 1e-6, 1e9, "of the contact of tip and rod"),
    FIELD(elements, "", 8.0, NT_ROD_ELEMENTS, "pieces of the line of contact"),
    FIELD(step, "m", 1e-13, 1e-6, "largest step of the tip"),
};
enum { ROD_FIELDS = (int)(sizeof rod_fields / sizeof rod_fields[0]) };

nt_rod nt_rod_defaults(void)
{
    return (nt_rod){2e-6, 50e-9, 70e9, 10e9, 0.05, 10e6, 20e-9, 100.0, 100.0, 1e-9};
}

const nt_field *nt_rod_fields(int *count)
{
    if (count != NULL)
        *count = ROD_FIELDS;
    return rod_fields;
}

double nt_rod_half_width(const nt_rod *rod)
{
    return cube_root(32.0 * rod->radius * rod->radius * rod->work_of_adhesion / (NT_PI * rod->effective_modulus));
}

double nt_rod_friction(const nt_rod *rod)
{
    return 2.0 * nt_rod_half_width(rod) * rod->shear_strength;
}

double nt_rod_stiffness(const nt_rod *rod)
{
    return NT_PI * rod->effective_shear_modulus / log(rod->length / nt_rod_half_width(rod));
}

double nt_rod_turning_point(double length, double arm)
{
    return sqrt(arm * arm + 0.25 * length * length) - arm;
}

nt_status nt_rod_check(const nt_rod *rod, nt_problem *problem)
{
    const nt_status status = nt_field_check(rod_fields, ROD_FIELDS, rod, problem);
    if (status != NT_OK)
        return status;
    if (rod->elements != floor(rod->elements))
        return nt_problem_set(problem, "elements (a whole number)", "", rod->elements, 8.0, NT_ROD_ELEMENTS);
    if (!(rod->length >= 4.0 * rod->radius))
        return nt_problem_set(problem, "length (4 radii at least)", "m", rod->length, 4.0 * rod->radius, 1e-2);
    const double b = nt_rod_half_width(rod), widest = 0.5 * rod->radius;
    if (!(b < widest))
        return nt_problem_set(problem, "half_width (of the contact without load)", "m", b, 0.0, widest);
    const double least = 4.0 * nt_rod_friction(rod) * rod->length / fmin(rod->radius, rod->tip_radius);
    if (!(rod->tip_stiffness >= least))
        return nt_problem_set(problem, "tip_stiffness (a tip that does not go through the rod)", "N/m",
                              rod->tip_stiffness, least, 1e9);
    return NT_OK;
}

/* --- tip and rod, seen from above: a circle, and a line with round ends --- */

typedef struct touch {
    double depth;     /* how deep they overlap, 0 apart [m] */
    double normal[2]; /* from the tip to the rod */
    double along;     /* the place on the axis [m] */
} touch;

static touch touch_at(const nt_rod *rod, const double tip[2], const double pose[3])
{
    const double axis[2] = {cos(pose[2]), sin(pose[2])}, half = 0.5 * rod->length;
    const double along = fmin(fmax((tip[0] - pose[0]) * axis[0] + (tip[1] - pose[1]) * axis[1], -half), half);
    const double away[2] = {pose[0] + along * axis[0] - tip[0], pose[1] + along * axis[1] - tip[1]};
    const double distance = sqrt(away[0] * away[0] + away[1] * away[1]);
    touch found = {fmax(rod->radius + rod->tip_radius - distance, 0.0), {0.0, 1.0}, along};
    if (distance > 0.0) {
        found.normal[0] = away[0] / distance;
        found.normal[1] = away[1] / distance;
    }
    return found;
}

/* --- one step of the tip --- */

typedef struct rod_step {
    const nt_rod *rod;
    const nt_rod_state *from;
    double tip[2];   /* where it ends [m] */
    double k, limit; /* of each piece [N/m], [N] */
    double arm;      /* half of the length [m] */
    double axis[2];  /* as it begins */
} rod_step;

typedef struct rod_value {
    double cost;                /* stored and made heat of [J] */
    double gradient[WAYS];      /* [N] */
    double hessian[WAYS][WAYS]; /* [N/m] */
    double size;                /* of all forces [N] */
} rod_value;

static rod_step step_to(const nt_rod *rod, const nt_rod_state *from, const double tip[2])
{
    const double share = rod->length / rod->elements;
    return (rod_step){.rod = rod,
                      .from = from,
                      .tip = {tip[0], tip[1]},
                      .k = nt_rod_stiffness(rod) * share,
                      .limit = nt_rod_friction(rod) * share,
                      .arm = 0.5 * rod->length,
                      .axis = {cos(from->pose[2]), sin(from->pose[2])}};
}

static double place_of(const nt_rod *rod, int i)
{
    return ((i + 0.5) / rod->elements - 0.5) * rod->length;
}

/* How far the spring of a piece is stretched if it does not give way; its length. */
static double stretch_of(const rod_step *step, int i, const double pose[3], const double axis[2], double stretch[2])
{
    const double s = place_of(step->rod, i);
    for (int k = 0; k < 2; ++k)
        stretch[k] =
            step->from->pulls[i][k] / step->k + (pose[k] - step->from->pose[k]) + s * (axis[k] - step->axis[k]);
    return sqrt(stretch[0] * stretch[0] + stretch[1] * stretch[1]);
}

/* ways: of the piece with x, y and the turn. */
static void add_piece(const rod_step *step, const double stretch[2], double length, double turn[2], rod_value *value)
{
    const int gives = step->k * length > step->limit;
    const double across = gives ? step->limit / length : step->k;
    const double unit[2] = {gives ? stretch[0] / length : 0.0, gives ? stretch[1] / length : 0.0};
    const double ways[WAYS][2] = {{1.0, 0.0}, {0.0, 1.0}, {turn[0], turn[1]}};
    value->cost += gives ? step->limit * (length - 0.5 * step->limit / step->k) : 0.5 * step->k * length * length;
    value->size += across * (fabs(stretch[0]) + fabs(stretch[1]));
    for (int i = 0; i < WAYS; ++i) {
        value->gradient[i] += across * (ways[i][0] * stretch[0] + ways[i][1] * stretch[1]);
        const double gone = ways[i][0] * unit[0] + ways[i][1] * unit[1];
        for (int j = 0; j < WAYS; ++j)
            value->hessian[i][j] += across * (ways[i][0] * ways[j][0] + ways[i][1] * ways[j][1] -
                                              gone * (ways[j][0] * unit[0] + ways[j][1] * unit[1]));
    }
}

static void add_tip(const rod_step *step, const double pose[3], const double side[2], rod_value *value)
{
    const nt_rod *rod = step->rod;
    const touch at = touch_at(rod, step->tip, pose);
    const double stiff = rod->tip_stiffness, sideways = side[0] * at.normal[0] + side[1] * at.normal[1];
    const double lever[WAYS] = {at.normal[0], at.normal[1], at.along * sideways / step->arm};
    if (!(at.depth > 0.0))
        return;
    value->cost += 0.5 * stiff * at.depth * at.depth;
    value->size += stiff * at.depth;
    for (int i = 0; i < WAYS; ++i) {
        value->gradient[i] -= stiff * at.depth * lever[i];
        for (int j = 0; j < WAYS; ++j)
            value->hessian[i][j] += stiff * lever[i] * lever[j];
    }
    if (!(fabs(at.along) < step->arm))
        return;
    /* a side that turns moves its normal, too */
    const double bend = copysign(stiff * at.depth / step->arm, sideways);
    value->hessian[0][2] += bend * side[1];
    value->hessian[1][2] -= bend * side[0];
    value->hessian[2][0] = value->hessian[0][2];
    value->hessian[2][1] = value->hessian[1][2];
    value->hessian[2][2] += stiff * at.depth * (rod->radius + rod->tip_radius - at.depth) / (step->arm * step->arm);
}

static rod_value value_at(const rod_step *step, const double pose[3])
{
    const double axis[2] = {cos(pose[2]), sin(pose[2])}, side[2] = {-axis[1], axis[0]};
    const int count = (int)step->rod->elements;
    rod_value value = {0};
    for (int i = 0; i < count; ++i) {
        double stretch[2];
        const double length = stretch_of(step, i, pose, axis, stretch), s = place_of(step->rod, i) / step->arm;
        add_piece(step, stretch, length, (double[2]){s * side[0], s * side[1]}, &value);
    }
    add_tip(step, pose, side, &value);
    return value;
}

static double largest(const double values[WAYS])
{
    return fmax(fmax(fabs(values[0]), fabs(values[1])), fabs(values[2]));
}

static double determinant(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* way = -(H + damping tr(H))^-1 g, no longer than allowed; how steep it goes down: 0 where it does not. */
static double newton(const rod_value *value, double damping, double longest, double way[WAYS])
{
    const double trace = value->hessian[0][0] + value->hessian[1][1] + value->hessian[2][2];
    double h[WAYS][WAYS], slope = 0.0;
    memcpy(h, value->hessian, sizeof h);
    for (int i = 0; i < WAYS; ++i)
        h[i][i] += damping * trace;
    const double whole = determinant(h[0], h[1], h[2]); /* Cramer: H is symmetric */
    for (int i = 0; i < WAYS; ++i) {
        const double *columns[WAYS] = {h[0], h[1], h[2]};
        columns[i] = value->gradient;
        way[i] = -determinant(columns[0], columns[1], columns[2]) / whole;
        slope += value->gradient[i] * way[i];
    }
    if (!(slope < 0.0) || !isfinite(slope))
        return 0.0;
    const double share = fmin(1.0, longest / largest(way));
    for (int i = 0; i < WAYS; ++i)
        way[i] *= share;
    return share * slope;
}

/* A step that goes down; 0: none does. */
static int go_down(const rod_step *step, double pose[3], rod_value *value, double *damping)
{
    const double longest = LONGEST * fmin(step->rod->radius, step->rod->tip_radius);
    for (int tries = 0; tries < HALVINGS; ++tries, *damping *= 8.0) {
        double way[WAYS];
        const double slope = newton(value, *damping, longest, way);
        if (slope == 0.0)
            continue;
        const double trial[3] = {pose[0] + way[0], pose[1] + way[1], pose[2] + way[2] / step->arm};
        const rod_value found = value_at(step, trial);
        const int closer = largest(found.gradient) < 0.9 * largest(value->gradient);
        if (found.cost <= value->cost + 1e-4 * slope || (closer && found.cost <= value->cost * (1.0 + 1e-13))) {
            memcpy(pose, trial, sizeof trial);
            *value = found;
            *damping = fmax(*damping / 100.0, DAMPING);
            return 1;
        }
    }
    return 0;
}

static nt_status find(const rod_step *step, double pose[3])
{
    double damping = DAMPING;
    rod_value value = value_at(step, pose);
    for (int i = 0; i < ROUNDS; ++i) {
        if (largest(value.gradient) <= EXACT * value.size + FAINT)
            return NT_OK;
        if (!go_down(step, pose, &value, &damping))
            break;
    }
    return largest(value.gradient) <= ENOUGH * value.size + FAINT ? NT_OK : NT_E_NO_CONVERGENCE;
}

/* Pulls after the step; the way by which all have given [m]. */
static double give_way(const rod_step *step, nt_rod_state *to)
{
    const double axis[2] = {cos(to->pose[2]), sin(to->pose[2])};
    double given = 0.0;
    for (int i = 0; i < (int)step->rod->elements; ++i) {
        double stretch[2];
        const double length = stretch_of(step, i, to->pose, axis, stretch);
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
static nt_status take_step(const nt_rod *rod, nt_rod_state *state, const double tip[2])
{
    const rod_step step = step_to(rod, state, tip);
    nt_rod_state to = {.pose = {state->pose[0], state->pose[1], state->pose[2]}, .tip = {tip[0], tip[1]}};
    const nt_status status = find(&step, to.pose);
    if (status != NT_OK)
        return status;
    const double slipped = step.limit * give_way(&step, &to);
    const touch at = touch_at(rod, tip, to.pose);
    double ways[2] = {0.0, 0.0};
    to.stored += 0.5 * rod->tip_stiffness * at.depth * at.depth;
    for (int k = 0; k < 2; ++k) {
        to.force[k] = -rod->tip_stiffness * at.depth * at.normal[k];
        ways[0] -= state->force[k] * (tip[k] - state->tip[k]);
        ways[1] -= to.force[k] * (tip[k] - state->tip[k]);
    }
    const double kept = to.stored - state->stored + slipped;
    const double jump = fmax(fmin(ways[0], ways[1]) - kept, 0.0);
    to.dissipated = state->dissipated + slipped + jump;
    to.work = state->work + kept + jump;
    *state = to;
    return NT_OK;
}

nt_status nt_rod_place(const nt_rod *rod, const double pose[3], const double tip[2], nt_rod_state *state)
{
    for (int i = 0; i < 5; ++i)
        if (!isfinite(i < 3 ? pose[i] : tip[i - 3]))
            return NT_E_NOT_FINITE;
    if (touch_at(rod, tip, pose).depth > 0.0)
        return NT_E_RANGE;
    *state = (nt_rod_state){.pose = {pose[0], pose[1], pose[2]}, .tip = {tip[0], tip[1]}};
    return NT_OK;
}

nt_status nt_rod_advance(const nt_rod *rod, nt_rod_state *state, const double tip[2])
{
    if (!isfinite(tip[0]) || !isfinite(tip[1]))
        return NT_E_NOT_FINITE;
    const double from[2] = {state->tip[0], state->tip[1]}, way[2] = {tip[0] - from[0], tip[1] - from[1]};
    const double steps = fmax(1.0, ceil(sqrt(way[0] * way[0] + way[1] * way[1]) / rod->step));
    if (!(steps <= MOST_STEPS))
        return NT_E_RANGE;
    nt_rod_state now = *state;
    for (long i = 1; i <= (long)steps; ++i) {
        const double share = (double)i / steps, to[2] = {from[0] + share * way[0], from[1] + share * way[1]};
        const nt_status status = take_step(rod, &now, i < (long)steps ? to : tip);
        if (status != NT_OK)
            return status;
    }
    *state = now;
    return NT_OK;
}
