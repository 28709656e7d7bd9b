/* SPDX-License-Identifier: BSD-3-Clause
 * The plan of a sample that deforms under all forces together: the pressures of the terms summed, solved when the plan
 * is made, run from a table (docs/deformation.md). */
#include <math.h>

#include "scene/deformation/deform.h"
#include "scene/terms/term.h"

#define SEAM 0.1           /* of the tolerance: where the table begins */
#define PARTS 2.5          /* a table's bound over its tolerance */
#define ROUGHEST 8.6177e-3 /* tolerances of a table: so that there is one for each power of ten of the demand */
#define FINER 0.46415888   /* from one to the next: three a decade */
#define FINEST 2e-6
#define UNASKED 0.01  /* without a demand all that a table does not know comes to less */
#define ENDED 20.0    /* times the finest, where a law ends with a kink */
#define PLENTY 10.0   /* times the finest, then */
#define INSIDE 0.9    /* of what is left, in a second attempt */
#define LEAVES 0.7    /* of the demand; the rest is for the form of contact */
#define WEAKER 0.7    /* of the pull-off of rigid bodies: that of a sample that deforms, at least */
#define FLAT 10.0     /* tables of a stiffness are coarser by */
#define STIFF 0.3     /* of the tolerance: the gap of a jump, where that of a stiffness was sought */
#define RELEASED 1e-4 /* of the release gap: two solvers agree on it to 3e-5, whatever is demanded */
#define WORST 0.5     /* the largest error that can be demanded */
#define UNFELT 0.3    /* of the demand: a spread of radii that one table may leave out */
#define BETWEEN 0.4   /* of what is left over relief: what lies between its tables */

enum { ATTEMPTS = 4, OF_EACH_RADIUS = 2, RUNGS = 100 };

static int adheres(const nt_plan *plan)
{
    return plan->source != NT_ADHESION_NONE;
}

