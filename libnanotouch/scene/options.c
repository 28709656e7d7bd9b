/* SPDX-License-Identifier: BSD-3-Clause
 * The forms in which every term of a plan could be computed, each with a bound of its error and its cost.
 *
 * An error is a share of the demand: over max(|X|, S), X the demanded quantity of the whole and S its scale. Contact is
 * off by at most e max(|X_c|, S). With T the largest that the terms beside contact come to, |X_c| <= |X| + T, so that
 * its share is e (1 + T/S); of a force T need only be their largest attraction, since X_c <= |X| + T then, and X_c >=
 * -S. A term left out is off by its largest value in the range; one in a simpler form by the largest difference of the
 * two forms. */
#include <math.h>

#include "scene/parts.h"

/* Measured cost of {U, F, k, a}, in evaluations of an inlined Hertz law (tests/bench/bench_plan.c; exact: in contact).
 */
#define COST_SHAPE 6.0
#define COST_SPHERE 55.0
#define COST_HERTZ 3.0
#define COST_SERIES 4.0
#define COST_JKR 11.0
#define COST_TABLE 14.0
#define COST_POLISHED 40.0
#define COST_EXACT 280.0
#define COST_LOCAL 55.0 /* with dU/dR */
#define COST_LOCAL_HERTZ 6.0
#define COST_LOCAL_EXACT 1100.0
#define COST_HEIGHT 15.0 /* height and slopes of a surface */
#define COST_PLACE 28.0  /* and its effective radius */
static const double law_costs[NT_PLAN_TERMS][NT_FORM_LOCAL + 1] = {
    [NT_PLAN_VDW] = {[NT_FORM_DERJAGUIN] = 8.0, [NT_FORM_SPHERE] = 10.0, [NT_FORM_TIP] = 18.0},
    [NT_PLAN_ELECTROSTATIC] = {[NT_FORM_SPHERE] = 9.0, [NT_FORM_TIP] = 20.0},
    [NT_PLAN_CHARGE] = {[NT_FORM_ON] = 7.0},
    [NT_PLAN_DOUBLE_LAYER] = {[NT_FORM_ON] = 17.0},
    [NT_PLAN_HYDRATION] = {[NT_FORM_ON] = 6.0},
    [NT_PLAN_STERIC] = {[NT_FORM_ON] = 10.0},
};

#define SAMPLED 1.05    /* a largest value that was sampled on a smooth curve may be this much short of the true one */
#define TABLED 2.0      /* the same for the error of a table, which oscillates within its cells */
#define ROUNDING 1e-12  /* polished and exact tiers, away from folds (docs/contact.md) */
#define LAST_BITS 1e-15 /* of each term beside contact: large ones can cancel to a small sum */

static void offer(nt_plan_options *options, int term, nt_form form, double error, double cost)
{
    const int i = options->count[term]++;
    options->option[term][i].form = form;
    options->option[term][i].error = error;
    options->option[term][i].cost = cost;
}

/* Of contact, which other terms may hide; of what hides contact there is no less. */
static double rounding(double more)
{
    return ROUNDING * fmax(more, 1.0);
}

static double share(double error, double scale)
{
    return error == 0.0 ? 0.0 : error / scale;
}

/* What leaving out the curvature of the surface costs beside contact. */
static double curved_laws(const nt_plan *plan, double beside)
{
    const double R = plan->contact.radius;
    if (!nt_plan_is_curved(plan))
        return 0.0;
    const double ratio = fmax(fabs(plan->radii->minimum / R - 1.0), fabs(plan->radii->maximum / R - 1.0));
    return share(ratio * beside, plan->scale);
}

/* And in contact: force grows with the radius, so that the smallest and the largest on the map are the worst. */
static double curved_contact(const nt_plan *plan, double more)
{
    if (!nt_plan_is_curved(plan))
        return 0.0;
    if (plan->demand.quantity == NT_QUANTITY_FOLDS)
        return share(nt_plan_curvature_shift(plan), plan->scale);
    return more * SAMPLED * nt_plan_curvature_distance(plan);
}

