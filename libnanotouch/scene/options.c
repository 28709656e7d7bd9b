/* SPDX-License-Identifier: BSD-3-Clause
 * The forms in which every term of a plan could be computed, each with a bound of its error and its cost.
 *
 * An error is a share of the demand: over max(|X|, S), X the demanded quantity of the whole and S its scale. A term
 * left out is off by its largest value in the range; one in a simpler form by the largest difference of the two forms.
 * What has a rule of its own, as contact, offers its forms itself (terms/). */
#include <math.h>
#include <stddef.h>

#include "scene/terms/term.h"

/* Measured cost and latency of a surface, in Hertz evaluations (tests/bench/bench_plan.c). */
static const double cost_height[2] = {2.0, 2.3};   /* height and slopes */
static const double cost_radius[2] = {1.0, 1.0};   /* and the effective radius */
static const double cost_property[2] = {0.7, 0.6}; /* and each property */
static const double cost_tables[2] = {6.6, 5.4};   /* and four tables of a sample that deforms, in place of one */

/* What the first law beside contact costs before its own. A contact that is solved, or looked up, hides it; one by a
 * formula of some operations does less; none at all, least of all. */
#define FORMULA 1.3 /* costs of such a contact, at most */
#define NONE 0.5    /* of none */
static const double first_beside_formula[2] = {0.7, 0.6}, first_of_all[2] = {1.1, 1.75};

#define LAST_BITS                                                                                                      \
    5e-15 /* of each term beside contact, within which a difference loses some, too; large ones can cancel to a small  \
             sum */

void nt_plan_offer(const nt_plan *plan, nt_plan_options *options, int term, nt_form form, double error)
{
    const int i = options->count[term]++;
    options->option[term][i].form = form;
    options->option[term][i].error = error;
    options->option[term][i].cost = nt_term_form_of(plan, term, form)->cost;
    options->option[term][i].latency = nt_term_form_of(plan, term, form)->latency;
}

double nt_plan_share(const nt_plan *plan, double error)
{
    return error == 0.0 ? 0.0 : error / plan->scale;
}

double nt_plan_table_error(const nt_plan *plan, nt_quantity quantity)
{
    double error = 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (nt_term_rows[term]->error)
            error += plan->ratio * nt_term_rows[term]->error(nt_term_law(plan, term), quantity);
    return error;
}

nt_problem nt_plan_reason(const nt_plan *plan, const char *law, double error)
{
    const double table = nt_plan_share(plan, nt_plan_table_error(plan, plan->quantity));
    nt_problem reason = nt_demand_accuracy(plan->accuracy, INFINITY);
    reason.code = table > error ? NT_PROBLEM_TABLE : NT_PROBLEM_DEFORMS;
    reason.cause = law;
    return reason;
}

static double difference(const nt_plan *plan, int term, nt_form form, double gap)
{
    const nt_quantity quantity = plan->quantity;
    return fabs(nt_plan_pick(nt_plan_law_eval(plan, term, form, gap), quantity) -
                nt_plan_pick(nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), gap), quantity));
}

/* The largest difference of a form to the fullest one, over the gaps of the range; as a rule it is just outside the
 * hold, where both are steepest. */
static double form_distance(const nt_plan *plan, int term, nt_form form, double nearest)
{
    const nt_quantity quantity = plan->quantity;
    if (form == nt_plan_full_form(plan, term) || quantity == NT_QUANTITY_RADIUS || quantity == NT_QUANTITY_FOLDS)
        return 0.0;
    const double outside = fmax(nearest, nt_plan_hold_gap(plan, term) * (1.0 + 1e-12));
    double largest = fmax(difference(plan, term, form, nearest), difference(plan, term, form, outside));
    for (double gap = fmax(nearest, 1e-13); gap < 1e-1; gap *= 1.1)
        largest = fmax(largest, difference(plan, term, form, gap));
    return NT_SAMPLED * largest;
}

