/* SPDX-License-Identifier: BSD-3-Clause
 * The description of a scene: defaults, one table of fields, checks of each field and of what belongs together. */
#include "nanotouch/scene.h"
#include "internal/field.h"

#include <math.h>
#include <string.h>

#include "scene/parts.h"
#include "scene/scene.h"

#define FIELD(path, ...) NT_FIELD(nt_scene, path, __VA_ARGS__)
#define FIELD_NAMED(name, path, ...) NT_FIELD_NAMED(name, nt_scene, path, __VA_ARGS__)
#define CHOICE(path, choices, last, doc) FIELD(path, choices, 0.0, last, doc)
#define NO_YES "no|yes"
#define OF_TERM(name, unit, least, most, usual, doc) , FIELD(medium.name, unit, least, most, doc)
#define USUAL(name, unit, least, most, usual, doc) , .name = usual

static const nt_field scene_fields[] = {
    CHOICE(tip.shape, "paraboloid|sphere|cone|punch|blunted|truncated", 5.0, "shape of the tip"),
    FIELD(tip.sides, "", 0.0, 4.0, "of a cone or blunted or truncated tip: 0 round, 3 or 4 a pyramid"),
    FIELD(tip.radius, "m", 1e-10, 1e-3, "apex radius R, or radius of the flat end"),
    FIELD(tip.half_angle, "rad", 0.0, 1.5, "half-angle psi of the cone above the apex"),
    FIELD(tip.height, "m", 0.0, 1e-3, "height L of that cone, for long-range forces; 0: a sphere alone"),
    FIELD(tip.youngs_modulus, "Pa", 1e2, 1e13, "Young's modulus of the tip"),
    FIELD(tip.poisson_ratio, "", -0.99, 0.5, "Poisson ratio of the tip"),
    FIELD(tip.yield_strength, "Pa", 0.0, 1e12, "yield strength of the tip; 0: not known"),
    CHOICE(tip.conducting, NO_YES, 1.0, "whether the tip conducts"),
    FIELD(tip.work_function, "V", 0.0, 10.0, "work function over e; 0: not known"),
    FIELD(tip.surface_potential, "V", -0.5, 0.5, "potential of the tip's surface in the liquid, where no pH is given"),
    FIELD(tip.isoelectric_point, "", 0.0, 14.0, "pH at which the tip's surface bears no charge"),
    FIELD(sample.youngs_modulus, "Pa", 1e2, 1e13, "Young's modulus of the sample"),
    FIELD(sample.poisson_ratio, "", -0.99, 0.5, "Poisson ratio of the sample"),
    FIELD(sample.yield_strength, "Pa", 0.0, 1e12, "yield strength of the sample; 0: not known"),
    CHOICE(sample.dents, NO_YES, 1.0, "whether it yields while a session touches it, and keeps its dents"),
    FIELD(sample.thickness, "m", 0.0, 1.0, "thickness of the layer that is pressed; 0: a half-space"),
    FIELD(sample.roughness, "m", 0.0, 1e-6, "roughness b, peak to peak, below what the surface map shows"),
    CHOICE(sample.conducting, NO_YES, 1.0, "whether the sample conducts"),
    CHOICE(sample.grounded, NO_YES, 1.0, "whether the sample is connected to the tip's circuit"),
    FIELD(sample.work_function, "V", 0.0, 10.0, "work function over e; 0: not known"),
    FIELD(sample.charge, "C", -1e-12, 1e-12, "charge q trapped on the surface under the tip"),
    FIELD(sample.surface_potential, "V", -0.5, 0.5, "potential of its surface in the liquid, where no pH is given"),
    FIELD(sample.isoelectric_point, "", 0.0, 14.0, "pH at which the sample's surface bears no charge"),
    CHOICE(medium.kind, "air|vacuum|liquid", 2.0, "what is between tip and sample"),
    FIELD(medium.temperature, "K", 200.0, 500.0, "temperature"),
    FIELD(medium.relative_humidity, "", 0.0, 1.0,
          "relative humidity of air; 0: no meniscus; 1 needs a meniscus radius"),
    FIELD(medium.surface_tension, "N/m", 0.0, 1.0, "surface tension gamma_L of the condensed liquid; 0: no meniscus"),
    FIELD(medium.molar_volume, "m^3/mol", 1e-6, 1e-3, "molar volume of the condensed liquid"),
    FIELD(medium.meniscus_radius, "m", 0.0, 1e-6, "meniscus radius r1; 0: from the Kelvin equation"),
    FIELD(medium.film_thickness, "m", 0.0, 1e-7, "thickness e of the adsorbed film on each surface"),
    FIELD(medium.relative_permittivity, "", 1.0, 200.0, "relative permittivity of the liquid"),
    FIELD(medium.ionic_strength, "mol/m^3", 0.0, 1e4, "ionic strength of the liquid; 0: no double layer"),
    FIELD(medium.ph, "", 0.0, 14.0, "pH of the liquid; 0: surface potentials as given"),
    FIELD(medium.potential_per_ph, "V", 0.0, 0.06, "surface potential per pH below the isoelectric point"),
    FIELD(medium.hydration_energy, "J/m^2", -1.0, 1.0, "hydration energy W of plates at gap 0; below 0: hydrophobic"),
    FIELD(medium.hydration_length, "m", 1e-11, 1e-7, "decay length of the hydration force"),
    FIELD(medium.brush_thickness, "m", 0.0, 1e-6, "thickness T of the free polymer brushes of both bodies; 0: none"),
    FIELD(medium.brush_spacing, "m", 1e-10, 1e-6, "distance s of grafted chains") NT_TERM_FIELDS(OF_TERM),
    CHOICE(adhesion.given, "work_of_adhesion|surface_energies|pull_off_force", 2.0, "what the adhesion follows from"),
    FIELD(adhesion.work_of_adhesion, "J/m^2", 0.0, 10.0, "work of adhesion w of the dry solids"),
    FIELD(adhesion.tip_surface_energy, "J/m^2", 0.0, 10.0, "surface energy of the tip"),
    FIELD(adhesion.sample_surface_energy, "J/m^2", 0.0, 10.0, "surface energy of the sample"),
    FIELD(adhesion.pull_off_force, "N", 0.0, 1.0, "measured pull-off force under load control"),
    FIELD(adhesion.equilibrium_distance, "m", 1e-11, 1e-8, "distance z0 of atoms in contact (the paper's a0)"),
    FIELD(adhesion.hamaker_constant, "J", 0.0, 1e-17, "Hamaker constant H through the medium"),
    FIELD(adhesion.contact_potential, "V", -100.0, 100.0, "potential difference U of tip and sample, bias included"),
    FIELD(friction.shear_strength, "Pa", 0.0, 1e12, "shear strength tau0, friction per contact area without load"),
    FIELD(friction.coefficient, "", 0.0, 100.0, "coefficient alpha, friction per load inside the contact"),
    FIELD(friction.lateral_compliance, "m/N", 0.0, 1e6, "lateral compliance of the tip at its apex; 0: rigid"),
    FIELD(range.minimum_gap, "m", -1e-3, 1e-2, "smallest gap that will be visited; below 0: contact"),
    FIELD(range.maximum_load, "N", 1e-15, 1.0, "largest load that will be visited"),
    FIELD(range.speed, "m/s", 0.0, 1.0, "fastest approach"),
    FIELD(range.viscosity, "Pa s", 0.0, 1e3, "viscosity of the medium, for the drag that a plan leaves out"),
    FIELD(range.warming, "K", 0.0, 100.0, "the temperature may move by this either way"),
    FIELD(range.duration, "s", 1e-3, 1e6, "longest touch, over which the memory of a sample that relaxes counts"),
    CHOICE(rheology.kind, "elastic|power_law|standard_linear_solid|prony", NT_RHEOLOGY_COUNT - 1.0,
           "how the sample's modulus relaxes; but for elastic in place of sample.youngs_modulus"),
    CHOICE(rheology.arm_count, "0|1|2|3|4|5|6|7|8", NT_RHEOLOGY_ARMS,
           "of a prony series, how many of these arms it has"),
    FIELD(rheology.modulus, "Pa", 1e-3, 1e13, "of a power law, Young's modulus E_1 at the reference time"),
    FIELD(rheology.exponent, "", 0.0, 0.85, "of a power law, beta: 0 is elastic"),
    FIELD(rheology.reference_time, "s", 1e-9, 1e9, "of a power law, t_0"),
    FIELD(rheology.equilibrium_modulus, "Pa", 0.0, 1e13, "of arms, Young's modulus E_inf that is left in the end"),
    FIELD_NAMED("rheology.arm_modulus_1", rheology.arm_moduli[0], "Pa", 0.0, 1e13, "E_1 of an arm"),
    FIELD_NAMED("rheology.arm_modulus_2", rheology.arm_moduli[1], "Pa", 0.0, 1e13, "E_2 of an arm"),
    FIELD_NAMED("rheology.arm_modulus_3", rheology.arm_moduli[2], "Pa", 0.0, 1e13, "E_3 of an arm"),
    FIELD_NAMED("rheology.arm_modulus_4", rheology.arm_moduli[3], "Pa", 0.0, 1e13, "E_4 of an arm"),
    FIELD_NAMED("rheology.arm_modulus_5", rheology.arm_moduli[4], "Pa", 0.0, 1e13, "E_5 of an arm"),
    FIELD_NAMED("rheology.arm_modulus_6", rheology.arm_moduli[5], "Pa", 0.0, 1e13, "E_6 of an arm"),
    FIELD_NAMED("rheology.arm_modulus_7", rheology.arm_moduli[6], "Pa", 0.0, 1e13, "E_7 of an arm"),
    FIELD_NAMED("rheology.arm_modulus_8", rheology.arm_moduli[7], "Pa", 0.0, 1e13, "E_8 of an arm"),
    FIELD_NAMED("rheology.relaxation_time_1", rheology.relaxation_times[0], "s", 0.0, 1e9, "tau_1 of that arm"),
    FIELD_NAMED("rheology.relaxation_time_2", rheology.relaxation_times[1], "s", 0.0, 1e9, "tau_2 of that arm"),
    FIELD_NAMED("rheology.relaxation_time_3", rheology.relaxation_times[2], "s", 0.0, 1e9, "tau_3 of that arm"),
    FIELD_NAMED("rheology.relaxation_time_4", rheology.relaxation_times[3], "s", 0.0, 1e9, "tau_4 of that arm"),
    FIELD_NAMED("rheology.relaxation_time_5", rheology.relaxation_times[4], "s", 0.0, 1e9, "tau_5 of that arm"),
    FIELD_NAMED("rheology.relaxation_time_6", rheology.relaxation_times[5], "s", 0.0, 1e9, "tau_6 of that arm"),
    FIELD_NAMED("rheology.relaxation_time_7", rheology.relaxation_times[6], "s", 0.0, 1e9, "tau_7 of that arm"),
    FIELD_NAMED("rheology.relaxation_time_8", rheology.relaxation_times[7], "s", 0.0, 1e9, "tau_8 of that arm"),
};

