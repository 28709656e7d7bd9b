/* SPDX-License-Identifier: BSD-3-Clause
 * What lies on the surface of a session: what it adds to its promise, laid, shown and told of. */
#include <math.h>
#include <string.h>

#include "core/problem.h"
#include "internal/manipulation.h"
#include "internal/margins.h"
#include "internal/session.h"
#include "session/state.h"
#include "session/terrain.h"

int nt_composition_pushes(const nt_composition *composition)
{
    return composition->pushed.kind != NT_PUSHED_NOTHING;
}

/* What a kind cannot be in, and what it has to share with the scene. */
typedef struct terms {
    const char *taps, *dynamic, *surface, *tip_radius, *tip_half_angle;
} terms;
static const terms terms_of[] = {
    [NT_PUSHED_PARTICLES] = {"particles in a session that taps", "particles with a dynamic probe",
                             "surface (particles lie on a flat)", "particles.tip_radius (that of the scene)",
                             "particles.tip_half_angle (that of the scene)"},
    [NT_PUSHED_ROD] = {"rod in a session that taps", "rod with a dynamic probe", "surface (a rod lies on a flat)",
                       "rod.tip_radius (that of the scene)", "rod.tip_half_angle (that of the scene)"},
};

/* Under what limit and friction press together, the tip does not go through the rod. */
static nt_status check_rod(const nt_composition *made, nt_problem *problem)
{
    const nt_rod *rod = &made->pushed.of.rod;
    const double slides = nt_rod_friction(rod) * rod->length, limit = made->setup.settings.limits.force;
    const double least = 4.0 * sqrt(slides * slides + limit * limit) / fmin(rod->radius, rod->tip_radius);
    if (made->pushed.kind != NT_PUSHED_ROD || rod->tip_stiffness >= least)
        return NT_OK;
    return nt_problem_set(problem, "rod.tip_stiffness (a tip that does not go through it under the force limit)", "N/m",
                          rod->tip_stiffness, least, 1e9);
}

static nt_status check_first(const nt_composition *made, nt_problem *problem)
{
    const nt_session_setup *setup = &made->setup;
    const nt_surface *surface = nt_terrain_surface(made->terrain);
    const double R = setup->scene.tip.radius, psi = setup->scene.tip.half_angle;
    const nt_particle *particle = &made->pushed.of.particles.pushing.particle;
    const nt_rod *rod = &made->pushed.of.rod;
    const int is_rod = made->pushed.kind == NT_PUSHED_ROD;
    const double radius = is_rod ? rod->tip_radius : particle->tip_radius;
    const double half_angle = is_rod ? rod->tip_half_angle : particle->tip_half_angle;
    const terms *of = &terms_of[made->pushed.kind];
    if (setup->mode == NT_MODE_TAPPING)
        return nt_problem_set(problem, of->taps, "no|yes", 1.0, 0.0, 0.0);
    if (setup->probe_model == NT_PROBE_DYNAMIC)
        return nt_problem_set(problem, of->dynamic, "no|yes", 1.0, 0.0, 0.0);
    if (surface && (surface->height_minimum != 0.0 || surface->height_maximum != 0.0))
        return nt_problem_set(problem, of->surface, "m", surface->height_maximum - surface->height_minimum, 0.0, 0.0);
    if (radius != R)
        return nt_problem_set(problem, of->tip_radius, "m", radius, R, R);
    if (half_angle != psi)
        return nt_problem_set(problem, of->tip_half_angle, "rad", half_angle, psi, psi);
    return NT_OK;
}

nt_status nt_composition_take_pushed(nt_composition *made, const nt_composition *before, nt_problem *problem)
{
    const nt_session_setup *setup = &made->setup;
    nt_status status = NT_OK;
    if (setup->particles && setup->rod)
        return nt_problem_set(problem, "rod beside particles (a session has the one or the other)", "no|yes", 1.0, 0.0,
                              0.0);
    if (before)
        made->pushed = before->pushed; /* what the first one had stays */
    else if (setup->particles)
        made->pushed = nt_pushed_particles(setup->particles);
    else if (setup->rod)
        made->pushed = nt_pushed_rod(setup->rod);
    if (!before && setup->rod)
        status = nt_rod_check(setup->rod, problem);
    if (status == NT_OK && !before && nt_composition_pushes(made))
        status = check_first(made, problem);
    return status == NT_OK ? check_rod(made, problem) : status;
}

static nt_pushed_bound bound_of(const nt_composition *composition, double load)
{
    return nt_composition_pushes(composition) ? nt_pushed_bound_of(&composition->pushed, load) : (nt_pushed_bound){0};
}

double nt_composition_stiffness(const nt_composition *composition)
{
    const double of_plan = nt_terrain_plan(composition->terrain)->maximum_stiffness;
    return fmax(of_plan, bound_of(composition, composition->setup.settings.limits.force).stiffness);
}

