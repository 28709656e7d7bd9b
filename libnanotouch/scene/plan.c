/* SPDX-License-Identifier: BSD-3-Clause
 * From a scene and a demand to what has to be computed: the steps of parts.h in their order. */
#include "nanotouch/plan.h"

#include <math.h>
#include <string.h>

#include "scene/deformation/deform.h"
#include "scene/terms/term.h"

#define STIFF 0.1       /* elastic number of samples that may count as rigid */
#define WORST 0.5       /* an error that is no bound any more: the largest that can be demanded */
#define UNASKED 0.01    /* without a demand the sample is rigid up to this error */
#define STRICTEST 1e-12 /* demand */
#define COARSER 2.0     /* a table, where no finer one was found */

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
        plan->demand.quantity == NT_QUANTITY_STIFFNESS) /* k ~ 1/sqrt */
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
        *problem = (nt_problem){"tip.shape (adhesion on a surface with properties)", shape->unit, scene->tip.shape,
                                NT_SHAPE_PARABOLOID, NT_SHAPE_SPHERE};
    return NT_E_RANGE;
}

nt_status nt_plan_begin(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem)
{
    static const nt_plan empty = {.surface = NULL};
    const nt_demand demand = inputs->demand ? *inputs->demand : nt_demand_defaults();
    nt_status status = check(inputs, &demand, problem);
    if (status != NT_OK)
        return status;
    *plan = empty;
    plan->demand = demand;
    plan->surface = inputs->surface;
    plan->radii = inputs->radii;
    plan->properties = inputs->properties;
    plan->relief.room = inputs->room;
    plan->ratio = 1.0;
    plan->probe_noise = inputs->probe ? nt_probe_force_noise(inputs->probe) : 0.0;
    const nt_scene scene = nt_plan_scene_over(inputs->scene, inputs->properties);
    status = nt_plan_check_distance(&scene, problem);
    if (status == NT_OK)
        status = nt_plan_tabulate(plan, &scene, problem);
    if (status == NT_OK)
        status = nt_plan_adhere(plan, &scene, problem);
    return status == NT_OK ? check_shape(plan, &scene, problem) : status;
}

/* Nothing but a contact of its own is computed, and what is not cannot be felt. */
static int is_alone(const nt_plan *plan)
{
    const nt_quantity quantity = plan->demand.quantity;
    const int felt = quantity == NT_QUANTITY_FORCE || quantity == NT_QUANTITY_STIFFNESS;
    return felt && plan->on_count == 0 && plan->source == NT_ADHESION_NONE;
}

/* Laws that are not computed press the surface away all the same, so that a contact alone is too stiff. 0: it keeps to
 * the demand, of which this is a part from here on. */
static int add_press(nt_plan *plan)
{
    const double error = plan->bound.force_error + nt_plan_press_error(plan);
    if (error > plan->demand.relative_accuracy)
        return 1;
    plan->bound.force_error = error;
    return 0;
}

/* With the error of terms that add on the undeformed gap: inside the demand, or beside it. */
static nt_status choose_rigid(nt_plan *plan, const nt_plan_options *options, int inside, nt_problem *problem)
{
    const double demanded = plan->demand.relative_accuracy, rigid = fmax(plan->rigid_error, plan->around_error);
    if (inside && demanded > 0.0 && rigid >= demanded)
        return NT_E_RANGE;
    plan->demand.relative_accuracy = inside && demanded > 0.0 ? demanded - rigid : demanded;
    const nt_status status = nt_plan_choose(plan, options, problem);
    plan->demand.relative_accuracy = demanded;
    if (status != NT_OK)
        return status;
    if (is_alone(plan) && add_press(plan) == 0)
        return NT_OK;
    plan->bound.force_error += rigid; /* a tail that was left out, too, pulls by so much more */
    return NT_OK;
}

/* What no table was made for adds on the undeformed gap, with an error of force or stiffness beyond the demand that is
 * part of the bound and that the plan warns of: over a surface with properties; with adhesion, if the sample is stiff;
 * without, where something pulls. A demand of 0 takes whatever that errs by, with no bound where the surface jumps. */
static int is_left(const nt_plan *plan, double maximum_load)
{
    const double scale = nt_plan_force_scale(plan, maximum_load);
    if (!(plan->demand.relative_accuracy > 0.0))
        return 1;
    const double errs = fmax(plan->rigid_error, plan->around_error);
    if (isinf(errs))
        return 0;
    if (plan->source == NT_ADHESION_NONE && !plan->properties)
        return plan->pull_off_force > UNASKED * scale;
    if (plan->properties || errs > WORST)
        return errs <= WORST;
    return plan->elastic_number <= STIFF || plan->rigid_error <= plan->demand.relative_accuracy;
}

