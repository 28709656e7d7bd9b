/* SPDX-License-Identifier: BSD-3-Clause
 * A session running: one period after another, requests between them, and what may be read of it. No heap. */
#include <math.h>

#include "session/state.h"

nt_status nt_session_aim(nt_session *session, const nt_input *input)
{
    if (!isfinite(input->operator_force) || !isfinite(input->x) || !isfinite(input->y) || !isfinite(input->duration))
        return NT_E_NOT_FINITE;
    if (input->duration < 0.0)
        return NT_E_RANGE;
    if (session->plan.surface && !nt_surface_contains(session->plan.surface, input->x, input->y))
        return NT_E_RANGE;
    nt_mailbox_post(&session->mailbox, input);
    return NT_OK;
}

static nt_status take_input(nt_session *session)
{
    nt_input input;
    if (!nt_mailbox_take(&session->mailbox, &input))
        return NT_OK;
    const nt_hand_target target = {.force = input.operator_force, .duration = input.duration};
    nt_sim_aim_hand(&session->sim, &target);
    return nt_touch_aim(&session->touch, &session->touch_state, input.x, input.y, input.duration);
}

static nt_record record_of(const nt_session *session, const nt_sample *sample, const nt_command *command,
                           const nt_truth *truth)
{
    const uint64_t tick = session->touch_state.ticks - 1u;
    nt_record record = {.tick = tick,
                        .time = (double)tick * session->touch.period,
                        .x = sample->x,
                        .y = sample->y,
                        .master_position = sample->master_position,
                        .operator_force = sample->operator_force,
                        .stage_position = sample->stage_position,
                        .stage_command = command->stage_position,
                        .deflection = sample->deflection,
                        .slave_force = session->touch.rig.probe.spring_constant * sample->deflection,
                        .age = sample->age,
                        .lateness = sample->lateness,
                        .flags = sample->flags,
                        .phase = (uint32_t)session->touch_state.phase,
                        .motor_force = command->motor_force,
                        .gap = truth->gap,
                        .tip_force = truth->tip_force,
                        .contact_radius = truth->contact_radius,
                        .surface_height = truth->surface_height,
                        .state = command->state,
                        .reasons = command->reasons};
    return record;
}

/* What stands in for a sample that a device did not give. */
static void lose_device(nt_session *session, nt_sample *sample)
{
    const nt_sample lost = {.tick = sample->tick,
                            .master_position = NAN,
                            .operator_force = NAN,
                            .stage_position = NAN,
                            .deflection = NAN,
                            .x = session->touch_state.command.x,
                            .y = session->touch_state.command.y,
                            .flags = NT_SAMPLE_DEVICE_LOST | NT_SAMPLE_INVALID};
    *sample = lost;
}

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

/* A device that fails is the supervisor's matter; a simulation that fails is an error. */
static nt_status read_device(nt_session *session, nt_sample *sample)
{
    const nt_status status = nt_hal_read(&session->hal, sample);
    if (status == NT_E_DEVICE || (status == NT_OK && session->device_lost)) {
        lose_device(session, sample);
        return NT_OK;
    }
    if (status == NT_OK)
        nt_tare_apply(&session->tare, &session->touch.rig.probe, sample);
    return status;
}

static nt_status read_sample(nt_session *session, nt_sample *sample)
{
    const nt_status status = read_device(session, sample);
    if (status == NT_OK)
        sample->flags |= take_stop(session);
    return status;
}

static nt_status write_command(nt_session *session, const nt_command *command)
{
    const nt_status status = nt_hal_write(&session->hal, command);
    session->device_lost = status == NT_E_DEVICE; /* shows with the next sample */
    return session->device_lost ? NT_OK : status;
}

static nt_status step(nt_session *session)
{
    nt_sample sample = {.tick = session->touch_state.ticks};
    nt_command command;
    const nt_truth truth = session->sim.truth; /* at the moment of the sample */
    nt_status status = take_input(session);
    if (status == NT_OK)
        status = read_sample(session, &sample);
    if (status != NT_OK)
        return status;
    nt_touch_step(&session->touch, &session->touch_state, &sample, &command);
    const nt_record record = record_of(session, &sample, &command, &truth);
    status = nt_ring_push(&session->ring, &record);
    return status == NT_OK ? write_command(session, &command) : status;
}

nt_status nt_session_advance(nt_session *session, long ticks)
{
    if (ticks < 0)
        return NT_E_RANGE;
    if ((size_t)ticks > session->ring.capacity - nt_ring_count(&session->ring))
        return NT_E_CAPACITY;
    nt_status status = NT_OK;
    for (long i = 0; i < ticks && status == NT_OK; ++i)
        status = step(session);
    return status;
}

long nt_session_read(nt_session *session, nt_record *records, long count)
{
    return count > 0 ? (long)nt_ring_pop(&session->ring, records, (size_t)count) : 0;
}

nt_status nt_session_arm(nt_session *session, int confirmed)
{
    return nt_touch_arm(&session->touch_state, confirmed);
}

/* Would the loop be armed in this mode, with these scales? */
static int is_allowed(const nt_session *session, nt_mode mode, const nt_scaling *scaling)
{
    nt_settings settings = session->touch.settings;
    settings.gains.alpha_p = scaling->alpha_p;
    settings.gains.alpha_f = scaling->alpha_f;
    nt_margins margins;
    return nt_session_allows(session, nt_session_judge(session, &settings, mode, &margins).margin);
}

nt_status nt_session_set_mode(nt_session *session, nt_mode mode)
{
    if (mode > NT_MODE_CURVE)
        return NT_E_ARGUMENT;
    if (!is_allowed(session, mode, &session->touch_state.rescale.wanted))
        return NT_E_RANGE;
    return nt_touch_set_mode(&session->touch_state, mode);
}

nt_status nt_session_rescale(nt_session *session, const nt_scaling *scaling)
{
    if (isfinite(scaling->alpha_p) && isfinite(scaling->alpha_f) && scaling->alpha_p > 0.0 && scaling->alpha_f > 0.0 &&
        !is_allowed(session, session->touch_state.wanted_mode, scaling))
        return NT_E_RANGE;
    return nt_touch_rescale(&session->touch_state, scaling);
}

void nt_session_clutch(nt_session *session, int open)
{
    nt_touch_clutch(&session->touch_state, open);
}

nt_status nt_session_inject(nt_session *session, const nt_fault *fault)
{
    nt_fault shifted = *fault;
    if (fault->start < 0.0)
        return NT_E_RANGE;
    shifted.start += (double)session->first_tick * session->sim.period;
    return nt_sim_inject(&session->sim, &shifted);
}

int nt_session_is_dynamic(const nt_session *session)
{
    return session->sim.dynamic;
}

const nt_plan *nt_session_plan(const nt_session *session)
{
    return &session->plan;
}
const nt_touch *nt_session_touch(const nt_session *session)
{
    return &session->touch;
}
const nt_touch_state *nt_session_touch_state(const nt_session *session)
{
    return &session->touch_state;
}
nt_guarantee nt_session_guarantee(const nt_session *session)
{
    return session->guarantee;
}
nt_tare nt_session_tare(const nt_session *session)
{
    return session->tare;
}
nt_margins nt_session_margins(const nt_session *session)
{
    return session->margins;
}
double nt_session_start_height(const nt_session *session)
{
    return session->sim.start_height;
}
double nt_session_master_start(const nt_session *session)
{
    return session->master_start;
}
