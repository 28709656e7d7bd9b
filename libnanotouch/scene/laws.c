/* SPDX-License-Identifier: BSD-3-Clause
 * The terms of a scene beside contact: their parameters, their forms, and the largest they can be.
 *
 * The van der Waals tail and the adhesion in contact are the same surface forces (erratum E5b). The tail keeps its
 * value inside the gap where adhesion takes hold, and what it pulls there is taken out of w: together they pull 2 pi R
 * w in the rigid limit, both are potentials, and there is no seam. */
#include <math.h>

#include "scene/parts.h"

/* Cone and punch have no gap over which a tail could act: their w stands for all of it. */
static int has_tail(const nt_plan *plan)
{
    return plan->shape.kind != NT_SHAPE_CONE && plan->shape.kind != NT_SHAPE_PUNCH;
}

static void vdw_of(nt_plan *plan, const nt_scene *scene)
{
    const double distance = scene->adhesion.equilibrium_distance;
    const double hamaker = has_tail(plan) ? scene->adhesion.hamaker_constant : 0.0;
    /* the gap is measured between atoms in contact, z0 apart, and between the means of rough surfaces */
    const double roughness = scene->sample.roughness + 2.0 * distance;
    const double hold = fmax(plan->capture_gap, 1e-12);
    plan->laws.vdw = (nt_vdw){scene->tip.radius, hamaker, roughness, hold};
    plan->laws.angle = nt_tip_angle_of(scene->tip.half_angle);
    plan->laws.vdw_tip =
        (nt_vdw_tip){scene->tip.radius, hamaker, scene->tip.half_angle, scene->tip.height, roughness, hold};
}

static void charges_of(nt_plan *plan, const nt_scene *scene)
{
    const double R = scene->tip.radius, hold = scene->adhesion.equilibrium_distance;
    const double potential = nt_scene_potential(scene);
    plan->laws.electrostatic = (nt_electrostatic){R, potential, hold};
    plan->laws.electrostatic_tip = (nt_electrostatic_tip){R, scene->tip.half_angle, scene->tip.height, potential, hold};
    const int felt = scene->tip.conducting != 0.0 && scene->medium.kind != NT_MEDIUM_LIQUID;
    plan->laws.charge = (nt_point_charge){R, felt ? scene->sample.charge : 0.0, hold};
}

/* psi of a surface: as given, or linear in the pH near the isoelectric point. */
static double potential_of(const nt_medium *medium, double given, double isoelectric_point)
{
    return medium->ph > 0.0 ? medium->potential_per_ph * (isoelectric_point - medium->ph) : given;
}

static void liquid_of(nt_plan *plan, const nt_scene *scene)
{
    const nt_medium *medium = &scene->medium;
    const double R = scene->tip.radius, hold = scene->adhesion.equilibrium_distance;
    const int wet = medium->kind == NT_MEDIUM_LIQUID;
    const int ions = wet && medium->ionic_strength > 0.0;
    const double tip = potential_of(medium, scene->tip.surface_potential, scene->tip.isoelectric_point);
    const double sample = potential_of(medium, scene->sample.surface_potential, scene->sample.isoelectric_point);
    plan->laws.double_layer = (nt_double_layer){
        .radius = R,
        .debye_length =
            ions ? nt_debye_length(medium->ionic_strength, medium->relative_permittivity, medium->temperature) : 1e-9,
        .relative_permittivity = medium->relative_permittivity,
        .tip_potential = ions ? tip : 0.0,
        .sample_potential = ions ? sample : 0.0,
        .minimum_gap = hold};
    plan->laws.hydration = (nt_hydration){.radius = R,
                                          .amplitude = wet ? medium->hydration_energy : 0.0,
                                          .decay_length = medium->hydration_length,
                                          .second_decay_length = medium->hydration_length,
                                          .minimum_gap = hold};
    plan->laws.steric = (nt_steric){.radius = R,
                                    .thickness = medium->brush_thickness,
                                    .spacing = medium->brush_spacing,
                                    .temperature = medium->temperature,
                                    .minimum_gap = hold};
    plan->laws.steric.thickness = wet && medium->brush_thickness > hold ? medium->brush_thickness : 0.0;
}

