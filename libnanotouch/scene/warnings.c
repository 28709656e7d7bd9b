/* SPDX-License-Identifier: BSD-3-Clause
 * What a plan's bound does not cover: where a law is used outside its validity, and what is no part of the potential.
 */
#include <math.h>
#include <stddef.h>

#include "scene/terms/term.h"

void nt_plan_add_warning(nt_plan *plan, nt_plan_warning warning)
{
    if (plan->warning_count < NT_PLAN_WARNINGS_MAX)
        plan->warnings[plan->warning_count++] = warning;
}

/* A modulus below that of any solid, most often one in GPa under a key in Pa. No solid is stiffer than diamond's 1220
 * GPa, so such a slip stays below 2000; the softest gels that stand in air have some 3 kPa (Style et al., Nat. Commun.
 * 4 (2013) 2728). In a liquid samples go down to tens of Pa; tips do not. */
#define SOFTEST_SOLID 2e3 /* [Pa] */

static void check_moduli(nt_plan *plan, const nt_scene *scene)
{
    const double tip = scene->tip.youngs_modulus, sample = scene->sample.youngs_modulus;
    if (tip < SOFTEST_SOLID)
        nt_plan_add_warning(plan, (nt_plan_warning){"Young's modulus of the tip, softer than any tip, perhaps meant in "
                                                    "GPa",
                                                    "Pa", tip, SOFTEST_SOLID});
    if (sample < SOFTEST_SOLID && scene->medium.kind != NT_MEDIUM_LIQUID)
        nt_plan_add_warning(plan, (nt_plan_warning){"Young's modulus of the sample, softer than any solid outside a "
                                                    "liquid, perhaps meant in GPa",
                                                    "Pa", sample, SOFTEST_SOLID});
}

/* What the scene gives and nothing takes up; values that defaults have are not told. */
static void check_facts(nt_plan *plan, const nt_scene *scene, int term)
{
    nt_term_fact facts[NT_TERM_FACTS_MAX];
    const int count = nt_term_rows[term]->facts ? nt_term_rows[term]->facts(scene, facts) : 0;
    for (int i = 0; i < count; ++i)
        if (!facts[i].used && facts[i].value != 0.0)
            nt_plan_add_warning(plan, (nt_plan_warning){facts[i].text, facts[i].unit, facts[i].value, NAN});
}

/* Squeeze drag of a sphere, 6 pi eta R^2 v/h, at the closest that is not contact: a loss, no part of the potential. */
static void check_drag(nt_plan *plan, const nt_scene *scene)
{
    const double R = plan->contact.radius, h = fmax(scene->range.minimum_gap, scene->adhesion.equilibrium_distance);
    const double drag = 6.0 * NT_PI * scene->range.viscosity * R * R * scene->range.speed / h;
    const double scale = plan->quantity == NT_QUANTITY_FORCE ? plan->scale : plan->pull_off_force;
    const double felt = fmax(plan->demand.force_floor, plan->accuracy * scale);
    if (drag > felt)
        nt_plan_add_warning(plan, (nt_plan_warning){"viscous drag at the fastest approach, left out", "N", drag, felt});
}

#define UNRESOLVED 0.05 /* of the pixels: edges of steps, of which any map with steps has some */

static void check_surface(nt_plan *plan)
{
    if (plan->radii && !nt_plan_has_local_form(plan))
        nt_plan_add_warning(
            plan, (nt_plan_warning){"curvature of the surface, which this tip's law does not know: least radius", "m",
                                    plan->radii->minimum, plan->contact.radius});
    if (!plan->radii)
        return;
    const double share = (double)plan->radii->limited / ((double)plan->radii->ratio.nx * (double)plan->radii->ratio.ny);
    if (share > UNRESOLVED)
        nt_plan_add_warning(plan, (nt_plan_warning){"share of pixels whose curvature is beyond what the map resolves",
                                                    "", share, UNRESOLVED});
}

#define ROUNDED (1.0 + 1e-9)
#define SPHERE 0.1 /* over delta/R: what the force of a sphere lacks of its paraboloid's */

/* A layer in contact is solved together with its deformation; Hertz' contact and one with adhesion are those of a
 * half-space. Two terms of Dimitriadis et al. (2002), bonded, say by how much more force the layer takes. */
static void check_layer(nt_plan *plan, const nt_scene *scene)
{
    const double nu = scene->sample.poisson_ratio, chi = plan->validity.thickness_ratio;
    const double alpha = 2.0 / NT_PI * (1.2876 - 1.4678 * nu + 1.3442 * nu * nu) / (1.0 - nu) * chi;
    const double more = alpha + alpha * alpha, demanded = plan->accuracy;
    if (scene->sample.thickness > 0.0 && !nt_plan_solves_layer(plan) && more > demanded)
        nt_plan_add_warning(
            plan,
            (nt_plan_warning){"layer taken for a half-space in contact; the force of the layer is larger by about", "",
                              more, demanded});
}

