/* SPDX-License-Identifier: BSD-3-Clause
 * The cheapest combination of forms whose errors add up to no more than the demand: all of them are tried, a few
 * hundred at most. No plan can then cost more than everything-on; where two cost the same, the truer one is taken. */
#include "scene/terms/term.h"

/* What the first law beside contact costs more, 0: cost, 1: latency. */
static double beside(const nt_plan_options *options, const nt_plan_choice *tried, int which)
{
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (options->option[term][tried->index[term]].form != NT_FORM_OFF)
            return options->option[NT_PLAN_CONTACT][tried->index[NT_PLAN_CONTACT]].beside[which];
    return 0.0;
}

static void weigh(const nt_plan_options *options, nt_plan_choice *tried)
{
    tried->error = 0.0;
    tried->cost = beside(options, tried, 0);
    for (int term = 0; term < NT_PLAN_TERMS; ++term) {
        tried->error += options->option[term][tried->index[term]].error;
        tried->cost += options->option[term][tried->index[term]].cost;
    }
}

/* The next combination; 0 after the last. */
static int next(const nt_plan_options *options, nt_plan_choice *tried)
{
    for (int term = 0; term < NT_PLAN_TERMS; ++term) {
        if (++tried->index[term] < options->count[term])
            return 1;
        tried->index[term] = 0;
    }
    return 0;
}

/* The last option of every term is its fullest. */
static nt_plan_choice everything(const nt_plan_options *options)
{
    nt_plan_choice full;
    for (int term = 0; term < NT_PLAN_TERMS; ++term)
        full.index[term] = options->count[term] - 1;
    weigh(options, &full);
    return full;
}

int nt_plan_is_alone(const nt_plan_options *options, const nt_plan_choice *choice)
{
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (options->option[term][choice->index[term]].form != NT_FORM_OFF)
            return 0;
    return 1;
}

void nt_plan_take(nt_plan *plan, const nt_plan_options *options, const nt_plan_choice *best)
{
    plan->full_cost = everything(options).cost;
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

nt_status nt_plan_choose(const nt_plan_options *options, double accuracy, double budget, nt_plan_choice *choice,
                         nt_problem *problem)
{
    const nt_plan_choice full = everything(options);
    nt_plan_choice best = full, tried = {{0}, 0.0, 0.0};
    int found = !(accuracy > 0.0);
    do {
        weigh(options, &tried);
        if (!(tried.error <= accuracy) || !(accuracy > 0.0))
            continue;
        if (!found || tried.cost < best.cost || (tried.cost == best.cost && tried.error < best.error))
            best = tried;
        found = 1;
    } while (next(options, &tried));
    if (!found)
        return nt_problem_refuse(problem, nt_demand_accuracy(accuracy, full.error));
    if (budget > 0.0 && best.cost > budget * NT_BUDGET_ROUNDS)
        return nt_problem_refuse(problem, nt_demand_budget(budget, best.cost));
    *choice = best;
    return NT_OK;
}