nt_form nt_plan_full_form(const nt_plan *plan, int term)
{
    const nt_plan_laws *laws = &plan->laws;
    const int cone = laws->vdw_tip.height > 0.0;
    switch (term) {
    case NT_PLAN_VDW:
        return laws->vdw.hamaker_constant == 0.0 ? NT_FORM_OFF : cone ? NT_FORM_TIP : NT_FORM_SPHERE;
    case NT_PLAN_ELECTROSTATIC:
        return laws->electrostatic.potential == 0.0 ? NT_FORM_OFF : cone ? NT_FORM_TIP : NT_FORM_SPHERE;
    case NT_PLAN_CHARGE:
        return laws->charge.charge == 0.0 ? NT_FORM_OFF : NT_FORM_ON;
    case NT_PLAN_DOUBLE_LAYER:
        return laws->double_layer.tip_potential == 0.0 && laws->double_layer.sample_potential == 0.0 ? NT_FORM_OFF
                                                                                                     : NT_FORM_ON;
    case NT_PLAN_HYDRATION:
        return laws->hydration.amplitude == 0.0 ? NT_FORM_OFF : NT_FORM_ON;
    case NT_PLAN_STERIC:
        return laws->steric.thickness == 0.0 ? NT_FORM_OFF : NT_FORM_ON;
    default:
        return NT_FORM_OFF;
    }
}

nt_law_value nt_plan_law_eval(const nt_plan *plan, int term, nt_form form, double gap)
{
    const nt_plan_laws *laws = &plan->laws;
    const nt_law_value none = {0.0, 0.0, 0.0, 0.0};
    if (form == NT_FORM_OFF)
        return none;
    switch (term) {
    case NT_PLAN_VDW:
        return form == NT_FORM_TIP      ? nt_vdw_tip_eval_with(&laws->vdw_tip, &laws->angle, gap)
               : form == NT_FORM_SPHERE ? nt_vdw_eval(&laws->vdw, gap)
                                        : nt_vdw_derjaguin_eval(&laws->vdw, gap);
    case NT_PLAN_ELECTROSTATIC:
        return form == NT_FORM_TIP ? nt_electrostatic_tip_eval_with(&laws->electrostatic_tip, &laws->angle, gap)
                                   : nt_electrostatic_eval(&laws->electrostatic, gap);
    case NT_PLAN_CHARGE:
        return nt_point_charge_eval(&laws->charge, gap);
    case NT_PLAN_DOUBLE_LAYER:
        return nt_double_layer_potential_eval(&laws->double_layer, gap);
    case NT_PLAN_HYDRATION:
        return nt_hydration_eval(&laws->hydration, gap);
    case NT_PLAN_STERIC:
        return nt_steric_eval(&laws->steric, gap);
    default:
        return none;
    }
}

/* The gap below which a term keeps its value. */
static double hold_of(const nt_plan *plan, int term)
{
    return term == NT_PLAN_VDW ? plan->laws.vdw.minimum_gap : plan->laws.electrostatic.minimum_gap;
}

double nt_plan_law_limit(const nt_plan *plan, int term, double gap, nt_quantity quantity)
{
    if (quantity != NT_QUANTITY_FORCE && quantity != NT_QUANTITY_STIFFNESS)
        return 0.0; /* no term but contact has a radius; folds under grips are those of contact */
    const nt_form form = nt_plan_full_form(plan, term);
    const double nearest = fmax(gap, hold_of(plan, term) * (1.0 + 1e-12)); /* the steepest is just outside the hold */
    nt_law_value value = nt_plan_law_eval(plan, term, form, nearest);
    if (term == NT_PLAN_DOUBLE_LAYER) { /* attraction and repulsion both fall with the gap, their difference need not:
                                           of opposite potentials both attract */
        nt_double_layer apart = plan->laws.double_layer;
        apart.tip_potential = fabs(apart.tip_potential);
        apart.sample_potential = -fabs(apart.sample_potential);
        value = nt_double_layer_potential_eval(&apart, nearest);
    }
    return fabs(quantity == NT_QUANTITY_FORCE ? value.F : value.k);
}

double nt_plan_tail_share(const nt_plan *plan)
{
    if (plan->source == NT_ADHESION_NONE)
        return 0.0;
    const nt_law_value held = nt_plan_law_eval(plan, NT_PLAN_VDW, nt_plan_full_form(plan, NT_PLAN_VDW), 0.0);
    return -held.F / (2.0 * NT_PI * plan->contact.radius);
}

nt_status nt_plan_laws_of(nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    vdw_of(plan, scene);
    charges_of(plan, scene);
    liquid_of(plan, scene);
    const double share = nt_plan_tail_share(plan), w = plan->contact.work_of_adhesion;
    if (!(share > 0.0))
        return NT_OK;
    if (share >= w) { /* the tail alone would pull more than all the adhesion there is */
        if (problem)
            *problem = (nt_problem){"adhesion.hamaker_constant", "J", scene->adhesion.hamaker_constant, 0.0,
                                    scene->adhesion.hamaker_constant * w / share};
        return NT_E_RANGE;
    }
    const double range = w / plan->contact.cohesive_stress; /* h0 stays */
    plan->contact.work_of_adhesion = w - share;
    plan->contact.cohesive_stress = plan->contact.work_of_adhesion / range;
    return NT_OK;
}
