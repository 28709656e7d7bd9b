/* SPDX-License-Identifier: BSD-3-Clause
 * Particles on their way: limits and stiffnesses of their contacts, one step after the other, and the account of
 * energy.
 */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "internal/manipulation.h"
#include "manipulation/bristle.h"
#include "manipulation/particles.h"
#include "manipulation/set.h"
#include "manipulation/vector.h"

#define STEPS_MAX 1e7
#define REACH_SHARE 0.1
#define FINEST 1e-3 /* of particle.step */
#define NEAR 0.1    /* of R: who is nearer than this takes part in a step */

/* (a/a0)^1.5, of roots: the same bits everywhere. */
static double rolling_share(const nt_particle_laws *laws, double radius)
{
    const double ratio = laws->rest_radius > 0.0 ? radius / laws->rest_radius : 0.0;
    return ratio * sqrt(ratio);
}

double nt_particle_limit(const nt_particle_laws *laws, int bristle, const nt_friction_contact *contact)
{
    const double a = contact->radius, pull_off = laws->pull_off;
    if (bristle == NT_SLIDING)
        return nt_friction_limit(&laws->friction, contact);
    if (bristle == NT_ROLLING)
        return 4.0 * pull_off * rolling_share(laws, a) * laws->rolling_distance;
    return NT_PI * a *
           (2.0 / 3.0 * laws->friction.shear_strength * a * a +
            3.0 / 16.0 * laws->friction.coefficient * contact->compressive_load);
}

double nt_particle_stiffness(const nt_particle_laws *laws, int bristle, double radius)
{
    if (bristle == NT_SLIDING)
        return nt_friction_stiffness(&laws->friction, radius);
    if (bristle == NT_ROLLING)
        return 4.0 * laws->pull_off * rolling_share(laws, radius) * laws->reduced_radius;
    return 16.0 / 3.0 * radius * radius * radius * laws->torsion_modulus;
}

/* One step: who takes part, in the order of their numbers. */
typedef struct stride {
    balance balance;
    int members[NT_PARTICLES];
} stride;

static double gap_to_tip(const nt_particles *by, const nt_particle_state *of, const double tip[3])
{
    double n[3];
    return -balance_tip_indentation(&by->pushing.particle, of->position, tip, n);
}

static double gap_between(const nt_particles *by, const nt_particle_state *a, const nt_particle_state *b)
{
    double away[3];
    for (int i = 0; i < 3; ++i)
        away[i] = a->position[i] - b->position[i];
    return norm(away) - 2.0 * by->pushing.particle.radius;
}

/* Those that the tip may reach, and those that these may push. */
static void gather(const nt_particles *by, const nt_particles_state *state, const double base[3], stride *step)
{
    const double way[3] = {base[0] - state->tip[0], base[1] - state->tip[1], base[2] - state->tip[2]};
    const double near = NEAR * by->pushing.particle.radius + 2.0 * norm(way);
    int takes_part[NT_PARTICLES] = {0}, found = 0;
    for (int i = 0; i < state->count; ++i) {
        const nt_particle_state *of = &state->particles[i];
        const int touches = of->attached[NT_AT_TIP];
        takes_part[i] = touches || fmin(gap_to_tip(by, of, base), gap_to_tip(by, of, state->tip)) < near;
        found |= takes_part[i];
    }
    while (found) {
        found = 0;
        for (int i = 0; i < state->count; ++i)
            for (int j = 0; j < state->count && !takes_part[i]; ++j)
                if (takes_part[j] && gap_between(by, &state->particles[i], &state->particles[j]) < near)
                    found = takes_part[i] = 1;
    }
    for (int i = 0; i < state->count; ++i)
        if (takes_part[i])
            step->members[step->balance.particles++] = i;
}

static nt_bristle *bristles_of(const stride *step, const balance_link *link, nt_particles_state *state)
{
    const int i = step->members[link->particle];
    if (link->other < 0)
        return state->particles[i].bristles[link->other == BODY_TIP ? NT_AT_TIP : NT_AT_SUBSTRATE];
    return state->pairs[nt_particle_pair_of(step->members[link->other], i)].bristles;
}

