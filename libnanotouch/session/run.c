/* SPDX-License-Identifier: BSD-3-Clause
 * A session running: one period after another, and what may be read of it. No heap, no lock. */
#include <math.h>

#include "control/preflight.h"
#include "core/axes.h"
#include "hal/hal.h"
#include "hal/sim/sim.h"
#include "internal/session.h"
#include "session/frames_memory.h"
#include "session/state.h"

/* The button is held, or has been pressed since the last tick: no press is lost to a quick release. */
enum { STOP_HELD = 1, STOP_UNSEEN = 2 };

static uint32_t take_stop(nt_session *session)
{
    if (!atomic_load_explicit(&session->stop, memory_order_acquire))
        return 0u;
    atomic_fetch_and(&session->stop, ~(unsigned)STOP_UNSEEN);
    return NT_SAMPLE_EMERGENCY_STOP;
}

void nt_session_emergency_stop(nt_session *session, int pressed)
{
    if (pressed)
        atomic_fetch_or(&session->stop, STOP_HELD | STOP_UNSEEN);
    else
        atomic_fetch_and(&session->stop, ~(unsigned)STOP_HELD);
}

void nt_session_tap_stop(nt_session *session)
{
    atomic_fetch_or(&session->stop, STOP_UNSEEN); /* a button that the program itself holds stays held */
}

static void take_input(nt_session *session)
{
    nt_input input;
    if (!nt_mailbox_take(&session->mailbox, &input))
        return;
    if (session->simulates[NT_HALF_MASTER]) {
        nt_hand_target target = {.holds = input.holds, .duration = input.duration};
        copy_axes(target.force, input.operator_force);
        copy_axes(target.position, input.master_position);
        nt_sim_aim_hand(&session->sim.master, &target);
    }
    if (isnan(input.x))
        return;
    const nt_event event = {.kind = NT_EVENT_AIM, .value = {input.x, input.y, input.duration}};
    if (nt_touch_aim(&session->now->touch, &session->touch_state, input.x, input.y, input.duration) == NT_OK)
        (void)nt_session_keep_event(session, &event);
}

static const nt_truth unknown = {
    .gap = NAN, .tip_force = {NAN, NAN, NAN}, .contact_radius = NAN, .surface_height = NAN};

/* All of a record. What is true is so until the command is written. */
static void fill(nt_record *record, const nt_session *session, const nt_sample *sample, const nt_command *command)
{
    const nt_touch *touch = &session->now->touch;
    const nt_truth *truth = session->simulates[NT_HALF_SLAVE] ? &session->sim.slave.truth : &unknown;
    record->tick = session->touch_state.ticks - 1u;
    record->time = (double)record->tick * touch->period;
    record->slave_force = touch->rig.probe.spring_constant * sample->deflection[NT_Z];
    record->gap = truth->gap;
    record->contact_radius = truth->contact_radius;
    record->surface_height = truth->surface_height;
    record->age = sample->age;
    record->master_age = sample->master_age;
    record->lateness = sample->lateness;
    record->flags = sample->flags;
    record->phase = (uint32_t)session->touch_state.phase;
    record->state = command->state;
    record->reasons = command->reasons;
    copy_axes(record->master_position, sample->master_position);
    copy_axes(record->operator_force, sample->operator_force);
    copy_axes(record->stage_position, sample->stage_position);
    copy_axes(record->stage_command, command->stage_position);
    copy_axes(record->deflection, sample->deflection);
    record->amplitude = sample->amplitude;
    record->lag = sample->lag;
    copy_axes(record->motor_force, command->motor_force);
    copy_axes(record->tip_force, truth->tip_force);
}

/* Without a clock of the machine, time is ticks times period, as the simulated halves count it. */
static int64_t time_of(const nt_session *session, uint64_t tick)
{
    if (session->clock)
        return session->clock();
    return llround((double)(session->flights + tick) * session->now->touch.period * 1e9);
}

/* The one that leads the clock first: this tick begins when it has come. */
static nt_status read_halves(nt_session *session, uint64_t tick)
{
    nt_status status = NT_OK;
    session->time = time_of(session, tick);
    if (session->leader) {
        status = nt_session_follow_leader(session);
        session->time = time_of(session, tick);
    }
    if (status == NT_OK && session->leader != &session->master)
        status = nt_hal_read(&session->master);
    if (status == NT_OK && session->leader != &session->slave)
        status = nt_hal_read(&session->slave);
    return status;
}