/* Where no table keeps to the demand: the finest that does better than terms on the undeformed gap. What is the same
 * for every demand is tried in the same order, so that a stricter demand has no looser bound. */
static nt_status deform_at_best(nt_plan *plan, const nt_scene *scene, nt_deform_tried *tried)
{
    const double demanded = plan->demand.relative_accuracy, errs = fmax(plan->rigid_error, plan->around_error);
    nt_problem least = {0};
    if (!(demanded > 0.0) || plan->properties)
        return NT_E_RANGE;
    plan->demand.relative_accuracy = STRICTEST;
    nt_status status = nt_plan_deform(plan, scene, tried, &least);
    double wanted = nt_problem_names(&least, NT_DEMANDED) ? least.minimum : (double)INFINITY;
    for (int i = 0; i < TRIES && status != NT_OK && wanted < errs; ++i) {
        plan->demand.relative_accuracy = wanted;
        status = nt_plan_deform(plan, scene, tried, NULL);
        wanted *= COARSER;
    }
    plan->demand.relative_accuracy = demanded;
    return status;
}

/* As it was before a sample was to deform. */
static nt_status undeform(nt_plan *plan, const nt_scene *scene, nt_plan_options *options, nt_problem *problem)
{
    const nt_status status = nt_plan_adhere(plan, scene, problem);
    nt_plan_options_of(plan, scene, options);
    return status;
}

/* The cheapest plan whose terms add on the undeformed gap, with what that errs by in its bound; if it errs by too much,
 * the sample deforms. A demand of 0 asks for every law in full. */
static nt_status choose(nt_plan *plan, const nt_scene *scene, nt_deform_tried *tried, nt_problem *problem)
{
    const int adheres = plan->source != NT_ADHESION_NONE;
    nt_plan_options options;
    nt_plan_options_of(plan, scene, &options);
    const double demanded = plan->demand.relative_accuracy;
    nt_status status = nt_plan_choose(plan, &options, problem);
    plan->rigid_error = nt_plan_rigid_error(plan, scene);
    const int alone = status == NT_OK && is_alone(plan) && add_press(plan) == 0;
    if ((plan->rigid_error == 0.0 && plan->around_error == 0.0) || alone)
        return status;
    const double errs = fmax(plan->rigid_error, plan->around_error);
    if ((demanded > 0.0 || errs <= UNASKED) && choose_rigid(plan, &options, 1, NULL) == NT_OK)
        return NT_OK;
    nt_problem reason = {0};
    if (!plan->properties && nt_plan_deform(plan, scene, tried, &reason) == NT_OK)
        return NT_OK;
    if (problem)
        *problem = reason;
    status = adheres ? undeform(plan, scene, &options, problem) : NT_OK;
    if (!is_left(plan, scene->range.maximum_load))
        return nt_plan_refuse(plan, &options, problem);
    if (status == NT_OK)
        status = choose_rigid(plan, &options, 0, problem); /* a demand or a budget that nothing keeps is refused */
    if (status != NT_OK || deform_at_best(plan, scene, tried) == NT_OK)
        return status;
    status = adheres ? undeform(plan, scene, &options, problem) : NT_OK;
    return status == NT_OK ? choose_rigid(plan, &options, 0, problem) : status;
}

/* From a plan as it was begun. */
static nt_status decide(nt_plan *plan, const nt_plan_inputs *inputs, nt_deform_tried *tried, nt_problem *problem)
{
    const nt_scene scene = nt_plan_scene_over(inputs->scene, inputs->properties);
    plan->bank = inputs->bank;
    return choose(plan, &scene, tried, problem);
}

nt_status nt_plan_try(nt_plan *plan, const nt_plan_inputs *inputs, nt_deform_tried *tried, nt_problem *problem)
{
    const nt_status status = nt_plan_begin(plan, inputs, problem);
    return status == NT_OK ? decide(plan, inputs, tried, problem) : status;
}

nt_status nt_plan_decide(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem)
{
    nt_problem reason = {0};
    const nt_scene scene = nt_plan_scene_over(inputs->scene, inputs->properties);
    nt_deform_tried tried = {.count = 0};
    nt_status status = decide(plan, inputs, &tried, &reason);
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
    if (status != NT_OK)
        return status;
    finish(plan, scene.range.maximum_load);
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
