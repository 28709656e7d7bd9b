/* SPDX-License-Identifier: BSD-3-Clause
 * A table of a sample that deforms as a law of the gap: what is apart and what acts around a contact, with what adds on
 * the undeformed gap farther out and inside. A table of another effective radius has laws that grow with it. */
#include <math.h>

#include "scene/deformation/cubic.h"
#include "scene/terms/term.h"

enum { SAMPLES = 1000, HALVINGS = 60 };

#define CLOSER 1.02        /* ratio of gaps at which forces are sampled */
#define FARTHEST_SHIFT 0.1 /* of the first gap, where force and table differ by a small part of the tolerance */

/* In the part of the nodes low .. high - 1. */
static nt_law_value eval(const nt_deform_table *table, int low, int high, double h)
{
    const nt_deform_node *node = table->node;
    const int part = part_of(table, low);
    const double v = v_of(table, part, h), past = v - node[--high].v;
    if (past >= 0.0) { /* deeper than the table: with its last slope */
        const double F = node[high].F, k = node[high].k;
        const double d = high == table->count - 1 ? fmax(table->last - h, 0.0) : 0.0;
        return (nt_law_value){node[high].U + d * (F + 0.5 * k * d), F + k * d, k, node[high].a};
    }
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (v < node[middle].v)
            high = middle;
        else
            low = middle;
    }
    double c[4];
    cubic(&node[low], &node[high], c);
    const double t = v - node[low].v, m = metric(part, v);
    const double k = m > 0.0 ? slope_at(c, t) / m : node[low].k;
    const double share = t / (node[high].v - node[low].v);
    return (nt_law_value){node[low].U + work(c, part, node[low].v, t), force_at(c, t), k,
                          node[low].a + share * (node[high].a - node[low].a)};
}

nt_law_value nt_deform_table_eval(const nt_deform_table *table, double h)
{
    const int contact = h < table->touch && table->apart < table->count && !table->holds;
    return contact ? eval(table, table->apart, table->count, h) : eval(table, 0, table->apart, h);
}

nt_law_value nt_deform_table_held(const nt_deform_table *table, double h)
{
    return eval(table, table->apart, table->count, h);
}

static int adheres(const nt_plan *plan)
{
    return plan->source != NT_ADHESION_NONE;
}

/* What is computed beside contact, on the undeformed gap; without tails, which adhesion has in it. */
static nt_law_value sum_of(const nt_plan *plan, const nt_deform_table *table, int tails, double gap)
{
    nt_law_value all = {0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < plan->on_count; ++i) {
        const int term = plan->on[i];
        if (nt_term_rows[term]->words.tail && !tails)
            continue;
        const nt_law_value value = nt_term_rows[term]->eval(nt_term_law(plan, term), plan->terms[term].form, gap);
        all.U += table->ratio * value.U;
        all.F += table->ratio * value.F;
        all.k += table->ratio * value.k;
    }
    return all;
}

static nt_law_value others_at(const nt_plan *plan, const nt_deform_table *table, double gap)
{
    nt_law_value sum = sum_of(plan, table, 0, gap);
    sum.U += table->offset;
    return sum;
}

/* Of the tail alone, where adhesion takes hold. */
static nt_law_value tail_at_touch(const nt_plan *plan, const nt_deform_table *table)
{
    const nt_law_value all = nt_deform_table_eval(table, table->touch);
    const nt_law_value others = others_at(plan, table, table->touch);
    return (nt_law_value){all.U - others.U, all.F - others.F, all.k - others.k, 0.0};
}

/* In contact that the surface does not jump into: there the tail keeps its force. */
static nt_law_value kept_at(const nt_plan *plan, const nt_deform_table *table, double gap)
{
    const nt_law_value tail = tail_at_touch(plan, table), others = others_at(plan, table, gap);
    return (nt_law_value){tail.U + tail.F * (table->touch - gap) + others.U, tail.F + others.F, others.k, 0.0};
}

/* Without adhesion: the bodies touch at `hold`; the laws keep their force from there to gap 0, as they do without
 * deforming. */
static nt_law_value touched_at(const nt_deform_table *table, double gap)
{
    const nt_law_value touching = nt_deform_table_eval(table, table->touch);
    const double held = fmin(table->touch + table->hold - gap, table->hold);
    nt_law_value value = touching;
    if (held >= table->hold)
        value = nt_deform_table_eval(table, gap);
    else
        value.k = 0.0;
    value.U += touching.F * held;
    return value;
}

nt_law_value nt_deform_apart(const nt_plan *plan, const nt_deform_table *table, double gap)
{
    const double from_touch = gap - table->hold;
    if (from_touch >= table->first)
        return sum_of(plan, table, 1, gap + table->shift);
    if (!(from_touch < table->touch))
        return nt_deform_table_eval(table, from_touch);
    return adheres(plan) ? kept_at(plan, table, gap) : touched_at(table, gap);
}

