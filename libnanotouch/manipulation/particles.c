/* SPDX-License-Identifier: BSD-3-Clause
 * A set of particles as it is described, its contacts made ready, and laid on the substrate: see
 * advanced/manipulation.h. */
#include "internal/contact.h"
#include "internal/field.h"
#include "internal/manipulation.h"
#include "nanotouch/advanced/manipulation.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/problem.h"
#include "manipulation/bristle.h"
#include "manipulation/particle.h"
#include "manipulation/particles.h"
#include "manipulation/set.h"
#include "nanotouch/material.h"

#define LEVER(name, axis)                                                                                              \
    NT_FIELD_NAMED(name, nt_particles_setup, lever[axis], "N/m", 0.0, 1e9, "between base and tip; 0: held")

static const nt_field setup_fields[] = {
    PARTICLE_CONTACT(nt_particles_setup, between, "of two particles"),
    LEVER("lever.x", 0),
    LEVER("lever.y", 1),
    LEVER("lever.z", 2),
};

enum { SETUP_FIELDS = (int)(sizeof setup_fields / sizeof setup_fields[0]) };

const nt_field *nt_particles_fields(int *count)
{
    if (count != NULL)
        *count = SETUP_FIELDS;
    return setup_fields;
}

nt_particles_setup nt_particles_defaults(void)
{
    const nt_material polystyrene = {3.25e9, 0.35};
    return (nt_particles_setup){
        .particle = nt_particle_defaults(),
        .between = {.model = NT_HERTZ,
                    .effective_modulus = nt_effective_modulus(polystyrene, polystyrene),
                    .effective_shear_modulus = nt_effective_shear_modulus(polystyrene, polystyrene),
                    .shear_strength = 12e6},
    };
}

nt_status nt_particles_check(const nt_particles_setup *setup, nt_problem *problem)
{
    static const char *const names[] = {"between.effective_shear_modulus", "between.work_of_adhesion"};
    nt_status status = nt_particle_check(&setup->particle, problem);
    if (status == NT_OK)
        status = nt_field_check(setup_fields, SETUP_FIELDS, setup, problem);
    if (status == NT_OK)
        status = particle_check_contact(&setup->between, 0.5 * setup->particle.radius, names, problem);
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
    laws->rest_energy = value.U;
    return status;
}

nt_status particle_laws(nt_particle_laws *laws, const nt_particle_contact *given, double radius)
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

nt_status nt_particles_init(nt_particles *particles, const nt_particles_setup *setup, nt_problem *problem)
{
    nt_particles made = {.between = setup->between};
    nt_status status = nt_particles_check(setup, problem);
    if (status == NT_OK)
        status = nt_pushing_init(&made.pushing, &setup->particle, problem);
    if (status != NT_OK)
        return status;
    memcpy(made.lever, setup->lever, sizeof made.lever);
    status = particle_laws(&made.pair, &setup->between, 0.5 * setup->particle.radius);
    if (status != NT_OK) /* all else has been checked */
        return nt_problem_set(problem, "between.cohesive_stress", "Pa", setup->between.cohesive_stress, 1e-3, 1e12);
    *particles = made;
    return NT_OK;
}

int nt_particle_pair_of(int i, int j)
{
    return i * (2 * NT_PARTICLES - i - 1) / 2 + j - i - 1;
}

void particles_copy(nt_particles_state *to, const nt_particles_state *from)
{
    memcpy(to, from, offsetof(nt_particles_state, particles) + (size_t)from->count * sizeof from->particles[0]);
    if (from->count > 1)
        memcpy(to->pairs, from->pairs, sizeof to->pairs);
}

static double stored_in(const nt_bristle bristles[NT_BRISTLES])
{
    double sum = 0.0;
    for (int j = 0; j < NT_BRISTLES; ++j)
        sum += bristle_stored(&bristles[j]);
    return sum;
}

static nt_status own_contacts(const nt_particles *by, const double tip[3], nt_particle_state *state)
{
    const nt_particle *particle = &by->pushing.particle;
    const nt_particle_laws *laws = by->pushing.laws;
    const double depths[] = {particle->radius - state->position[2],
                             balance_tip_indentation(particle, state->position, tip, state->normal)};
    nt_status status = NT_OK;
    state->stored = -laws[NT_AT_SUBSTRATE].rest_energy;
    for (int i = 0; i < NT_PARTICLE_CONTACTS && status == NT_OK; ++i) {
        nt_law_value *contact = &state->contacts[i];
        status = balance_contact(&laws[i], state->attached[i], depths[i], contact);
        state->attached[i] = contact->a > 0.0 || contact->F != 0.0;
        state->stored += contact->U + stored_in(state->bristles[i]);
    }
    return status;
}

