/* SPDX-License-Identifier: BSD-3-Clause
 * What is said of a demand that no plan keeps: the accuracy that can be kept, or else what stands in the way, and one
 * change with which there is a plan. Both are tried here before they are named. */
#include <math.h>
#include <stddef.h>

#include "scene/deformation/deform.h"
#include "scene/terms/term.h"

#define NEAR 1.1             /* what is named over the smallest accuracy of which there is a plan, at most */
#define NEAR_OVER_RELIEF 2.0 /* the same where each plan makes the tables of many radii */
#define STRICTEST 1e-12
#define FARTHER 1.25 /* ratio of gaps that are tried, where a sample jumps */
/* What may be spent on tables [work of nt_deform_tried], so that a refusal takes no more than 0.5 s, at any demand. */
#define WORK_OF_ONE 350.0 /* plan that is tried */
#define WORK 1000.0       /* on an accuracy */
#define WORK_OF_CHANGE 500.0
#define OVER_RELIEF 10.0 /* times as much, where each plan makes the tables of many radii */
enum { SAID = 3, FARTHER_TRIES = 24 };

/* The law that presses most on a sample that does not keep still, or whose pull it jumps to. */
static int strongest(const nt_plan *plan, int pulls)
{
    int found = NT_PLAN_CONTACT;
    double most = 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        const nt_term_row *row = nt_term_rows[term];
        const int of_contact = plan->around_error > plan->rigid_error && row->words.tail != NULL;
        const double at_hold = nt_plan_hold_gap(plan, term) * (1.0 + 1e-12);
        const int wrong_way = pulls && nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), at_hold).F >= 0.0;
        const double force = row->pressure && !of_contact && !wrong_way ? plan->terms[term].force : 0.0;
        if (force > most) {
            found = term;
            most = force;
        }
    }
    return found;
}

static const char *name_of(int term)
{
    return term == NT_PLAN_CONTACT ? "the forces before contact" : nt_term_rows[term]->noun;
}

/* Infinite beyond a jump: then it is a pull. */
static double rigid_error(const nt_plan *plan)
{
    return fmax(plan->rigid_error, plan->around_error);
}

/* Because of a law. */
static nt_problem by_law(const nt_plan *plan)
{
    const double errs = rigid_error(plan);
    return nt_plan_reason(plan, name_of(strongest(plan, isinf(errs))), errs);
}

/* What no table was made for: its terms on the undeformed gap, where they are better than what the table could do. */
nt_status nt_plan_refuse(const nt_plan *plan, const nt_plan_options *options, const nt_problem *reason,
                         nt_problem *problem)
{
    double least = rigid_error(plan) * (1.0 + 1e-9);
    for (int term = 0; term < NT_PLAN_TERMS; ++term)
        least += options->option[term][options->count[term] - 1].error;
    const nt_problem rigid = nt_demand_accuracy(plan->accuracy, least);
    const int finer = reason->code == NT_PROBLEM_ACCURACY && reason->minimum < rigid.maximum;
    if (reason->code == NT_PROBLEM_BUDGET || (finer && reason->minimum <= least)) /* a table would do */
        return nt_problem_refuse(problem, *reason);
    if (least < rigid.maximum && !(plan->demand.budget > 0.0))
        return nt_problem_refuse(problem, rigid);
    const int is_said = finer || reason->code == NT_PROBLEM_SPREAD || reason->code == NT_PROBLEM_DEFORMED_TAIL;
    return nt_problem_refuse(problem, is_said ? *reason : by_law(plan));
}

/* --- What is tried --- */

typedef struct search {
    nt_plan_inputs inputs;
    nt_scene scene;
    nt_demand demand;
    nt_deform_tried *tried; /* NULL: of another scene, nothing is known */
    double *left;           /* work [that of nt_deform_tried] */
} search;

static double work_of(const nt_plan_inputs *inputs, double work)
{
    return inputs->room ? OVER_RELIEF * work : work;
}

static search search_of(const nt_plan_inputs *inputs, nt_deform_tried *tried, double *left)
{
    return (search){.inputs = *inputs,
                    .scene = *inputs->scene,
                    .demand = inputs->demand ? *inputs->demand : nt_demand_defaults(),
                    .tried = tried,
                    .left = left};
}

/* Whether there is a plan. */
static int is_planned(search *s, nt_problem *problem)
{
    nt_plan plan;
    nt_deform_tried none = {.count = 0}, *tried = s->tried ? s->tried : &none;
    if (!(*s->left > 0.0))
        return 0;
    const double allowed = fmin(*s->left, work_of(&s->inputs, WORK_OF_ONE));
    double work = allowed;
    s->inputs.scene = &s->scene;
    s->inputs.demand = &s->demand;
    tried->work = &work;
    const int is = nt_plan_try(&plan, &s->inputs, tried, problem) == NT_OK;
    tried->work = NULL;
    *s->left -= allowed - work;
    return is;
}

/* Of another accuracy, if not of that budget, too. */
static int keeps(search *s, double accuracy, nt_problem *problem)
{
    s->demand.relative_accuracy = accuracy;
    s->demand.budget = 0.0;
    return is_planned(s, problem);
}

/* The least of six digits that is not below. */
static double printed(double value)
{
    const double digit = pow(10.0, floor(log10(value)) - 5.0);
    return ceil(value / digit - 1e-9) * digit;
}

/* An accuracy of which there is a plan: what a refusal named, or what that names, or the largest there is. 0: none. */
static double find(search *s, const nt_problem *first)
{
    nt_problem reason = *first;
    double named = 0.0;
    for (int i = 0; i < SAID && reason.code == NT_PROBLEM_ACCURACY && reason.minimum > named; ++i) {
        named = printed(reason.minimum);
        if (keeps(s, named, &reason))
            return named;
    }
    const double most = nt_demand_accuracy(0.0, 0.0).maximum;
    return keeps(s, most, NULL) ? most : 0.0;
}

