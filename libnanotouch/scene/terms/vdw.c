/* SPDX-License-Identifier: BSD-3-Clause
 * The van der Waals tail. It and the adhesion in contact are the same surface forces (erratum E5b): inside the gap
 * where adhesion takes hold it keeps its value, and what it pulls there is taken out of w. */
#include <math.h>

#include "forces/forces.h"
#include "scene/terms/term.h"

/* Cone and punch have no gap over which a tail could act: their w stands for all of it. */
static int has_tail(const nt_scene *scene)
{
    return scene->tip.shape != NT_SHAPE_CONE && scene->tip.shape != NT_SHAPE_PUNCH;
}

static void prepare(void *law, const nt_scene *scene, double capture_gap)
{
    const nt_tip *tip = &scene->tip;
    const double hamaker = has_tail(scene) ? scene->adhesion.hamaker_constant : 0.0;
    /* the gap is measured between atoms in contact, z0 apart, and between the means of rough surfaces */
    const double roughness = scene->sample.roughness + 2.0 * scene->adhesion.equilibrium_distance;
    const double hold = fmax(capture_gap, 1e-12);
    *(nt_vdw_term *)law = (nt_vdw_term){.sphere = {tip->radius, hamaker, roughness, hold},
                                        .tip = {tip->radius, hamaker, tip->half_angle, tip->height, roughness, hold},
                                        .angle = nt_tip_angle_of(tip->half_angle)};
}

static nt_form full_form(const void *law)
{
    const nt_vdw_term *vdw = law;
    return vdw->sphere.hamaker_constant == 0.0 ? NT_FORM_OFF : vdw->tip.height > 0.0 ? NT_FORM_TIP : NT_FORM_SPHERE;
}

static nt_law_value eval(const void *law, nt_form form, double gap)
{
    const nt_vdw_term *vdw = law;
    return form == NT_FORM_TIP      ? nt_vdw_tip_eval_with(&vdw->tip, &vdw->angle, gap)
           : form == NT_FORM_SPHERE ? nt_vdw_eval(&vdw->sphere, gap)
                                    : nt_vdw_derjaguin_eval(&vdw->sphere, gap);
}

static double hold(const void *law)
{
    return ((const nt_vdw_term *)law)->sphere.minimum_gap;
}

/* W = -H/(12 pi s^2), s between the atoms' planes. */
static nt_pressure pressure(const void *law, double gap)
{
    const nt_vdw *vdw = &((const nt_vdw_term *)law)->sphere;
    const double s = gap + 0.5 * vdw->roughness, W = -vdw->hamaker_constant / (12.0 * NT_PI * s * s);
    return (nt_pressure){W, 2.0 * W / s, -6.0 * W / (s * s)};
}

/* Without adhesion there is no w to stand for it. The larger of cone and punch: H tan^2 psi/(6 s), H R^2/(6 s^3). */
static void warn(nt_plan *plan, const nt_scene *scene)
{
    const nt_quantity quantity = plan->quantity;
    const int felt = quantity == NT_QUANTITY_FORCE || quantity == NT_QUANTITY_STIFFNESS;
    if (has_tail(scene) || plan->source != NT_ADHESION_NONE || !felt)
        return;
    const double s = scene->adhesion.equilibrium_distance + 0.5 * scene->sample.roughness,
                 H = scene->adhesion.hamaker_constant;
    const double t = tan(scene->tip.half_angle), R = scene->tip.radius;
    const double force = scene->tip.shape == NT_SHAPE_CONE ? H * t * t / (6.0 * s) : H * R * R / (6.0 * s * s * s);
    const double least = plan->accuracy * nt_plan_force_scale(plan, scene->range.maximum_load);
    if (force > least)
        nt_plan_add_warning(plan, (nt_plan_warning){"van der Waals force of this shape, left out: it has no law here",
                                                    "N", force, least});
}

static const nt_term_form forms[] = {
    {NT_FORM_DERJAGUIN, 0.15, 0.15, "in Derjaguin's form"},
    {NT_FORM_SPHERE, 0.3, 0.25, "of the sphere"},
    {NT_FORM_TIP, 0.85, 0.7, "of the whole tip"},
};

NT_TERM_BESIDE(vdw, prepare, full_form, eval, hold, pressure,
               .words = {"vdw", "van der Waals", "Hamaker's sum over sphere, or sphere and cone, and a flat",
                         "adhesion.hamaker_constant", forms, 3, 1},
               .warn = warn, .noun = "van der Waals");
