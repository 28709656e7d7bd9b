/* SPDX-License-Identifier: BSD-3-Clause
 * The plan of a sample that yields to all forces together: the pressures of the terms summed, solved when the plan is
 * made, run from a table (docs/yielding.md). */
#include <math.h>

#include "scene/terms/term.h"
#include "scene/yield.h"

#define GAPS 1.1      /* ratio of gaps that are looked at */
#define FARTHEST 1e-2 /* [m] */
#define SEAM 0.1      /* of the tolerance: where the table begins */
#define PARTS 2.5     /* a table's bound over its tolerance */
#define ROUGHEST 1e-2 /* tolerances of a table */
#define FINEST 2e-5
#define UNASKED 0.01 /* without a demand all that a table does not know comes to less */
#define STEP 1e-4    /* of a gap: differences */
#define LEAVES 0.7   /* of the demand; the rest is for the form of contact */
#define WEAKER 0.7   /* of the pull-off of rigid bodies: that of a sample that yields, at least */
#define FADED 1e-6   /* of what a law is at half the gap: it ends without a kink */
#define FINER 0.45   /* each attempt */
#define CLOSER 1.02  /* ratio of gaps at which forces are sampled */
#define FLAT 50.0    /* tables of a stiffness are coarser by */
#define DEEPER 1.05  /* than the largest load */

enum { ATTEMPTS = 4, SAMPLES = 1000 };

/* The pressures of all terms at a gap that is counted from where the bodies touch. */
typedef struct pressures {
    const nt_plan *plan;
    double hold;
} pressures;

static int adheres(const nt_plan *plan)
{
    return plan->source != NT_ADHESION_NONE;
}

/* Whether a law is one of the tip and not of flats. */
static int is_of_tip(const nt_plan *plan, int term, double gap)
{
    const nt_form form = nt_plan_full_form(plan, term);
    return (form == NT_FORM_SPHERE || form == NT_FORM_TIP) && gap > nt_plan_hold_gap(plan, term);
}

/* That of the whole tip, as rigid bodies have it: p = k/(2 pi R). */
static nt_pressure pressure_of_tip(const nt_plan *plan, int term, double gap)
{
    const double per_area = 2.0 * NT_PI * plan->contact.radius, step = STEP * gap;
    const nt_form form = nt_plan_full_form(plan, term);
    const nt_law_value here = nt_plan_law_eval(plan, term, form, gap);
    const double far = nt_plan_law_eval(plan, term, form, gap + step).k;
    const double near = nt_plan_law_eval(plan, term, form, gap - step).k;
    return (nt_pressure){here.F / per_area, here.k / per_area, (far - near) / (2.0 * step * per_area)};
}

static nt_pressure pressure_at(const void *context, double gap)
{
    const pressures *in = context;
    nt_pressure all = {0.0, 0.0, 0.0};
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (nt_term_rows[term]->pressure && nt_plan_full_form(in->plan, term) != NT_FORM_OFF) {
            const nt_pressure p = adheres(in->plan) && is_of_tip(in->plan, term, gap)
                                      ? pressure_of_tip(in->plan, term, gap)
                                      : nt_term_rows[term]->pressure(nt_term_law(in->plan, term), gap + in->hold);
            all.energy += p.energy;
            all.pressure += p.pressure;
            all.slope += p.slope;
        }
    return all;
}

/* Where a term ends, as a brush does, and does not only fade, from where the bodies touch [m]; 0 if it goes on. */
static double end_of(const pressures *in, int term)
{
    const nt_term_row *row = nt_term_rows[term];
    double low = fmax(in->hold, 1e-11), high = 1e-5;
    if (!row->pressure || nt_plan_full_form(in->plan, term) == NT_FORM_OFF ||
        row->pressure(nt_term_law(in->plan, term), high).energy != 0.0)
        return 0.0;
    for (int i = 0; i < 100; ++i) {
        const double middle = sqrt(low * high);
        *(row->pressure(nt_term_law(in->plan, term), middle).energy == 0.0 ? &high : &low) = middle;
    }
    const double inside = row->pressure(nt_term_law(in->plan, term), 0.9 * high).pressure;
    const double deeper = row->pressure(nt_term_law(in->plan, term), 0.5 * high).pressure;
    return fabs(inside) > FADED * fabs(deeper) ? high - in->hold : 0.0;
}