static nt_status pair_contact(const nt_particles *by, const nt_particle_state *a, const nt_particle_state *b,
                              nt_particle_pair *pair)
{
    double way[3], square = 0.0;
    for (int i = 0; i < 3; ++i) {
        way[i] = b->position[i] - a->position[i];
        square += way[i] * way[i];
    }
    const double distance = sqrt(square);
    for (int i = 0; i < 3; ++i)
        pair->normal[i] = distance > 0.0 ? way[i] / distance : (double)(i == 0);
    const double indentation = 2.0 * by->pushing.particle.radius - distance;
    const nt_status status = balance_contact(&by->pair, pair->attached, indentation, &pair->contact);
    pair->attached = pair->contact.a > 0.0 || pair->contact.F != 0.0;
    return status;
}

nt_status particles_contacts(const nt_particles *by, nt_particles_state *state)
{
    nt_status status = NT_OK;
    state->stored = 0.0;
    for (int j = 0; j < state->count && status == NT_OK; ++j) {
        status = own_contacts(by, state->tip, &state->particles[j]);
        state->stored += state->particles[j].stored;
        for (int i = 0; i < j && status == NT_OK; ++i) {
            nt_particle_pair *pair = &state->pairs[nt_particle_pair_of(i, j)];
            status = pair_contact(by, &state->particles[i], &state->particles[j], pair);
            state->stored += pair->contact.U + stored_in(pair->bristles);
        }
    }
    for (int i = 0; i < 3; ++i) {
        const double bent = state->base[i] - state->tip[i];
        state->stored += 0.5 * by->lever[i] * bent * bent;
    }
    return status;
}

nt_status nt_particles_begin(const nt_particles *particles, const double base[3], nt_particles_state *state)
{
    (void)particles;
    if (!isfinite(base[0]) || !isfinite(base[1]) || !isfinite(base[2]))
        return NT_E_NOT_FINITE;
    if (base[2] < 0.0)
        return NT_E_RANGE;
    *state = (nt_particles_state){.base = {base[0], base[1], base[2]}, .tip = {base[0], base[1], base[2]}};
    return NT_OK;
}

/* Unstrained where it lies; what it pressed is free of it. */
static void let_go(const nt_particles *by, nt_particles_state *state, int number, const double place[2])
{
    nt_particle_state *of = &state->particles[number];
    const nt_particle_state before = *of;
    *of = particle_at_rest(&by->pushing, place[0], place[1]);
    memcpy(of->tip, state->tip, sizeof of->tip);
    memcpy(of->turned, before.turned, sizeof of->turned);
    of->dissipated = before.dissipated;
    for (int i = 0; i < state->count; ++i)
        if (i != number)
            state->pairs[i < number ? nt_particle_pair_of(i, number) : nt_particle_pair_of(number, i)] =
                (nt_particle_pair){0};
}

/* With which others it is in touch; 1: with one at least. */
static int touched_by(const nt_particles_state *state, int number, int touched[NT_PARTICLES])
{
    int any = 0;
    for (int i = 0; i < state->count; ++i) {
        const int pair = i < number ? nt_particle_pair_of(i, number) : nt_particle_pair_of(number, i);
        touched[i] = i != number && state->pairs[pair].attached;
        any |= touched[i];
    }
    return any;
}

nt_status nt_particles_lay(const nt_particles *particles, nt_particles_state *state, int number, const double place[2])
{
    nt_particles_state laid = *state;
    int touched[NT_PARTICLES] = {0};
    if (!isfinite(place[0]) || !isfinite(place[1]))
        return NT_E_NOT_FINITE;
    if (number < 0 || number > state->count || number >= NT_PARTICLES)
        return NT_E_CAPACITY;
    if (number < state->count && state->particles[number].attached[NT_AT_TIP])
        return NT_E_STATE;
    if (number == state->count)
        ++laid.count;
    (void)touched_by(&laid, number, touched);
    for (int i = 0; i < laid.count; ++i) /* those that it leaned on come to rest where they are */
        if (touched[i] && !laid.particles[i].attached[NT_AT_TIP])
            let_go(particles, &laid, i, laid.particles[i].position);
    let_go(particles, &laid, number, place);
    const nt_status status = particles_contacts(particles, &laid);
    if (status != NT_OK)
        return status;
    if (laid.particles[number].attached[NT_AT_TIP] || touched_by(&laid, number, touched))
        return NT_E_STATE;
    laid.dissipated += fmax(state->stored - laid.stored, 0.0);
    *state = laid;
    return NT_OK;
}

int nt_particles_touches(const nt_particles_state *state)
{
    for (int i = 0; i < state->count; ++i)
        if (state->particles[i].attached[NT_AT_TIP])
            return 1;
    return 0;
}
