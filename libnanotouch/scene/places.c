/* SPDX-License-Identifier: BSD-3-Clause
 * A surface that is made of something else at each place: its modulus and its work of adhesion stand in place of the
 * scene's. The plan's own contact is that of corner 0, softest and least adhesive, with which a demand is hardest to
 * keep: there the sample gives most, and the scale of small forces is smallest. What others are told is the worst of
 * all corners. */
#include <math.h>

#include "core/same_bits.h"
#include "scene/deformation/deform.h"
#include "scene/parts.h"

static int has(const nt_surface *property)
{
    return property->coefficients != NULL;
}

double nt_plan_effective_modulus(const nt_plan *plan, double youngs_modulus)
{
    return 1.0 / (plan->tip_compliance + plan->sample_factor / youngs_modulus);
}

nt_scene nt_plan_scene_over(const nt_plan_inputs *inputs)
{
    const nt_properties *properties = inputs->properties;
    nt_scene over = *inputs->scene;
    if (over.rheology.kind != NT_RHEOLOGY_ELASTIC)
        over.sample.youngs_modulus = nt_plan_relaxation_before(inputs).modulus;
    if (properties && has(&properties->youngs_modulus))
        over.sample.youngs_modulus = properties->youngs_modulus.height_minimum;
    if (properties && has(&properties->work_of_adhesion)) {
        over.adhesion.given = NT_ADHESION_GIVEN_WORK;
        over.adhesion.work_of_adhesion = properties->work_of_adhesion.height_minimum;
    }
    over.adhesion.equilibrium_distance = nt_plan_atomic_distance(&over);
    return over;
}

void nt_plan_take_properties(nt_plan *plan, const nt_scene *scene)
{
    const nt_properties *of = plan->properties;
    plan->tip_compliance = (1.0 - scene->tip.poisson_ratio * scene->tip.poisson_ratio) / scene->tip.youngs_modulus;
    plan->sample_factor = 1.0 - scene->sample.poisson_ratio * scene->sample.poisson_ratio;
    if (of && has(&of->youngs_modulus)) {
        const nt_surface *E = &of->youngs_modulus;
        plan->contact.effective_modulus =
            nt_plan_effective_modulus(plan, plan->corner & NT_CORNER_STIFF ? E->height_maximum : E->height_minimum);
    }
    if (of && has(&of->work_of_adhesion)) { /* of water, too, whose range is that of its meniscus */
        const nt_surface *w = &of->work_of_adhesion;
        const double work = plan->corner & NT_CORNER_STICKY ? w->height_maximum : w->height_minimum;
        plan->contact.cohesive_stress *= work / plan->contact.work_of_adhesion;
        plan->contact.work_of_adhesion = work;
    }
}

nt_contact nt_plan_contact_of_radius(const nt_plan *plan, double radius)
{
    nt_contact contact = plan->contact;
    contact.radius = radius;
    return contact;
}

/* The same range of adhesion as that of the plan's own contact. */
static void set_work(const nt_plan *plan, nt_contact *contact, double work_of_adhesion)
{
    contact->cohesive_stress *= work_of_adhesion / plan->contact.work_of_adhesion;
    contact->work_of_adhesion = work_of_adhesion;
}

nt_contact nt_plan_contact_of_place(const nt_plan *plan, const nt_place *place)
{
    nt_contact contact = plan->contact;
    if (!place)
        return contact;
    contact.radius = place->radius.radius;
    if (place->youngs_modulus.value > 0.0)
        contact.effective_modulus = nt_plan_effective_modulus(plan, place->youngs_modulus.value);
    if (place->work_of_adhesion.value > 0.0)
        set_work(plan, &contact, place->work_of_adhesion.value - plan->tail);
    if (plan->relief.count > 0 && !plan->deformation.jumps && plan->source != NT_ADHESION_NONE) {
        double slope;
        set_work(plan, &contact,
                 plan->contact.work_of_adhesion + plan->tail - nt_deform_relief_share(plan, contact.radius, &slope));
    }
    return contact;
}