/* One that is near the smallest, between what is refused and what is planned: bisected. */
static double narrow(search *s, const nt_plan *plan, double planned)
{
    const double near = plan->relief.room ? NEAR_OVER_RELIEF : NEAR;
    double low = fmax(plan->accuracy, STRICTEST), high = planned;
    for (double next = high / near; high > near * low; next = sqrt(low * high)) {
        const double accuracy = printed(next);
        *(keeps(s, accuracy, NULL) ? &high : &low) = accuracy;
    }
    return high;
}

/* --- One change --- */

/* From weak to strong, until one works. A field that the scene does not use is passed over. */
static const struct {
    const char *field;
    double factor, least; /* of its value; and what it is at least, where it is 0 */
} changes[] = {{"adhesion.hamaker_constant", 0.8, 0.0},
               {"adhesion.work_of_adhesion", 1.25, 0.0},
               {"adhesion.equilibrium_distance", 1.15, 0.0},
               {"adhesion.hamaker_constant", 0.5, 0.0},
               {"adhesion.work_of_adhesion", 1.6, 0.0},
               {"adhesion.equilibrium_distance", 1.4, 0.0},
               {"range.minimum_gap", 1.5, 0.5e-9},
               {"adhesion.work_of_adhesion", 2.5, 0.0},
               {"range.minimum_gap", 4.0, 2e-9},
               {"adhesion.hamaker_constant", 0.2, 0.0},
               {"adhesion.work_of_adhesion", 5.0, 0.0},
               {"range.minimum_gap", 15.0, 1e-8},
               {"range.minimum_gap", 60.0, 1e-7},
               {"sample.youngs_modulus", 4.0, 0.0},
               {"adhesion.hamaker_constant", 0.02, 0.0},
               {"sample.youngs_modulus", 50.0, 0.0},
               {"range.minimum_gap", 600.0, 1e-6}};

/* Whether a scene has a use for another value of a field. */
static int is_of_use(const nt_scene *scene, const char *name, double value)
{
    const nt_field *field = nt_scene_field(name);
    nt_scene other = *scene;
    if (field == nt_scene_field("adhesion.work_of_adhesion") && scene->adhesion.given != NT_ADHESION_GIVEN_WORK)
        return 0;
    nt_field_set(field, &other, value);
    return value != nt_field_get(field, scene) && nt_scene_check(&other, NULL) == NT_OK;
}

nt_remedy nt_plan_remedy(const nt_plan_inputs *inputs)
{
    double left = work_of(inputs, WORK_OF_CHANGE);
    for (size_t i = 0; i < sizeof changes / sizeof *changes; ++i) {
        search s = search_of(inputs, NULL, &left);
        const nt_field *field = nt_scene_field(changes[i].field);
        const double value = printed(fmax(changes[i].factor * nt_field_get(field, inputs->scene), changes[i].least));
        if (!is_of_use(inputs->scene, field->name, value))
            continue;
        nt_field_set(field, &s.scene, value);
        if (is_planned(&s, NULL))
            return (nt_remedy){field->name, field->unit, value};
    }
    return (nt_remedy){NULL, NULL, 0.0};
}

/* Without adhesion a sample that jumps to a pull is planned only farther out: a gap beyond which it is. */
static nt_problem of_jump(const nt_plan *plan, const nt_plan_inputs *inputs)
{
    const nt_field *field = nt_scene_field("range.minimum_gap");
    nt_problem problem =
        nt_problem_of(field->name, field->unit, inputs->scene->range.minimum_gap, INFINITY, NT_DEFORM_FARTHEST);
    problem.code = NT_PROBLEM_JUMPS;
    problem.cause = name_of(strongest(plan, 1));
    double gap = nt_plan_jump_gap(plan), left = work_of(inputs, WORK_OF_CHANGE);
    for (int i = 0; i < FARTHER_TRIES && !problem.remedy.field; ++i) {
        search s = search_of(inputs, NULL, &left);
        gap = printed(FARTHER * gap);
        s.scene.range.minimum_gap = gap;
        if (is_planned(&s, NULL)) {
            problem.minimum = gap;
            problem.remedy = (nt_remedy){field->name, field->unit, gap};
        }
    }
    return problem;
}

nt_problem nt_plan_word(const nt_plan *plan, const nt_plan_inputs *inputs, nt_deform_tried *tried,
                        const nt_problem *reason)
{
    const int jumps = plan->source == NT_ADHESION_NONE && !plan->properties && isinf(plan->rigid_error);
    const int of_accuracy =
        reason->code == NT_PROBLEM_ACCURACY || reason->code == NT_PROBLEM_DEFORMS || reason->code == NT_PROBLEM_TABLE;
    const int is_closed = reason->code == NT_PROBLEM_BUDGET || reason->code == NT_PROBLEM_SPREAD;
    double left = work_of(inputs, WORK);
    search s = search_of(inputs, tried, &left);
    const double planned = of_accuracy ? find(&s, reason) : 0.0;
    if (planned > 0.0)
        return nt_demand_accuracy(plan->demand.relative_accuracy, narrow(&s, plan, planned));
    nt_problem word = reason->code == NT_PROBLEM_ACCURACY ? by_law(plan) : *reason;
    if (jumps && of_accuracy)
        word = of_jump(plan, inputs);
    if (!is_closed && !word.remedy.field)
        word.remedy = nt_plan_remedy(inputs);
    return word;
}