/* The gap from which on the terms add within an error: bisected to where they no longer do. */
static double where_rigid(const nt_plan *plan, double hold, double error)
{
    double low = fmax(hold, nt_elastic_hold(plan)) * (1.0 + 1e-12),
           high = NT_DEFORM_FARTHEST; /* held, they have no length */
    nt_elastic_sum s = nt_elastic_sum_at(plan, low);
    const double length = s.here_F / s.here_k;
    for (double gap = NT_DEFORM_FARTHEST; gap > low; gap = nt_elastic_nearer(plan, gap)) {
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
            rest += nt_plan_law_limit(plan, term, nearest, plan->quantity);
    return rest;
}

/* What one table for all effective radii of the surface leaves out. */
static double spread_of_radii(const nt_plan *plan)
{
    const double R = plan->contact.radius;
    return nt_plan_is_curved(plan) ? fmax(fabs(plan->radii->minimum / R - 1.0), fabs(plan->radii->maximum / R - 1.0))
                                   : 0.0;
}

/* Whether it takes tables of many radii: one would take most of the demand. */
static int takes_relief(const nt_plan *plan)
{
    return plan->relief.room && spread_of_radii(plan) > UNFELT * plan->accuracy;
}

/* All that a table does not know, as a share of the demand. */
static double other_errors(const nt_plan *plan, double nearest, int felt)
{
    const double lost = without_pressure(plan, nearest) + nt_plan_table_error(plan, plan->quantity);
    const double error = felt ? nt_plan_share(plan, lost) : 0.0;
    return error + (takes_relief(plan) ? 0.0 : spread_of_radii(plan));
}

/* What the plan says of its terms. */
static void describe(nt_plan *plan, double error)
{
    const nt_term_form *all = nt_term_form_of(plan, NT_PLAN_CONTACT, NT_FORM_DEFORMED); /* computed as one */
    plan->cost = all->cost + nt_plan_cost_of_place(plan, NT_FORM_DEFORMED, 0);
    plan->latency = all->latency + nt_plan_cost_of_place(plan, NT_FORM_DEFORMED, 1);
    plan->terms[NT_PLAN_CONTACT].form = NT_FORM_DEFORMED;
    for (int term = 0; term < NT_PLAN_TERMS; ++term) {
        const nt_term_row *row = nt_term_rows[term];
        nt_plan_term *t = &plan->terms[term];
        const nt_term_form *form = nt_term_form_of(plan, term, t->form);
        t->name = nt_term_name_of(plan, term);
        t->title = row->name_of ? t->name : row->words.title;
        t->words = form->words;
        t->bound = term == NT_PLAN_CONTACT ? error : 0.0;
        t->cost = term == NT_PLAN_CONTACT ? plan->cost : 0.0;
        t->latency = term == NT_PLAN_CONTACT ? plan->latency : 0.0;
    }
    plan->bound.force_error = error;
}

/* What no table of the plan can be made for. */
static nt_status check(const nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    const nt_shape_kind kind = plan->shape.kind;
    const int round = kind == NT_SHAPE_PARABOLOID || kind == NT_SHAPE_SPHERE;
    if (!round && !(kind == NT_SHAPE_BLUNTED && adheres(plan)))
        return nt_problem_refuse(
            problem, nt_problem_coded(NT_PROBLEM_DEFORMS_BEFORE_SHAPE,
                                      nt_problem_of("tip.shape", nt_scene_field("tip.shape")->unit, scene->tip.shape,
                                                    NT_SHAPE_PARABOLOID, NT_SHAPE_SPHERE)));
    return NT_OK;
}

/* By how much a pull that grows inside the gap where others are held would be lost in contact [N]. */
static double held_pull(const nt_plan *plan)
{
    double lost = 0.0;
    if (isinf(plan->deformation.touch) || adheres(plan))
        return lost;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        const nt_form form = nt_plan_full_form(plan, term);
        lost += fabs(nt_plan_law_eval(plan, term, form, 0.0).F -
                     nt_plan_law_eval(plan, term, form, plan->deformation.hold).F);
    }
    return lost;
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

static nt_status make(nt_plan *plan, const nt_scene *scene, const nt_deform_terms *in, const nt_deform_wanted *of)
{
    const double tolerance = of->tolerance;
    const int sticks = adheres(plan), surrounded = sticks && nt_plan_is_surrounded(plan, scene);
    const double least = scene->range.minimum_gap;
    const double farthest = where_rigid(plan, sticks ? plan->capture_gap : in->hold, SEAM * tolerance);
    const nt_deform_sample sample = nt_deform_sample_of(in, scene, farthest);
    const nt_deform_range range = {.farthest = farthest - in->hold,
                                   .nearest = sticks && !surrounded ? fmax(plan->capture_gap, least) : least - in->hold,
                                   .centre = surrounded ? plan->length : 0.0,
                                   .load = sticks && !surrounded ? (double)INFINITY : of->load,
                                   .tolerance = tolerance,
                                   .scale =
                                       (sticks ? WEAKER : 1.0) * nt_plan_force_scale(plan, scene->range.maximum_load),
                                   .attracts = sticks,
                                   .stiffness = plan->quantity == NT_QUANTITY_STIFFNESS,
                                   .stiffness_scale = plan->scale,
                                   .radius_scale = of->radius_scale,
                                   .work = of->tried->work,
                                   .touches = of->touches};
    const nt_status status = nt_deform_table_make(&plan->deformation, &sample, &range);
    if (status != NT_OK || !surrounded)
        return status;
    return nt_plan_deform_hold(plan, scene, &range) == NT_OK ? NT_OK : NT_E_RANGE; /* no finer one would do */
}

static int is_end(const nt_deform_end *end, const nt_deform_end *wanted)
{
    const double rounding = 1e-12;
    return fabs(end->tolerance - wanted->tolerance) <= rounding * wanted->tolerance &&
           fabs(end->scale - wanted->scale) <= rounding * wanted->scale && end->surrounded == wanted->surrounded;
}

/* Makes a table, unless it is there already, or known to come to no end. */
static nt_status table_of(nt_plan *plan, const nt_scene *scene, const nt_deform_terms *in, const nt_deform_wanted *of)
{
    nt_deform_end end = {of->tolerance, plan->scale, adheres(plan) && nt_plan_is_surrounded(plan, scene), NT_OK};
    nt_deform_tried *tried = of->tried;
    if (plan->ratio != 1.0 || of->touches)
        return make(plan, scene, in, of);
    for (int i = 0; i < tried->count; ++i)
        if (is_end(&tried->end[i], &end))
            return tried->end[i].status;
    if (is_end(&tried->last, &end)) {
        plan->deformation = tried->table;
        return NT_OK;
    }
    if (tried->work && !(*tried->work > 0.0))
        return NT_E_NO_CONVERGENCE;
    end.status = make(plan, scene, in, of);
    const int was_stopped = tried->work && !(*tried->work > 0.0);
    if (end.status == NT_OK) {
        tried->last = end;
        tried->table = plan->deformation;
    } else if (tried->count < NT_DEFORM_TRIED && !was_stopped)
        tried->end[tried->count++] = end;
    return end.status;
}

/* Tables have the tolerances of one ladder, so that a looser demand can have every table that a stricter one can. */
static double rung_below(double tolerance, double finest)
{
    double rung = ROUGHEST;
    if (!(tolerance >= finest))
        return tolerance;
    while (rung > tolerance)
        rung *= FINER;
    return fmax(rung, finest);
}

/* With a tolerance, or finer, where Newton or the mesh do not come to an end. */
nt_status nt_plan_deform_table(nt_plan *plan, const nt_scene *scene, const nt_deform_wanted *of)
{
    const double tolerance = of->tolerance;
    const nt_deform_terms in = {plan, adheres(plan) ? 0.0 : nt_elastic_hold(plan), 0};
    nt_status status = NT_E_NO_CONVERGENCE;
    if (adheres(plan)) /* inside the range of adhesion, too */
        nt_plan_prepare_laws(plan, scene, 0.0);
    nt_deform_wanted finer = *of;
    for (int i = 0, last = 0; status == NT_E_NO_CONVERGENCE && !last; ++i) {
        status = table_of(plan, scene, &in, &finer);
        const int attempts = plan->ratio != 1.0 ? OF_EACH_RADIUS
                             : adheres(plan)    ? ATTEMPTS
                                                : RUNGS; /* some take long */
        last = finer.tolerance <= of->finest || i + 1 >= attempts;
        finer.tolerance = fmax(FINER * finer.tolerance, of->finest);
    }
    turn_on(plan);
    plan->deformation.hold = in.hold;
    plan->deformation.ratio = plan->ratio;
    plan->deformation.jump_error =
        tolerance * fmax(isinf(plan->deformation.touch) ? 0.0 : fabs(plan->deformation.touch), plan->length);
    if (plan->quantity == NT_QUANTITY_STIFFNESS)
        plan->deformation.jump_error *= STIFF;
    if (plan->deformation.holds)
        plan->deformation.jump_error =
            PARTS * plan->deformation.jump_error + RELEASED * fabs(plan->deformation.release);
    if (status == NT_OK && held_pull(plan) > fmax(plan->accuracy, tolerance) * plan->scale)
        status = NT_E_NO_CONVERGENCE;
    return status;
}

nt_status nt_plan_deform_compose(nt_plan *plan, const nt_scene *scene, double work_of_adhesion)
{
    nt_deform_join(plan, &plan->deformation);
    if (adheres(plan))
        return nt_plan_deform_contact(plan, scene, work_of_adhesion);
    nt_deform_facts(plan, scene->range.maximum_load);
    return NT_OK;
}

/* The table is there: contact, facts and words. Errors of it, and of all that is in no table, as shares of the demand.
 */
static nt_status compose(nt_plan *plan, const nt_scene *scene, double of_table, double others, nt_problem *problem)
{
    const double budget = plan->demand.budget;
    nt_deform_join(plan, &plan->deformation);
    if (adheres(plan))
        return nt_plan_deform_adhere(plan, scene, of_table, others, problem);
    describe(plan, of_table + others);
    if (budget > 0.0 && plan->cost > budget * NT_BUDGET_ROUNDS)
        return nt_problem_refuse(problem, nt_demand_budget(budget, plan->cost));
    nt_deform_facts(plan, scene->range.maximum_load);
    return NT_OK;
}

/* A jump, or a pressure that no mesh resolves: a stiffer sample would not deform. */
static nt_status refuse_modulus(const nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    const double E = scene->sample.youngs_modulus;
    const double stiffer = E * plan->elastic_number / fmax(plan->accuracy, FINEST);
    return nt_problem_refuse(problem,
                             nt_problem_of("sample.youngs_modulus", "Pa", E, fmin(fmax(stiffer, E), 1e13), 1e13));
}

/* The finest tolerance that was measured: where a law ends, as a brush, the mesh only nearly knows where. */
static double finest_of(const nt_plan *plan, const nt_scene *scene)
{
    const nt_deform_terms in = {plan, adheres(plan) ? 0.0 : nt_elastic_hold(plan), 0};
    const nt_deform_sample sample = nt_deform_sample_of(&in, scene, NT_DEFORM_FARTHEST);
    const double finest = sample.end_count > 0 ? ENDED * FINEST : FINEST;
    return plan->quantity == NT_QUANTITY_STIFFNESS ? FLAT * FINEST : finest;
}

/* Of the folds: where the surface jumps is known to a distance. */
static double error_of_folds(const nt_plan *plan, const nt_deform_wanted *of)
{
    if (of->quantity != NT_QUANTITY_FOLDS || !plan->deformation.jumps)
        return 0.0;
    return plan->deformation.jump_error / plan->scale;
}

/* Of a plan over relief: its places, too. */
static void take_worst(nt_plan *plan, const nt_deform_worst *worst)
{
    plan->deformation.jump_error += worst->moved;
    plan->largest_pull_off_force = fmax(plan->largest_pull_off_force, worst->pull_off_force);
    plan->minimum_spring = fmax(plan->minimum_spring, worst->minimum_spring);
    plan->maximum_stiffness = fmax(plan->maximum_stiffness, worst->maximum_stiffness);
}

/* With one tolerance, from a plan that has no table yet; `error`: of all that is in no table, as a share of the demand.
 */
static nt_status deform_within(const nt_plan *plan, const nt_scene *scene, const nt_deform_wanted *of, double error,
                               nt_plan *made, nt_problem *problem)
{
    nt_problem reason = {0};
    nt_deform_worst worst = {0};
    nt_plan_copy(made, plan);
    nt_status status = nt_plan_deform_table(made, scene, of);
    const double most = BETWEEN / (1.0 - BETWEEN) * PARTS * of->tolerance;
    if (status == NT_OK && takes_relief(made))
        status = nt_plan_deform_over(made, scene, of, most, &worst, &reason);
    made->quantity = of->quantity; /* the tables are made */
    if (status == NT_OK)
        status = compose(made, scene, PARTS * of->tolerance + worst.error, error, &reason);
    if (status != NT_OK)
        return reason.field ? nt_problem_refuse(problem, reason) : refuse_modulus(plan, scene, problem);
    take_worst(made, &worst);
    made->bound.force_error = fmax(made->bound.force_error, error + error_of_folds(made, of));
    return NT_OK;
}

/* Tables are of forces, whatever is demanded. */
static nt_status deform(const nt_plan *plan, const nt_scene *scene, nt_deform_wanted *of, nt_plan *made,
                        nt_problem *problem)
{
    const double nearest = fmax(scene->range.minimum_gap, 0.0), demanded = plan->accuracy;
    const int felt = of->quantity == NT_QUANTITY_FORCE || of->quantity == NT_QUANTITY_STIFFNESS;
    const int surrounded = nt_plan_is_surrounded(plan, scene);
    const double others = other_errors(plan, nearest, felt) + (surrounded ? 0.0 : of->around);
    const double finest = finest_of(plan, scene);
    const double left = (demanded > 0.0 ? demanded - others : fmin(UNASKED - others, PLENTY * PARTS * finest)) / PARTS;
    const double alone = takes_relief(plan) ? 1.0 - BETWEEN : 1.0;
    const double share = alone * (adheres(plan) && !surrounded ? LEAVES : 1.0);
    of->load = NT_DEFORM_DEEPER * scene->range.maximum_load;
    of->finest = share * finest;
    of->tolerance = rung_below(share * left, of->finest);
    if (plan->radii && !(left >= finest) && others >= WORST && others - spread_of_radii(plan) < demanded)
        return nt_problem_refuse(problem, nt_deform_spread(plan->radii->maximum, plan->contact.radius,
                                                           plan->contact.radius * (1.0 + demanded)));
    if (!(left >= finest))
        return nt_problem_refuse(problem, nt_demand_accuracy(demanded, (others + PARTS * finest) * (1.0 + 1e-9)));
    const nt_status status = deform_within(plan, scene, of, others, made, problem);
    const double error = made->bound.force_error - others;
    if (status != NT_OK || !(demanded > 0.0) || others + error <= demanded)
        return status;
    of->tolerance = rung_below(of->tolerance * INSIDE * (demanded - others) / error, of->finest); /* of folds */
    return deform_within(plan, scene, of, others, made, problem);
}

nt_status nt_plan_deform(const nt_plan *plan, const nt_scene *scene, double accuracy, nt_deform_tried *tried,
                         nt_plan *made, nt_problem *problem)
{
    const double load = scene->range.maximum_load;
    nt_deform_wanted of = {.quantity = plan->quantity, .tried = tried};
    nt_status status = check(plan, scene, problem);
    if (status != NT_OK)
        return status;
    nt_plan tables;
    nt_plan_copy(&tables, plan);
    tables.accuracy = accuracy;
    of.around = adheres(plan) ? nt_plan_around_error(plan, 0) : 0.0;
    if (of.quantity == NT_QUANTITY_RADIUS)
        of.radius_scale = plan->scale;
    if (of.quantity != NT_QUANTITY_STIFFNESS) {
        tables.quantity = NT_QUANTITY_FORCE;
        tables.scale = nt_plan_scale_of(&tables, load);
    }
    status = deform(&tables, scene, &of, made, problem);
    made->accuracy = plan->accuracy;
    if (status == NT_OK && of.quantity == NT_QUANTITY_RADIUS)
        made->scale = of.radius_scale;
    if (status == NT_OK && of.quantity == NT_QUANTITY_FOLDS)
        made->scale = nt_plan_scale_of(made, load);
    return status;
}
