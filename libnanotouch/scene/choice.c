/* SPDX-License-Identifier: BSD-3-Clause
 * The cheapest combination of forms whose errors add up to no more than the demand: all of them are tried, a few
 * hundred at most. No plan can then cost more than everything-on; where two cost the same, the truer one is taken. */
#include <string.h>

#include "scene/terms/term.h"

typedef struct combination {
    int index[NT_PLAN_TERMS];
    double error, cost;
} combination;

/* What the first law beside contact costs more, 0: cost, 1: latency. */
static double beside(const nt_plan_options *options, const combination *tried, int which)
{
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (options->option[term][tried->index[term]].form != NT_FORM_OFF)
            return options->option[NT_PLAN_CONTACT][tried->index[NT_PLAN_CONTACT]].beside[which];
    return 0.0;
}

static void weigh(const nt_plan_options *options, combination *tried)
{
    tried->error = 0.0;
    tried->cost = beside(options, tried, 0);
    for (int term = 0; term < NT_PLAN_TERMS; ++term) {
        tried->error += options->option[term][tried->index[term]].error;
        tried->cost += options->option[term][tried->index[term]].cost;
    }
}

/* The next combination; 0 after the last. */
static int next(const nt_plan_options *options, combination *tried)
{
    for (int term = 0; term < NT_PLAN_TERMS; ++term) {
        if (++tried->index[term] < options->count[term])
            return 1;
        tried->index[term] = 0;
    }
    return 0;
}

/* What the field of the demand would have to be, up to its own maximum. */
static nt_status refuse(nt_problem *problem, const char *name, double value, double minimum)
{
    int count = 0;
    const nt_field *fields = nt_demand_fields(&count);
    for (int i = 0; i < count; ++i)
        if (problem && strcmp(fields[i].name, name) == 0)
            *problem = (nt_problem){fields[i].name, fields[i].unit, value, minimum, fields[i].maximum};
    return NT_E_RANGE;
}

static void take(nt_plan *plan, const nt_plan_options *options, const combination *best)
{
    plan->on_count = 0;
    plan->latency = 0.0;
    for (int term = 0; term < NT_PLAN_TERMS; ++term) {
        const nt_form form = options->option[term][best->index[term]].form;
        plan->terms[term].name = nt_term_name_of(plan, term);
        plan->terms[term].title =
            nt_term_rows[term]->name_of ? plan->terms[term].name : nt_term_rows[term]->words.title;
        plan->terms[term].words = nt_term_form_of(plan, term, form)->words;
        plan->terms[term].form = form;
        plan->terms[term].bound = options->option[term][best->index[term]].error;
        plan->terms[term].cost = options->option[term][best->index[term]].cost;
        plan->terms[term].latency = options->option[term][best->index[term]].latency;
        if (term == NT_PLAN_CONTACT) {
            plan->terms[term].cost += beside(options, best, 0);
            plan->terms[term].latency += beside(options, best, 1);
        }
        plan->latency += plan->terms[term].latency;
        if (term != NT_PLAN_CONTACT && form != NT_FORM_OFF)
            plan->on[plan->on_count++] = term;
    }
    plan->bound.force_error = best->error;
    plan->cost = best->cost;
}

/* The last option of every term is its fullest. */
static combination everything(const nt_plan_options *options)
{
    combination full;
    for (int term = 0; term < NT_PLAN_TERMS; ++term)
        full.index[term] = options->count[term] - 1;
    weigh(options, &full);
    return full;
}

nt_status nt_plan_choose(nt_plan *plan, const nt_plan_options *options, nt_problem *problem)
{
    const double demanded = plan->demand.relative_accuracy, budget = plan->demand.budget;
    const combination full = everything(options);
    combination best = full, tried = {{0}, 0.0, 0.0};
    int found = !(demanded > 0.0);
    plan->full_cost = full.cost;
    do {
        weigh(options, &tried);
        if (!(tried.error <= demanded) || !(demanded > 0.0))
            continue;
        if (!found || tried.cost < best.cost || (tried.cost == best.cost && tried.error < best.error))
            best = tried;
        found = 1;
    } while (next(options, &tried));
    if (!found)
        return refuse(problem, "demand.relative_accuracy", demanded, full.error);
    if (budget > 0.0 && best.cost > budget * NT_BUDGET_ROUNDS)
        return refuse(problem, "demand.budget", budget, best.cost);
    take(plan, options, &best);
    return NT_OK;
}