nt_status nt_session_sample(nt_session *session, uint64_t tick, nt_sample *sample)
{
    const nt_status status = read_halves(session, tick);
    if (status != NT_OK)
        return status;
    nt_hal_join(&session->master, &session->slave, tick, session->time, sample);
    if (session->now->touch.rig.stage.axes == 1.0) { /* nothing moves it sideways */
        sample->stage_position[NT_X] = session->now->setup.x;
        sample->stage_position[NT_Y] = session->now->setup.y;
    }
    return NT_OK;
}

nt_status nt_session_write(nt_session *session, uint64_t tick, const nt_command *command)
{
    nt_action action = {.size = sizeof action, .tick = tick, .time = session->time};
    if (session->now->touch.rig.master.motor || !(session->master.capabilities.can & NT_CAN_PUSH))
        return nt_hal_command(&session->master, &session->slave, command, &action);
    nt_command written = *command; /* a motor that the rig does not have is not driven */
    written.motor_force[NT_X] = written.motor_force[NT_Y] = written.motor_force[NT_Z] = 0.0;
    return nt_hal_command(&session->master, &session->slave, &written, &action);
}

/* The record of this tick goes straight into the ring; one that has no place there can still be shown. */
static nt_record *next_record(nt_session *session)
{
    nt_record *next = session->records ? nt_ring_next(&session->ring) : NULL;
    return next ? next : &session->unkept;
}

static nt_status keep(nt_session *session, const nt_record *record)
{
    if (session->frames || session->stepped) {
        const nt_frame frame = nt_session_frame(session, record); /* before the halves go on */
        if (session->frames)
            nt_frames_publish(session->frames, &frame);
        if (session->stepped)
            *session->stepped = frame;
    }
    if (record != &session->unkept)
        nt_ring_add(&session->ring);
    else if (session->records && !session->may_drop)
        return NT_E_CAPACITY;
    else if (session->records)
        atomic_fetch_add_explicit(&session->dropped, 1, memory_order_relaxed);
    return NT_OK;
}

/* Where a real hand has gone while nothing ran moves nothing. Nothing runs without room for the event. */
static void come_back(nt_session *session, const nt_sample *sample)
{
    const nt_event event = {.kind = NT_EVENT_INDEX, .value = {sample->master_position[NT_Z]}};
    if (!isfinite(event.value[0]))
        return; /* it is not known yet */
    nt_touch_index(&session->touch_state, event.value[0]);
    (void)nt_session_keep_event(session, &event);
    session->comes_back = 0;
}

/* What the contact that has ended in this period has left. */
static nt_status keep_dents(nt_session *session)
{
    const nt_dents *dents = &session->sim.slave.dents;
    nt_status status = NT_OK;
    for (int i = dents->count - session->sim.slave.left; i < dents->count && status == NT_OK; ++i) {
        const nt_dent *dent = &dents->made[i];
        const nt_imprint *of = &dent->imprint;
        const int before = dent->grown > 0 ? i : dent->before;
        const nt_event events[] = {
            {.kind = NT_EVENT_DENT, .value = {of->start[NT_X], of->start[NT_Y], of->end[NT_X], of->end[NT_Y]}},
            {.kind = NT_EVENT_DENT, .field = 1, .value = {of->radius, of->depth, dent->load, before}}};
        for (int k = 0; k < 2 && status == NT_OK; ++k)
            status = nt_session_keep_event(session, &events[k]);
    }
    return status;
}

static nt_status run_tick(nt_session *session, nt_record *record)
{
    nt_sample sample;
    nt_command command;
    if (session->frames)
        nt_session_take_clients(session);
    nt_session_take_calls(session);
    take_input(session);
    const uint64_t tick = session->touch_state.ticks;
    const nt_status status = nt_session_sample(session, tick, &sample);
    if (status != NT_OK)
        return status;
    nt_tare_apply(&session->tare, &session->now->touch.rig.probe, &sample);
    sample.flags |= take_stop(session);
    if (session->clock)
        sample.lateness = session->lateness;
    if (session->comes_back)
        come_back(session, &sample);
    nt_touch_step(&session->now->touch, &session->touch_state, &sample, &command);
    fill(record, session, &sample, &command);
    nt_status kept = keep(session, record);
    if (kept == NT_OK)
        kept = nt_session_write(session, tick, &command);
    if (kept != NT_OK || !session->simulates[NT_HALF_SLAVE])
        return kept;
    const nt_sim_slave *slave = &session->sim.slave;
    if (slave->pushed.state.count > 0)
        nt_session_show_particles(session);
    if (slave->pushed.left != 0u)
        return nt_session_keep_pushed(session);
    return slave->left > 0 ? keep_dents(session) : NT_OK;
}

