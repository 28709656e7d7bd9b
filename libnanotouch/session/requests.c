/* SPDX-License-Identifier: BSD-3-Clause
 * Requests on their way into the loop, which applies them between two ticks and keeps each as an event. What a change
 * has replaced is freed by the thread that has prepared it, never by the loop. Clients of published frames (frames.h)
 * ask through the loop: it hands their requests to the thread that prepares, and answers them. */
#include <math.h>

#include "core/axes.h"
#include "hal/sim/sim.h"
#include "plasticity/dents.h"
#include "session/state.h"

static nt_status push_event(nt_session *session, const nt_event *event)
{
    const nt_status status = nt_ring_push(&session->events, event);
    session->kept_events += status == NT_OK;
    return status;
}

nt_status nt_session_keep_event(nt_session *session, const nt_event *event)
{
    if (!session->records)
        return NT_OK; /* there is nothing to replay */
    nt_event kept = *event;
    kept.tick = session->touch_state.ticks;
    return push_event(session, &kept);
}

int nt_session_events_are_full(const nt_session *session)
{
    return session->records && nt_ring_count(&session->events) == session->events.capacity;
}

/* --- the loop's side --- */

static void swap(nt_session *session, nt_composition *next)
{
    nt_composition *old = session->now;
    session->now = next;
    nt_sim_change_plan(&session->sim.slave, nt_terrain_plan(next->terrain));
    atomic_store_explicit(&session->retired, old, memory_order_release);
}

static void aim_hand(nt_session *session, const double value[4])
{
    nt_hand_target target = {.holds = 1, .duration = value[NT_AXES]};
    copy_axes(target.position, value);
    nt_sim_aim_hand(&session->sim.master, &target);
}

static nt_status lay(nt_session *session, const nt_event *event)
{
    const int number = event->field < NT_PARTICLES ? (int)event->field : NT_PARTICLES;
    const nt_status status = nt_sim_lay(&session->sim.slave, number, event->value);
    if (status == NT_OK)
        nt_session_show_particles(session);
    return status;
}

static nt_status apply_event(nt_session *session, const nt_event *event)
{
    nt_touch_state *state = &session->touch_state;
    const nt_scaling scaling = {event->value[0], event->value[1]};
    switch ((nt_event_kind)event->kind) {
    case NT_EVENT_ARM:
        return nt_touch_arm(state, event->value[0] != 0.0);
    case NT_EVENT_MODE:
        return nt_touch_set_mode(state, (nt_mode)event->value[0]);
    case NT_EVENT_RESCALE:
        return nt_touch_rescale(state, &scaling);
    case NT_EVENT_CLUTCH:
        nt_touch_clutch(state, event->value[0] != 0.0);
        return NT_OK;
    case NT_EVENT_AIM:
        if (event->field == NT_AIM_HAND) {
            aim_hand(session, event->value);
            return NT_OK;
        }
        return nt_touch_aim(&session->now->touch, state, event->value[0], event->value[1], event->value[2]);
    case NT_EVENT_STOP:
        nt_session_emergency_stop(session, event->value[0] != 0.0);
        return NT_OK;
    case NT_EVENT_SETTING:
    case NT_EVENT_SCENE:
        return NT_OK; /* the swap is all */
    case NT_EVENT_UNDENT:
        return nt_dents_undo(&session->sim.slave.dents) ? NT_OK : NT_E_STATE;
    case NT_EVENT_LAY:
    case NT_EVENT_LAY_ROD:
        return lay(session, event);
    case NT_EVENT_REWIND:
    case NT_EVENT_INDEX:
    case NT_EVENT_DENT:
    case NT_EVENT_PUSHED:
    case NT_EVENT_TURNED:
    case NT_EVENT_KINDS:
        break;
    }
    return NT_E_ARGUMENT;
}