static void offer_local(const nt_plan *plan, nt_plan_options *options, double more)
{
    if (!nt_plan_is_curved(plan))
        return;
    if (plan->source == NT_ADHESION_NONE) {
        offer(options, NT_PLAN_CONTACT, NT_FORM_LOCAL, rounding(more), COST_LOCAL_HERTZ);
        return;
    }
    if (plan->bank) {
        const double error = nt_plan_bank_error(plan, (nt_quantity)(int)plan->demand.quantity);
        offer(options, NT_PLAN_CONTACT, NT_FORM_LOCAL, more * (error + ROUNDING), COST_LOCAL);
    }
    offer(options, NT_PLAN_CONTACT, NT_FORM_LOCAL_EXACT, more * ROUNDING, COST_LOCAL_EXACT);
}

/* Contact of tips that adhesion makes Maugis-Dugdale's. */
static void offer_maugis(nt_plan *plan, nt_plan_options *options, double more)
{
    const nt_quantity quantity = (nt_quantity)(int)plan->demand.quantity;
    double table = TABLED * plan->table.accuracy[NT_TIER_TABLE].force_error;
    if (quantity == NT_QUANTITY_FOLDS)
        table = share(plan->table.accuracy[NT_TIER_TABLE].fold_shift, plan->scale);
    else if (quantity != NT_QUANTITY_FORCE)
        table = TABLED * nt_plan_contact_distance(plan, NT_FORM_TABLE);
    else
        table *= fmax(1.0, share(nt_maugis_pull_off_force(&plan->maugis), plan->scale));
    const int hertz_shape = plan->shape.kind == NT_SHAPE_PARABOLOID;
    if (hertz_shape && quantity == NT_QUANTITY_FORCE && plan->demand.force_floor > 0.0)
        offer(options, NT_PLAN_CONTACT, NT_FORM_SHAPE,
              SAMPLED * more * nt_plan_contact_distance(plan, NT_FORM_PARABOLOID) + plan->curvature_error, COST_HERTZ);
    offer(options, NT_PLAN_CONTACT, NT_FORM_TABLE, more * table + ROUNDING + plan->curvature_error, COST_TABLE);
    offer(options, NT_PLAN_CONTACT, NT_FORM_POLISHED, more * 2.0 * ROUNDING + plan->curvature_error, COST_POLISHED);
    offer(options, NT_PLAN_CONTACT, NT_FORM_EXACT, more * ROUNDING + plan->curvature_error, COST_EXACT);
    offer_local(plan, options, more);
}

/* All beside contact, in full. */
static double beside_at(const nt_plan *plan, double gap)
{
    double sum = 0.0;
    for (int term = NT_PLAN_VDW; term < NT_PLAN_TERMS; ++term)
        sum += nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), gap).F;
    return sum;
}

/* The largest attraction of all beside contact, at the gaps where there can be contact; all is held inside 0. */
static double opposing(const nt_plan *plan)
{
    double reach = fmax(plan->capture_gap, plan->release_gap), pull = fmax(-beside_at(plan, 0.0), 0.0);
    if (nt_plan_is_curved(plan))
        reach = fmax(reach, nt_plan_local_release_gap(plan, NT_FORM_LOCAL_EXACT, plan->radii->maximum));
    for (double gap = reach; gap > 1e-13; gap *= 0.9)
        pull = fmax(pull, -SAMPLED * beside_at(plan, gap));
    return pull * nt_plan_largest_ratio(plan);
}

/* How much larger the share of contact is than its own error, 1 + T/S; `beside`: all that the other terms come to.
 * Where contact without adhesion begins the others are held: X = X_c + their sum, 0 <= X_c <= P. If that pushes,
 * max(X_c, S)/max(X, S) is largest at either end of X_c. */
