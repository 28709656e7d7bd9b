/* SPDX-License-Identifier: BSD-3-Clause
 * From a scene and a demand to what has to be computed: the steps of parts.h in their order. */
#include "internal/plan.h"
#include "nanotouch/plan.h"

#include <float.h>
#include <math.h>

#include "contact/geometry.h"
#include "core/rig.h"
#include "scene/deformation/deform.h"
#include "scene/terms/term.h"

#define STIFF 0.1       /* elastic number of samples that may count as rigid */
#define WORST 0.5       /* an error that is no bound any more: the largest that can be demanded */
#define UNASKED 0.01    /* without a demand the sample is rigid up to this error */
#define STRICTEST 1e-12 /* demand */
#define FINER 0.2       /* from one table to the next, where the best is looked for */
#define WORK 1000.0     /* of all tables that are tried: 0.15 s, where usual ones take 3 ms */
#define WORK_OF_BEST 700.0

enum { TRIES = 8 };

/* What belongs to a surface has its grid. */
static int is_of(const nt_surface *grid, const nt_surface *surface)
{
    return surface && grid->nx == surface->nx && grid->ny == surface->ny && grid->dx == surface->dx &&
           grid->dy == surface->dy;
}

static nt_status check(const nt_plan_inputs *inputs, const nt_demand *demand, nt_problem *problem)
{
    nt_status status = nt_scene_check(inputs->scene, problem);
    if (status == NT_OK)
        status = nt_demand_check(demand, problem);
    if (status == NT_OK && inputs->probe) {
        nt_rig rig = nt_rig_defaults();
        rig.probe = *inputs->probe;
        status = nt_rig_check(&rig, problem);
    }
    if (status == NT_OK)
        status = nt_plan_check_relaxation(inputs, problem);
    if (status == NT_OK && inputs->radii && !is_of(&inputs->radii->ratio, inputs->surface))
        status = NT_E_ARGUMENT;
    if (status == NT_OK && inputs->properties && !is_of(&inputs->properties->youngs_modulus, inputs->surface))
        status = NT_E_ARGUMENT;
    return status;
}

/* Numbers that belong to the plan as chosen. */
static void finish(nt_plan *plan, double maximum_load)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    plan->bound.model_error = plan->source == NT_ADHESION_NONE ? (double)NAN : nt_maugis_model_error(plan->lambda);
    if (form == NT_FORM_TABLE || form == NT_FORM_POLISHED)
        plan->bound.fold_shift = plan->table.accuracy[form == NT_FORM_TABLE ? 0 : 1].fold_shift;
    if (nt_form_is_local(form))
        nt_plan_local_facts(plan, maximum_load);
    else
        plan->bound.fold_shift += nt_plan_curvature_shift(plan);
    if (plan->deformation.count > 0 && plan->deformation.jumps)
        plan->bound.fold_shift += plan->deformation.jump_error;
    plan->bound.fold_shift += nt_plan_rigid_shift(plan);
    plan->fold_distance = nt_plan_away_from_folds(plan) + plan->bound.fold_shift + nt_plan_deform_touch(plan);
    plan->fold_distance += (NT_ELASTIC_BESIDE - 1.0) * nt_plan_rigid_shift(plan);
    if (plan->deformation.count > 0 && plan->source != NT_ADHESION_NONE)
        plan->fold_distance = fmax(plan->fold_distance, plan->deformation.beside);
    if (plan->deformation.count > 0 && plan->deformation.jumps &&
        plan->quantity == NT_QUANTITY_STIFFNESS) /* k ~ 1/sqrt */
        plan->fold_distance += plan->deformation.jump_error / plan->bound.force_error;
    if (form == NT_FORM_SHAPE && plan->source != NT_ADHESION_NONE) { /* adhesion that cannot be felt: no folds */
        plan->bound.fold_shift = fmax(plan->release_gap, plan->capture_gap);
        plan->capture_gap = plan->release_gap = plan->capture_energy = plan->release_energy = 0.0;
        plan->source = NT_ADHESION_NONE;
        plan->fold_distance = plan->bound.fold_shift;
    }
}

/* JKR's cone and punch are no law of places. */
static nt_status check_shape(const nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    int count = 0;
    const nt_field *shape = nt_scene_fields(&count); /* the first */
    if (!plan->properties || nt_plan_contact_form(plan) != NT_FORM_JKR)
        return NT_OK;
    if (problem)
        *problem =
            nt_problem_coded(NT_PROBLEM_SHAPE_OF_PROPERTIES, nt_problem_of(shape->name, shape->unit, scene->tip.shape,
                                                                           NT_SHAPE_PARABOLOID, NT_SHAPE_SPHERE));
    return NT_E_RANGE;
}

