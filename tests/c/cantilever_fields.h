/* SPDX-License-Identifier: BSD-3-Clause
 * Force fields in closed form for test_dynamics_cantilever.c: a wall, a sphere, a bridge. */
#ifndef CANTILEVER_FIELDS_H
#define CANTILEVER_FIELDS_H

#include <math.h>

#include "nanotouch/dynamics.h"

typedef struct wall {
    double stiffness; /* of the linear spring below z = 0 */
    int commits;
    double last_commit;
} wall;

static inline nt_law_value wall_eval(void *context, double z)
{
    const wall *w = context;
    const double depth = z < 0.0 ? -z : 0.0;
    return (nt_law_value){
        .U = 0.5 * w->stiffness * depth * depth, .F = w->stiffness * depth, .k = z < 0.0 ? w->stiffness : 0.0};
}

static inline void wall_advance(void *context, double z)
{
    wall *w = context;
    w->commits++;
    w->last_commit = z;
}

/* Sphere on flat: van der Waals attraction over Hertz contact, continuous at contact (z = a0), like DMT. */
typedef struct sphere {
    double adhesion; /* H R / 6 [N m^2] */
    double hertz;    /* 4/3 E* sqrt(R) [N/m^1.5] */
    double a0;       /* [m] */
    double layers;   /* amplitude of an oscillating force of liquid layers: many wells [N] */
    long evaluations;
} sphere;

enum { LAYERS_PER_NM = 4 };

static const sphere silicon = {
    .adhesion = 1.9e-19 * 20e-9 / 6.0, .hertz = 4.0 / 3.0 * 80e9 * 1.4142135623730951e-4, .a0 = 0.2e-9};

static nt_law_value sphere_eval(void *context, double z)
{
    sphere *s = context;
    s->evaluations++;
    if (s->layers > 0.0) {
        const double q = 2e9 * 3.14159265358979323846 * LAYERS_PER_NM, decay = 0.7e-9;
        const double size = s->layers * exp(-fabs(z) / decay), sign = z < 0.0 ? -1.0 : 1.0;
        sphere dry = *s;
        dry.layers = 0.0;
        nt_law_value v = sphere_eval(&dry, z);
        v.F += size * cos(q * z);
        v.k += size * (q * sin(q * z) + sign * cos(q * z) / decay);
        return v;
    }
    if (z >= s->a0)
        return (nt_law_value){
            .U = -s->adhesion / z, .F = -s->adhesion / (z * z), .k = -2.0 * s->adhesion / (z * z * z)};
    const double depth = s->a0 - z;
    return (nt_law_value){.U = -s->adhesion / s->a0 * (1.0 + depth / s->a0) + 0.4 * s->hertz * pow(depth, 2.5),
                          .F = -s->adhesion / (s->a0 * s->a0) + s->hertz * pow(depth, 1.5),
                          .k = 1.5 * s->hertz * sqrt(depth)};
}

static nt_force_field sphere_field(sphere *s)
{
    return (nt_force_field){.eval = sphere_eval, .context = s, .length = s->a0};
}

/* A constant pull that snaps at z = reach once it is made at z <= make: history, and jumps of the force. */
typedef struct bridge {
    double pull, make, reach;
    int made;
} bridge;

static inline nt_law_value bridge_eval(void *context, double z)
{
    const bridge *b = context;
    const int holds = z <= b->make || (b->made && z < b->reach);
    const double depth = z < 0.0 ? -z : 0.0;
    return (nt_law_value){.U = (holds ? b->pull * (z - b->reach) : 0.0) + 500.0 * depth * depth,
                          .F = (holds ? -b->pull : 0.0) + 1000.0 * depth,
                          .k = z < 0.0 ? 1000.0 : 0.0};
}

static inline void bridge_advance(void *context, double z)
{
    bridge *b = context;
    b->made = z <= b->make || (b->made && z < b->reach);
}

#endif