static double more_than_contact(const nt_plan *plan, const nt_scene *scene, double beside)
{
    if (plan->demand.quantity != NT_QUANTITY_FORCE)
        return 1.0 + share(nt_plan_largest_ratio(plan) * beside, plan->scale);
    const double pull = opposing(plan), sharpest = plan->radii ? plan->radii->minimum / plan->contact.radius : 1.0;
    const double push = beside_at(plan, 0.0) * fmin(sharpest, 1.0), S = plan->scale;
    if (plan->source != NT_ADHESION_NONE || pull > 0.0)
        return 1.0 + share(pull, S);
    const double load = fmax(scene->range.maximum_load, S);
    return fmax(S / fmax(push, S), load / (load + push));
}

static double cost_of_shape(nt_shape_kind kind)
{
    return kind == NT_SHAPE_PARABOLOID ? COST_HERTZ : kind == NT_SHAPE_SPHERE ? COST_SPHERE : COST_SHAPE;
}

/* A form other than the fullest of a contact without adhesion, which has no folds. */
static void offer_simpler(const nt_plan *plan, nt_plan_options *options, nt_form form, double more)
{
    const double error = plan->demand.quantity == NT_QUANTITY_FOLDS ? 0.0 : nt_plan_contact_distance(plan, form);
    offer(options, NT_PLAN_CONTACT, form, more * SAMPLED * error + rounding(more),
          form == NT_FORM_SERIES ? COST_SERIES : COST_HERTZ);
}

static void offer_shape(const nt_plan *plan, nt_plan_options *options, double more)
{
    const nt_shape_kind kind = plan->shape.kind;
    if (kind == NT_SHAPE_SPHERE || kind == NT_SHAPE_BLUNTED)
        offer_simpler(plan, options, NT_FORM_PARABOLOID, more);
    if (kind == NT_SHAPE_SPHERE && plan->largest_indentation < plan->shape.radius)
        offer_simpler(plan, options, NT_FORM_SERIES, more);
    offer(options, NT_PLAN_CONTACT, NT_FORM_SHAPE, rounding(more) + plan->curvature_error, cost_of_shape(kind));
    offer_local(plan, options, more);
}

static void offer_contact(nt_plan *plan, const nt_scene *scene, nt_plan_options *options, double beside)
{
    const double more = more_than_contact(plan, scene, beside);
    const nt_form full = nt_plan_contact_form(plan);
    nt_plan_term *term = &plan->terms[NT_PLAN_CONTACT];
    if (scene->range.minimum_gap > fmax(fmax(plan->capture_gap, plan->release_gap), 0.0)) {
        term->force = 0.0; /* never touched */
        plan->curvature_error = curved_laws(plan, beside);
        offer(options, NT_PLAN_CONTACT, NT_FORM_OFF, plan->curvature_error, 0.0);
        const int exact = plan->source != NT_ADHESION_NONE && !plan->bank;
        if (nt_plan_is_curved(plan)) /* for the radii that the other terms follow */
            offer(options, NT_PLAN_CONTACT, exact ? NT_FORM_LOCAL_EXACT : NT_FORM_LOCAL, ROUNDING, 0.0);
        return;
    }
    term->force = scene->range.maximum_load;
    plan->curvature_error = curved_contact(plan, more) + curved_laws(plan, beside);
    if (full == NT_FORM_EXACT)
        offer_maugis(plan, options, more);
    else if (full == NT_FORM_JKR)
        offer(options, NT_PLAN_CONTACT, full, ROUNDING, COST_JKR);
    else
        offer_shape(plan, options, more);
}

/* The largest difference of a form to the fullest one, over the gaps of the range. */
static double form_distance(const nt_plan *plan, int term, nt_form form, double nearest)
{
    const nt_quantity quantity = (nt_quantity)(int)plan->demand.quantity;
    const nt_form full = nt_plan_full_form(plan, term);
    if (form == full || quantity == NT_QUANTITY_RADIUS || quantity == NT_QUANTITY_FOLDS)
        return 0.0;
    double largest = 0.0;
    for (double gap = fmax(nearest, 1e-13); gap < 1e-1; gap *= 1.1)
        largest = fmax(largest, fabs(nt_plan_pick(nt_plan_law_eval(plan, term, form, gap), quantity) -
                                     nt_plan_pick(nt_plan_law_eval(plan, term, full, gap), quantity)));
    const double held = fabs(nt_plan_pick(nt_plan_law_eval(plan, term, form, nearest), quantity) -
                             nt_plan_pick(nt_plan_law_eval(plan, term, full, nearest), quantity));
    return SAMPLED * fmax(largest, held);
}