static nt_status begin(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem)
{
    static const nt_plan empty = {.surface = NULL};
    const nt_demand demand = inputs->demand ? *inputs->demand : nt_demand_defaults();
    nt_status status = check(inputs, &demand, problem);
    if (status != NT_OK)
        return status;
    *plan = empty;
    plan->demand = demand;
    plan->quantity = demand.quantity;
    plan->accuracy = demand.bound == NT_BOUND_EXACT ? 0.0 : fmax(demand.relative_accuracy, DBL_MIN);
    plan->surface = inputs->surface;
    plan->radii = inputs->radii;
    plan->properties = inputs->properties;
    plan->relief.room = inputs->room;
    plan->ratio = 1.0;
    plan->probe_noise = inputs->probe ? nt_probe_force_noise(inputs->probe) : 0.0;
    const nt_scene scene = nt_plan_scene_over(inputs);
    status = nt_plan_check_distance(&scene, problem);
    if (status == NT_OK)
        status = nt_plan_tabulate(plan, &scene, problem);
    if (status == NT_OK)
        status = nt_plan_adhere(plan, &scene, problem);
    return status == NT_OK ? check_shape(plan, &scene, problem) : status;
}

/* Of what is computed where only contact is, and what is not cannot be felt. */
static int is_of_contact(const nt_plan *plan)
{
    const int felt = plan->quantity == NT_QUANTITY_FORCE || plan->quantity == NT_QUANTITY_STIFFNESS;
    return felt && plan->source == NT_ADHESION_NONE;
}

/* What the terms err by on the undeformed gap. */
static double rigid_error(const nt_plan *plan)
{
    return fmax(plan->rigid_error, plan->around_error);
}

/* Takes the cheapest forms of laws that add on the undeformed gap, which errs by `more` beside them: inside an accuracy
 * (0: in full), or beside it. Laws that are not computed press the surface away all the same, so that a contact alone
 * is too stiff. */
static nt_status take_rigid(nt_plan *plan, const nt_plan_options *options, double accuracy, double more,
                            nt_problem *problem)
{
    nt_plan_choice choice;
    const nt_status status = nt_plan_choose(options, accuracy, plan->demand.budget, &choice, problem);
    if (status != NT_OK)
        return status;
    const double pressed = choice.error + nt_plan_press_error(plan);
    nt_plan_take(plan, options, &choice);
    plan->bound.force_error += more; /* of a tail that was left out, too */
    if (is_of_contact(plan) && nt_plan_is_alone(options, &choice) && pressed <= plan->accuracy)
        plan->bound.force_error = pressed;
    return NT_OK;
}

/* What no table was made for adds on the undeformed gap, with an error of force or stiffness beyond the demand that is
 * part of the bound and that the plan warns of: over a surface with properties; with adhesion, if the sample is stiff;
 * without, where something pulls. Who asks for everything exact, or for any bound, takes whatever that errs by, with no
 * bound where the surface jumps. */
static int is_left(const nt_plan *plan, double maximum_load)
{
    const double scale = nt_plan_force_scale(plan, maximum_load), errs = rigid_error(plan);
    if (plan->demand.bound != NT_BOUND_KEPT)
        return 1;
    if (isinf(errs))
        return 0;
    if (plan->source == NT_ADHESION_NONE && !plan->properties)
        return plan->pull_off_force > UNASKED * scale;
    if (plan->properties || errs > WORST)
        return errs <= WORST;
    return plan->elastic_number <= STIFF || plan->rigid_error <= plan->accuracy;
}

/* Where no table keeps to the demand: one that does better than terms on the undeformed gap, then finer ones while
 * there are any. That is the same for every demand, so that a stricter one has no looser bound. */
static nt_status deform_at_best(const nt_plan *plan, const nt_scene *scene, nt_deform_tried *tried, nt_plan *made)
{
    nt_problem least = {0};
    double best = 0.0, work = WORK_OF_BEST, *before = tried->work;
    (void)nt_plan_deform(plan, scene, STRICTEST, tried, made, &least);
    const double roughest = fmin(WORST, rigid_error(plan));
    if (least.code != NT_PROBLEM_ACCURACY || !(least.minimum < roughest))
        return NT_E_RANGE;
    tried->work = before ? &work : NULL;
    double more = roughest - least.minimum;
    for (int i = 0, found = 1; i < TRIES && (found || best == 0.0); ++i, more *= FINER) {
        const double wanted = least.minimum + (i + 1 < TRIES ? more : 0.0);
        found = nt_plan_deform(plan, scene, wanted, tried, made, NULL) == NT_OK;
        if (found)
            best = wanted;
    }
    tried->work = NULL; /* it is there already */
    const nt_status status = best > 0.0 ? nt_plan_deform(plan, scene, best, tried, made, NULL) : NT_E_RANGE;
    tried->work = before;
    return status;
}

/* The candidates, from facts to a choice: the cheapest forms whose laws add on the undeformed gap, with what that errs
 * by inside the demand; a sample that deforms, within the demand; and where neither keeps it, what errs by least. */