nt_scene nt_scene_defaults(void)
{
    /* Fig. 9 and 17: Si on Si, 40 % humidity, gamma_L = 72 mJ/m^2. e: van der Waals film of water at 40 % (erratum E4).
     * w, z0, H are those of dry silicon; they matter outside the meniscus. Same material on both sides: U = 0. The
     * liquid's numbers are those of water; gases are as viscous as air. The largest load presses with up to 10.6 GPa;
     * silicon begins to yield at 11 (1.6 Y). Y itself is not known: a modulus of one's own is another material. */
    nt_scene scene = {
        .tip = {.radius = 20e-9,
                .half_angle = 0.30,
                .youngs_modulus = 135e9,
                .poisson_ratio = 0.35,
                .conducting = 1,
                .isoelectric_point = 2.0},
        .sample =
            {.youngs_modulus = 135e9, .poisson_ratio = 0.35, .conducting = 1, .grounded = 1, .isoelectric_point = 2.0},
        .medium = {.kind = NT_MEDIUM_AIR,
                   .temperature = 298.15,
                   .relative_humidity = 0.40,
                   .surface_tension = 0.072,
                   .molar_volume = 1.8e-5,
                   .film_thickness = 0.35e-9,
                   .relative_permittivity = 78.4,
                   .potential_per_ph = 0.006,
                   .hydration_length = 0.3e-9,
                   .brush_spacing = 10e-9 NT_TERM_FIELDS(USUAL)},
        .adhesion = {.work_of_adhesion = 0.10, .equilibrium_distance = 0.2e-9, .hamaker_constant = 1e-19},
        .range = {.minimum_gap = -1e-3, .maximum_load = 0.4e-6, .viscosity = 1.8e-5, .duration = 100.0},
        .rheology = nt_rheology_defaults(),
    };
    scene.rheology.kind = NT_RHEOLOGY_ELASTIC;
    return scene;
}

