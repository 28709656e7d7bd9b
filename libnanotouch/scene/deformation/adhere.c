/* SPDX-License-Identifier: BSD-3-Clause
 * A sample that deforms under the tail of its own adhesion (docs/deformation.md).
 *
 * Apart, the surface bulges towards the tip: a table that runs to the tail's own fold, where the surface jumps. In
 * contact Maugis-Dugdale has all of w, and no tail acts beside it: what w holds is not counted again. Where the tail
 * has no fold outside the range of adhesion the force goes on into contact, as with rigid bodies: there it keeps its
 * value, which is taken out of w (laws.c).
 *
 * Both branches are potentials. That of contact begins at 0 far away, but without a tail; where it would lie above the
 * fold it is counted from there, so that no jump gives out energy. */
#include <math.h>

#include "internal/contact.h"
#include "scene/deformation/deform.h"
#include "scene/terms/term.h"

#define INSIDE 0.01 /* of what a cycle can lose: at least so much is lost at either jump */
#define FELT 0.2    /* of the demand: what laws around a contact err by on the undeformed gap */
#define SOFT 0.6    /* elastic number: a dry contact that is stiffer has a tail that goes on into it, without a jump */
#define STRONGEST 0.9 /* of w: what a tail may pull of it */

static double energy_of_contact(const nt_plan *plan, double gap)
{
    return nt_plan_contact_at(plan, NULL, gap).law.U + nt_plan_rise(plan, NULL, gap);
}

/* Contact after the jump lies below it, and above what it falls to when it lets go; NT_E_RANGE where it cannot. */
static nt_status count_from_fold(nt_plan *plan)
{
    nt_deform_table *table = &plan->deformation;
    table->offset = 0.0;
    if (!table->jumps)
        return NT_OK;
    if (!(plan->release_gap > table->touch))
        return NT_E_RANGE;
    const double most = -energy_of_contact(plan, table->touch);
    const double least = -energy_of_contact(plan, nt_plan_last_hold(plan->release_gap));
    if (!(least < most))
        return NT_E_RANGE;
    const double margin = INSIDE * (most - least);
    table->offset = fmin(fmax(0.0, least + margin), most - margin);
    return NT_OK;
}

/* Whether a law that is no tail presses on the sample. */
static int has_others(const nt_plan *plan)
{
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (nt_term_rows[term]->pressure && !nt_term_rows[term]->words.tail &&
            nt_plan_full_form(plan, term) != NT_FORM_OFF)
            return 1;
    return 0;
}

/* Whether the contact with all of w lets go while it has a radius: only such a fold is found on a mesh. */
static int keeps_radius(const nt_plan *plan)
{
    nt_contact contact = plan->contact;
    nt_maugis whole;
    const double more = 1.0 + plan->tail / contact.work_of_adhesion; /* h0 stays */
    contact.work_of_adhesion *= more;
    contact.cohesive_stress *= more;
    return nt_maugis_init(&whole, &contact) == NT_OK && whole.folds.grip_in_contact;
}

int nt_plan_is_surrounded(const nt_plan *plan, const nt_scene *scene)
{
    const double demanded = plan->accuracy;
    const int solid =
        plan->source == NT_ADHESION_SOLID && (scene->medium.kind == NT_MEDIUM_LIQUID || plan->elastic_number > SOFT);
    const int known = scene->adhesion.given != NT_ADHESION_GIVEN_PULL_OFF && scene->sample.thickness == 0.0 &&
                      nt_plan_contact_form(plan) == NT_FORM_EXACT;
    const int felt = demanded > 0.0 && plan->around_error > FELT * demanded;
    return solid && known && felt && has_others(plan) && keeps_radius(plan);
}

/* Laws act from where adhesion ends, there as at the interatomic distance: inside they keep their force. Adhesion has
 * all of w, also what a tail on rigid bodies would take of it. */
nt_status nt_plan_deform_hold(nt_plan *plan, const nt_scene *scene, const nt_deform_range *range)
{
    const nt_contact *contact = &plan->contact;
    const double radius = plan->maugis.folds.zero_load_radius * plan->maugis.radius_scale;
    const double h0 = contact->work_of_adhesion / contact->cohesive_stress;
    const nt_deform_terms in = {plan, scene->adhesion.equilibrium_distance - h0, 1};
    nt_deform_sample sample = nt_deform_sample_of(&in, scene, range->farthest);
    nt_deform_range held = *range;
    sample.stress = (contact->work_of_adhesion + plan->tail) / h0;
    sample.range = h0;
    held.nearest = -INFINITY;
    return nt_deform_table_hold(&plan->deformation, &sample, &held, radius);
}

void nt_plan_hold_facts(nt_plan *plan, double maximum_load)
{
    const nt_deform_table *table = &plan->deformation;
    double low = table->release, high = table->last;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        *(nt_deform_table_held(table, middle).F < maximum_load ? &low : &high) = middle;
    }
    plan->release_gap = table->release;
    plan->largest_indentation = -high;
    plan->maximum_stiffness = nt_deform_table_held(table, high).k;
}