static nt_yield_sample sample_of(const nt_plan *plan, const nt_scene *scene, const pressures *in, double farthest)
{
    const nt_specimen *s = &scene->sample;
    const double compliance = (1.0 - s->poisson_ratio * s->poisson_ratio) / s->youngs_modulus;
    nt_yield_sample sample = {.radius = plan->contact.radius,
                              .modulus = plan->contact.effective_modulus,
                              .thickness = s->thickness,
                              .poisson_ratio = s->poisson_ratio,
                              .share = compliance * plan->contact.effective_modulus,
                              .law = pressure_at,
                              .context = in,
                              .pole = -in->hold};
    const nt_elastic_sum far = nt_elastic_sum_at(plan, farthest);
    sample.length = far.all_F / far.all_k;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        const double end = end_of(in, term);
        if (end > 0.0 && sample.end_count < NT_YIELD_ENDS)
            sample.ends[sample.end_count++] = end;
    }
    return sample;
}

/* The gap from which on the terms add within an error: bisected to where they no longer do. */
static double where_rigid(const nt_plan *plan, double hold, double error)
{
    double low = hold * (1.0 + 1e-12), high = FARTHEST;
    nt_elastic_sum s = nt_elastic_sum_at(plan, low);
    const double length = s.all_F / s.all_k;
    for (double gap = FARTHEST; gap > low; gap /= GAPS) {
        s = nt_elastic_sum_at(plan, gap);
        if (nt_elastic_error(plan, &s) > error) {
            low = gap;
            break;
        }
        high = gap;
    }
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        s = nt_elastic_sum_at(plan, middle);
        *(nt_elastic_error(plan, &s) > error ? &low : &high) = middle;
    }
    return fmax(low, hold + 2.0 * length);
}

/* What those terms would leave out that have no pressure [N]. */
static double without_pressure(const nt_plan *plan, double nearest)
{
    double rest = 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (!nt_term_rows[term]->pressure)
            rest += nt_plan_law_limit(plan, term, nearest, (nt_quantity)(int)plan->demand.quantity);
    return rest;
}

/* All that a table does not know, as a share of the demand. */
static double other_errors(const nt_plan *plan, double nearest)
{
    double error = nt_plan_share(plan, without_pressure(plan, nearest));
    if (nt_plan_is_curved(plan))
        error += fmax(fabs(plan->radii->minimum / plan->contact.radius - 1.0),
                      fabs(plan->radii->maximum / plan->contact.radius - 1.0));
    return error;
}

/* Force and table meet at the first gap, and U begins there as that of the laws. */
static void join(nt_plan *plan)
{
    nt_yield_table *table = &plan->yield;
    const double first = table->first + table->hold, F = table->node[0].F;
    nt_law_value value = {0.0, 0.0, 0.0, 0.0};
    table->shift = 0.0;
    for (int i = 0; i < 30; ++i) {
        value = nt_plan_rigid_at(plan, first + table->shift);
        if (value.k == 0.0 || F == 0.0)
            break;
        table->shift += (value.F - F) / value.k;
    }
    value = nt_plan_rigid_at(plan, first + table->shift);
    for (int i = 0; i < table->count; ++i)
        table->node[i].U += value.U;
}

nt_law_value nt_plan_rigid_at(const nt_plan *plan, double gap)
{
    nt_law_value all = {0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < plan->on_count; ++i) {
        const int term = plan->on[i];
        const nt_law_value value = nt_term_rows[term]->eval(nt_term_law(plan, term), plan->terms[term].form, gap);
        all.U += value.U;
        all.F += value.F;
        all.k += value.k;
    }
    return all;
}

nt_law_value nt_plan_yield_at(const nt_plan *plan, double gap)
{
    const nt_yield_table *table = &plan->yield;
    const double from_touch = gap - table->hold;
    if (from_touch >= table->first)
        return nt_plan_rigid_at(plan, gap + table->shift);
    if (!(from_touch < table->touch))
        return nt_yield_table_eval(table, from_touch);
    if (adheres(plan))
        return nt_plan_kept_at(plan, gap);
    /* the bodies touch at `hold`; the laws keep their force from there to gap 0, as they do without yielding */
    const nt_law_value touching = nt_yield_table_eval(table, table->touch);
    const double held = fmin(table->touch - from_touch, table->hold);
    nt_law_value value = touching;
    if (held >= table->hold)
        value = nt_yield_table_eval(table, gap);
    else
        value.k = 0.0;
    value.U += touching.F * held;
    return value;
}

