/* SPDX-License-Identifier: BSD-3-Clause
 * Before a session is armed: the preflight. */
#include <math.h>

#include "nanotouch/preflight.h"

#include "session/state.h"

nt_status nt_session_fly(nt_session *session, nt_problem *problem)
{
    const nt_touch *touch = &session->now->touch;
    const nt_preflight preflight = nt_preflight_make(&touch->rig, &touch->settings);
    nt_preflight_state state = {.verdict = NT_PREFLIGHT_RUNNING};
    nt_command command = {.stage_position = {session->now->setup.x, session->now->setup.y}};
    nt_status status = NT_OK;
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
