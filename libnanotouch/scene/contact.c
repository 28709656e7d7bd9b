/* SPDX-License-Identifier: BSD-3-Clause
 * The contact of a scene: which laws can stand for it, made ready, and where adhesion takes hold and lets go.
 *
 * Paraboloid, sphere and cap with adhesion are Maugis-Dugdale's paraboloid; cone and punch with adhesion are JKR's, of
 * no range; without adhesion every shape has its own law. */
#include <math.h>
#include <stddef.h>

#include "contact/hertz.h"
#include "contact/maugis_table.h"
#include "internal/contact.h"
#include "internal/geometry.h"
#include "internal/maugis.h"
#include "scene/parts.h"
#include "scene/scene.h"

static int is_jkr_shape(const nt_plan *plan)
{
    return plan->shape.kind == NT_SHAPE_CONE || plan->shape.kind == NT_SHAPE_PUNCH;
}

nt_form nt_plan_contact_form(const nt_plan *plan)
{
    if (plan->source == NT_ADHESION_NONE)
        return NT_FORM_SHAPE;
    return is_jkr_shape(plan) ? NT_FORM_JKR : NT_FORM_EXACT;
}

nt_form nt_plan_contact_truth(const nt_plan *plan)
{
    const nt_form form = nt_plan_contact_form(plan);
    return form == NT_FORM_EXACT ? NT_FORM_POLISHED : form; /* as true, and ten times faster */
}

double nt_plan_contact_pull_off(const nt_plan *plan)
{
    const nt_form form = nt_plan_contact_form(plan);
    return form == NT_FORM_EXACT ? nt_maugis_pull_off_force(&plan->maugis)
           : form == NT_FORM_JKR ? nt_jkr_shape_pull_off_force(&plan->jkr)
                                 : 0.0;
}

void nt_plan_contact_of(nt_plan *plan, const nt_scene *scene, double work_of_adhesion)
{
    plan->source = nt_scene_adhesion_source(scene);
    plan->shape = nt_scene_shape(scene);
    plan->contact = nt_scene_contact(scene, work_of_adhesion);
    plan->contact.radius *= plan->ratio;
    nt_plan_take_properties(plan, scene);
    const double range =
        plan->source == NT_ADHESION_NONE ? 0.0 : plan->contact.work_of_adhesion / plan->contact.cohesive_stress;
    plan->capture_gap = range; /* where attraction begins; a bridge, where the films touch */
    if (plan->source == NT_ADHESION_MENISCUS)
        plan->capture_gap = fmin(2.0 * scene->medium.film_thickness, range);
    if (is_jkr_shape(plan))
        plan->capture_gap = 0.0;
}

static const nt_law_value nowhere = {NAN, NAN, NAN, NAN};

/* All NaN where a law with a fold has no contact. */
static nt_law_value adhesive_eval(const nt_plan *plan, nt_form form, double indentation)
{
    nt_law_value value = nowhere;
    if (form == NT_FORM_JKR)
        (void)nt_jkr_shape_eval(&plan->jkr, indentation, NT_BRANCH_STABLE, &value);
    else if (form == NT_FORM_EXACT)
        (void)nt_maugis_eval(&plan->maugis, indentation, NT_BRANCH_STABLE, &value, NULL);
    else
        (void)nt_maugis_table_eval(&plan->table, form == NT_FORM_POLISHED ? NT_TIER_POLISHED : NT_TIER_TABLE,
                                   indentation, NT_BRANCH_STABLE, &value);
    return value;
}

/* With no default: a form without its case does not compile. */
nt_law_value nt_plan_contact_eval(const nt_plan *plan, nt_form form, double indentation)
{
    switch (form) {
    case NT_FORM_PARABOLOID:
        return nt_hertz_eval(&plan->contact, indentation);
    case NT_FORM_SERIES:
        return nt_sphere_series_eval(plan->shape.radius, plan->contact.effective_modulus, indentation);
    case NT_FORM_SHAPE:
        return nt_shape_law(&plan->shape, plan->contact.effective_modulus, indentation);
    case NT_FORM_DEFORMED: /* is in the table, with all that acts around it */
        return (nt_law_value){0.0, 0.0, 0.0, 0.0};
    case NT_FORM_JKR:
    case NT_FORM_TABLE:
    case NT_FORM_POLISHED:
    case NT_FORM_EXACT:
        return adhesive_eval(plan, form, indentation);
    case NT_FORM_OFF: /* not of contact; of places: nt_plan_local_eval */
    case NT_FORM_ON:
    case NT_FORM_DERJAGUIN:
    case NT_FORM_SPHERE:
    case NT_FORM_TIP:
    case NT_FORM_LOCAL:
    case NT_FORM_LOCAL_EXACT:
        break;
    }
    return nowhere;
}

