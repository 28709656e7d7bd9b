/* SPDX-License-Identifier: BSD-3-Clause
 * The description of a scene: defaults, one table of fields, checks. */
#include <math.h>
#include <stddef.h>

#include "nanotouch/forces.h"
#include "nanotouch/scene.h"

#define FIELD(path, unit, minimum, maximum, doc)                                                                       \
    {#path, unit, minimum, maximum, (unsigned)offsetof(nt_scene, path), doc}

static const nt_field scene_fields[] = {
    FIELD(tip.radius, "m", 1e-10, 1e-3, "apex radius R"),
    FIELD(tip.half_angle, "rad", 0.0, 1.5, "half-angle psi of the cone above the apex"),
    FIELD(tip.youngs_modulus, "Pa", 1e2, 1e13, "Young's modulus of the tip"),
    FIELD(tip.poisson_ratio, "", -0.99, 0.5, "Poisson ratio of the tip"),
    FIELD(sample.youngs_modulus, "Pa", 1e2, 1e13, "Young's modulus of the sample"),
    FIELD(sample.poisson_ratio, "", -0.99, 0.5, "Poisson ratio of the sample"),
    FIELD(sample.roughness, "m", 0.0, 1e-6, "roughness b, peak to peak, below what the surface map shows"),
    FIELD(medium.temperature, "K", 200.0, 500.0, "temperature"),
    FIELD(medium.relative_humidity, "", 0.0, 0.99, "relative humidity; 0 is dry gas or vacuum"),
    FIELD(medium.surface_tension, "N/m", 0.0, 1.0, "surface tension gamma_L of the condensed liquid; 0: no meniscus"),
    FIELD(medium.molar_volume, "m^3/mol", 1e-6, 1e-3, "molar volume of the liquid"),
    FIELD(medium.meniscus_radius, "m", 0.0, 1e-6, "meniscus radius r1; 0: from the Kelvin equation"),
    FIELD(medium.film_thickness, "m", 0.0, 1e-7, "thickness e of the adsorbed film on each surface"),
    FIELD(adhesion.work_of_adhesion, "J/m^2", 0.0, 10.0, "work of adhesion w of the dry solids"),
    FIELD(adhesion.equilibrium_distance, "m", 1e-11, 1e-8, "distance z0 of atoms in contact (the paper's a0)"),
    FIELD(adhesion.hamaker_constant, "J", 0.0, 1e-17, "Hamaker constant H"),
    FIELD(adhesion.contact_potential, "V", -100.0, 100.0, "potential difference U of tip and sample"),
};

nt_scene nt_scene_defaults(void)
{
    /* Fig. 9 and 17: Si on Si, 40 % humidity, gamma_L = 72 mJ/m^2. e: van der Waals film of water at 40 % (erratum E4).
     * w, z0, H are those of dry silicon; they matter outside the meniscus. Same material on both sides: U = 0. */
    nt_scene scene = {
        .tip = {.radius = 20e-9, .half_angle = 0.30, .youngs_modulus = 135e9, .poisson_ratio = 0.35},
        .sample = {.youngs_modulus = 135e9, .poisson_ratio = 0.35, .roughness = 0.0},
        .medium = {.temperature = 298.15,
                   .relative_humidity = 0.40,
                   .surface_tension = 0.072,
                   .molar_volume = 1.8e-5,
                   .meniscus_radius = 0.0,
                   .film_thickness = 0.35e-9},
        .adhesion = {.work_of_adhesion = 0.10,
                     .equilibrium_distance = 0.2e-9,
                     .hamaker_constant = 1e-19,
                     .contact_potential = 0.0},
    };
    return scene;
}

const nt_field *nt_scene_fields(int *count)
{
    *count = (int)(sizeof scene_fields / sizeof scene_fields[0]);
    return scene_fields;
}

nt_status nt_scene_check(const nt_scene *scene, nt_problem *problem)
{
    int count = 0;
    const nt_field *fields = nt_scene_fields(&count);
    return nt_field_check(fields, count, scene, problem);
}

nt_adhesion_source nt_scene_adhesion_source(const nt_scene *scene)
{
    const nt_medium *medium = &scene->medium;
    if (medium->relative_humidity > 0.0 && medium->surface_tension > 0.0)
        return NT_ADHESION_MENISCUS;
    return scene->adhesion.work_of_adhesion > 0.0 ? NT_ADHESION_SOLID : NT_ADHESION_NONE;
}

double nt_scene_meniscus_radius(const nt_scene *scene)
{
    const nt_medium *medium = &scene->medium;
    if (medium->meniscus_radius > 0.0)
        return medium->meniscus_radius;
    return nt_kelvin_radius(medium->surface_tension, medium->molar_volume, medium->temperature,
                            medium->relative_humidity);
}