/* Contact and all around it are one table. */
static void take_contact(const nt_plan *plan, nt_plan_options *options, double error)
{
    options->count[NT_PLAN_CONTACT] = 0;
    nt_plan_offer(plan, options, NT_PLAN_CONTACT, NT_FORM_DEFORMED, error);
    options->option[NT_PLAN_CONTACT][0].cost += nt_plan_cost_of_place(plan, NT_FORM_DEFORMED, 0);
    options->option[NT_PLAN_CONTACT][0].latency += nt_plan_cost_of_place(plan, NT_FORM_DEFORMED, 1);
}

/* What the table of all beside it adds to an evaluation in contact [Hertz evaluations] (tests/bench/bench_plan.c). */
#define BESIDE_COST 0.35
#define BESIDE_LATENCY 0.55
#define RELIEF_COST 5.7 /* over relief */
#define RELIEF_LATENCY 4.7

/* Only forms of contact with the tip's own radius, or that of each place: all else is in the table. */
static int is_beside(const nt_plan *plan, nt_form form)
{
    if (plan->relief.count > 0)
        return nt_form_is_local(form);
    return form == NT_FORM_OFF || (nt_form_is_maugis(form) && !nt_form_is_local(form));
}

static void drop_others(const nt_plan *plan, nt_plan_options *options, double error)
{
    int count = 0;
    for (int i = 0; i < options->count[NT_PLAN_CONTACT]; ++i) {
        const nt_form form = options->option[NT_PLAN_CONTACT][i].form;
        if (!is_beside(plan, form))
            continue;
        options->option[NT_PLAN_CONTACT][count] = options->option[NT_PLAN_CONTACT][i];
        options->option[NT_PLAN_CONTACT][count].error += error;
        options->option[NT_PLAN_CONTACT][count].cost += plan->relief.count > 0 ? RELIEF_COST : BESIDE_COST;
        options->option[NT_PLAN_CONTACT][count++].latency += plan->relief.count > 0 ? RELIEF_LATENCY : BESIDE_LATENCY;
    }
    options->count[NT_PLAN_CONTACT] = count;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        options->count[term] = 1;
        options->option[term][0].form = nt_term_rows[term]->pressure ? nt_plan_full_form(plan, term) : NT_FORM_OFF;
        options->option[term][0].error = options->option[term][0].cost = options->option[term][0].latency = 0.0;
    }
}

/* A tail that pulls almost all of w leaves no contact. */
static int is_left(const nt_plan *plan)
{
    return nt_plan_deform_share(plan) <= STRONGEST * plan->contact.work_of_adhesion;
}

/* What of the strongest tail would be left. */
static nt_problem of_tail(const nt_plan *plan, const nt_scene *scene)
{
    const int tail = nt_plan_strongest_tail(plan);
    const nt_field *field = nt_scene_field(nt_term_rows[tail]->words.tail);
    const double value = nt_field_get(field, scene), w = plan->contact.work_of_adhesion;
    nt_problem problem =
        nt_problem_of(field->name, field->unit, value, 0.0, value * STRONGEST * w / nt_plan_deform_share(plan));
    problem.code = NT_PROBLEM_DEFORMED_TAIL;
    problem.cause = nt_term_rows[tail]->noun;
    return problem;
}

nt_status nt_plan_deform_contact(nt_plan *plan, const nt_scene *scene, double work_of_adhesion)
{
    if (!is_left(plan) || nt_plan_laws_at(plan, scene, work_of_adhesion, NULL) != NT_OK)
        return NT_E_RANGE;
    plan->terms[NT_PLAN_CONTACT].form = plan->deformation.holds ? NT_FORM_DEFORMED : NT_FORM_POLISHED;
    plan->deformation.share = nt_plan_deform_share(plan);
    return count_from_fold(plan);
}

nt_status nt_plan_deform_adhere(nt_plan *plan, const nt_scene *scene, double of_table, double others,
                                nt_problem *problem)
{
    nt_plan_options options;
    nt_plan_choice choice;
    if (!is_left(plan))
        return nt_problem_refuse(problem, of_tail(plan, scene));
    nt_status status = nt_plan_adhere(plan, scene, problem);
    if (status != NT_OK || plan->source == NT_ADHESION_NONE)
        return NT_E_RANGE;
    nt_plan_options_of(plan, scene, &options);
    const double error = of_table + others + nt_plan_doubt_share(plan, of_table, of_table + others);
    drop_others(plan, &options, error);
    if (plan->deformation.holds)
        take_contact(plan, &options, error);
    status = nt_plan_choose(&options, plan->accuracy, plan->demand.budget, &choice, problem);
    if (status != NT_OK)
        return status;
    nt_plan_take(plan, &options, &choice);
    status = count_from_fold(plan);
    return status == NT_OK ? nt_plan_facts(plan) : status;
}