nt_law_value nt_deform_around(const nt_plan *plan, const nt_deform_table *table, int attached, double gap)
{
    if (attached && table->holds) {
        nt_law_value value = nt_deform_table_held(table, gap);
        value.U += table->offset;
        return value;
    }
    return attached && table->jumps ? others_at(plan, table, gap) : nt_deform_apart(plan, table, gap);
}

void nt_deform_join(const nt_plan *plan, nt_deform_table *table)
{
    const double first = table->first + table->hold, F = table->node[0].F;
    nt_law_value value = {0.0, 0.0, 0.0, 0.0};
    table->shift = 0.0;
    for (int i = 0; i < 30; ++i) {
        value = sum_of(plan, table, 1, first + table->shift);
        if (value.k == 0.0 || F == 0.0)
            break;
        table->shift += (value.F - F) / value.k;
    }
    if (!(fabs(table->shift) < FARTHEST_SHIFT * first)) /* beside an extremum there may be no such gap */
        table->shift = 0.0;
    value = sum_of(plan, table, 1, first + table->shift);
    for (int i = 0; i < table->count; ++i)
        table->node[i].U += value.U;
}

nt_law_value nt_plan_around(const nt_plan *plan, int attached, double gap)
{
    return plan->deformation.count == 0 ? nt_plan_beside_at(plan, gap)
                                        : nt_deform_around(plan, &plan->deformation, attached, gap);
}

double nt_plan_deform_share(const nt_plan *plan)
{
    const double radius = plan->contact.radius;
    return plan->deformation.jumps ? 0.0 : -tail_at_touch(plan, &plan->deformation).F / (2.0 * NT_PI * radius);
}

double nt_plan_rise(const nt_plan *plan, const nt_place *place, double gap)
{
    if (plan->deformation.count == 0 || !plan->deformation.jumps)
        return 0.0;
    if (place && plan->relief.count > 0)
        return nt_deform_relief_at(plan, place, 1, gap).law.U - nt_deform_relief_at(plan, place, 0, gap).law.U;
    return nt_plan_around(plan, 1, gap).U - nt_plan_around(plan, 0, gap).U;
}

/* --- Facts --- */

/* Where a load is reached, which lies between nodes [m]; the table's end where that is less. */
static double gap_at_load(const nt_plan *plan, double load)
{
    const nt_deform_table *table = &plan->deformation;
    double nearer = table->last, farther = table->first + table->hold;
    for (int i = 0; i < HALVINGS && nt_deform_apart(plan, &plan->deformation, table->last).F > load; ++i) {
        const double middle = 0.5 * (nearer + farther);
        *(nt_deform_apart(plan, &plan->deformation, middle).F > load ? &nearer : &farther) = middle;
    }
    return nearer;
}

static double pull_at(const nt_plan *plan, double gap)
{
    return -nt_deform_apart(plan, &plan->deformation, gap).F;
}

static double growth_at(const nt_plan *plan, double gap)
{
    return -nt_deform_apart(plan, &plan->deformation, gap).k;
}

void nt_deform_facts(nt_plan *plan, double load)
{
    const nt_deform_table *table = &plan->deformation;
    double pull = nt_plan_largest_at_edges(plan, pull_at, table->last, INFINITY);
    double growth = nt_plan_largest_at_edges(plan, growth_at, table->last, INFINITY);
    plan->maximum_stiffness =
        fmax(nt_deform_apart(plan, &plan->deformation, gap_at_load(plan, NT_DEFORM_DEEPER * load)).k, 0.0);
    for (int i = 0; i < table->count; ++i)
        if (table->node[i].F <= NT_DEFORM_DEEPER * load)
            plan->maximum_stiffness = fmax(plan->maximum_stiffness, table->node[i].k);
    const double first = table->first + table->hold;
    for (int i = 0; i <= SAMPLES; ++i) {
        const double gap = first + (table->last - first) * i / SAMPLES;
        pull = fmax(pull, pull_at(plan, gap));
        growth = fmax(growth, growth_at(plan, gap));
    }
    for (double gap = first; gap < NT_DEFORM_FARTHEST; gap *= CLOSER) {
        pull = fmax(pull, pull_at(plan, gap));
        growth = fmax(growth, growth_at(plan, gap));
    }
    pull = nt_plan_known_pull(plan, pull);
    plan->pull_off_force = plan->largest_pull_off_force = plan->contact_pull = pull;
    plan->minimum_spring = growth;
    plan->largest_indentation = -gap_at_load(plan, load);
}
