/* SPDX-License-Identifier: BSD-3-Clause
 * A sample that deforms over a surface: tables of some effective radii, and between them cubics of ln R.
 *
 *     U(h, R) = R Sum w_i(ln R) U_i(h - s(R) + s_i)/R_i        s(R) = Sum w_i(ln R) s_i
 *
 * w_i are those of Catmull and Rom (1974): 1 at their own radius, with continuous slopes, so that U is one potential.
 * s_i is the gap where the surface jumps, touches or lets go, so that what is sharp there falls on itself. Over R and
 * from there, all is smooth: rigid laws grow as R, and those of one exponential are one curve of h - l/2 ln R. */
#include <math.h>

#include "internal/maugis.h"
#include "scene/deformation/deform.h"

enum { POINTS = 4 };

/* Four tables beside a radius, what they weigh, and the slopes of that over ln R. */
typedef struct mix {
    int first;
    double weight[POINTS], slope[POINTS];
} mix;

/* A point beyond an end is that of a parabola through three inside. */
static void fold_back(double weight[POINTS], int outer, int inwards)
{
    const double w = weight[outer];
    weight[outer] = 0.0;
    weight[outer + inwards] += 3.0 * w;
    weight[outer + 2 * inwards] -= 3.0 * w;
    weight[outer + 3 * inwards] += w;
}

static mix mix_of(const nt_deform_relief *relief, double radius)
{
    const double at = log(radius / relief->first) / relief->step;
    const int last = relief->count - 2, cell = (int)fmin(fmax(at, 0.0), last);
    const double t = at - cell;
    mix m = {
        .first = cell - 1,
        .weight = {t * (-0.5 + t * (1.0 - 0.5 * t)), 1.0 + t * t * (1.5 * t - 2.5), t * (0.5 + t * (2.0 - 1.5 * t)),
                   t * t * (0.5 * t - 0.5)},
        .slope = {-0.5 + t * (2.0 - 1.5 * t), t * (4.5 * t - 5.0), 0.5 + t * (4.0 - 4.5 * t), t * (1.5 * t - 1.0)}};
    if (cell == 0) {
        fold_back(m.weight, 0, 1);
        fold_back(m.slope, 0, 1);
    }
    if (cell == last) {
        fold_back(m.weight, POINTS - 1, -1);
        fold_back(m.slope, POINTS - 1, -1);
    }
    for (int i = 0; i < POINTS; ++i)
        m.slope[i] /= relief->step;
    return m;
}

/* What stands at one gap in all tables: where the surface jumps or touches, or where contact lets go. */
typedef enum mark { NOTHING, TOUCH, RELEASE, SHARE } mark;

static double mark_of(const nt_deform_table *table, mark which)
{
    switch (which) {
    case TOUCH:
        return table->touch;
    case RELEASE:
        return table->release;
    case SHARE:
        return table->share;
    default:
        return 0.0;
    }
}

/* That of a radius; *slope (NULL allowed): over ln R. */
static double mixed(const nt_deform_relief *relief, const mix *m, mark which, double *slope)
{
    double sum = 0.0, rise = 0.0;
    for (int i = 0; i < POINTS; ++i)
        if (m->weight[i] != 0.0 || m->slope[i] != 0.0) {
            const double value = mark_of(relief->table[m->first + i], which);
            sum += m->weight[i] * value;
            rise += m->slope[i] * value;
        }
    if (slope)
        *slope = rise;
    return sum;
}

static mark mark_for(const nt_deform_table *table, int attached)
{
    if (attached && table->holds)
        return RELEASE;
    return isinf(table->touch) || (attached && table->jumps) ? NOTHING : TOUCH;
}

nt_bank_value nt_deform_relief_at(const nt_plan *plan, const nt_place *place, int attached, double gap)
{
    const nt_deform_relief *relief = &plan->relief;
    const double R = nt_plan_radius_at(plan, place);
    const mix m = mix_of(relief, R);
    const mark which = mark_for(relief->table[0], attached);
    double moves, rises = 0.0;
    const double at = mixed(relief, &m, which, &moves);
    nt_law_value sum = {0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < POINTS; ++i) {
        if (m.weight[i] == 0.0 && m.slope[i] == 0.0)
            continue;
        const nt_deform_table *table = relief->table[m.first + i];
        const nt_law_value value = nt_deform_around(plan, table, attached, gap - at + mark_of(table, which));
        const double share = 1.0 / (plan->contact.radius * table->ratio);
        sum.U += m.weight[i] * share * value.U;
        sum.F += m.weight[i] * share * value.F;
        sum.k += m.weight[i] * share * value.k;
        sum.a += m.weight[i] * sqrt(share) * value.a;
        rises += share * (m.slope[i] * value.U + m.weight[i] * moves * value.F);
    }
    return (nt_bank_value){{R * sum.U, R * sum.F, R * sum.k, sqrt(R) * sum.a}, sum.U + rises};
}

double nt_deform_relief_fold(const nt_plan *plan, double radius, int attached)
{
    const mix m = mix_of(&plan->relief, radius);
    return mixed(&plan->relief, &m, mark_for(plan->relief.table[0], attached), NULL);
}

double nt_plan_capture_gap(const nt_plan *plan, const nt_place *place)
{
    if (!place || plan->relief.count == 0 || !plan->deformation.jumps)
        return plan->capture_gap;
    return nt_deform_relief_fold(plan, place->radius.radius, 0);
}

double nt_deform_relief_share(const nt_plan *plan, double radius, double *slope)
{
    *slope = 0.0;
    if (plan->deformation.jumps)
        return 0.0;
    const mix m = mix_of(&plan->relief, radius);
    const double share = mixed(&plan->relief, &m, SHARE, slope);
    *slope /= radius;
    return share;
}
