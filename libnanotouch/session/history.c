/* SPDX-License-Identifier: BSD-3-Clause
 * Copies of a simulated session's states: snapshots that a caller keeps, and the history of a session that runs in its
 * thread, a moment each quarter of a second, to go back to. */
#include "session/history.h"

#include <stdlib.h>

#define INTERVAL 0.25 /* between two moments of the history [s] */

static int is_simulated(const nt_session *session)
{
    return session->simulates[NT_HALF_MASTER] && session->simulates[NT_HALF_SLAVE];
}

static void save(const nt_session *session, nt_past *past)
{
    past->setup = session->now->setup;
    past->touch_state = session->touch_state;
    past->sim = session->sim;
    past->readings[NT_HALF_MASTER] = session->master.reading;
    past->readings[NT_HALF_SLAVE] = session->slave.reading;
    past->asked_mode = session->asked_mode;
    past->asked_scaling = session->asked_scaling;
}

/* Pointers stay those of the session that goes on. */
static void load(nt_session *session, const nt_past *past)
{
    const nt_host *host = session->sim.slave.link.host;
    session->touch_state = past->touch_state;
    session->sim = past->sim;
    session->sim.master.link.host = session->sim.slave.link.host = host;
    session->sim.slave.plan = nt_terrain_plan(session->now->terrain);
    session->master.reading = past->readings[NT_HALF_MASTER];
    session->slave.reading = past->readings[NT_HALF_SLAVE];
    session->asked_mode = past->asked_mode;
    session->asked_scaling = past->asked_scaling;
}

/* --- snapshots --- */

struct nt_snapshot {
    nt_past past;
};

nt_status nt_session_snapshot(const nt_session *session, nt_snapshot **snapshot)
{
    if (nt_session_is_running(session))
        return NT_E_STATE;
    if (!is_simulated(session))
        return NT_E_UNSUPPORTED;
    nt_snapshot *made = malloc(sizeof *made);
    if (!made)
        return NT_E_NO_MEMORY;
    save(session, &made->past);
    *snapshot = made;
    return NT_OK;
}

nt_status nt_session_restore(nt_session *session, const nt_snapshot *snapshot)
{
    if (nt_session_is_running(session) || !nt_composition_is_same(&snapshot->past.setup, &session->now->setup))
        return NT_E_STATE;
    if (!is_simulated(session))
        return NT_E_UNSUPPORTED;
    const nt_event event = {.kind = NT_EVENT_REWIND, .value = {(double)snapshot->past.touch_state.ticks}};
    const nt_status status = nt_session_keep_event(session, &event);
    if (status == NT_OK)
        load(session, &snapshot->past);
    return status;
}

void nt_snapshot_close(nt_snapshot *snapshot)
{
    free(snapshot);
}

/* --- history --- */

nt_status nt_history_make(nt_session *session)
{
    if (!is_simulated(session) || session->history)
        return NT_OK;
    session->history = calloc(1, sizeof *session->history);
    if (!session->history)
        return NT_E_NO_MEMORY;
    const double ticks = INTERVAL / session->now->touch.period;
    session->history->interval = ticks > 1.0 ? (uint64_t)ticks : 1u;
    return NT_OK;
}

void nt_history_keep(nt_session *session)
{
    nt_history *history = session->history;
    if (!history || session->touch_state.ticks % history->interval != 0)
        return;
    save(session, &history->moments[history->next % NT_HISTORY]);
    ++history->next;
}

nt_status nt_history_back(nt_session *session, uint64_t tick)
{
    nt_history *history = session->history;
    const uint64_t oldest = history->next > NT_HISTORY ? history->next - NT_HISTORY : 0u;
    while (history->next > oldest) {
        const nt_past *past = &history->moments[(history->next - 1u) % NT_HISTORY];
        if (past->touch_state.ticks <= tick && nt_composition_is_same(&past->setup, &session->now->setup)) {
            load(session, past);
            return NT_OK;
        }
        --history->next; /* later than where it goes back to */
    }
    return NT_E_NO_SOLUTION;
}
