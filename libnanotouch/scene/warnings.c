/* SPDX-License-Identifier: BSD-3-Clause
 * What a plan's bound does not cover: where a law is used outside its validity, and what is no part of the potential.
 */
#include <math.h>

#include "scene/parts.h"

static void warn(nt_plan *plan, nt_plan_warning warning)
{
    if (plan->warning_count < NT_PLAN_WARNINGS_MAX)
        plan->warnings[plan->warning_count++] = warning;
}

static void check_contact(nt_plan *plan)
{
    const nt_contact_validity *v = &plan->validity;
    if (v->outside & NT_OUTSIDE_RADIUS_RATIO)
        warn(plan, (nt_plan_warning){"contact radius over tip radius at the largest load", "", v->radius_ratio,
                                     NT_VALID_RADIUS_RATIO});
    if (v->outside & NT_OUTSIDE_SLOPE)
        warn(plan, (nt_plan_warning){"slope of the tip at the edge of contact at the largest load", "", v->slope,
                                     NT_VALID_SLOPE});
    if (v->outside & NT_OUTSIDE_STRAIN)
        warn(plan, (nt_plan_warning){"strain at the largest load", "", v->strain, NT_VALID_STRAIN});
    if (v->outside & NT_OUTSIDE_THICKNESS)
        warn(plan, (nt_plan_warning){"contact radius over thickness of the sample at the largest load", "",
                                     v->thickness_ratio, NT_VALID_THICKNESS_RATIO});
}

/* Film and meniscus are of one humidity (erratum E4). */
static void check_meniscus(nt_plan *plan, const nt_scene *scene)
{
    const nt_medium *medium = &scene->medium;
    if (plan->source != NT_ADHESION_MENISCUS)
        return;
    const double r1 = nt_scene_meniscus_radius(scene);
    const double kelvin =
        nt_kelvin_radius(medium->surface_tension, medium->molar_volume, medium->temperature, medium->relative_humidity);
    if (fabs(r1 - kelvin) > 0.25 * kelvin)
        warn(plan, (nt_plan_warning){"meniscus radius, which the Kelvin equation gives otherwise for this humidity",
                                     "m", r1, kelvin});
    if (medium->film_thickness > r1)
        warn(plan, (nt_plan_warning){"film thicker than the meniscus radius, which no one humidity makes", "m",
                                     medium->film_thickness, r1});
    const double T = medium->temperature, warmer = T + scene->range.warming;
    const double change = medium->meniscus_radius > 0.0 ? 0.0 : T / warmer - 1.0; /* r1 ~ 1/T at a given humidity */
    if (fabs(change) > 0.01)
        warn(plan, (nt_plan_warning){"relative change of the meniscus radius with temperature", "", change, -0.01});
}

static void check_liquid(nt_plan *plan)
{
    const nt_double_layer *layer = &plan->laws.double_layer;
    if (plan->terms[NT_PLAN_DOUBLE_LAYER].form == NT_FORM_OFF)
        return;
    const double potential = fmax(fabs(layer->tip_potential), fabs(layer->sample_potential));
    if (potential > 0.025)
        warn(plan,
             (nt_plan_warning){"surface potential, beyond the linear theory of double layers", "V", potential, 0.025});
    if (layer->debye_length > 0.2 * layer->radius)
        warn(plan, (nt_plan_warning){"Debye length, not small against the tip", "m", layer->debye_length,
                                     0.2 * layer->radius});
}

/* Squeeze drag of a sphere, 6 pi eta R^2 v/h, at the closest that is not contact: a loss, no part of the potential. */
static void check_drag(nt_plan *plan, const nt_scene *scene)
{
    const double R = plan->contact.radius, h = fmax(scene->range.minimum_gap, scene->adhesion.equilibrium_distance);
    const double drag = 6.0 * NT_PI * scene->range.viscosity * R * R * scene->range.speed / h;
    const double felt = fmax(plan->demand.force_floor, plan->demand.relative_accuracy * plan->pull_off_force);
    if (drag > felt)
        warn(plan, (nt_plan_warning){"viscous drag at the fastest approach, left out", "N", drag, felt});
}

static void check_surface(nt_plan *plan)
{
    if (plan->radii && !nt_plan_has_local_form(plan))
        warn(plan, (nt_plan_warning){"curvature of the surface, which this tip's law does not know: least radius", "m",
                                     plan->radii->minimum, plan->contact.radius});
    if (plan->radii && plan->radii->limited > 0)
        warn(plan, (nt_plan_warning){"pixels whose curvature is beyond what the map resolves", "",
                                     (double)plan->radii->limited, 0.0});
}

void nt_plan_warn(nt_plan *plan, const nt_scene *scene)
{
    plan->warning_count = 0;
    check_contact(plan);
    check_meniscus(plan, scene);
    check_liquid(plan);
    check_drag(plan, scene);
    check_surface(plan);
}