/* Numbers of the force as it is now. */
static void facts_of(nt_plan *plan, double load)
{
    const nt_yield_table *table = &plan->yield;
    double pull = 0.0, growth = 0.0;
    plan->maximum_stiffness = 0.0;
    for (int i = 0; i < table->count; ++i)
        if (table->node[i].F <= DEEPER * load)
            plan->maximum_stiffness = fmax(plan->maximum_stiffness, table->node[i].k);
    const double first = table->first + table->hold;
    for (int i = 0; i <= SAMPLES; ++i) {
        const nt_law_value value = nt_plan_yield_at(plan, first + (table->last - first) * i / SAMPLES);
        pull = fmax(pull, -value.F);
        growth = fmax(growth, -value.k);
    }
    for (double gap = first; gap < FARTHEST; gap *= CLOSER) {
        const nt_law_value value = nt_plan_rigid_at(plan, gap + table->shift);
        pull = fmax(pull, -value.F);
        growth = fmax(growth, -value.k);
    }
    plan->pull_off_force = plan->largest_pull_off_force = plan->contact_pull = pull;
    plan->minimum_spring = growth;
    plan->largest_indentation = -table->last;
}

/* Laws that have a pressure act in full. */
static void turn_on(nt_plan *plan)
{
    plan->on_count = 0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        const nt_form form = nt_term_rows[term]->pressure ? nt_plan_full_form(plan, term) : NT_FORM_OFF;
        plan->terms[term].form = form;
        if (form != NT_FORM_OFF)
            plan->on[plan->on_count++] = term;
    }
}

/* What the plan says of its terms. */
static void describe(nt_plan *plan, double error)
{
    const nt_term_form *all = nt_term_form_of(plan, NT_PLAN_CONTACT, NT_FORM_YIELDING); /* computed as one */
    plan->cost = all->cost;
    plan->latency = all->latency;
    plan->terms[NT_PLAN_CONTACT].form = NT_FORM_YIELDING;
    for (int term = 0; term < NT_PLAN_TERMS; ++term) {
        const nt_term_row *row = nt_term_rows[term];
        nt_plan_term *t = &plan->terms[term];
        const nt_term_form *form = nt_term_form_of(plan, term, t->form);
        t->name = row->words.name;
        t->title = row->words.title;
        t->words = form->words;
        t->error = term == NT_PLAN_CONTACT ? error : 0.0;
        t->cost = term == NT_PLAN_CONTACT ? all->cost : 0.0;
        t->latency = term == NT_PLAN_CONTACT ? all->latency : 0.0;
    }
    plan->bound.force_error = error;
}

static nt_status refuse(nt_problem *problem, nt_problem reason)
{
    if (problem)
        *problem = reason;
    return NT_E_RANGE;
}

/* What no table of the plan can be made for. */
static nt_status check(const nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    const nt_shape_kind kind = plan->shape.kind;
    const nt_quantity quantity = (nt_quantity)(int)plan->demand.quantity;
    const int round = kind == NT_SHAPE_PARABOLOID || kind == NT_SHAPE_SPHERE;
    if (!round && !(kind == NT_SHAPE_BLUNTED && adheres(plan)))
        return refuse(problem, (nt_problem){"tip.shape", "", scene->tip.shape, 0.0, 1.0});
    if (quantity != NT_QUANTITY_FORCE && quantity != NT_QUANTITY_STIFFNESS && !adheres(plan))
        return refuse(problem, (nt_problem){"demand.quantity", "", plan->demand.quantity, 0.0, 1.0});
    return NT_OK;
}

/* By how much a pull that grows inside the gap where others are held would be lost in contact [N]. */
static double held_pull(const nt_plan *plan)
{
    double lost = 0.0;
    if (isinf(plan->yield.touch) || adheres(plan))
        return lost;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        const nt_form form = nt_plan_full_form(plan, term);
        lost +=
            fabs(nt_plan_law_eval(plan, term, form, 0.0).F - nt_plan_law_eval(plan, term, form, plan->yield.hold).F);
    }
    return lost;
}

static nt_status table_of(nt_plan *plan, const nt_scene *scene, const pressures *in, double tolerance)
{
    const int sticks = adheres(plan);
    const double farthest = where_rigid(plan, sticks ? plan->capture_gap : in->hold, SEAM * tolerance);
    const nt_yield_sample sample = sample_of(plan, scene, in, farthest);
    const nt_yield_range range = {.farthest = farthest - in->hold,
                                  .nearest = sticks ? fmax(plan->capture_gap, scene->range.minimum_gap)
                                                    : scene->range.minimum_gap - in->hold,
                                  .load = sticks ? (double)INFINITY : DEEPER * scene->range.maximum_load,
                                  .tolerance = tolerance,
                                  .scale = sticks ? WEAKER * plan->scale : plan->scale,
                                  .attracts = sticks,
                                  .stiffness = plan->demand.quantity == NT_QUANTITY_STIFFNESS,
                                  .stiffness_scale = plan->scale};
    return nt_yield_table_make(&plan->yield, &sample, &range);
}