/* A link with its bristles as the contact now is; turns are lengths, R times an angle. Heat [J]. */
static double add_link(stride *step, const balance_link *link, const nt_law_value *contact, nt_particles_state *state)
{
    const nt_particle_laws *laws = link->laws;
    const double R = step->balance.particle->radius;
    const double load = nt_compressive_load(laws->normal.model, &laws->normal.maugis.contact, *contact);
    const nt_friction_contact at = {contact->a, load};
    balance_link *made = &step->balance.link[step->balance.links++];
    nt_bristle *bristles = bristles_of(step, link, state);
    double heat = 0.0;
    *made = *link;
    made->bristles = bristles;
    for (int j = 0; j < NT_BRISTLES; ++j) {
        const double length = j == NT_SLIDING ? 1.0 : R;
        const double stiffness = nt_particle_stiffness(laws, j, at.radius) / (length * length);
        made->limits[j] = nt_particle_limit(laws, j, &at) / length;
        heat += bristle_change(&bristles[j], stiffness, made->limits[j]);
    }
    return heat;
}

/* Of a particle with tip and substrate, and with those before it. Heat of both [J]. */
static double add_links(const nt_particles *by, stride *step, int number, nt_particles_state *state)
{
    nt_particle_state *of = &state->particles[step->members[number]];
    balance_link tip = {.laws = &by->pushing.laws[NT_AT_TIP], .particle = number, .other = BODY_TIP};
    balance_link substrate = {.laws = &by->pushing.laws[NT_AT_SUBSTRATE], .particle = number, .other = BODY_SUBSTRATE};
    memcpy(tip.normal, of->normal, sizeof tip.normal);
    tip.attached = of->attached[NT_AT_TIP];
    substrate.normal[2] = 1.0;
    substrate.attached = of->attached[NT_AT_SUBSTRATE];
    const double own = add_link(step, &tip, &of->contacts[NT_AT_TIP], state) +
                       add_link(step, &substrate, &of->contacts[NT_AT_SUBSTRATE], state);
    double heat = own;
    of->dissipated += own;
    for (int other = 0; other < number; ++other) {
        nt_particle_pair *pair = &state->pairs[nt_particle_pair_of(step->members[other], step->members[number])];
        balance_link link = {.laws = &by->pair, .particle = number, .other = other, .attached = pair->attached};
        memcpy(link.normal, pair->normal, sizeof link.normal);
        heat += add_link(step, &link, &pair->contact, state);
    }
    return heat;
}

/* All that a step holds; heat of contacts that have changed [J]. */
static double begin(const nt_particles *by, nt_particles_state *state, const double base[3], stride *step)
{
    balance *b = &step->balance;
    double heat = 0.0;
    memset(step, 0, offsetof(stride, balance.link));
    b->particle = &by->pushing.particle;
    memcpy(b->tip, state->tip, sizeof b->tip);
    memcpy(b->base, base, sizeof b->base);
    memcpy(b->lever, by->lever, sizeof b->lever);
    gather(by, state, base, step);
    balance_count(b);
    for (int p = 0; p < b->particles; ++p) {
        memcpy(b->from[p], state->particles[step->members[p]].position, sizeof b->from[p]);
        heat += add_links(by, step, p, state);
    }
    return heat;
}

/* The shortest turn that takes the old normal to the new one. */
static void turn_with(const double from[3], const double to[3], double pull[3])
{
    const double along = dot(pull, from), share = 1.0 + dot(from, to);
    double sum[3], side[3];
    for (int i = 0; i < 3; ++i) {
        sum[i] = from[i] + to[i];
        side[i] = pull[i] - along * from[i];
    }
    const double back = share > 0.0 ? dot(side, to) / share : 0.0;
    for (int i = 0; i < 3; ++i)
        pull[i] = side[i] - back * sum[i] + along * to[i];
}