const nt_field *nt_scene_fields(int *count)
{
    if (count != NULL)
        *count = (int)(sizeof scene_fields / sizeof scene_fields[0]);
    return scene_fields;
}

const nt_field *nt_scene_field(const char *name)
{
    int count = 0;
    const nt_field *field = nt_scene_fields(&count);
    for (int i = 0; i < count; ++i)
        if (strcmp(field[i].name, name) == 0)
            return &field[i];
    return NULL;
}

/* Refuses `field` of a scene whose other fields leave it [minimum, maximum]. */
static nt_status refuse(nt_problem *problem, const char *field, double value, double minimum, double maximum)
{
    return nt_problem_refuse(problem, nt_problem_of(field, nt_scene_field(field)->unit, value, minimum, maximum));
}

nt_shape nt_scene_shape(const nt_scene *scene)
{
    const nt_tip *tip = &scene->tip;
    nt_shape shape = {
        .kind = tip->shape, .sides = (int)tip->sides, .radius = tip->radius, .half_angle = tip->half_angle};
    return shape;
}

/* Names what the adhesion of the scene follows from. */
static nt_status refuse_adhesion(const nt_scene *scene, nt_problem *problem)
{
    const nt_adhesion *adhesion = &scene->adhesion;
    if (nt_scene_adhesion_source(scene) == NT_ADHESION_MENISCUS)
        return refuse(problem, "medium.relative_humidity", scene->medium.relative_humidity, 0.0, 0.0);
    if (adhesion->given == NT_ADHESION_GIVEN_ENERGIES)
        return refuse(problem, "adhesion.tip_surface_energy", adhesion->tip_surface_energy, 0.0, 0.0);
    if (adhesion->given == NT_ADHESION_GIVEN_PULL_OFF)
        return refuse(problem, "adhesion.pull_off_force", adhesion->pull_off_force, 0.0, 0.0);
    return refuse(problem, "adhesion.work_of_adhesion", adhesion->work_of_adhesion, 0.0, 0.0);
}