/* A sample that deforms has a paraboloid before it. With adhesion, or where something pulls, the terms beside contact
 * may add on the undeformed gap though that errs by more than is demanded: it is part of the bound. */
static void check_deformed(nt_plan *plan)
{
    const double demanded = plan->accuracy;
    const double flatter = SPHERE * plan->largest_indentation / plan->contact.radius;
    if (plan->deformation.count > 0 && plan->shape.kind == NT_SHAPE_SPHERE && flatter > demanded)
        nt_plan_add_warning(
            plan, (nt_plan_warning){"sphere taken for a paraboloid, whose force is larger by", "", flatter, demanded});
    if (plan->deformation.count > 0 && demanded > 0.0 && plan->bound.force_error > demanded * ROUNDED)
        nt_plan_add_warning(plan,
                            (nt_plan_warning){"error of a sample that deforms, more than demanded: no finer table "
                                              "of it is made",
                                              "", plan->bound.force_error, demanded});
    if (plan->drops_tails)
        nt_plan_add_warning(plan, (nt_plan_warning){"long-range adhesion left out, which alone exceeds the work of "
                                                    "adhesion, so that no bound is known: w",
                                                    "J/m^2", plan->contact.work_of_adhesion, NAN});
    const double rigid = fmax(plan->rigid_error, plan->around_error);
    const int left = plan->deformation.count == 0 && rigid > 0.0 && plan->bound.force_error >= rigid;
    if (left && isinf(rigid)) /* beyond a jump no error is known */
        nt_plan_add_warning(plan,
                            (nt_plan_warning){"sample jumps to the tip before contact, so that no bound is known: "
                                              "elastic number",
                                              "", plan->elastic_number, NT_ELASTIC_JUMP});
    else if (left && plan->bound.force_error > (demanded > 0.0 ? demanded : 0.01))
        nt_plan_add_warning(plan,
                            (nt_plan_warning){"error of forces before contact, under which this sample deforms, more "
                                              "than demanded and part of the bound",
                                              "", rigid, demanded});
}

/* A sample that relaxes has springs of the tip's own radius everywhere. */
static void check_relaxation(nt_plan *plan)
{
    const double demanded = plan->accuracy;
    if (plan->history == NT_HISTORY_RELAXES && demanded > 0.0 && plan->bound.force_error > demanded * ROUNDED)
        nt_plan_add_warning(plan, (nt_plan_warning){"error of a sample that relaxes, more than demanded: it has the "
                                                    "tip's own radius at every place",
                                                    "", plan->bound.force_error, demanded});
}

/* Nearer than fold_distance to a fold the bound does not hold. Where strong laws move the folds of a soft sample by
 * more than their own gap, that is the whole of what is felt. */
static void check_folds(nt_plan *plan)
{
    const double gap = fmax(fabs(plan->release_gap), fabs(plan->capture_gap));
    if (plan->source != NT_ADHESION_NONE && plan->bound.fold_shift > gap && isfinite(plan->bound.fold_shift))
        nt_plan_add_warning(plan,
                            (nt_plan_warning){"where the folds are is not known, and no bound holds nearer to them "
                                              "than",
                                              "m", plan->fold_distance, gap});
}

#define ATOMS_MOVED (1.0 + 1e-6) /* scenes that give H by w and z0 round them */

void nt_plan_warn_distance(nt_plan *plan, const nt_scene *given, const nt_scene *computed)
{
    const double z0 = given->adhesion.equilibrium_distance, taken = computed->adhesion.equilibrium_distance;
    if (taken > z0 * ATOMS_MOVED)
        nt_plan_add_warning(plan,
                            (nt_plan_warning){"van der Waals alone exceeds the work of adhesion at the interatomic "
                                              "distance, so that a larger one is taken, at which it is all of it",
                                              "m", taken, z0});
}

void nt_plan_warn(nt_plan *plan, const nt_scene *scene)
{
    plan->warning_count = 0;
    check_moduli(plan, scene);
    for (int term = 0; term < NT_PLAN_TERMS; ++term)
        if (nt_term_rows[term]->warn)
            nt_term_rows[term]->warn(plan, scene);
    nt_plan_warn_plastic(plan, scene);
    check_drag(plan, scene);
    check_surface(plan);
    nt_plan_warn_flank(plan);
    check_deformed(plan);
    check_relaxation(plan);
    check_folds(plan);
    check_layer(plan, scene);
    nt_plan_warn_friction(plan);
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        check_facts(plan, scene, term);
    check_facts(plan, scene, NT_PLAN_CONTACT);
}
