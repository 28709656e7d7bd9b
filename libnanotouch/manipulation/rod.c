/* SPDX-License-Identifier: BSD-3-Clause
 * A rod that a tip pushes: see advanced/manipulation.h. What it is like, where it lies, and its way, step by step. */
#include "internal/field.h"
#include "internal/manipulation.h"
#include "nanotouch/advanced/manipulation.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/problem.h"
#include "core/same_bits.h"
#include "manipulation/rod.h"
#include "manipulation/rod_step.h"
#include "nanotouch/material.h"

#define MOST_STEPS 1e7

#define FIELD(path, ...) NT_FIELD(nt_rod, path, __VA_ARGS__)
static const nt_field rod_fields[] = {
    FIELD(length, "m", 1e-9, 1e-2, "L of the rod"),
    FIELD(radius, "m", 1e-10, 1e-3, "R of the rod"),
    FIELD(effective_modulus, "Pa", 1e3, 1e13, "E* of rod and substrate"),
    FIELD(effective_shear_modulus, "Pa", 1e2, 1e13, "G* of rod and substrate"),
    FIELD(work_of_adhesion, "J/m^2", 1e-9, 1e6, "w of rod and substrate"),
    FIELD(shear_strength, "Pa", 1e-3, 1e12, "tau, friction per contact area"),
    FIELD(tip_radius, "m", 1e-10, 1e-3, "r of the tip"),
    FIELD(tip_half_angle, "rad", 0.0, 1.4, "psi of its cone"),
    FIELD(tip_stiffness, "N/m", 1e-6, 1e9, "of the contact of tip and rod"),
    FIELD(lever, "N/m", 0.0, 1e9, "stiffness between base and tip along x and y; 0: held"),
    FIELD(elements, "", 8.0, NT_ROD_ELEMENTS, "pieces of the line of contact"),
    FIELD(step, "m", 1e-13, 1e-6, "largest step of the tip"),
};
enum { ROD_FIELDS = (int)(sizeof rod_fields / sizeof rod_fields[0]) };

nt_rod nt_rod_defaults(void)
{
    return (nt_rod){2e-6, 50e-9, 70e9, 10e9, 0.05, 10e6, 20e-9, 0.0, 100.0, 0.0, 100.0, 1e-9};
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
    const double push = nt_rod_friction(rod) * rod->length / cos(rod->tip_half_angle);
    const double least = 4.0 * push / fmin(rod->radius, rod->tip_radius);
    if (!(rod->tip_stiffness >= least))
        return nt_problem_set(problem, "tip_stiffness (a tip that does not go through the rod)", "N/m",
                              rod->tip_stiffness, least, 1e9);
    return NT_OK;
}

nt_status nt_rod_place(const nt_rod *rod, const double pose[3], const double base[3], nt_rod_state *state)
{
    for (int i = 0; i < 3; ++i)
        if (!isfinite(pose[i]) || !isfinite(base[i]))
            return NT_E_NOT_FINITE;
    if (base[2] < 0.0 || rod_touch_at(rod, base, pose).depth > 0.0)
        return NT_E_RANGE;
    *state = (nt_rod_state){0};
    memcpy(state->pose, pose, sizeof state->pose);
    memcpy(state->base, base, sizeof state->base);
    memcpy(state->tip, base, sizeof state->tip);
    return NT_OK;
}

void rod_copy(const nt_rod *rod, nt_rod_state *to, const nt_rod_state *from)
{
    memcpy(to, from, offsetof(nt_rod_state, pulls) + (size_t)rod->elements * sizeof from->pulls[0]);
}

int nt_rod_touches(const nt_rod_state *state)
{
    return state->force[0] != 0.0 || state->force[1] != 0.0 || state->force[2] != 0.0;
}

nt_status nt_rod_advance(const nt_rod *rod, nt_rod_state *state, const double base[3])
{
    double from[3], way[3], length = 0.0;
    for (int i = 0; i < 3; ++i) {
        if (!isfinite(base[i]))
            return NT_E_NOT_FINITE;
        from[i] = state->base[i];
        way[i] = base[i] - from[i];
        length += way[i] * way[i];
    }
    const double steps = fmax(1.0, ceil(sqrt(length) / rod->step));
    if (!(steps <= MOST_STEPS) || base[2] < 0.0)
        return NT_E_RANGE;
    nt_rod_state now;
    rod_copy(rod, &now, state);
    for (long i = 1; i <= (long)steps; ++i) {
        const double share = (double)i / steps;
        const double to[3] = {from[0] + share * way[0], from[1] + share * way[1], from[2] + share * way[2]};
        const nt_status status = rod_take_step(rod, &now, i < (long)steps ? to : base);
        if (status != NT_OK)
            return status;
    }
    rod_copy(rod, state, &now);
    return NT_OK;
}
