/* SPDX-License-Identifier: BSD-3-Clause
 * What holds tip and sample together: the one source of adhesion of a scene, and the contact that follows from it. */
#include <math.h>

#include "nanotouch/forces.h"
#include "nanotouch/scene.h"

nt_adhesion_source nt_scene_adhesion_source(const nt_scene *scene)
{
    const nt_medium *medium = &scene->medium;
    const nt_adhesion *adhesion = &scene->adhesion;
    if (medium->kind == NT_MEDIUM_AIR && medium->relative_humidity > 0.0 && medium->surface_tension > 0.0)
        return NT_ADHESION_MENISCUS;
    double w = adhesion->work_of_adhesion;
    if (adhesion->given == NT_ADHESION_GIVEN_ENERGIES)
        w = nt_work_of_adhesion(adhesion->tip_surface_energy, adhesion->sample_surface_energy);
    else if (adhesion->given == NT_ADHESION_GIVEN_PULL_OFF)
        w = adhesion->pull_off_force;
    return w > 0.0 ? NT_ADHESION_SOLID : NT_ADHESION_NONE;
}

double nt_scene_meniscus_radius(const nt_scene *scene)
{
    const nt_medium *medium = &scene->medium;
    if (medium->meniscus_radius > 0.0)
        return medium->meniscus_radius;
    return nt_kelvin_radius(medium->surface_tension, medium->molar_volume, medium->temperature,
                            medium->relative_humidity);
}

double nt_scene_potential(const nt_scene *scene)
{
    const nt_tip *tip = &scene->tip;
    const nt_specimen *sample = &scene->sample;
    if (scene->medium.kind == NT_MEDIUM_LIQUID || !tip->conducting || !sample->conducting || !sample->grounded)
        return 0.0;
    const int known = tip->work_function > 0.0 && sample->work_function > 0.0;
    return scene->adhesion.contact_potential + (known ? tip->work_function - sample->work_function : 0.0);
}

/* w and sigma0 of the source, for a work of adhesion in place of the source's own where that is above 0. */
static void adhere(const nt_scene *scene, double work_of_adhesion, nt_contact *contact)
{
    const nt_adhesion *adhesion = &scene->adhesion;
    const nt_adhesion_source source = nt_scene_adhesion_source(scene);
    double w = work_of_adhesion;
    if (source == NT_ADHESION_MENISCUS) { /* w = 2 gamma_L over 2 r1, the Laplace pressure gamma_L/r1 (E12) */
        w = w > 0.0 ? w : 2.0 * scene->medium.surface_tension;
        contact->cohesive_stress = w / (2.0 * nt_scene_meniscus_radius(scene));
    } else if (source == NT_ADHESION_SOLID) {
        const double own = adhesion->given == NT_ADHESION_GIVEN_ENERGIES
                               ? nt_work_of_adhesion(adhesion->tip_surface_energy, adhesion->sample_surface_energy)
                               : adhesion->work_of_adhesion;
        w = w > 0.0 ? w : own;
        contact->cohesive_stress = nt_cohesive_stress_atomic(w, adhesion->equilibrium_distance);
    }
    contact->work_of_adhesion = w;
}

/* Of a contact with this adhesion, under load control [N]; NaN where a law refuses it. */
static double pull_off_force(const nt_scene *scene, const nt_contact *contact)
{
    const nt_shape shape = nt_scene_shape(scene);
    if (shape.kind == NT_SHAPE_CONE || shape.kind == NT_SHAPE_PUNCH) {
        const nt_jkr_shape jkr = {shape, contact->effective_modulus, contact->work_of_adhesion};
        return nt_jkr_shape_pull_off_force(&jkr);
    }
    nt_maugis maugis;
    return nt_maugis_init(&maugis, contact) == NT_OK ? nt_maugis_pull_off_force(&maugis) : (double)NAN;
}

/* The w that gives the measured pull-off force, which grows with w: bisection in ln w. */
static nt_status adhere_by_pull_off(const nt_scene *scene, nt_contact *contact, nt_problem *problem)
{
    const double measured = scene->adhesion.pull_off_force;
    double low = 1e-12, high = 1e2;
    adhere(scene, high, contact);
    const double largest = pull_off_force(scene, contact);
    adhere(scene, low, contact);
    const double smallest = pull_off_force(scene, contact);
    if (!(measured >= smallest && measured <= largest)) {
        if (problem)
            *problem = (nt_problem){"adhesion.pull_off_force", "N", measured, smallest, largest};
        return NT_E_RANGE;
    }
    for (int i = 0; i < 64; ++i) {
        const double middle = sqrt(low * high);
        adhere(scene, middle, contact);
        if (pull_off_force(scene, contact) < measured)
            low = middle;
        else
            high = middle;
    }
    return NT_OK;
}

nt_status nt_scene_contact(const nt_scene *scene, nt_contact *contact, nt_problem *problem)
{
    const nt_material tip = {scene->tip.youngs_modulus, scene->tip.poisson_ratio};
    const nt_material sample = {scene->sample.youngs_modulus, scene->sample.poisson_ratio};
    nt_contact made = {.radius = scene->tip.radius, .effective_modulus = nt_effective_modulus(tip, sample)};
    if (nt_scene_adhesion_source(scene) != NT_ADHESION_NONE) {
        adhere(scene, 0.0, &made);
        if (scene->adhesion.given == NT_ADHESION_GIVEN_PULL_OFF) {
            const nt_status status = adhere_by_pull_off(scene, &made, problem);
            if (status != NT_OK)
                return status;
        }
    }
    *contact = made;
    return NT_OK;
}