/* Takes over what became of a link; heat of what gave way [J]. */
static double end_link(const stride *step, int which, const balance_value *value, nt_particles_state *to)
{
    const balance_link *link = &step->balance.link[which];
    nt_bristle *bristles = bristles_of(step, link, to);
    nt_particle_state *of = &to->particles[step->members[link->particle]];
    double heat = 0.0;
    unsigned gave = 0;
    for (int j = 0; j < NT_BRISTLES; ++j) {
        const double given = bristles[j].given;
        heat += bristle_end(&bristles[j], link->limits[j], value->link[which].stretches[j]);
        gave |= bristles[j].given > given ? 1u << j : 0u;
    }
    if (link->other >= 0) {
        to->pairs[nt_particle_pair_of(step->members[link->other], step->members[link->particle])].attached =
            link->attached;
        return heat;
    }
    const int contact = link->other == BODY_TIP ? NT_AT_TIP : NT_AT_SUBSTRATE;
    of->attached[contact] = link->attached;
    of->dissipated += heat;
    of->modes |= gave << (NT_BRISTLES * contact);
    return heat;
}

/* Takes the motion over into the state; heat of what gave way [J]. */
static double end(const stride *step, const double motion[], const balance_value *value, nt_particles_state *to)
{
    const balance *b = &step->balance;
    double heat = 0.0;
    for (int i = 0; i < to->count; ++i) {
        memset(to->particles[i].force, 0, sizeof to->particles[i].force);
        memcpy(to->particles[i].tip, value->tip, sizeof value->tip);
    }
    for (int p = 0; p < b->particles; ++p)
        for (int i = 0; i < 3; ++i) {
            nt_particle_state *of = &to->particles[step->members[p]];
            of->position[i] += motion[FREEDOMS * p + i];
            of->turned[i] += motion[FREEDOMS * p + 3 + i] / b->particle->radius;
            of->force[i] = value->tip_shares[p][i];
        }
    memcpy(to->base, b->base, sizeof to->base);
    memcpy(to->tip, value->tip, sizeof to->tip);
    memcpy(to->force, value->tip_force, sizeof to->force);
    for (int which = 0; which < b->links; ++which)
        heat += end_link(step, which, value, to);
    return heat;
}

/* Bristles that are not the substrate's turn with the line of centres. */
static void turn_bristles(const stride *step, const nt_particles_state *from, nt_particles_state *to)
{
    for (int which = 0; which < step->balance.links; ++which) {
        const balance_link *link = &step->balance.link[which];
        const int i = step->members[link->particle];
        if (link->other == BODY_SUBSTRATE)
            continue;
        const int pair = link->other >= 0 ? nt_particle_pair_of(step->members[link->other], i) : -1;
        const double *before = pair < 0 ? from->particles[i].normal : from->pairs[pair].normal;
        const double *now = pair < 0 ? to->particles[i].normal : to->pairs[pair].normal;
        for (int j = 0; j < NT_BRISTLES; ++j)
            turn_with(before, now, bristles_of(step, link, to)[j].pull);
    }
}

/* The hand's work in a step lies between its forces at both ends times the way of the base. What is missing at the
 * least of it was set free in a jump. */
static void account(const nt_particles_state *before, double stored, double slipped, double changed,
                    nt_particles_state *to)
{
    double first = 0.0, last = 0.0;
    for (int i = 0; i < 3; ++i) {
        const double way = to->base[i] - before->base[i];
        first -= before->force[i] * way;
        last -= to->force[i] * way;
    }
    const double kept = to->stored - stored + slipped;
    const double jump = fmax(fmin(first, last) - kept, 0.0);
    to->dissipated += changed + slipped + jump;
    to->work += kept + jump;
}

static nt_status advance_by_a_step(const nt_particles *by, nt_particles_state *state, const double base[3], int is_last)
{
    stride step;
    double motion[BALANCE_FREEDOMS];
    balance_value value;
    nt_particles_state from, to;
    particles_copy(&from, state);
    const double changed = begin(by, &from, base, &step), stored = from.stored - changed;
    nt_status status = balance_find(&step.balance, motion, &value);
    if (status != NT_OK)
        return status;
    particles_copy(&to, &from);
    const double slipped = end(&step, motion, &value, &to);
    status = particles_contacts(by, &to);
    if (status != NT_OK)
        return status;
    turn_bristles(&step, &from, &to);
    to.resistance = is_last ? balance_resistance(&step.balance, &value) : 0.0;
    account(&from, stored, slipped, changed, &to);
    particles_copy(state, &to);
    return NT_OK;
}

