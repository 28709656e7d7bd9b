/* SPDX-License-Identifier: BSD-3-Clause
 * Particles of a session: what they add to its promise, laid, shown and told of. */
#include <math.h>
#include <string.h>

#include "core/problem.h"
#include "session/state.h"

#define FACES 3.0 /* a tip lies against so many spheres at most ... */
#define PAIRS 9.0 /* ... and so many pairs of six equal ones touch on a plane */
enum { BISECTIONS = 60 };

/* The contact under a load [N]: the deepest of its branches. */
static nt_law_value pressed(const nt_particle_laws *laws, double load)
{
    const double R = laws->normal.maugis.contact.radius;
    double shallow = laws->rest_indentation, deep = R;
    nt_law_value value = {0};
    for (int i = 0; i < BISECTIONS; ++i) {
        const double middle = 0.5 * (shallow + deep);
        if (nt_contact_law_eval(&laws->normal, middle, NT_BRANCH_STABLE, &value) == NT_OK && value.F < load)
            shallow = middle;
        else
            deep = middle;
    }
    (void)nt_contact_law_eval(&laws->normal, deep, NT_BRANCH_STABLE, &value);
    return value;
}

/* What gives way at a contact under a load [N]. */
static double limit_under(const nt_particle_laws *laws, int bristle, double load)
{
    const nt_law_value value = pressed(laws, load);
    const nt_friction_contact contact = {value.a,
                                         nt_compressive_load(laws->normal.model, &laws->normal.maugis.contact, value)};
    return nt_particle_limit(laws, bristle, &contact);
}

/* Largest push sideways that all of them resist while the tip presses with a load [N]. Each slides at most. Or each
 * rolls, no faster than the tip goes: by the power of the push, its rolling torque over R, and friction times how fast
 * surfaces can rub: 3 at the tip, 2 where two of them touch. */
static double resistance(const nt_particles *particles, double load)
{
    const nt_particle_laws *laws = particles->pushing.laws;
    const double R = particles->pushing.particle.radius;
    const double slides = NT_PARTICLES * limit_under(&laws[NT_AT_SUBSTRATE], NT_SLIDING, load);
    const double most = load + slides;
    const double rolls = NT_PARTICLES * limit_under(&laws[NT_AT_SUBSTRATE], NT_ROLLING, load) / R +
                         FACES * limit_under(&laws[NT_AT_TIP], NT_ROLLING, most) / R +
                         PAIRS * limit_under(&particles->pair, NT_ROLLING, most) / R;
    const double rubs = 3.0 * FACES * limit_under(&laws[NT_AT_TIP], NT_SLIDING, most) +
                        2.0 * PAIRS * limit_under(&particles->pair, NT_SLIDING, most);
    return fmin(slides, rolls + rubs);
}

/* Of the tip's contact, along its normal or across: under the limit above, or what a row bears beside the flank. */
static double stiffest(const nt_particles *particles, double load)
{
    const nt_particle_laws *laws = &particles->pushing.laws[NT_AT_TIP];
    const nt_law_value value = pressed(laws, load + resistance(particles, load));
    return fmax(value.k, nt_particle_stiffness(laws, NT_SLIDING, value.a));
}

double nt_composition_stiffness(const nt_composition *composition)
{
    const double of_plan = nt_terrain_plan(composition->terrain)->maximum_stiffness;
    const double limit = composition->setup.settings.limits.force;
    return composition->pushes ? fmax(of_plan, stiffest(&composition->particles, limit)) : of_plan;
}

/* Where the tip is pressed with the limit F, what resists with L gives way on each slope that is steeper than L/F. */
double nt_composition_slope(const nt_composition *composition)
{
    const double limit = composition->setup.settings.limits.force;
    if (!composition->pushes)
        return composition->reach.slope;
    return fmax(composition->reach.slope, resistance(&composition->particles, limit) / limit);
}

void nt_composition_add_particles(const nt_composition *composition, nt_hazard *hazard)
{
    const nt_particles *particles = &composition->particles;
    const double limit = composition->setup.settings.limits.force;
    const double lever = composition->setup.rig.probe.lateral_stiffness;
    if (!composition->pushes)
        return;
    const double hard = stiffest(particles, limit);
    hazard->stiffness = fmax(hazard->stiffness, hard);
    for (int i = 0; i < NT_FAILURES; ++i)
        hazard->failing[i] = fmax(hazard->failing[i], hard);
    hazard->pull_off_force += FACES * particles->pushing.laws[NT_AT_TIP].pull_off;
    if (lever > 0.0)
        hazard->stick = fmax(hazard->stick, hard / (1.0 + hard / lever));
}

double nt_composition_resistance(const nt_composition *composition, double load)
{
    const nt_particles *particles = &composition->particles;
    if (!composition->pushes)
        return 0.0;
    return resistance(particles, load) + FACES * particles->pushing.laws[NT_AT_TIP].pull_off;
}

nt_status nt_session_lay(nt_session *session, int number, const double place[2])
{
    nt_call call = {.event = {.kind = NT_EVENT_LAY, .field = (uint32_t)number, .value = {place[0], place[1]}}};
    if (!session)
        return NT_E_ARGUMENT;
    if (number < 0)
        return NT_E_CAPACITY;
    if (nt_session_runs_here(session))
        return NT_E_STATE;
    nt_session_lock(session);
    nt_status status = nt_session_prepare(session, &call, NULL);
    if (status == NT_OK)
        status = nt_session_ask(session, &call);
    nt_session_unlock(session);
    return status;
}

void nt_session_show_particles(nt_session *session)
{
    const nt_sim_particles *pushed = &session->sim.slave.pushed;
    const nt_particles_state *state = &pushed->state;
    nt_session_particles shown = {.count = state->count,
                                  .radius = pushed->laws.pushing.particle.radius,
                                  .tick = session->touch_state.ticks,
                                  .stored = state->stored,
                                  .dissipated = state->dissipated};
    for (int i = 0; i < state->count; ++i) {
        memcpy(shown.position[i], state->particles[i].position, sizeof shown.position[i]);
        memcpy(shown.force[i], state->particles[i].force, sizeof shown.force[i]);
        shown.touches[i] = pushed->touches[i];
        shown.losses[i] = pushed->losses[i];
    }
    nt_mailbox_post(&session->shown, &shown);
}

nt_status nt_session_keep_pushed(nt_session *session)
{
    const nt_sim_particles *pushed = &session->sim.slave.pushed;
    nt_status status = NT_OK;
    for (uint32_t i = 0; i < NT_PARTICLES && status == NT_OK; ++i) {
        const double *before = pushed->before[i], *now = pushed->rested[i];
        const nt_event event = {
            .kind = NT_EVENT_PUSHED, .field = i, .value = {before[NT_X], before[NT_Y], now[NT_X], now[NT_Y]}};
        if (pushed->left >> i & 1u)
            status = nt_session_keep_event(session, &event);
    }
    return status;
}

nt_status nt_session_read_particles(nt_session *session, nt_session_particles *particles)
{
    if (!session || !particles)
        return NT_E_ARGUMENT;
    if (!session->simulates[NT_HALF_SLAVE] || !session->now->pushes)
        return NT_E_UNSUPPORTED;
    (void)nt_mailbox_take(&session->shown, &session->newest);
    *particles = session->newest;
    return NT_OK;
}
