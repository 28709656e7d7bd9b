/* SPDX-License-Identifier: BSD-3-Clause
 * What a plan's bound does not cover: where a law is used outside its validity, and what is no part of the potential.
 */
#include <math.h>
#include <stddef.h>

#include "scene/parts.h"

static void warn(nt_plan *plan, nt_plan_warning warning)
{
    if (plan->warning_count < NT_PLAN_WARNINGS_MAX)
        plan->warnings[plan->warning_count++] = warning;
}

static void check_contact(nt_plan *plan)
{
    const nt_contact_validity *v = &plan->validity;
    if (plan->terms[NT_PLAN_CONTACT].form == NT_FORM_OFF)
        return;
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
    const double ratio = r1 / kelvin;
    if (fabs(ratio - 1.0) > 0.25)
        warn(plan, (nt_plan_warning){"meniscus radius over that of the Kelvin equation for this humidity", "", ratio,
                                     ratio > 1.0 ? 1.25 : 0.75});
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

/* What the scene gives and nothing takes up, because of what else it says; values that defaults have are not told. */
static void check_unused(nt_plan *plan, const nt_scene *scene)
{
    const nt_tip *tip = &scene->tip;
    const nt_specimen *sample = &scene->sample;
    const nt_medium *medium = &scene->medium;
    const nt_adhesion *adhesion = &scene->adhesion;
    const int liquid = medium->kind == NT_MEDIUM_LIQUID, ions = liquid && medium->ionic_strength > 0.0;
    const int conducting = tip->conducting != 0.0;
    const int connected = !liquid && conducting && sample->conducting != 0.0 && sample->grounded != 0.0;
    const int both_known = tip->work_function > 0.0 && sample->work_function > 0.0;
    const double potential = fmax(fabs(tip->surface_potential), fabs(sample->surface_potential));
    const int meniscus = nt_scene_adhesion_source(scene) == NT_ADHESION_MENISCUS;
    const int by_energies = adhesion->given == NT_ADHESION_GIVEN_ENERGIES;
    const struct {
        int used;
        const char *text, *unit;
        double value;
    } facts[] = {
        {connected, "contact potential, which does not act between these bodies", "V", adhesion->contact_potential},
        {both_known, "work function of one body alone, not used", "V", fmax(tip->work_function, sample->work_function)},
        {!liquid && conducting, "trapped charge, which does not act on this tip here", "C", sample->charge},
        {adhesion->given == NT_ADHESION_GIVEN_PULL_OFF,
         "measured pull-off force, not used: the adhesion is given otherwise", "N", adhesion->pull_off_force},
        {!(meniscus && by_energies), "surface energy of the tip, not used: water holds", "J/m^2",
         adhesion->tip_surface_energy},
        {meniscus, "meniscus radius, not used: there is no meniscus", "m", medium->meniscus_radius},
        {liquid, "ionic strength, not used: there is no liquid", "mol/m^3", medium->ionic_strength},
        {liquid, "hydration energy, not used: there is no liquid", "J/m^2", medium->hydration_energy},
        {liquid, "thickness of the brush, not used: there is no liquid", "m", medium->brush_thickness},
        {ions, "pH, not used: there are no ions", "", medium->ph},
        {ions && !(medium->ph > 0.0), "surface potential, not used: there are no ions, or there is a pH", "V",
         potential},
    };
    for (size_t i = 0; i < sizeof facts / sizeof facts[0]; ++i)
        if (!facts[i].used && facts[i].value != 0.0)
            warn(plan, (nt_plan_warning){facts[i].text, facts[i].unit, facts[i].value, NAN});
}

/* Squeeze drag of a sphere, 6 pi eta R^2 v/h, at the closest that is not contact: a loss, no part of the potential. */
static void check_drag(nt_plan *plan, const nt_scene *scene)
{
    const double R = plan->contact.radius, h = fmax(scene->range.minimum_gap, scene->adhesion.equilibrium_distance);
    const double drag = 6.0 * NT_PI * scene->range.viscosity * R * R * scene->range.speed / h;
    const double scale = plan->demand.quantity == NT_QUANTITY_FORCE ? plan->scale : plan->pull_off_force;
    const double felt = fmax(plan->demand.force_floor, plan->demand.relative_accuracy * scale);
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
    check_unused(plan, scene);
}
