/* SPDX-License-Identifier: BSD-3-Clause
 * A particle on its way: limits and stiffnesses of its contacts, one step after the other, and the account of energy.
 */
#include <math.h>
#include <string.h>

#include "manipulation/balance.h"
#include "manipulation/bristle.h"
#include "manipulation/vector.h"

#define STEPS_MAX 1e7
#define REACH_SHARE 0.1
#define FINEST 1e-3 /* of particle.step */

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

/* The bristles for the contacts as they are; turns are lengths, R times an angle. Heat [J]. */
static double begin(balance *step, nt_particle_state *state)
{
    const double R = step->pushing->particle.radius;
    double heat = 0.0;
    for (int i = 0; i < NT_PARTICLE_CONTACTS; ++i) {
        const nt_particle_laws *laws = &step->pushing->laws[i];
        const double load = nt_compressive_load(laws->normal.model, &laws->normal.maugis.contact, state->contacts[i]);
        const nt_friction_contact contact = {state->contacts[i].a, load};
        for (int j = 0; j < NT_BRISTLES; ++j) {
            const double length = j == NT_SLIDING ? 1.0 : R;
            const double stiffness = nt_particle_stiffness(laws, j, contact.radius) / (length * length);
            step->limits[i][j] = nt_particle_limit(laws, j, &contact) / length;
            heat += bristle_change(&state->bristles[i][j], stiffness, step->limits[i][j]);
        }
    }
    memcpy(step->normals[NT_AT_TIP], state->normal, sizeof state->normal);
    step->normals[NT_AT_SUBSTRATE][2] = 1.0;
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

/* Takes the motion over into the state; heat of what gave way [J]. */
static double end(const balance *step, const double motion[FREEDOMS], const balance_value *value,
                  nt_particle_state *state)
{
    const double R = step->pushing->particle.radius;
    double heat = 0.0;
    for (int i = 0; i < 3; ++i) {
        state->position[i] += motion[i];
        state->turned[i] += motion[3 + i] / R;
        state->tip[i] = step->tip[i];
        state->force[i] = value->tip_force[i];
    }
    for (int i = 0; i < NT_PARTICLE_CONTACTS; ++i)
        for (int j = 0; j < NT_BRISTLES; ++j) {
            const double given = state->bristles[i][j].given;
            heat += bristle_end(&state->bristles[i][j], step->limits[i][j], value->stretches[i][j]);
            if (state->bristles[i][j].given > given)
                state->modes |= 1u << (NT_BRISTLES * i + j);
        }
    return heat;
}

/* The hand's work in a step lies between its forces at both ends times the way. What is missing at the least of it was
 * set free in a jump. */
static void account(const balance *step, const double before[3], double stored, double slipped, double changed,
                    nt_particle_state *state)
{
    double first = 0.0, last = 0.0;
    for (int i = 0; i < 3; ++i) {
        const double way = step->tip[i] - step->from->tip[i];
        first -= before[i] * way;
        last -= state->force[i] * way;
    }
    const double kept = state->stored - stored + slipped;
    const double jump = fmax(fmin(first, last) - kept, 0.0);
    state->dissipated += changed + slipped + jump;
    state->work += kept + jump;
}

static nt_status advance_by_a_step(const nt_pushing *pushing, nt_particle_state *state, const double tip[3])
{
    balance step = {.pushing = pushing, .tip = {tip[0], tip[1], tip[2]}};
    double motion[FREEDOMS];
    balance_value value;
    nt_particle_state from = *state, to;
    const double changed = begin(&step, &from), stored = from.stored - changed;
    step.from = &from;
    memcpy(step.attached, from.attached, sizeof step.attached);
    nt_status status = balance_find(&step, motion, &value);
    if (status != NT_OK)
        return status;
    to = from;
    const double slipped = end(&step, motion, &value, &to);
    memcpy(to.attached, step.attached, sizeof to.attached);
    status = balance_contacts(pushing, &to);
    if (status != NT_OK)
        return status;
    for (int j = 0; j < NT_BRISTLES; ++j)
        turn_with(from.normal, to.normal, to.bristles[NT_AT_TIP][j].pull);
    account(&step, from.force, stored, slipped, changed, &to);
    *state = to;
    return NT_OK;
}

/* Equal parts of what is left, each at most particle.step; from a contact that pulls, the tip recedes by a part of its
 * reach at most, or a step would tear off what can follow. */
static double next_step(const nt_pushing *pushing, const nt_particle_state *state, const double way[3], double left)
{
    const nt_particle_laws *laws = &pushing->laws[NT_AT_TIP];
    const double length = norm(way), most = pushing->particle.step;
    double step = most;
    if (state->attached[NT_AT_TIP] && laws->pull_off > 0.0 && dot(way, state->normal) < 0.0) {
        const double reach = laws->rest_indentation - nt_contact_law_grip_indentation(&laws->normal);
        step = fmin(most, fmax(REACH_SHARE * reach * length / -dot(way, state->normal), FINEST * most));
    }
    return left / fmax(ceil(left / step), 1.0);
}

nt_status nt_particle_advance(const nt_pushing *pushing, nt_particle_state *state, const double tip[3])
{
    if (!isfinite(tip[0]) || !isfinite(tip[1]) || !isfinite(tip[2]))
        return NT_E_NOT_FINITE;
    const double way[3] = {tip[0] - state->tip[0], tip[1] - state->tip[1], tip[2] - state->tip[2]};
    const double length = norm(way);
    if (tip[2] < 0.0 || !(length <= STEPS_MAX * pushing->particle.step))
        return NT_E_RANGE;
    nt_particle_state moving = *state;
    moving.modes = 0;
    for (double left = length;;) {
        left -= next_step(pushing, &moving, way, left);
        const double share = left > 0.0 ? left / length : 0.0; /* the end is hit exactly */
        const double to[3] = {tip[0] - share * way[0], tip[1] - share * way[1], tip[2] - share * way[2]};
        const nt_status status = advance_by_a_step(pushing, &moving, to);
        if (status != NT_OK)
            return status;
        if (!(left > 0.0))
            break;
    }
    if (!moving.attached[NT_AT_TIP])
        moving.modes |= NT_PARTICLE_APART;
    else if (!moving.attached[NT_AT_SUBSTRATE])
        moving.modes |= NT_PARTICLE_LIFTED;
    *state = moving;
    return NT_OK;
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