/* Beside contact every term grows with the effective radius, as for gaps that are small against it. */
static void offer_law(const nt_plan *plan, int term, double nearest, nt_plan_options *options)
{
    const double blunter = nt_plan_largest_ratio(plan);
    const nt_quantity quantity = plan->quantity;
    const nt_form full = nt_plan_full_form(plan, term);
    const nt_term_words *words = &nt_term_rows[term]->words;
    const double limit = nt_plan_law_limit(plan, term, nearest, quantity);
    nt_plan_offer(plan, options, term, NT_FORM_OFF, blunter * nt_plan_share(plan, limit));
    if (full == NT_FORM_OFF)
        return;
    for (int i = 0; i < words->form_count && words->forms[i].form != full; ++i) {
        const double error = form_distance(plan, term, words->forms[i].form, nearest);
        nt_plan_offer(plan, options, term, words->forms[i].form, blunter * nt_plan_share(plan, error));
    }
    const double error = nt_term_rows[term]->error ? nt_term_rows[term]->error(nt_term_law(plan, term), quantity) : 0.0;
    nt_plan_offer(plan, options, term, full, blunter * nt_plan_share(plan, error));
}

/* What the sum loses where large terms cancel, over max(|X|, S). Contact adds no less than -S to B, what the others
 * come to, so that |X| >= B/2 where B > 2 S. */
static double lost_bits(const nt_plan *plan, double nearest, double beside)
{
    const double ratio = nt_plan_largest_ratio(plan);
    double worst = 0.0;
    if (plan->quantity != NT_QUANTITY_FORCE)
        return LAST_BITS * nt_plan_share(plan, ratio * beside);
    for (double gap = nearest; gap < 1e-1; gap = fmax(1.1 * gap, 1e-13)) {
        double all = 0.0, sum = 0.0;
        for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
            const double F = nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), gap).F;
            all += fabs(F);
            sum += F;
        }
        worst = fmax(worst, fmin(nt_plan_share(plan, ratio * all), sum > 0.0 ? 2.0 * all / sum : (double)INFINITY));
    }
    return LAST_BITS * worst;
}

double nt_plan_cost_of_place(const nt_plan *plan, nt_form form, int which)
{
    double cost = plan->surface ? cost_height[which] : 0.0;
    if (!nt_form_is_local(form) && plan->relief.count == 0)
        return cost;
    if (plan->relief.count > 0 && form == NT_FORM_DEFORMED)
        cost += cost_tables[which];
    if (plan->followed)
        cost += cost_radius[which];
    if (plan->properties)
        cost += cost_property[which] * ((plan->properties->youngs_modulus.coefficients != NULL) +
                                        (plan->properties->work_of_adhesion.coefficients != NULL));
    return cost;
}

/* What all share, contact bears, whatever its form: the bits that the sum loses, and the surface under it. */
static void burden_contact(const nt_plan *plan, nt_plan_options *options, double lost)
{
    for (int i = 0; i < options->count[NT_PLAN_CONTACT]; ++i) {
        const nt_form form = options->option[NT_PLAN_CONTACT][i].form;
        const double own = options->option[NT_PLAN_CONTACT][i].cost;
        const double *first = own < NONE ? first_of_all : first_beside_formula;
        for (int which = 0; which < 2 && own < FORMULA; ++which)
            options->option[NT_PLAN_CONTACT][i].beside[which] = first[which];
        options->option[NT_PLAN_CONTACT][i].error += lost;
        options->option[NT_PLAN_CONTACT][i].cost += nt_plan_cost_of_place(plan, form, 0);
        options->option[NT_PLAN_CONTACT][i].latency += nt_plan_cost_of_place(plan, form, 1);
    }
}

void nt_plan_options_of(nt_plan *plan, const nt_scene *scene, nt_plan_options *options)
{
    static const nt_plan_options none = {0};
    const nt_quantity quantity = plan->quantity;
    const double nearest = fmax(scene->range.minimum_gap, 0.0);
    double beside = 0.0;
    *options = none;
    nt_plan_visit(plan, scene);
    plan->scale = nt_plan_scale_of(plan, scene->range.maximum_load);
    for (int term = 0; term < NT_PLAN_TERMS; ++term)
        if (!nt_term_rows[term]->offer) {
            plan->terms[term].force = nt_plan_law_limit(plan, term, nearest, NT_QUANTITY_FORCE);
            beside += nt_plan_law_limit(plan, term, nearest, quantity);
            offer_law(plan, term, nearest, options);
        }
    for (int term = 0; term < NT_PLAN_TERMS; ++term)
        if (nt_term_rows[term]->offer)
            nt_term_rows[term]->offer(plan, scene, options, beside);
    burden_contact(plan, options, lost_bits(plan, nearest, beside));
}