int nt_plan_has_local_form(const nt_plan *plan)
{
    const nt_form form = nt_plan_contact_form(plan);
    return form == NT_FORM_EXACT || (form == NT_FORM_SHAPE && plan->shape.kind == NT_SHAPE_PARABOLOID);
}

static const nt_maugis_bank no_tables = {.panels = NULL}; /* what it does not hold, the exact solver answers */

static const nt_maugis_bank *bank_of(const nt_plan *plan, nt_form form)
{
    return form == NT_FORM_LOCAL_EXACT ? &no_tables : plan->bank;
}

nt_bank_value nt_plan_local_eval(const nt_plan *plan, nt_form form, const nt_contact *contact, double indentation)
{
    nt_bank_value value = {{NAN, NAN, NAN, NAN}, NAN};
    if (plan->source != NT_ADHESION_NONE) {
        (void)nt_maugis_bank_eval_radius(bank_of(plan, form), contact, indentation, NT_BRANCH_STABLE, &value);
        return value;
    }
    value.law = plan->shape.kind == NT_SHAPE_PARABOLOID
                    ? nt_hertz_eval(contact, indentation)
                    : nt_shape_eval(&plan->shape, contact->effective_modulus, indentation);
    value.dU_dR = 0.5 * value.law.U / contact->radius;
    return value;
}

double nt_plan_local_release_gap(const nt_plan *plan, nt_form form, const nt_contact *contact)
{
    return plan->source == NT_ADHESION_NONE ? 0.0 : -nt_maugis_bank_grip_indentation(bank_of(plan, form), contact);
}

/* Where the contact carries `load` [m]: bracket upwards from first touch, where it cannot push, then bisect. NaN if it
 * never does. */
static double indentation_at(const nt_plan *plan, nt_form form, double load)
{
    double low = 0.0, high = nt_shape_indentation(&plan->shape, plan->contact.effective_modulus, load);
    for (int i = 0; i < 64 && nt_plan_contact_eval(plan, form, high).F < load; ++i) {
        low = high;
        high *= 2.0;
    }
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        if (nt_plan_contact_eval(plan, form, middle).F < load)
            low = middle;
        else
            high = middle;
    }
    return nt_plan_contact_eval(plan, form, high).F >= load ? high : (double)NAN;
}

/* Tables of Maugis-Dugdale up to the largest load, for those scenes that have it. */
static nt_status prepare_maugis(nt_plan *plan, double maximum_load)
{
    nt_status status = nt_maugis_init(&plan->maugis, &plan->contact);
    if (status != NT_OK)
        return status;
    plan->lambda = plan->maugis.lambda;
    plan->release_gap = -plan->maugis.folds.grip_indentation * plan->maugis.indentation_scale;
    nt_maugis_table_options options = nt_maugis_table_defaults();
    const double deepest = indentation_at(plan, NT_FORM_EXACT, maximum_load);
    options.largest_indentation = 1.01 * deepest;
    return nt_maugis_table_init(&plan->table, &plan->maugis, &options, plan->cells, NT_PLAN_CELLS);
}

nt_status nt_plan_contact_laws(nt_plan *plan, const nt_scene *scene)
{
    const double load = scene->range.maximum_load;
    nt_status status = NT_OK;
    plan->lambda = INFINITY;
    plan->jkr = (nt_jkr_shape){plan->shape, plan->contact.effective_modulus, plan->contact.work_of_adhesion};
    if (nt_plan_contact_form(plan) == NT_FORM_EXACT)
        status = prepare_maugis(plan, load);
    else if (nt_plan_contact_form(plan) == NT_FORM_JKR)
        plan->release_gap = -nt_jkr_shape_pull_off_indentation(&plan->jkr);
    if (status != NT_OK)
        return status;
    const nt_form form = nt_plan_contact_form(plan);
    const double deepest = indentation_at(plan, form, load);
    if (!isfinite(deepest))
        return NT_E_NO_CONVERGENCE;
    const nt_law_value loaded = nt_plan_contact_eval(plan, form, deepest);
    plan->largest_indentation = deepest;
    plan->maximum_stiffness = loaded.k;
    plan->length = plan->source == NT_ADHESION_NONE ? 1e-3 * plan->contact.radius
                                                    : plan->contact.work_of_adhesion / plan->contact.cohesive_stress;
    const double thickness = scene->sample.thickness > 0.0 ? scene->sample.thickness : (double)INFINITY;
    return nt_contact_validity_of(&plan->shape, loaded.a, deepest, thickness, &plan->validity);
}
