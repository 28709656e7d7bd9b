/* SPDX-License-Identifier: BSD-3-Clause
 * The table of an adhesive contact with what acts around it: from where it lets go, the largest gap over its radius. */
#include <math.h>

#include "scene/deformation/march.h"

#define UPHILL 0.15  /* steps of ln a on the way to where contact lets go */
#define BEYOND 0.02  /* of the radius there: the table of contact begins so much farther */
#define HIGHEST 1e-3 /* of ln a: where that is */
#define RESOLVED 2.0 /* times the tolerance: energy that the force does not tell */

enum { CLIMB = 60, PARABOLAS = 12 };

typedef nt_deform_maker maker;

static double gap_at(maker *m, double log_radius)
{
    const nt_status status = nt_deform_go(&m->solver, NT_DEFORM_CONTACT, exp(log_radius), NULL);
    return status == NT_OK ? m->solver.h : (double)NAN;
}

/* Between ln a of which the middle one is highest: by parabolas. */
static int refine_release(maker *m, double x[3], double h[3])
{
    for (int i = 0; i < PARABOLAS; ++i) {
        const double p = (x[1] - x[0]) * (h[1] - h[2]), q = (x[1] - x[2]) * (h[1] - h[0]);
        const double left = x[1] - x[0], right = x[1] - x[2];
        double next = x[1] - 0.5 * (left * p - right * q) / (p - q);
        if (!(fabs(next - x[1]) > HIGHEST))
            break;
        const double there = gap_at(m, next);
        if (isnan(there))
            return 0;
        const int outer = (next - x[1]) * (x[2] - x[1]) > 0.0 ? 2 : 0;
        if (there > h[1]) {
            x[2 - outer] = x[1];
            h[2 - outer] = h[1];
            x[1] = next;
            h[1] = there;
        } else {
            x[outer] = next;
            h[outer] = there;
        }
    }
    m->table->release = h[1];
    return 1;
}

/* Where contact lets go the gap is largest: uphill in ln a, from a radius; the ln a of it, NaN if there is none. */
static double find_release(maker *m, double radius)
{
    double x[3] = {log(radius) - UPHILL, log(radius), 0.0}, h[3] = {gap_at(m, x[0]), gap_at(m, x[1]), 0.0};
    if (h[0] > h[1]) {
        const double at = x[0], gap = h[0];
        x[0] = x[1];
        h[0] = h[1];
        x[1] = at;
        h[1] = gap;
    }
    for (int i = 0; i < CLIMB; ++i) {
        x[2] = 2.0 * x[1] - x[0];
        h[2] = gap_at(m, x[2]);
        if (!(h[2] > h[1]))
            return !isnan(h[1]) && !isnan(h[2]) && refine_release(m, x, h) ? x[1] : (double)NAN;
        x[0] = x[1];
        x[1] = x[2];
        h[0] = h[1];
        h[1] = h[2];
    }
    return NAN;
}

/* What the force does over the table is the energy of its ends, unless the mesh does not resolve the pressure. */
static int is_resolved(const maker *m, double first, double last)
{
    const nt_deform_table *table = m->table;
    const nt_deform_node *from = &table->node[table->apart], *to = &table->node[table->count - 1];
    const double depth = to->v * to->v - from->v * from->v;
    const double most = fmax(fmax(fabs(from->F), fabs(to->F)), m->range->scale);
    return fabs((last - first) - (to->U - from->U)) <= RESOLVED * m->range->tolerance * most * depth;
}

nt_status nt_deform_table_hold(nt_deform_table *table, const nt_deform_sample *sample, const nt_deform_range *range,
                               double radius)
{
    maker m = {.table = table, .range = range, .hold = NT_DEFORM_CONTACT, .end = INFINITY};
    m.solver.work = range->work;
    table->apart = table->count;
    nt_status status = nt_deform_begin_contact(&m.solver, sample, radius);
    const double fold = status == NT_OK ? find_release(&m, radius) : (double)NAN;
    if (isnan(fold))
        return NT_E_NO_CONVERGENCE;
    table->holds = 1;
    status = nt_deform_go(&m.solver, NT_DEFORM_CONTACT, exp(fold + BEYOND), &m.last);
    const double first = nt_deform_energy_in_contact(&m.solver);
    if (status == NT_OK)
        status = nt_deform_march(&m, 1, BEYOND * exp(fold));
    table->last = m.last.h;
    nt_deform_integrate(table, first);
    return status == NT_OK && !is_resolved(&m, first, nt_deform_energy_in_contact(&m.solver)) ? NT_E_NO_CONVERGENCE
                                                                                              : status;
}