static nt_status choose(nt_plan *plan, const nt_scene *scene, nt_deform_tried *tried, nt_problem *problem)
{
    nt_plan_options options;
    nt_plan made;
    nt_problem reason = {0};
    const double demanded = plan->accuracy;
    nt_plan_options_of(plan, scene, &options);
    plan->rigid_error = nt_plan_rigid_error(plan, scene);
    const double errs = rigid_error(plan);
    nt_status status = take_rigid(plan, &options, demanded, errs, problem);
    if (errs == 0.0 || (status == NT_OK && plan->bound.force_error <= demanded))
        return status;
    if (demanded > errs || (!(demanded > 0.0) && errs <= UNASKED))
        status = take_rigid(plan, &options, fmax(demanded - errs, 0.0), errs, NULL);
    else
        status = NT_E_RANGE;
    if (status == NT_OK)
        return status;
    if (plan->properties || nt_plan_deform(plan, scene, demanded, tried, &made, &reason) != NT_OK) {
        if (!is_left(plan, scene->range.maximum_load))
            return nt_plan_refuse(plan, &options, &reason, problem);
        const double within = plan->demand.bound == NT_BOUND_KEPT ? demanded : 0.0;
        status =
            take_rigid(plan, &options, within, errs, problem); /* a demand or budget that nothing keeps is refused */
        const int is_done = status != NT_OK || plan->properties || !(demanded > 0.0);
        if (is_done || deform_at_best(plan, scene, tried, &made) != NT_OK)
            return status;
    }
    nt_plan_copy(plan, &made);
    return NT_OK;
}

/* That a plan was begun with. */
static nt_scene scene_of(const nt_plan *plan, const nt_plan_inputs *inputs)
{
    const nt_scene scene = nt_plan_scene_over(inputs);
    return plan->drops_tails ? nt_plan_scene_without_tails(&scene) : scene;
}

/* From a plan as it was begun. */
static nt_status decide(nt_plan *plan, const nt_plan_inputs *inputs, nt_deform_tried *tried, nt_problem *problem)
{
    const nt_scene scene = scene_of(plan, inputs);
    plan->bank = inputs->bank;
    return choose(plan, &scene, tried, problem);
}

/* Where no bound is asked for: an adhesion that its own tail exceeds is taken without that tail. */
static nt_status begin_without_tail(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem)
{
    nt_plan_inputs without = *inputs;
    const nt_scene scene = nt_plan_scene_without_tails(inputs->scene);
    without.scene = &scene;
    const nt_status status = begin(plan, &without, problem);
    plan->drops_tails = 1;
    return status;
}

nt_status nt_plan_try(nt_plan *plan, const nt_plan_inputs *inputs, nt_deform_tried *tried, nt_problem *problem)
{
    const nt_status status = begin(plan, inputs, problem);
    return status == NT_OK ? decide(plan, inputs, tried, problem) : status;
}

nt_status nt_plan_begin(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem)
{
    nt_problem reason = {0};
    const nt_status status = begin(plan, inputs, &reason);
    if (reason.code == NT_PROBLEM_TAIL && inputs->demand && inputs->demand->bound == NT_BOUND_ANY)
        return begin_without_tail(plan, inputs, problem);
    if (status == NT_OK || !problem)
        return status;
    *problem = reason;
    if (reason.code == NT_PROBLEM_TAIL)
        problem->remedy = nt_plan_remedy(inputs);
    return status;
}

nt_status nt_plan_decide(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem)
{
    nt_problem reason = {0};
    const nt_scene scene = scene_of(plan, inputs);
    double work = WORK;
    nt_deform_tried tried = {.work = inputs->room ? NULL : &work};
    nt_status status = decide(plan, inputs, &tried, &reason);
    tried.work = NULL;
    if (status != NT_OK) {
        if (problem)
            *problem = nt_plan_word(plan, inputs, &tried, &reason);
        return status;
    }
    status = nt_plan_dents_of(plan, &scene, problem);
    if (status == NT_OK)
        status = nt_plan_check_plastic(plan, &scene, problem);
    if (status == NT_OK)
        status = nt_plan_friction_of(plan, inputs, problem);
    if (status == NT_OK)
        status = nt_plan_relaxation_of(plan, inputs, problem);
    if (status != NT_OK)
        return status;
    finish(plan, scene.range.maximum_load);
    if (plan->drops_tails)
        plan->bound.force_error = INFINITY;
    nt_plan_warn(plan, &scene);
    nt_plan_warn_distance(plan, inputs->scene, &scene);
    return NT_OK;
}

nt_status nt_plan_make(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem)
{
    const nt_status status = nt_plan_begin(plan, inputs, problem);
    return status == NT_OK ? nt_plan_decide(plan, inputs, problem) : status;
}

void nt_plan_copy(nt_plan *copy, const nt_plan *plan)
{
    *copy = *plan;
    if (plan->table.cells)
        copy->table.cells = copy->cells;
    for (int term = 0; term < NT_PLAN_TERMS; ++term)
        if (nt_term_rows[term]->name_of) /* the plan has the name itself */
            copy->terms[term].name = copy->terms[term].title = nt_term_name_of(copy, term);
}
