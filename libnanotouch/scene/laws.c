/* SPDX-License-Identifier: BSD-3-Clause
 * The terms of a scene beside contact, whatever they are: their parameters, their forms, the largest they can be, and
 * what a tail leaves of w. The tail and the adhesion in contact are the same surface forces (erratum E5b): together
 * they pull 2 pi R w in the rigid limit, both are potentials, and there is no seam. */
#include <math.h>
#include <string.h>

#include "scene/terms/term.h"

static void *law_of(nt_plan *plan, int term)
{
    return (char *)plan + nt_term_offsets[term];
}

nt_form nt_plan_full_form(const nt_plan *plan, int term)
{
    return nt_term_rows[term]->full_form(nt_term_law(plan, term));
}

nt_law_value nt_plan_law_eval(const nt_plan *plan, int term, nt_form form, double gap)
{
    nt_law_value value = {0.0, 0.0, 0.0, 0.0};
    if (form == NT_FORM_OFF)
        return value;
    value = nt_term_rows[term]->eval(nt_term_law(plan, term), form, gap);
    value.U *= plan->ratio;
    value.F *= plan->ratio;
    value.k *= plan->ratio;
    return value;
}

nt_law_value nt_plan_beside_at(const nt_plan *plan, double gap)
{
    nt_law_value sum = {0.0, 0.0, 0.0, 0.0};
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        const nt_law_value value = nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), gap);
        sum.U += value.U;
        sum.F += value.F;
        sum.k += value.k;
    }
    return sum;
}

double nt_plan_hold_gap(const nt_plan *plan, int term)
{
    const nt_term_row *row = nt_term_rows[term];
    return row->hold ? row->hold(nt_term_law(plan, term)) : 0.0;
}

double nt_plan_law_limit(const nt_plan *plan, int term, double gap, nt_quantity quantity)
{
    if (quantity != NT_QUANTITY_FORCE && quantity != NT_QUANTITY_STIFFNESS)
        return 0.0; /* no term but contact has a radius; folds under grips are those of contact */
    const nt_term_row *row = nt_term_rows[term];
    const nt_form form = nt_plan_full_form(plan, term);
    /* the steepest is just outside the hold */
    const double nearest = fmax(gap, nt_plan_hold_gap(plan, term) * (1.0 + 1e-12));
    const nt_law_value value = form != NT_FORM_OFF && row->limit ? row->limit(nt_term_law(plan, term), nearest)
                                                                 : nt_plan_law_eval(plan, term, form, nearest);
    const double size = fabs(quantity == NT_QUANTITY_FORCE ? value.F : value.k);
    return form != NT_FORM_OFF && row->limit ? plan->ratio * size : size;
}

/* What the tail of one term pulls of w [J/m^2]; 0 if it is none. */
static double share_of(const nt_plan *plan, int term)
{
    if (!nt_term_rows[term]->words.tail)
        return 0.0;
    const nt_law_value held = nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), 0.0);
    return -held.F / (2.0 * NT_PI * plan->contact.radius);
}

double nt_plan_tail_share(const nt_plan *plan)
{
    double share = 0.0;
    /* a table that ends farther out, at the min gap of the range, does not know it */
    const int is_told = plan->deformation.jumps || plan->deformation.touch <= plan->capture_gap * (1.0 + 1e-9);
    if (plan->deformation.count > 0 && is_told)
        return nt_plan_deform_share(plan);
    for (int term = 0; term < NT_PLAN_TERMS && plan->source != NT_ADHESION_NONE; ++term)
        share += share_of(plan, term);
    return share;
}

int nt_plan_strongest_tail(const nt_plan *plan)
{
    int strongest = NT_PLAN_CONTACT;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (share_of(plan, term) > share_of(plan, strongest))
            strongest = term;
    return strongest;
}

nt_scene nt_plan_scene_without_tails(const nt_scene *scene)
{
    nt_scene without = *scene;
    for (int term = 0; term < NT_PLAN_TERMS; ++term)
        if (nt_term_rows[term]->words.tail)
            nt_field_set(nt_scene_field(nt_term_rows[term]->words.tail), &without, 0.0);
    return without;
}

/* The tails alone pull `share`, more than all the adhesion there is: names what scales the strongest. */
static nt_status refuse(const nt_plan *plan, const nt_scene *scene, double share, nt_problem *problem)
{
    const int strongest = nt_plan_strongest_tail(plan);
    const double own = share_of(plan, strongest), left = plan->contact.work_of_adhesion - (share - own);
    const nt_field *field = nt_scene_field(nt_term_rows[strongest]->words.tail);
    const double value = nt_field_get(field, scene);
    nt_problem tail = nt_problem_of(field->name, field->unit, value, 0.0, value * fmax(left, 0.0) / own);
    tail.code = NT_PROBLEM_TAIL;
    tail.cause = nt_term_rows[strongest]->noun;
    return nt_problem_refuse(problem, tail);
}

nt_status nt_plan_tabulate(nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    nt_status status = NT_OK;
    for (int term = 0; term < NT_PLAN_TERMS && status == NT_OK; ++term)
        if (nt_term_rows[term]->tabulate)
            status = nt_term_rows[term]->tabulate(law_of(plan, term), scene, problem);
    return status;
}

void nt_plan_prepare_laws(nt_plan *plan, const nt_scene *scene, double capture_gap)
{
    for (int term = 0; term < NT_PLAN_TERMS; ++term)
        if (nt_term_rows[term]->prepare)
            nt_term_rows[term]->prepare(law_of(plan, term), scene, capture_gap);
}

nt_status nt_plan_laws_of(nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    nt_plan_prepare_laws(plan, scene, plan->capture_gap);
    const double share = plan->tail = nt_plan_tail_share(plan), w = plan->contact.work_of_adhesion;
    if (!(share > 0.0))
        return NT_OK;
    if (share >= w)
        return refuse(plan, scene, share, problem);
    const double range = w / plan->contact.cohesive_stress; /* h0 stays */
    plan->contact.work_of_adhesion = w - share;
    plan->contact.cohesive_stress = plan->contact.work_of_adhesion / range;
    return NT_OK;
}
