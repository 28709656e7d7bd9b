/* SPDX-License-Identifier: BSD-3-Clause
 * A cell of the table of a sample that deforms: F as a cubic of v, and U, its integral over h. Private to scene/. */
#ifndef NANOTOUCH_SCENE_DEFORM_CUBIC_H
#define NANOTOUCH_SCENE_DEFORM_CUBIC_H

#include <math.h>

#include "scene/deformation/deform.h"

/* The cubic of a cell at t = v - v0, and its slope. */
static inline void cubic(const nt_deform_node *from, const nt_deform_node *to, double c[4])
{
    const double w = to->v - from->v, rise = (to->F - from->F) / w;
    c[0] = from->F;
    c[1] = from->slope;
    c[2] = (3.0 * rise - 2.0 * from->slope - to->slope) / w;
    c[3] = (from->slope + to->slope - 2.0 * rise) / (w * w);
}

static inline double force_at(const double c[4], double t)
{
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

static inline double slope_at(const double c[4], double t)
{
    return c[1] + t * (2.0 * c[2] + 3.0 * t * c[3]);
}

/* Whether v is a square root in the part of a node: -1 before a jump, 1 in contact, 0: v = -h. */
static inline int part_of(const nt_deform_table *table, int node)
{
    return node >= table->apart ? 1 : table->jumps ? -1 : 0;
}

static inline double v_of(const nt_deform_table *table, int part, double h)
{
    if (part > 0)
        return sqrt(fmax((table->holds ? table->release : table->touch) - h, 0.0));
    return part == 0 ? -h : -sqrt(fmax(h - table->touch, 0.0));
}

/* -dh/dv */
static inline double metric(int part, double v)
{
    return part == 0 ? 1.0 : 2.0 * fabs(v);
}

/* U from v0 to v0 + t: Int F (-dh/dv) dv. */
static inline double work(const double c[4], int part, double v0, double t)
{
    double sum = 0.0, power = t;
    for (int i = 0; i < 4; ++i) {
        sum += c[i] * (part == 0 ? power / (i + 1.0) : 2.0 * part * (v0 * power / (i + 1.0) + power * t / (i + 2.0)));
        power *= t;
    }
    return sum;
}

#endif
