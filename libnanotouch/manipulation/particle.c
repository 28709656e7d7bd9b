/* SPDX-License-Identifier: BSD-3-Clause
 * A particle as it is described, its contacts made ready, and the particle at rest: see particle.h. */
#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "manipulation/balance.h"
#include "nanotouch/material.h"

/* For the dotted names. */
struct described {
    double radius, tip_radius, tip_half_angle, step;
    nt_particle_contact substrate, tip;
};
_Static_assert(sizeof(struct described) == sizeof(nt_particle), "the names are those of the fields");

#define FIELD(path, ...) NT_FIELD(struct described, path, __VA_ARGS__)
#define CONTACT(side, of)                                                                                              \
    FIELD(side.model, "hertz|dmt|jkr|maugis", 0.0, 3.0, "contact law " of),                                            \
        FIELD(side.effective_modulus, "Pa", 1e2, 1e13, "E* " of),                                                      \
        FIELD(side.work_of_adhesion, "J/m^2", 0.0, 10.0, "w " of),                                                     \
        FIELD(side.cohesive_stress, "Pa", 0.0, 1e12, "sigma0 " of ", for maugis"),                                     \
        FIELD(side.effective_shear_modulus, "Pa", 1.0, 1e13, "G* " of ", 1/G* = sum of (2 - nu)/G"),                   \
        FIELD(side.shear_strength, "Pa", 0.0, 1e12, "tau " of ", friction per contact area"),                          \
        FIELD(side.coefficient, "", 0.0, 100.0, "alpha " of ", friction per load inside the contact"),                 \
        FIELD(side.rolling_distance, "m", 0.0, 1e-3, "xi " of ", way that it rolls before it gives way")

static const nt_field particle_fields[] = {
    FIELD(radius, "m", 1e-9, 1e-3, "R of the particle"),
    FIELD(tip_radius, "m", 1e-9, 1e-3, "of the tip where it touches"),
    FIELD(tip_half_angle, "rad", 0.0, 1.5, "psi of the tip's cone"),
    FIELD(step, "m", 1e-13, 1e-6, "largest step of the tip"),
    CONTACT(substrate, "with the substrate"),
    CONTACT(tip, "with the tip"),
};

enum { PARTICLE_FIELDS = (int)(sizeof particle_fields / sizeof particle_fields[0]) };

nt_particle nt_particle_defaults(void)
{
    const nt_material polystyrene = {3.25e9, 0.35}, glass = {70e9, 0.22}, silicon = {169e9, 0.27};
    const nt_particle_contact contact = {.model = NT_JKR, .work_of_adhesion = 0.06, .shear_strength = 12e6};
    nt_particle made = {.radius = 5e-6, .tip_radius = 100e-9, .tip_half_angle = 0.26, .step = 2e-9};
    for (int i = 0; i < NT_PARTICLE_CONTACTS; ++i) {
        const nt_material other = i == NT_AT_SUBSTRATE ? glass : silicon;
        made.contacts[i] = contact;
        made.contacts[i].effective_modulus = nt_effective_modulus(polystyrene, other);
        made.contacts[i].effective_shear_modulus = nt_effective_shear_modulus(polystyrene, other);
    }
    made.contacts[NT_AT_SUBSTRATE].rolling_distance = 42e-9;
    made.contacts[NT_AT_TIP].rolling_distance = 1e-9;
    return made;
}

const nt_field *nt_particle_fields(int *count)
{
    if (count != NULL)
        *count = PARTICLE_FIELDS;
    return particle_fields;
}

/* G* over E* is (1 - nu)/(2 (2 - nu)) for bodies of one nu: 1/3 at -1, 1/6 at 1/2; a mixture lies between. */
static nt_status check_shear(const nt_particle_contact *contact, const char *name, nt_problem *problem)
{
    const double low = contact->effective_modulus / 6.0, high = contact->effective_modulus / 3.0;
    const double modulus = contact->effective_shear_modulus;
    if (modulus >= low * (1.0 - 1e-12) && modulus <= high * (1.0 + 1e-12))
        return NT_OK;
    return nt_problem_set(problem, name, "Pa", modulus, low, high);
}

/* JKR's a0 is R/2 at w = E* R/(36 pi): a sphere that adhesion flattens more is none. */
static nt_status check_adhesion(const nt_particle_contact *contact, double radius, const char *name,
                                nt_problem *problem)
{
    const double most = contact->effective_modulus * radius / (36.0 * NT_PI);
    if (contact->work_of_adhesion <= most)
        return NT_OK;
    return nt_problem_set(problem, name, "J/m^2", contact->work_of_adhesion, 0.0, most);
}

