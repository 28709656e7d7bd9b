/* SPDX-License-Identifier: BSD-3-Clause
 * A particle as it is described, its contacts made ready, and the particle at rest: see advanced/manipulation.h. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/problem.h"
#include "internal/field.h"
#include "internal/manipulation.h"
#include "manipulation/particle.h"
#include "manipulation/set.h"
#include "nanotouch/material.h"

/* For the dotted names. */
struct described {
    double radius, tip_radius, tip_half_angle, step;
    nt_particle_contact substrate, tip;
};
_Static_assert(sizeof(struct described) == sizeof(nt_particle), "the names are those of the fields");

#define FIELD(path, ...) NT_FIELD(struct described, path, __VA_ARGS__)
static const nt_field particle_fields[] = {
    FIELD(radius, "m", 1e-9, 1e-3, "R of the particle"),
    FIELD(tip_radius, "m", 1e-9, 1e-3, "of the tip where it touches"),
    FIELD(tip_half_angle, "rad", 0.0, 1.5, "psi of the tip's cone"),
    FIELD(step, "m", 1e-13, 1e-6, "largest step of the tip"),
    PARTICLE_CONTACT(struct described, substrate, "with the substrate"),
    PARTICLE_CONTACT(struct described, tip, "with the tip"),
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

nt_status particle_check_contact(const nt_particle_contact *contact, double radius, const char *const names[2],
                                 nt_problem *problem)
{
    const nt_status status = check_shear(contact, names[0], problem);
    return status == NT_OK ? check_adhesion(contact, radius, names[1], problem) : status;
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
    for (int i = 0; i < NT_PARTICLE_CONTACTS && status == NT_OK; ++i)
        status = particle_check_contact(&particle->contacts[i], reduced_radius(particle, i), names[i], problem);
    return status;
}

nt_status nt_pushing_init(nt_pushing *pushing, const nt_particle *particle, nt_problem *problem)
{
    nt_pushing made = {.particle = *particle};
    nt_status status = nt_particle_check(particle, problem);
    if (status != NT_OK)
        return status;
    const char *names[] = {"substrate.cohesive_stress", "tip.cohesive_stress"};
    for (int i = 0; i < NT_PARTICLE_CONTACTS; ++i) {
        status = particle_laws(&made.laws[i], &particle->contacts[i], reduced_radius(particle, i));
        if (status != NT_OK) /* all else has been checked */
            return nt_problem_set(problem, names[i], "Pa", particle->contacts[i].cohesive_stress, 1e-3, 1e12);
    }
    *pushing = made;
    return NT_OK;
}

nt_particle_state particle_at_rest(const nt_pushing *pushing, double x, double y)
{
    const nt_particle_laws *substrate = &pushing->laws[NT_AT_SUBSTRATE];
    return (nt_particle_state){.position = {x, y, pushing->particle.radius - substrate->rest_indentation},
                               .attached = {1, 0},
                               .modes = NT_PARTICLE_APART};
}

/* As a set of one under a tip that is held. */
static nt_particles_state set_of(const nt_particle_state *state)
{
    nt_particles_state set = {.count = 1,
                              .particles = {*state},
                              .stored = state->stored,
                              .dissipated = state->dissipated,
                              .work = state->work};
    memcpy(set.base, state->tip, sizeof set.base);
    memcpy(set.tip, state->tip, sizeof set.tip);
    memcpy(set.force, state->force, sizeof set.force);
    return set;
}

static nt_particle_state state_of(const nt_particles_state *set)
{
    nt_particle_state state = set->particles[0];
    state.stored = set->stored;
    state.dissipated = set->dissipated;
    state.work = set->work;
    return state;
}

nt_status nt_particle_place(const nt_pushing *pushing, double x, double y, const double tip[3],
                            nt_particle_state *state)
{
    const nt_particles alone = {.pushing = *pushing};
    nt_particles_state set;
    nt_status status = nt_particles_begin(&alone, tip, &set);
    if (status == NT_OK)
        status = nt_particles_lay(&alone, &set, 0, (double[2]){x, y});
    if (status == NT_E_STATE)
        return NT_E_RANGE;
    if (status == NT_OK)
        *state = state_of(&set);
    return status;
}

nt_status nt_particle_advance(const nt_pushing *pushing, nt_particle_state *state, const double tip[3])
{
    const nt_particles alone = {.pushing = *pushing};
    nt_particles_state set = set_of(state);
    const nt_status status = nt_particles_advance(&alone, &set, tip);
    if (status == NT_OK)
        *state = state_of(&set);
    return status;
}

nt_status nt_particle_run_n(const nt_pushing *pushing, nt_particle_state *state, const double (*tips)[3],
                            nt_particle_state *states, long count)
{
    for (long i = 0; i < count; ++i) {
        const nt_status status = nt_particle_advance(pushing, state, tips[i]);
        if (status != NT_OK)
            return status;
        states[i] = *state;
    }
    return NT_OK;
}