/* With a tolerance, or finer, where Newton or the mesh do not come to an end. */
static nt_status tabulate(nt_plan *plan, const nt_scene *scene, double tolerance)
{
    const pressures in = {plan, adheres(plan) ? 0.0 : nt_elastic_hold(plan)};
    nt_status status = NT_E_NO_CONVERGENCE;
    if (adheres(plan)) /* inside the range of adhesion, too */
        nt_plan_prepare_laws(plan, scene, 0.0);
    for (int i = 0; i < ATTEMPTS && status != NT_OK; ++i)
        status = table_of(plan, scene, &in, tolerance * pow(FINER, i));
    plan->yield.hold = in.hold;
    plan->yield.jump_error = tolerance * plan->yield.touch;
    if (status == NT_OK && held_pull(plan) > fmax(plan->demand.relative_accuracy, tolerance) * plan->scale)
        status = NT_E_NO_CONVERGENCE;
    return status;
}

/* The table is there: contact, facts and words. */
static nt_status compose(nt_plan *plan, const nt_scene *scene, double error, nt_problem *problem)
{
    const double budget = plan->demand.budget;
    turn_on(plan);
    join(plan);
    if (adheres(plan))
        return nt_plan_yield_adhere(plan, scene, error, problem);
    describe(plan, error);
    if (budget > 0.0 && plan->cost > budget)
        return refuse(problem, (nt_problem){"demand.budget", "", budget, plan->cost, 1e9});
    facts_of(plan, scene->range.maximum_load);
    return NT_OK;
}

/* A jump, or a pressure that no mesh resolves: a stiffer sample would not yield. */
static nt_status refuse_modulus(const nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    const double E = scene->sample.youngs_modulus;
    const double stiffer = E * plan->elastic_number / fmax(plan->demand.relative_accuracy, FINEST);
    return refuse(problem, (nt_problem){"sample.youngs_modulus", "Pa", E, fmin(fmax(stiffer, E), 1e13), 1e13});
}

/* Tables are of forces, whatever is demanded. */
static nt_status yield(nt_plan *plan, const nt_scene *scene, double quantity, nt_problem *problem)
{
    const double nearest = fmax(scene->range.minimum_gap, 0.0), demanded = plan->demand.relative_accuracy;
    const int felt = quantity == NT_QUANTITY_FORCE || quantity == NT_QUANTITY_STIFFNESS;
    const double others = felt ? other_errors(plan, nearest) + plan->around_error : 0.0;
    const double finest = plan->demand.quantity == NT_QUANTITY_STIFFNESS ? FLAT * FINEST : FINEST;
    const double left = (demanded > 0.0 ? demanded - others : fmin(UNASKED - others, PARTS * finest)) / PARTS;
    const double tolerance = fmin(adheres(plan) ? LEAVES * left : left, ROUGHEST);
    if (left < finest)
        return refuse(problem, (nt_problem){"demand.relative_accuracy", "", demanded,
                                            (others + PARTS * finest) * (1.0 + 1e-9), 0.5});
    nt_status status = tabulate(plan, scene, tolerance);
    if (status != NT_OK)
        return refuse_modulus(plan, scene, problem);
    plan->demand.quantity = quantity;
    nt_problem reason = {0};
    status = compose(plan, scene, others + PARTS * tolerance, &reason);
    if (status == NT_OK)
        return status;
    return reason.field ? refuse(problem, reason) : refuse_modulus(plan, scene, problem);
}

nt_status nt_plan_yield(nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    const double quantity = plan->demand.quantity;
    nt_status status = check(plan, scene, problem);
    if (status != NT_OK)
        return status;
    if (quantity != NT_QUANTITY_STIFFNESS) {
        plan->demand.quantity = NT_QUANTITY_FORCE;
        plan->scale = nt_plan_scale_of(plan, scene->range.maximum_load);
    }
    status = yield(plan, scene, quantity, problem);
    plan->demand.quantity = quantity;
    if (status != NT_OK)
        plan->yield.count = 0;
    return status;
}
