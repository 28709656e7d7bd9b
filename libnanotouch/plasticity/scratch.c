/* SPDX-License-Identifier: BSD-3-Clause
 * A round tip that ploughs through a soft sample, and what wears: see plasticity.h. The tip is a paraboloid, a^2 = 2 R
 * d; its rear half is free, so that half a circle carries the load: P = H pi a^2/2 = pi R H d. Below a layer of the
 * thickness t the part that is deeper, (d - t), bears on the substrate: P = pi R (H t + H_s (d - t)). */
#include <math.h>
#include <stddef.h>

#include "internal/field.h"
#include "internal/plasticity.h"
#include "nanotouch/advanced/plasticity.h"
#include "nanotouch/material.h"

#include "core/problem.h"

#define FIELD(path, ...) NT_FIELD(nt_scratching, path, __VA_ARGS__)

static const nt_field scratching_fields[] = {
    FIELD(radius, "m", 1e-10, 1e-2, "R, of the tip"),
    FIELD(hardness, "Pa", 1.0, 1e12, "H, of the sample or its layer"),
    FIELD(shear_strength, "Pa", 0.0, 1e12, "tau, between tip and sample"),
    FIELD(layer_thickness, "m", 0.0, 1e-3, "t, of a layer; 0 for none"),
    FIELD(substrate_hardness, "Pa", 1.0, 1e12, "H_s, below the layer; read where there is one"),
};

enum { SCRATCHING_FIELDS = (int)(sizeof scratching_fields / sizeof scratching_fields[0]) };

nt_scratching nt_scratching_defaults(void)
{
    return (nt_scratching){.radius = 20e-9, .hardness = 1.05e9, .shear_strength = 50e6, .substrate_hardness = 10e9};
}

const nt_field *nt_scratching_fields(int *count)
{
    if (count != NULL)
        *count = SCRATCHING_FIELDS;
    return scratching_fields;
}

nt_status nt_scratching_check(const nt_scratching *scratching, nt_problem *problem)
{
    return nt_field_check(scratching_fields, SCRATCHING_FIELDS, scratching, problem);
}

/* The parabola below a depth, as it meets the sample in front [m^2]. */
static double front(double radius, double depth)
{
    return depth > 0.0 ? 4.0 / 3.0 * depth * sqrt(2.0 * radius * depth) : 0.0;
}

nt_status nt_scratch(const nt_scratching *scratching, double load, nt_groove *groove, nt_problem *problem)
{
    const nt_scratching *s = scratching;
    const double per_depth = NT_PI * s->radius, t = s->layer_thickness;
    const double deepest = 0.5 * NT_INDENTATION_LARGEST_RADIUS * NT_INDENTATION_LARGEST_RADIUS * s->radius;
    if (!isfinite(load))
        return NT_E_NOT_FINITE;
    const double in_layer = load / (per_depth * s->hardness);
    const int is_cut = t > 0.0 && in_layer > t;
    const double depth = is_cut ? t + (load / per_depth - s->hardness * t) / s->substrate_hardness : in_layer;
    if (!(load >= 0.0 && depth <= deepest)) {
        const double layer = t > 0.0 ? fmin(t, deepest) : deepest;
        const double most = per_depth * (s->hardness * layer + s->substrate_hardness * (deepest - layer));
        if (problem != NULL)
            *problem = nt_problem_of("load (contact radius up to half of the tip's)", "N", load, 0.0, most);
        return NT_E_RANGE;
    }
    const double below = is_cut ? front(s->radius, depth - t) : 0.0;
    const double ploughing = s->hardness * (front(s->radius, depth) - below) + s->substrate_hardness * below;
    *groove = (nt_groove){.depth = depth,
                          .width = 2.0 * sqrt(2.0 * s->radius * depth),
                          .ploughing = ploughing,
                          .shearing = s->shear_strength * per_depth * depth,
                          .layer_load = per_depth * s->hardness * t,
                          .is_cut_through = is_cut};
    return NT_OK;
}

double nt_worn_volume(double coefficient, double load, double way, double hardness)
{
    return coefficient * load * way / hardness;
}

double nt_worn_flat(double radius, double volume)
{
    return sqrt(sqrt(4.0 * radius * volume / NT_PI));
}