static double reduced_radius(const nt_particle *particle, int which)
{
    const double R = particle->radius, r = particle->tip_radius;
    return which == NT_AT_TIP ? R * r / (R + r) : R;
}

nt_status nt_particle_check(const nt_particle *particle, nt_problem *problem)
{
    static const char *const names[][2] = {{"substrate.effective_shear_modulus", "substrate.work_of_adhesion"},
                                           {"tip.effective_shear_modulus", "tip.work_of_adhesion"}};
    nt_status status = nt_field_check(particle_fields, PARTICLE_FIELDS, particle, problem);
    for (int i = 0; i < NT_PARTICLE_CONTACTS && status == NT_OK; ++i) {
        status = check_shear(&particle->contacts[i], names[i][0], problem);
        if (status == NT_OK)
            status = check_adhesion(&particle->contacts[i], reduced_radius(particle, i), names[i][1], problem);
    }
    return status;
}

static nt_status rest(nt_particle_laws *laws)
{
    const nt_contact *contact = &laws->normal.maugis.contact;
    nt_law_value value = {0};
    nt_status status = NT_OK;
    laws->rest_indentation = 0.0;
    if (laws->normal.model == NT_DMT)
        laws->rest_indentation = nt_dmt_indentation(contact, 0.0);
    else if (laws->normal.model == NT_JKR)
        status = nt_jkr_indentation(contact, 0.0, NT_BRANCH_STABLE, &laws->rest_indentation);
    else if (laws->normal.model == NT_MAUGIS)
        status = nt_maugis_indentation(&laws->normal.maugis, 0.0, NT_BRANCH_STABLE, &laws->rest_indentation, NULL);
    if (status == NT_OK)
        status = nt_contact_law_eval(&laws->normal, laws->rest_indentation, NT_BRANCH_STABLE, &value);
    laws->rest_radius = value.a;
    return status;
}

static nt_status init_contact(nt_particle_laws *laws, const nt_particle_contact *given, double radius)
{
    const double compliance = 1.0 / given->effective_shear_modulus - 2.0 / given->effective_modulus;
    *laws = (nt_particle_laws){
        .friction = {given->effective_shear_modulus, 0.0, given->shear_strength, given->coefficient},
        .torsion_modulus = 1.0 / compliance, /* (2 - nu)/G - (1 - nu)/G = 1/G, summed over both bodies */
        .reduced_radius = radius,
        .rolling_distance = given->rolling_distance,
    };
    const nt_contact contact = {radius, given->effective_modulus, given->work_of_adhesion, given->cohesive_stress};
    nt_status status = nt_contact_law_init(&laws->normal, (nt_model)given->model, &contact);
    if (status != NT_OK)
        return status;
    laws->pull_off = nt_contact_law_pull_off_force(&laws->normal);
    return rest(laws);
}

nt_status nt_pushing_init(nt_pushing *pushing, const nt_particle *particle, nt_problem *problem)
{
    nt_pushing made = {.particle = *particle};
    nt_status status = nt_particle_check(particle, problem);
    if (status != NT_OK)
        return status;
    const char *names[] = {"substrate.cohesive_stress", "tip.cohesive_stress"};
    for (int i = 0; i < NT_PARTICLE_CONTACTS; ++i) {
        status = init_contact(&made.laws[i], &particle->contacts[i], reduced_radius(particle, i));
        if (status != NT_OK) /* all else has been checked */
            return nt_problem_set(problem, names[i], "Pa", particle->contacts[i].cohesive_stress, 1e-3, 1e12);
    }
    *pushing = made;
    return NT_OK;
}

nt_status nt_particle_place(const nt_pushing *pushing, double x, double y, const double tip[3],
                            nt_particle_state *state)
{
    const nt_particle_laws *substrate = &pushing->laws[NT_AT_SUBSTRATE];
    nt_particle_state made = {.position = {x, y, pushing->particle.radius - substrate->rest_indentation},
                              .tip = {tip[0], tip[1], tip[2]},
                              .attached = {1, 0}};
    if (!isfinite(x) || !isfinite(y) || !isfinite(tip[0]) || !isfinite(tip[1]) || !isfinite(tip[2]))
        return NT_E_NOT_FINITE;
    if (tip[2] < 0.0)
        return NT_E_RANGE;
    nt_status status = balance_contacts(pushing, &made);
    if (status == NT_OK && made.attached[NT_AT_TIP])
        status = NT_E_RANGE;
    if (status != NT_OK)
        return status;
    made.modes = NT_PARTICLE_APART;
    *state = made;
    return NT_OK;
}