/* Equal parts of what is left, each at most particle.step; from a contact that pulls, the tip recedes by a part of its
 * reach at most, or a step would tear off what can follow. */
static double next_step(const nt_particles *by, const nt_particles_state *state, const double way[3], double left)
{
    const nt_particle_laws *laws = &by->pushing.laws[NT_AT_TIP];
    const double length = norm(way), most = by->pushing.particle.step;
    const double reach = laws->rest_indentation - nt_contact_law_grip_indentation(&laws->normal);
    double step = most;
    for (int i = 0; i < state->count && laws->pull_off > 0.0; ++i) {
        const double recedes = -dot(way, state->particles[i].normal);
        if (state->particles[i].attached[NT_AT_TIP] && recedes > 0.0)
            step = fmin(step, fmax(REACH_SHARE * reach * length / recedes, FINEST * most));
    }
    return left / fmax(ceil(left / step), 1.0);
}

/* What each particle is at the end of its way. */
static void tell_ends(nt_particles_state *state)
{
    for (int i = 0; i < state->count; ++i) {
        nt_particle_state *of = &state->particles[i];
        if (!of->attached[NT_AT_TIP])
            of->modes |= NT_PARTICLE_APART;
        else if (!of->attached[NT_AT_SUBSTRATE])
            of->modes |= NT_PARTICLE_LIFTED;
    }
}

/* Does the tip stay away from all of them, by more than what takes part in a step? */
static int is_clear(const nt_particles *by, const nt_particles_state *state, double way)
{
    for (int i = 0; i < state->count; ++i) {
        const nt_particle_state *of = &state->particles[i];
        if (of->attached[NT_AT_TIP] ||
            !(gap_to_tip(by, of, state->tip) > NEAR * by->pushing.particle.radius + 2.0 * way))
            return 0;
    }
    return 1;
}

/* The tip goes alone. */
static void pass_by(const nt_particles *by, nt_particles_state *state, const double base[3])
{
    memcpy(state->base, base, sizeof state->base);
    memcpy(state->tip, base, sizeof state->tip);
    state->resistance = 0.0;
    for (int i = 0; i < state->count; ++i) {
        nt_particle_state *of = &state->particles[i];
        (void)balance_tip_indentation(&by->pushing.particle, of->position, base, of->normal);
        memcpy(of->tip, base, sizeof of->tip);
        of->modes = NT_PARTICLE_APART;
    }
}

nt_status nt_particles_advance(const nt_particles *particles, nt_particles_state *state, const double base[3])
{
    if (!isfinite(base[0]) || !isfinite(base[1]) || !isfinite(base[2]))
        return NT_E_NOT_FINITE;
    const double way[3] = {base[0] - state->base[0], base[1] - state->base[1], base[2] - state->base[2]};
    const double length = norm(way);
    if (base[2] < 0.0 || !(length <= STEPS_MAX * particles->pushing.particle.step))
        return NT_E_RANGE;
    if (is_clear(particles, state, length)) {
        pass_by(particles, state, base);
        return NT_OK;
    }
    nt_particles_state moving;
    particles_copy(&moving, state);
    for (int i = 0; i < moving.count; ++i)
        moving.particles[i].modes = 0;
    for (double left = length;;) {
        left -= next_step(particles, &moving, way, left);
        const double share = left > 0.0 ? left / length : 0.0; /* the end is hit exactly */
        const double to[3] = {base[0] - share * way[0], base[1] - share * way[1], base[2] - share * way[2]};
        const nt_status status = advance_by_a_step(particles, &moving, to, !(left > 0.0));
        if (status != NT_OK)
            return status;
        if (!(left > 0.0))
            break;
    }
    tell_ends(&moving);
    particles_copy(state, &moving);
    return NT_OK;
}
