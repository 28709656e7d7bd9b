/* SPDX-License-Identifier: BSD-3-Clause
 * Pressures on a sample that deforms, of each equilibrium and over the load: the largest, which is under the apex, and
 * the mean over what is touched. */
#include <math.h>

#include "scene/deformation/deform.h"

#define OF_MEAN 1.5 /* Hertz' peak over his mean */

enum { POINTS = 16 }; /* of a panel */

/* What the pressures outside a contact come to under its apex, since the surface follows the tip in it: by Abel
 * 2/pi Int_a p(r) a/(r sqrt(r^2 - a^2)) dr, which is 2/pi Int p dtheta over r = a/cos(theta). */
static double from_outside(const nt_deform_mesh *mesh, const double *pressures)
{
    double sum = 0.0, from = 0.0;
    for (int panel = 0; panel < mesh->panels; ++panel) {
        const double to = atan(sqrt(mesh->edges[panel + 1]) / mesh->a), step = (to - from) / POINTS;
        for (int i = 0; i < POINTS; ++i) {
            const double y = mesh->a * tan(from + (i + 0.5) * step);
            sum += step * nt_deform_mesh_at(mesh, pressures, y * y);
        }
        from = to;
    }
    return 2.0 / NT_PI * sum;
}

/* Under the apex: that of the laws; in contact Hertz' 2 E* a/(pi R), and what the laws around it and a layer add. */
double nt_deform_peak_of(const nt_deform_solver *s, double centre)
{
    const nt_deform_mesh *m = &s->mesh;
    double pressures[NT_DEFORM_NODES], layer = m->under[0] + m->under[1] * s->h;
    if (!(m->a > 0.0))
        return nt_deform_law(s, fmax(centre, 0.0)).pressure;
    for (int i = 0; i < m->count; ++i) {
        pressures[i] = nt_deform_law(s, s->gap[i]).pressure;
        layer += m->under_load[i] * pressures[i];
    }
    return 2.0 * s->sample->modulus * m->a / (NT_PI * s->sample->radius) + from_outside(m, pressures) + layer;
}

double nt_deform_peak_between(const nt_deform_node ends[2], double load)
{
    if (!(ends[0].F > 0.0 && ends[1].F > ends[0].F && load > 0.0 && ends[0].peak > 0.0 && ends[1].peak > 0.0))
        return NAN;
    return ends[0].peak * pow(ends[1].peak / ends[0].peak, log(load / ends[0].F) / log(ends[1].F / ends[0].F));
}

double nt_deform_peak_at(const nt_deform_table *table, const nt_deform_node *node)
{
    (void)table;
    return node->peak;
}

/* Two thirds of the peak, as Hertz has it; on a layer, whose peak is up to three times it, the load over the area. */
double nt_deform_mean_at(const nt_deform_table *table, const nt_deform_node *node)
{
    const double hertz = node->peak / OF_MEAN;
    return table->layered && node->a > 0.0 ? fmin(hertz, node->F / (NT_PI * node->a * node->a)) : hertz;
}

double nt_deform_table_load(const nt_deform_table *table, double pressure, nt_deform_pressure *of)
{
    const nt_deform_node *node = table->node;
    int i = 1;
    while (i < table->count && !(of(table, &node[i]) > pressure))
        ++i;
    if (i == table->count)
        return INFINITY;
    const double before = of(table, &node[i - 1]), after = of(table, &node[i]);
    if (!(node[i - 1].F > 0.0 && before > 0.0))
        return fmax(node[i - 1].F, 0.0);
    const double power = log(node[i].F / node[i - 1].F) / log(after / before);
    return node[i - 1].F * pow(pressure / before, power);
}

double nt_deform_table_pressure(const nt_deform_table *table, double load, nt_deform_pressure *of)
{
    const nt_deform_node *node = table->node;
    int i = 1;
    while (i < table->count - 1 && node[i].F < load)
        ++i;
    const double before = of(table, &node[i - 1]), after = of(table, &node[i]);
    if (!(node[i - 1].F > 0.0 && before > 0.0))
        return after;
    const double power = log(after / before) / log(node[i].F / node[i - 1].F);
    return before * pow(fmin(load, node[i].F) / node[i - 1].F, power);
}
