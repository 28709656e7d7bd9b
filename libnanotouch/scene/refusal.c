/* SPDX-License-Identifier: BSD-3-Clause
 * What a plan says that is refused: an accuracy, or a gap, of which there is a plan, or the law for which there is
 * none.
 */
#include <math.h>
#include <string.h>

#include "scene/deformation/deform.h"
#include "scene/terms/term.h"

#define NEAR 1.1             /* what is named over the smallest accuracy of which there is a plan, at most */
#define NEAR_OVER_RELIEF 2.0 /* the same where each plan makes the tables of many radii */
#define FARTHER 1.25         /* ratio of gaps that are tried, where a sample jumps */
#define FARTHEST 1e-2        /* [m] */
#define STRICTEST 1e-12
enum { SAID = 3, FARTHER_TRIES = 24 };

/* The law that presses most on a sample that does not keep still. */
static int strongest(const nt_plan *plan)
{
    int found = NT_PLAN_CONTACT;
    double most = 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        const nt_term_row *row = nt_term_rows[term];
        const int of_contact = plan->around_error > plan->rigid_error && row->words.tail != NULL;
        const double force = row->pressure && !of_contact ? plan->terms[term].force : 0.0;
        if (force > most) {
            found = term;
            most = force;
        }
    }
    return found;
}

/* What is said of that law. */
static nt_term_refused words_of(const nt_plan *plan)
{
    static const nt_term_refused nameless = NT_TERM_REFUSED("the forces before contact");
    const nt_term_refused words = nt_term_rows[strongest(plan)]->refused;
    return words.deforms ? words : nameless;
}

/* By the name of that law. */
static nt_problem by_law(const nt_plan *plan, double error)
{
    return nt_plan_reason(plan, words_of(plan).deforms, error);
}

/* What can be demanded of a sample for which no table was made: the terms on the undeformed gap, where they are better.
 */
nt_status nt_plan_refuse(const nt_plan *plan, const nt_plan_options *options, nt_problem *problem)
{
    double least = fmax(plan->rigid_error, plan->around_error) * (1.0 + 1e-9);
    int count = 0;
    const nt_field *field = nt_demand_fields(&count);          /* the first is the accuracy */
    if (problem && nt_problem_names(problem, "demand.budget")) /* a dearer table would do */
        return NT_E_RANGE;
    for (int term = 0; term < NT_PLAN_TERMS; ++term)
        least += options->option[term][options->count[term] - 1].error;
    const int finer = problem && nt_problem_names(problem, NT_DEMANDED) &&
                      problem->minimum < field->maximum; /* a table of another demand would do */
    if (problem && !finer && !(least < field->maximum)) {
        if (!nt_problem_names(problem, NT_DEFORM_SPREAD))
            *problem = by_law(plan, fmax(plan->rigid_error, plan->around_error));
        return NT_E_RANGE;
    }
    const int better = problem && (problem->field != field->name || least < problem->minimum);
    if (problem && least < field->maximum && better && !(plan->demand.budget > 0.0))
        *problem = (nt_problem){field->name, field->unit, plan->demand.relative_accuracy, least, field->maximum};
    return NT_E_RANGE;
}

/* Whether there is a plan of another accuracy, if not of that budget, too. */
static int is_planned(nt_plan *plan, const nt_plan_inputs *inputs, double accuracy, nt_deform_tried *tried,
                      nt_problem *problem)
{
    nt_plan_inputs asked = *inputs;
    nt_demand demand = plan->demand;
    demand.relative_accuracy = accuracy;
    demand.budget = 0.0;
    asked.demand = &demand;
    return nt_plan_try(plan, &asked, tried, problem) == NT_OK;
}

/* The least of six digits that is not below. */
static double printed(double accuracy)
{
    const double digit = pow(10.0, floor(log10(accuracy)) - 5.0);
    return ceil(accuracy / digit - 1e-9) * digit;
}

/* An accuracy of which there is a plan: what a refusal named, or what that names, or the largest there is. 0: none. */
static double find(nt_plan *plan, const nt_plan_inputs *inputs, nt_deform_tried *tried, const nt_problem *first)
{
    nt_problem reason = *first;
    double named = 0.0;
    int count = 0;
    for (int i = 0; i < SAID && nt_problem_names(&reason, NT_DEMANDED) && reason.minimum > named; ++i) {
        named = printed(reason.minimum);
        if (is_planned(plan, inputs, named, tried, &reason))
            return named;
    }
    const double most = nt_demand_fields(&count)->maximum;
    return is_planned(plan, inputs, most, tried, NULL) ? most : 0.0;
}

/* One that is near the smallest, between what is refused and what is planned: bisected. */
static double narrow(nt_plan *plan, const nt_plan_inputs *inputs, nt_deform_tried *tried, double planned)
{
    const double near = plan->relief.room ? NEAR_OVER_RELIEF : NEAR;
    double low = fmax(plan->demand.relative_accuracy, STRICTEST), high = planned;
    for (double tried_next = high / near; high > near * low; tried_next = sqrt(low * high)) {
        const double accuracy = printed(tried_next);
        if (is_planned(plan, inputs, accuracy, tried, NULL))
            high = accuracy;
        else
            low = accuracy;
    }
    return high;
}

static nt_problem keep_word(nt_plan *plan, const nt_plan_inputs *inputs, nt_deform_tried *tried,
                            const nt_problem *reason)
{
    int count = 0;
    const nt_field *field = nt_demand_fields(&count); /* the first is the accuracy */
    const nt_demand demand = plan->demand;
    const nt_problem law =
        nt_problem_names(reason, NT_DEMANDED) ? by_law(plan, fmax(plan->rigid_error, plan->around_error)) : *reason;
    double named = find(plan, inputs, tried, reason);
    plan->demand = demand;
    if (named == 0.0)
        return law;
    named = narrow(plan, inputs, tried, named);
    plan->demand = demand;
    return (nt_problem){field->name, field->unit, demand.relative_accuracy, named, field->maximum};
}

/* Without adhesion a sample that jumps to a pull has a plan only farther out: names a gap beyond which there is one. */
static nt_problem stay_away(nt_plan *plan, const nt_plan_inputs *inputs, const nt_problem *reason)
{
    nt_scene scene = *inputs->scene;
    nt_plan_inputs asked = *inputs;
    const nt_term_refused words = words_of(plan);
    asked.scene = &scene;
    double gap = nt_plan_jump_gap(plan);
    for (int i = 0; i < FARTHER_TRIES; ++i) {
        nt_deform_tried tried = {.count = 0};
        gap = printed(FARTHER * gap);
        scene.range.minimum_gap = gap;
        if (nt_plan_try(plan, &asked, &tried, NULL) == NT_OK)
            return (nt_problem){words.jumps, "m", inputs->scene->range.minimum_gap, gap, FARTHEST};
    }
    return *reason;
}

nt_problem nt_plan_word(nt_plan *plan, const nt_plan_inputs *inputs, nt_deform_tried *tried, const nt_problem *reason)
{
    const int jumps = plan->source == NT_ADHESION_NONE && !plan->properties && isinf(plan->rigid_error);
    const int by_law = reason->unit && strcmp(reason->unit, NT_UNIT_ERROR) == 0;
    const int lost = jumps && isinf(reason->value);
    nt_problem word = lost ? stay_away(plan, inputs, reason) : *reason;
    if (lost && word.field != reason->field)
        return word;
    if (nt_problem_names(reason, NT_DEMANDED) || by_law)
        word = keep_word(plan, inputs, tried, reason);
    return jumps && !lost && isinf(word.value) ? stay_away(plan, inputs, &word) : word;
}