nt_contact nt_plan_contact_of_corner(const nt_plan *plan, int corner)
{
    nt_contact contact = corner & NT_CORNER_BLUNT ? plan->most : plan->least;
    contact.effective_modulus = (corner & NT_CORNER_STIFF ? &plan->most : &plan->least)->effective_modulus;
    if (plan->contact.work_of_adhesion > 0.0) {
        contact.cohesive_stress = plan->contact.cohesive_stress;
        set_work(plan, &contact, (corner & NT_CORNER_STICKY ? &plan->most : &plan->least)->work_of_adhesion);
    }
    return contact;
}

int nt_plan_varies(const nt_plan *plan)
{
    return plan->properties || nt_plan_is_curved(plan);
}

/* Of radii from the tip's own, of E* from the softest and of w from the least on. */
double nt_plan_largest_unit(const nt_plan *plan, nt_quantity quantity)
{
    const double R = nt_plan_largest_ratio(plan), K = plan->most.effective_modulus / plan->contact.effective_modulus;
    const double w =
        plan->contact.work_of_adhesion > 0.0 ? plan->most.work_of_adhesion / plan->contact.work_of_adhesion : 1.0;
    switch (quantity) {
    case NT_QUANTITY_STIFFNESS:
        return cube_root(R * R * K * K * w);
    case NT_QUANTITY_RADIUS:
        return cube_root(R * R * w);
    default:
        return cube_root(R * w * w);
    }
}

double nt_plan_farthest_release(const nt_plan *plan)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    double farthest = plan->release_gap;
    if (!nt_form_is_local(form))
        return farthest;
    for (int corner = NT_CORNER_BLUNT; corner < NT_CORNERS; corner += 2) {
        const nt_contact contact = nt_plan_contact_of_corner(plan, corner);
        farthest = fmax(farthest, nt_plan_local_release_gap(plan, form, &contact));
    }
    return farthest;
}

double nt_plan_local_depth(const nt_plan *plan, nt_form form, const nt_contact *contact, double load)
{
    double low = 0.0, high = plan->largest_indentation;
    for (int i = 0; i < 64 && nt_plan_local_eval(plan, form, contact, high).law.F < load; ++i) {
        low = high;
        high *= 2.0;
    }
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        if (nt_plan_local_eval(plan, form, contact, middle).law.F < load)
            low = middle;
        else
            high = middle;
    }
    return high;
}

/* What others need to know of one corner. */
typedef struct facts {
    double pull_off_force, minimum_spring, maximum_stiffness, largest_indentation;
    nt_contact_validity validity;
} facts;

static facts worse(const nt_plan *plan, facts so_far)
{
    const facts worst = {fmax(so_far.pull_off_force, plan->largest_pull_off_force),
                         fmax(so_far.minimum_spring, plan->minimum_spring),
                         fmax(so_far.maximum_stiffness, plan->maximum_stiffness),
                         fmax(so_far.largest_indentation, plan->largest_indentation),
                         plan->validity.radius_ratio > so_far.validity.radius_ratio ? plan->validity : so_far.validity};
    return worst;
}

/* After the plan's own contact was found: the ranges, by its own radius and that of the surface. */
static void find_ranges(nt_plan *plan, const nt_contact *most)
{
    plan->least = plan->contact;
    plan->most = *most;
    plan->followed = nt_plan_has_local_form(plan) ? plan->radii : NULL;
    if (plan->followed) {
        plan->least.radius = plan->radii->minimum;
        plan->most.radius = plan->radii->maximum;
    }
}

nt_status nt_plan_over_surface(nt_plan *plan, const nt_scene *scene, nt_problem *problem)
{
    facts worst = {0};
    nt_contact most = plan->contact;
    nt_status status = NT_OK;
    const double w = plan->contact.work_of_adhesion + plan->tail; /* of a measured pull-off force what was found */
    for (int corner = NT_CORNERS - 2; corner >= 0 && plan->properties && status == NT_OK; corner -= 2) {
        plan->corner = corner;
        status = nt_plan_laws_at(plan, scene, w, problem);
        worst = worse(plan, worst);
        if (corner == NT_CORNERS - 2)
            most = plan->contact;
    }
    if (status != NT_OK)
        return status;
    if (plan->properties) {
        plan->largest_pull_off_force = worst.pull_off_force;
        plan->minimum_spring = worst.minimum_spring;
        plan->maximum_stiffness = worst.maximum_stiffness;
        plan->largest_indentation = worst.largest_indentation;
        plan->validity = worst.validity;
    }
    find_ranges(plan, &most);
    return NT_OK;
}