/* Where the tip is pressed with the limit F, what resists with L gives way on each slope that is steeper than L/F. */
double nt_composition_slope(const nt_composition *composition)
{
    const double limit = composition->setup.settings.limits.force;
    return fmax(composition->reach.slope, bound_of(composition, limit).resistance / limit);
}

void nt_composition_add_pushed(const nt_composition *composition, nt_hazard *hazard)
{
    const nt_pushed_bound bound = bound_of(composition, composition->setup.settings.limits.force);
    const double hard = bound.stiffness, lever = composition->setup.rig.probe.lateral_stiffness;
    if (!nt_composition_pushes(composition))
        return;
    hazard->stiffness = fmax(hazard->stiffness, hard);
    for (int i = 0; i < NT_FAILURES; ++i)
        hazard->failing[i] = fmax(hazard->failing[i], hard);
    hazard->pull_off_force += bound.pull_off;
    if (lever > 0.0)
        hazard->stick = fmax(hazard->stick, hard / (1.0 + hard / lever));
}

double nt_composition_resistance(const nt_composition *composition, double load)
{
    const nt_pushed_bound bound = bound_of(composition, load);
    return bound.resistance + bound.pull_off;
}

static nt_status lay(nt_session *session, nt_pushed_kind kind, int number, const double pose[3])
{
    const nt_event_kind as = kind == NT_PUSHED_ROD ? NT_EVENT_LAY_ROD : NT_EVENT_LAY;
    nt_call call = {.event = {.kind = as, .field = (uint32_t)number, .value = {pose[0], pose[1], pose[2]}}};
    if (!session)
        return NT_E_ARGUMENT;
    if (number < 0)
        return NT_E_CAPACITY;
    if (nt_session_runs_here(session))
        return NT_E_STATE;
    nt_session_lock(session);
    nt_status status = session->now->pushed.kind == kind ? NT_OK : NT_E_UNSUPPORTED;
    if (status == NT_OK)
        status = nt_session_prepare(session, &call, NULL);
    if (status == NT_OK)
        status = nt_session_ask(session, &call);
    nt_session_unlock(session);
    return status;
}

nt_status nt_session_lay(nt_session *session, int number, const double place[2])
{
    return lay(session, NT_PUSHED_PARTICLES, number, (double[3]){place[0], place[1], 0.0});
}

nt_status nt_session_lay_rod(nt_session *session, const double pose[3])
{
    return lay(session, NT_PUSHED_ROD, 0, pose);
}

void nt_session_show_particles(nt_session *session)
{
    const nt_sim_pushed *pushed = &session->sim.slave.pushed;
    const nt_pushed_state *state = &pushed->state;
    const int is_rod = pushed->laws.kind == NT_PUSHED_ROD;
    const nt_rod *rod = &pushed->laws.of.rod;
    nt_session_particles shown = {.count = state->count,
                                  .radius = is_rod ? rod->radius : pushed->laws.of.particles.pushing.particle.radius,
                                  .length = is_rod ? rod->length : 0.0,
                                  .tick = session->touch_state.ticks,
                                  .stored = state->stored,
                                  .dissipated = state->dissipated};
    for (int i = 0; i < state->count; ++i) {
        const nt_pushed_body *body = &state->bodies[i];
        memcpy(shown.position[i], body->place, sizeof shown.position[i]);
        memcpy(shown.force[i], body->force, sizeof shown.force[i]);
        shown.angle[i] = body->angle;
        shown.touches[i] = pushed->touches[i];
        shown.losses[i] = pushed->losses[i];
    }
    nt_mailbox_post(&session->shown, &shown);
}

nt_status nt_session_keep_pushed(nt_session *session)
{
    const nt_sim_pushed *pushed = &session->sim.slave.pushed;
    const int is_rod = pushed->laws.kind == NT_PUSHED_ROD;
    nt_status status = NT_OK;
    for (uint32_t i = 0; i < NT_PARTICLES && status == NT_OK; ++i) {
        const double *before = pushed->before[i], *now = pushed->rested[i];
        const nt_event moved = {.kind = NT_EVENT_PUSHED, .field = i, .value = {before[0], before[1], now[0], now[1]}};
        const nt_event turned = {.kind = NT_EVENT_TURNED, .field = i, .value = {before[2], now[2]}};
        const int has_left = pushed->left >> i & 1u;
        if (has_left)
            status = nt_session_keep_event(session, &moved);
        if (has_left && is_rod && status == NT_OK)
            status = nt_session_keep_event(session, &turned);
    }
    return status;
}

nt_status nt_session_read_particles(nt_session *session, nt_session_particles *particles)
{
    if (!session || !particles)
        return NT_E_ARGUMENT;
    if (!session->simulates[NT_HALF_SLAVE] || !nt_composition_pushes(session->now))
        return NT_E_UNSUPPORTED;
    (void)nt_mailbox_take(&session->shown, &session->newest);
    *particles = session->newest;
    return NT_OK;
}
