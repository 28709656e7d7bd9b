/* SPDX-License-Identifier: BSD-3-Clause
 * Copies of a simulated session's states: snapshots that a caller keeps, and the history of a session that runs in its
 * thread, a moment each quarter of a second, to go back to. */
#include "session/history.h"
#include "internal/session.h"

#include <stdlib.h>

#define INTERVAL 0.25 /* between two moments of the history [s] */

static int is_simulated(const nt_session *session)
{
    return session->simulates[NT_HALF_MASTER] && session->simulates[NT_HALF_SLAVE];
}

static void save(const nt_session *session, nt_past *past)
{
    const nt_composition *now = session->now;
    past->setup = now->setup;
    past->touch = now->touch;
    past->margins = now->margins;
    past->sideways = now->sideways;
    past->guarantee = now->guarantee;
    past->touch_state = session->touch_state;
    past->sim = session->sim;
    past->kept_events = session->kept_events;
    past->readings[NT_HALF_MASTER] = session->master.reading;
    past->readings[NT_HALF_SLAVE] = session->slave.reading;
}

/* Mode and scales, and what was judged of them. Pointers stay those of the session that goes on. */
static void load_standing(nt_composition *now, const nt_past *past)
{
    const nt_control control = now->touch.settings.control;
    now->setup.mode = past->setup.mode;
    now->setup.settings.gains = past->setup.settings.gains;
    now->margins = past->margins;
    now->sideways = past->sideways;
    now->guarantee = past->guarantee;
    now->touch = past->touch;
    now->touch.settings.control = control;
}

static void load(nt_session *session, const nt_past *past)
{
    const nt_host *host = session->sim.slave.link.host;
    load_standing(session->now, past);
    session->touch_state = past->touch_state;
    session->sim = past->sim;
    session->sim.master.link.host = session->sim.slave.link.host = host;
    session->sim.slave.plan = nt_terrain_plan(session->now->terrain);
    session->master.reading = past->readings[NT_HALF_MASTER];
    session->slave.reading = past->readings[NT_HALF_SLAVE];
}

/* --- snapshots --- */

struct nt_snapshot {
    nt_past past;
    nt_origin origin;
    const nt_session *of; /* whose it is, ... */
    int64_t opened;       /* ... unless another one has its place since [ns] */
};

nt_status nt_session_snapshot(const nt_session *session, nt_snapshot **snapshot)
{
    if (!session || !snapshot)
        return NT_E_ARGUMENT;
    if (nt_session_runs_here(session) || nt_session_is_running(session))
        return NT_E_STATE;
    if (!is_simulated(session))
        return NT_E_UNSUPPORTED;
    nt_snapshot *made = malloc(sizeof *made);
    if (!made)
        return NT_E_NO_MEMORY;
    save(session, &made->past);
    made->origin = session->origin;
    made->of = session;
    made->opened = session->opened;
    *snapshot = made;
    return NT_OK;
}

static nt_status check_snapshot(const nt_session *session, const nt_snapshot *snapshot, nt_problem *problem)
{
    if (nt_session_runs_here(session) || nt_session_is_running(session))
        return NT_E_STATE;
    if (!is_simulated(session))
        return NT_E_UNSUPPORTED;
    const nt_status status = nt_origin_check(&snapshot->origin, &session->origin, problem);
    return status == NT_OK ? nt_origin_check_setup(&snapshot->past.setup, &session->now->setup, problem) : status;
}

nt_status nt_session_restore(nt_session *session, const nt_snapshot *snapshot, nt_problem *problem)
{
    if (!session || !snapshot)
        return NT_E_ARGUMENT;
    nt_status status = check_snapshot(session, snapshot, problem);
    if (status != NT_OK)
        return status;
    const int is_own = snapshot->of == session && snapshot->opened == session->opened;
    const nt_event event = {
        .kind = NT_EVENT_REWIND,
        .value = {(double)snapshot->past.touch_state.ticks, is_own ? (double)snapshot->past.kept_events : -1.0}};
    status = nt_session_keep_event(session, &event);
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

nt_status nt_history_back(nt_session *session, uint64_t tick, double *events)
{
    nt_history *history = session->history;
    const uint64_t oldest = history->next > NT_HISTORY ? history->next - NT_HISTORY : 0u;
    while (history->next > oldest) {
        const nt_past *past = &history->moments[(history->next - 1u) % NT_HISTORY];
        if (past->touch_state.ticks <= tick &&
            nt_origin_check_setup(&past->setup, &session->now->setup, NULL) == NT_OK) {
            load(session, past);
            *events = (double)past->kept_events;
            return NT_OK;
        }
        --history->next; /* later than where it goes back to */
    }
    return NT_E_NO_SOLUTION;
}