/* A shape that the contact laws know. Adhesion of cones and punches is JKR's, of round ones only. */
static nt_status check_shape(const nt_scene *scene, nt_problem *problem)
{
    const nt_tip *tip = &scene->tip;
    const nt_shape shape = nt_scene_shape(scene);
    nt_problem found = {.field = "", .unit = ""};
    if (nt_shape_check(&shape, &found) != NT_OK) {
        const int sides = shape.sides != 0 && (shape.sides < 3 || shape.sides > 4);
        return refuse(problem, sides ? "tip.sides" : "tip.half_angle", sides ? tip->sides : tip->half_angle,
                      found.minimum, found.maximum);
    }
    const int adhesive = nt_scene_adhesion_source(scene) != NT_ADHESION_NONE;
    if (adhesive && shape.kind == NT_SHAPE_CONE && shape.sides != 0)
        return refuse(problem, "tip.sides", tip->sides, 0.0, 0.0);
    if (adhesive && shape.kind == NT_SHAPE_TRUNCATED)
        return refuse_adhesion(scene, problem);
    /* a full sphere fits into the cone above it: the forces of sphere and tip then have one order at every gap */
    if (tip->height > 0.0 && !(tip->height >= 2.0 * tip->radius && tip->half_angle >= 0.01))
        return refuse(problem, "tip.height", tip->height, 2.0 * tip->radius, 1e-3);
    return NT_OK;
}

nt_status nt_scene_check(const nt_scene *scene, nt_problem *problem)
{
    int count = 0;
    const nt_field *fields = nt_scene_fields(&count);
    nt_status status = nt_field_check(fields, count, scene, problem);
    if (status == NT_OK && scene->rheology.kind != NT_RHEOLOGY_ELASTIC)
        status = nt_rheology_check(&scene->rheology, problem);
    if (status != NT_OK)
        return status;
    const nt_medium *medium = &scene->medium;
    if (nt_scene_adhesion_source(scene) == NT_ADHESION_MENISCUS) {
        if (!(medium->relative_humidity < 1.0) && !(medium->meniscus_radius > 0.0))
            return refuse(problem, "medium.meniscus_radius", 0.0, 1e-10, 1e-6); /* Kelvin's is infinite at 100 % */
        if (!(nt_scene_meniscus_radius(scene) >= 1e-11)) /* thinner than a molecule: no liquid to speak of */
            return refuse(problem, "medium.relative_humidity", medium->relative_humidity, 1e-20, 1.0);
    }
    return check_shape(scene, problem);
}
