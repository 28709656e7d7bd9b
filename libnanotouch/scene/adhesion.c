/* SPDX-License-Identifier: BSD-3-Clause
 * What holds tip and sample together: the one source of adhesion of a scene, and the contact that follows from it. */
#include <math.h>

#include "nanotouch/forces.h"
#include "nanotouch/scene.h"
#include "scene/scene.h"
#include "scene/terms/term.h"

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

/* w of the source; of a measured pull-off force it is what a plan finds. */
static double work_of(const nt_scene *scene, double sought)
{
    const nt_adhesion *adhesion = &scene->adhesion;
    if (adhesion->given == NT_ADHESION_GIVEN_PULL_OFF)
        return sought;
    if (nt_scene_adhesion_source(scene) == NT_ADHESION_MENISCUS)
        return 2.0 * scene->medium.surface_tension;
    return adhesion->given == NT_ADHESION_GIVEN_ENERGIES
               ? nt_work_of_adhesion(adhesion->tip_surface_energy, adhesion->sample_surface_energy)
               : adhesion->work_of_adhesion;
}

#define FARTHEST_ATOMS 1e-9 /* apart in contact: beyond it a value of the scene is wrong [m] */

/* The least that w of the solids can be; of a measured pull-off force, that of rigid bodies. */
static double least_work(const nt_scene *scene)
{
    const nt_adhesion *adhesion = &scene->adhesion;
    if (adhesion->given == NT_ADHESION_GIVEN_PULL_OFF)
        return adhesion->pull_off_force / (2.0 * NT_PI * scene->tip.radius);
    return work_of(scene, 0.0);
}

/* Whether van der Waals is a part of w. */
static int has_part(const nt_scene *scene)
{
    const nt_shape_kind shape = scene->tip.shape;
    return nt_scene_adhesion_source(scene) == NT_ADHESION_SOLID && shape != NT_SHAPE_CONE && shape != NT_SHAPE_PUNCH;
}

double nt_plan_atomic_distance(const nt_scene *scene)
{
    const double given = scene->adhesion.equilibrium_distance, H = scene->adhesion.hamaker_constant;
    if (!has_part(scene))
        return given;
    const double all = sqrt(H / (12.0 * NT_PI * least_work(scene))) - 0.5 * scene->sample.roughness;
    return all > given && all <= FARTHEST_ATOMS ? all : given;
}

nt_status nt_plan_check_distance(const nt_scene *scene, nt_problem *problem)
{
    const double farthest = fmax(FARTHEST_ATOMS, scene->adhesion.equilibrium_distance) + 0.5 * scene->sample.roughness;
    const double most = 12.0 * NT_PI * farthest * farthest * least_work(scene), H = scene->adhesion.hamaker_constant;
    if (!has_part(scene) || scene->adhesion.given == NT_ADHESION_GIVEN_PULL_OFF || H <= most * (1.0 + 1e-12))
        return NT_OK;
    nt_problem tail = nt_problem_of("adhesion.hamaker_constant", "J", H, 0.0, most);
    tail.code = NT_PROBLEM_TAIL;
    tail.cause = nt_term_rows[NT_PLAN_VDW]->noun;
    return nt_problem_refuse(problem, tail);
}

nt_contact nt_scene_contact(const nt_scene *scene, double work_of_adhesion)
{
    const nt_material tip = {scene->tip.youngs_modulus, scene->tip.poisson_ratio};
    const nt_material sample = {scene->sample.youngs_modulus, scene->sample.poisson_ratio};
    const nt_adhesion_source source = nt_scene_adhesion_source(scene);
    nt_contact contact = {.radius = scene->tip.radius, .effective_modulus = nt_effective_modulus(tip, sample)};
    if (source == NT_ADHESION_NONE)
        return contact;
    const double w = contact.work_of_adhesion = work_of(scene, work_of_adhesion);
    contact.cohesive_stress = source == NT_ADHESION_MENISCUS /* over 2 r1, the Laplace pressure gamma_L/r1 (E12) */
                                  ? w / (2.0 * nt_scene_meniscus_radius(scene))
                                  : nt_cohesive_stress_atomic(w, nt_plan_atomic_distance(scene));
    return contact;
}