/* Beside contact every term grows with the effective radius, as for gaps that are small against it. */
static void offer_law(const nt_plan *plan, int term, double nearest, nt_plan_options *options)
{
    const double blunter = nt_plan_largest_ratio(plan);
    static const nt_form simpler[] = {NT_FORM_DERJAGUIN, NT_FORM_SPHERE};
    const nt_quantity quantity = (nt_quantity)(int)plan->demand.quantity;
    const nt_form full = nt_plan_full_form(plan, term);
    offer(options, term, NT_FORM_OFF, blunter * share(nt_plan_law_limit(plan, term, nearest, quantity), plan->scale),
          0.0);
    if (full == NT_FORM_OFF)
        return;
    for (int i = 0; i < 2; ++i) {
        const double cost = law_costs[term][simpler[i]];
        if (cost > 0.0 && simpler[i] != full)
            offer(options, term, simpler[i],
                  blunter * share(form_distance(plan, term, simpler[i], nearest), plan->scale), cost);
    }
    offer(options, term, full, 0.0, law_costs[term][full]);
}

/* What the sum loses where large terms cancel, over max(|X|, S). Contact adds no less than -S to B, what the others
 * come to, so that |X| >= B/2 where B > 2 S. */
static double lost_bits(const nt_plan *plan, double nearest, double beside)
{
    const double ratio = nt_plan_largest_ratio(plan);
    double worst = 0.0;
    if (plan->demand.quantity != NT_QUANTITY_FORCE)
        return LAST_BITS * share(ratio * beside, plan->scale);
    for (double gap = nearest; gap < 1e-1; gap = fmax(1.1 * gap, 1e-13)) {
        double all = 0.0, sum = 0.0;
        for (int term = NT_PLAN_VDW; term < NT_PLAN_TERMS; ++term) {
            const double F = nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), gap).F;
            all += fabs(F);
            sum += F;
        }
        worst = fmax(worst, fmin(share(ratio * all, plan->scale), sum > 0.0 ? 2.0 * all / sum : (double)INFINITY));
    }
    return LAST_BITS * worst;
}

void nt_plan_options_of(nt_plan *plan, const nt_scene *scene, nt_plan_options *options)
{
    static const nt_plan_options none = {0};
    const nt_quantity quantity = (nt_quantity)(int)plan->demand.quantity;
    const double nearest = fmax(scene->range.minimum_gap, 0.0);
    double beside = 0.0;
    *options = none;
    plan->scale = nt_plan_scale_of(plan, scene->range.maximum_load);
    for (int term = NT_PLAN_VDW; term < NT_PLAN_TERMS; ++term) {
        plan->terms[term].force = nt_plan_law_limit(plan, term, nearest, NT_QUANTITY_FORCE);
        beside += nt_plan_law_limit(plan, term, nearest, quantity);
        offer_law(plan, term, nearest, options);
    }
    if (nt_plan_contact_form(plan) == NT_FORM_EXACT)
        nt_plan_rivals_of(plan);
    offer_contact(plan, scene, options, beside);
    const double lost = lost_bits(plan, nearest, beside);
    for (int i = 0; i < options->count[NT_PLAN_CONTACT]; ++i) { /* whatever its form, contact bears what all share */
        options->option[NT_PLAN_CONTACT][i].error += lost;
        if (plan->surface)
            options->option[NT_PLAN_CONTACT][i].cost +=
                nt_form_is_local(options->option[NT_PLAN_CONTACT][i].form) ? COST_PLACE : COST_HEIGHT;
    }
}