nt_status nt_session_tick(nt_session *session)
{
    return run_tick(session, next_record(session));
}

void nt_session_enter(nt_session *session)
{
    atomic_store_explicit(&session->ticker, nt_session_thread(), memory_order_relaxed);
}

void nt_session_leave(nt_session *session)
{
    atomic_store_explicit(&session->ticker, 0, memory_order_relaxed);
}

static nt_status check_free(const nt_session *session, long ticks)
{
    if (!session)
        return NT_E_ARGUMENT;
    if (ticks < 0)
        return NT_E_RANGE;
    if (nt_session_runs_here(session) || nt_session_is_running(session))
        return NT_E_STATE;
    if (session->frames && !nt_frames_are_own(session->frames))
        return NT_E_STATE; /* forked off: they show another process's session */
    if (session->records && (size_t)ticks > session->ring.capacity - nt_ring_count(&session->ring))
        return NT_E_CAPACITY;
    if (session->comes_back && nt_session_events_are_full(session))
        return NT_E_CAPACITY;
    return nt_session_check_pace(session, NT_PACE_FREE);
}

nt_status nt_session_advance(nt_session *session, long ticks)
{
    nt_status status = check_free(session, ticks);
    if (status != NT_OK)
        return status;
    nt_session_enter(session);
    for (long i = 0; i < ticks && status == NT_OK; ++i) {
        if (session->frames)
            nt_session_serve_clients(session); /* no thread does it here */
        status = nt_session_tick(session);
    }
    nt_session_leave(session);
    return status;
}

nt_status nt_session_step(nt_session *session, const nt_input *input, nt_frame *frame)
{
    nt_status status = frame ? check_free(session, 1) : NT_E_ARGUMENT;
    if (status == NT_OK && input)
        status = nt_session_aim(session, input, NULL);
    if (status != NT_OK)
        return status;
    nt_frame shown;
    session->stepped = &shown;
    nt_session_enter(session);
    status = nt_session_tick(session);
    nt_session_leave(session);
    session->stepped = NULL;
    if (status == NT_OK)
        *frame = shown;
    return status;
}

long nt_session_read(nt_session *session, nt_record *records, long count)
{
    return session && records && session->records && count > 0
               ? (long)nt_ring_pop(&session->ring, records, (size_t)count)
               : 0;
}

long nt_session_read_events(nt_session *session, nt_event *events, long count)
{
    return session && events && count > 0 ? (long)nt_ring_pop(&session->events, events, (size_t)count) : 0;
}

int nt_session_is_dynamic(const nt_session *session)
{
    return session->simulates[NT_HALF_SLAVE] && session->sim.slave.dynamic;
}

const nt_capabilities *nt_session_capabilities(const nt_session *session, nt_half half)
{
    return half == NT_HALF_MASTER ? &session->master.capabilities : &session->slave.capabilities;
}
const nt_dents *nt_session_dents(const nt_session *session)
{
    return session->simulates[NT_HALF_SLAVE] && session->sim.slave.plan->history == NT_HISTORY_DENTS
               ? &session->sim.slave.dents
               : NULL;
}
const nt_session_setup *nt_session_setup_of(const nt_session *session)
{
    return &session->now->setup;
}
const nt_plan *nt_session_plan(const nt_session *session)
{
    return nt_terrain_plan(session->now->terrain);
}
nt_terrain *nt_session_hold_terrain(nt_session *session)
{
    return nt_terrain_hold(session->now->terrain);
}
const nt_touch *nt_session_touch(const nt_session *session)
{
    return &session->now->touch;
}
const nt_touch_state *nt_session_touch_state(const nt_session *session)
{
    return &session->touch_state;
}
nt_guarantee nt_session_guarantee(const nt_session *session)
{
    return session->now->guarantee;
}
nt_tare nt_session_tare(const nt_session *session)
{
    return session->tare;
}
nt_margins nt_session_margins(const nt_session *session)
{
    return session->now->margins;
}
nt_sideways_margins nt_session_sideways(const nt_session *session)
{
    return session->now->sideways;
}
nt_verdict nt_session_tap(const nt_session *session)
{
    return session->now->tap;
}
nt_reach nt_session_reach(const nt_session *session)
{
    return session->now->reach;
}
double nt_session_start_height(const nt_session *session)
{
    return session->simulates[NT_HALF_SLAVE] ? session->sim.slave.start_height : (double)NAN;
}
double nt_session_master_start(const nt_session *session)
{
    return session->master_start;
}