/* Back to the newest moment of the history that is so long ago. */
static nt_status rewind_to(nt_session *session, const nt_event *event)
{
    const uint64_t now = session->touch_state.ticks;
    const double back = round(event->value[0] / session->now->touch.period);
    nt_event done = {.tick = now, .kind = NT_EVENT_REWIND};
    const nt_status status = nt_history_back(session, back < (double)now ? now - (uint64_t)back : 0u, &done.value[1]);
    done.value[0] = (double)session->touch_state.ticks;
    return status == NT_OK && session->records ? push_event(session, &done) : status;
}

static nt_status apply(nt_session *session, const nt_call *call)
{
    if (call->refused != NT_OK)
        return call->refused;
    if (nt_session_events_are_full(session))
        return NT_E_CAPACITY;
    if (call->event.kind == NT_EVENT_REWIND)
        return rewind_to(session, &call->event);
    if (call->next)
        swap(session, call->next);
    const nt_status status = apply_event(session, &call->event);
    const int is_hand = call->event.kind == NT_EVENT_AIM && call->event.field == NT_AIM_HAND;
    return status == NT_OK && !is_hand ? nt_session_keep_event(session, &call->event) : status;
}

static void answer(nt_session *session, const nt_call *call, nt_status status)
{
    const nt_answer found = {.id = call->id, .tick = session->touch_state.ticks, .status = (int32_t)status};
    if (call->id != 0)
        nt_frames_answer(session->frames, &found);
    atomic_store_explicit(&session->call_status, (int)status, memory_order_release);
}

static void take_all(nt_session *session)
{
    nt_call call;
    while (nt_ring_pop(&session->calls, &call, 1) == 1)
        answer(session, &call, apply(session, &call));
}

void nt_session_take_calls(nt_session *session)
{
    if (nt_ring_count(&session->calls) > 0)
        take_all(session);
}

/* --- the caller's side --- */

static void free_retired(nt_session *session)
{
    nt_composition_close(atomic_exchange_explicit(&session->retired, NULL, memory_order_acq_rel), session->now);
}

nt_status nt_session_ask(nt_session *session, const nt_call *call)
{
    atomic_store_explicit(&session->call_status, NT_CALL_WAITING, memory_order_relaxed);
    nt_status status = nt_ring_push(&session->calls, call);
    if (status != NT_OK) {
        nt_composition_close(call->next, session->now);
        return status;
    }
    if (nt_session_is_running(session))
        status = nt_session_await(session);
    if (atomic_load_explicit(&session->call_status, memory_order_acquire) == NT_CALL_WAITING)
        nt_session_take_calls(session); /* nothing runs, or it has ended meanwhile */
    free_retired(session);
    status = (nt_status)atomic_load_explicit(&session->call_status, memory_order_acquire);
    if (status != NT_OK && session->now != call->next)
        nt_composition_close(call->next, session->now);
    return status;
}

/* --- clients of published frames --- */

static void refuse(nt_session *session, uint64_t id, nt_status status, uint32_t pending)
{
    const nt_answer found = {
        .id = id, .tick = session->touch_state.ticks, .status = (int32_t)status, .pending = pending};
    nt_frames_answer(session->frames, &found);
}

void nt_session_take_clients(nt_session *session)
{
    nt_request request;
    if (!nt_frames_take(session->frames, &request))
        return;
    if (request.kind == NT_REQUEST_STOP) {
        nt_session_tap_stop(session);
        refuse(session, request.id, NT_OK, 0);
        return;
    }
    const nt_status status = nt_ring_push(&session->clients, &request);
    refuse(session, request.id, status, status == NT_OK);
}

static nt_call call_of(const nt_request *request)
{
    nt_call call = {.id = request->id, .event = {.kind = request->kind, .field = request->field}};
    for (int i = 0; i < 4; ++i)
        call.event.value[i] = request->value[i];
    return call;
}

void nt_session_serve_clients(nt_session *session)
{
    nt_request request;
    while (nt_ring_pop(&session->clients, &request, 1) == 1) {
        nt_call call = call_of(&request);
        nt_session_lock(session);
        call.refused = nt_session_prepare(session, &call, NULL);
        (void)nt_session_ask(session, &call); /* the loop answers; where it does not, the client asks again */
        nt_session_unlock(session);
    }
}
