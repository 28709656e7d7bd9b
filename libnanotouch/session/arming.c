/* SPDX-License-Identifier: BSD-3-Clause
 * Before a session is armed: a stage of one's own goes to where the session starts, then the preflight. */
#include <math.h>

#include "control/preflight.h"
#include "core/clamp.h"
#include "core/problem.h"
#include "internal/control.h"
#include "nanotouch/advanced/control.h"
#include "session/state.h"

#define SETTLES 10.0 /* time constants of lever and lock-in amplifier until the free amplitude is there */
#define MEASURED 50L /* ticks, at the least, over which it is a mean */

/* One period: along each axis by no more than this. 1 if it is there. */
static int go_on(double *at, double goal, double most)
{
    *at += clamp(goal - *at, -most, most);
    return *at == goal;
}

/* Up, then sideways, then down. 1 if all are there. */
static int step_to(double *at, const double *goal, const nt_settings *settings)
{
    const double period = 1.0 / settings->gains.rate, sideways = settings->limits.lateral_speed * period;
    if (at[NT_Z] > goal[NT_Z] && !go_on(&at[NT_Z], goal[NT_Z], settings->limits.stage_speed * period))
        return 0;
    const int is_over = go_on(&at[NT_X], goal[NT_X], sideways) & go_on(&at[NT_Y], goal[NT_Y], sideways);
    return is_over && go_on(&at[NT_Z], goal[NT_Z], settings->gains.approach_speed * period);
}

/* Nothing is known of what lies on the way, so the deflection is watched. */
static nt_status judge_way(const nt_preflight *preflight, const nt_sample *sample, double first, nt_problem *problem)
{
    const nt_preflight_state bad = {.verdict = NT_PREFLIGHT_BAD_SAMPLE, .measure = (double)sample->flags};
    const double bend = sample->deflection[NT_Z] - first, most = preflight->limits.deflection_bias;
    if (fabs(bend) <= most && sample->flags == 0u)
        return NT_OK;
    if (fabs(bend) > most && sample->flags == 0u)
        return nt_problem_set(problem, "deflection on the way to where the session starts", "m", bend, -most, most);
    if (problem)
        *problem = nt_preflight_problem(preflight, &bad);
    return NT_E_RANGE;
}

/* A stage of one's own may stand elsewhere: a session before has lifted it, or somebody has moved it. It does not jump.
 * What gives no number is left to the preflight. */
static nt_status go_to_start(nt_session *session, const nt_preflight *preflight, nt_problem *problem)
{
    const double goal[NT_AXES] = {session->now->setup.x, session->now->setup.y, 0.0};
    nt_command command = {.state = NT_RUN};
    nt_sample sample;
    nt_status status = nt_session_sample(session, 0, &sample);
    if (status != NT_OK)
        return status;
    const double first = sample.deflection[NT_Z];
    int is_there = 1;
    for (int i = 0; i < NT_AXES; ++i) {
        const int is_far = fabs(sample.stage_position[i] - goal[i]) > 0.5 * preflight->distance;
        command.stage_position[i] = is_far ? sample.stage_position[i] : goal[i];
        is_there &= !is_far;
    }
    while (status == NT_OK && !is_there) {
        is_there = step_to(command.stage_position, goal, &session->now->touch.settings);
        status = nt_session_write(session, 0, &command);
        ++session->flights;
        nt_session_keep_time(session);
        if (status == NT_OK)
            status = nt_session_sample(session, 0, &sample);
        if (status == NT_OK)
            status = judge_way(preflight, &sample, first, problem);
    }
    return status;
}

nt_status nt_session_fly(nt_session *session, nt_problem *problem)
{
    const nt_touch *touch = &session->now->touch;
    const nt_preflight preflight = nt_preflight_make(&touch->rig, &touch->settings);
    nt_preflight_state state = {.verdict = NT_PREFLIGHT_RUNNING};
    nt_command command = {.stage_position = {session->now->setup.x, session->now->setup.y}};
    nt_status status = session->simulates[NT_HALF_SLAVE] ? NT_OK : go_to_start(session, &preflight, problem);
    while (status == NT_OK && state.verdict == NT_PREFLIGHT_RUNNING) {
        nt_sample sample;
        nt_session_keep_time(session);
        status = nt_session_sample(session, 0, &sample); /* the flights are counted already: one clock, no leap back */
        if (status == NT_OK && nt_preflight_step(&preflight, &state, &sample, &command) <= NT_PREFLIGHT_PASSED)
            status = nt_session_write(session, state.tick, &command);
        ++session->flights;
    }
    if (status == NT_OK && state.verdict != NT_PREFLIGHT_PASSED) {
        if (problem)
            *problem = nt_preflight_problem(&preflight, &state);
        return NT_E_RANGE;
    }
    session->tare = state.tare;
    if (!session->simulates[NT_HALF_MASTER]) /* where the hand has gone meanwhile */
        session->master_start = session->master.reading.position[NT_Z];
    if (status == NT_OK && !isfinite(session->master_start))
        return NT_E_DEVICE;
    return status;
}

/* The lever is far from the sample: the drive makes what the settings say, or the session does not open. */
nt_status nt_session_find_amplitude(nt_session *session, nt_problem *problem)
{
    const nt_touch *touch = &session->now->touch;
    const nt_tap *tap = &touch->settings.tap;
    const nt_command command = {.stage_position = {session->now->setup.x, session->now->setup.y},
                                .drive_amplitude = touch->drive_amplitude,
                                .drive_frequency = touch->drive_frequency};
    const double lag = nt_tap_lag(&touch->rig, tap) / touch->period;
    const long settle = 2 + (long)ceil(SETTLES * lag), measure = MEASURED + (long)ceil(lag);
    double sum = 0.0;
    nt_status status = NT_OK;
    for (long i = 0; i < settle + measure && status == NT_OK; ++i) {
        nt_sample sample;
        nt_session_keep_time(session);
        status = nt_session_sample(session, 0, &sample);
        if (status == NT_OK && sample.flags) /* a press of the stop is not lost here */
            return nt_problem_set(problem, "flags of a sample before arming (safety.md)", "", sample.flags, 0.0, 0.0);
        if (status == NT_OK && i >= settle)
            sum += sample.amplitude + 0.0 * sample.lag; /* what is not measured is no number */
        if (status == NT_OK)
            status = nt_session_write(session, 0, &command);
        ++session->flights;
    }
    const double found = sum / (double)measure, off = tap->tolerance * tap->free_amplitude;
    if (status != NT_OK || fabs(found - tap->free_amplitude) <= off)
        return status;
    (void)nt_problem_set(problem, "free amplitude as measured (tap.free_amplitude, tap.tolerance)", "m", found,
                         tap->free_amplitude - off, tap->free_amplitude + off);
    return NT_E_RANGE;
}
