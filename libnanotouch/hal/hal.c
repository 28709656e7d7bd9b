/* SPDX-License-Identifier: BSD-3-Clause
 * One half of a rig through its backend, and both halves as one sample. */
#include "nanotouch/hal.h"

#include <math.h>
#include <stddef.h>

#include "core/axes.h"
#include "core/problem.h"
#include "hal/capabilities.h"
#include "hal/hal.h"
#include "hal/reading.h"

#define ALL_CHANNELS ((1u << NT_READS) - 1u)

static nt_status check_backend(const nt_backend *backend, nt_half half, nt_problem *problem)
{
    if (!backend || !backend->read || !backend->write)
        return NT_E_ARGUMENT;
    if (backend->size != sizeof *backend || backend->version != NT_HAL_API_VERSION || backend->half != half)
        return NT_E_UNSUPPORTED;
    if (!backend->name || !backend->name[0]) {
        (void)nt_problem_set(problem, "backends without a name", "", 1.0, 0.0, 0.0);
        return NT_E_ARGUMENT;
    }
    return NT_OK;
}

nt_status nt_hal_open(nt_hal *hal, nt_half half, const nt_hal_choice *choice, const nt_host *host, nt_problem *problem)
{
    nt_status status = check_backend(choice->backend, half, problem);
    if (status != NT_OK)
        return status;
    const nt_backend *backend = choice->backend;
    nt_hal made = {.backend = backend,
                   .context = choice->context ? choice->context : backend->context,
                   .capabilities = {.size = sizeof made.capabilities, .can = NT_CAN_FEEL | NT_CAN_PUSH, .axes = 1},
                   .reading = {.size = sizeof made.reading}}; /* nothing is valid yet */
    if (backend->open)
        status = backend->open(made.context, host, problem);
    if (status == NT_OK && backend->describe)
        status = backend->describe(made.context, &made.capabilities);
    if (status == NT_OK)
        status = nt_capabilities_check(&made.capabilities, problem);
    if (status == NT_OK)
        *hal = made;
    else if (backend->close)
        backend->close(made.context);
    return status;
}

nt_status nt_hal_configure(nt_hal *hal, const nt_configuration *configuration, nt_problem *problem)
{
    if (!hal->backend)
        return NT_E_STATE;
    return hal->backend->configure ? hal->backend->configure(hal->context, configuration, problem) : NT_OK;
}

nt_status nt_hal_arm(nt_hal *hal)
{
    if (!hal->backend)
        return NT_E_STATE;
    const nt_status status = hal->backend->arm ? hal->backend->arm(hal->context) : NT_OK;
    hal->is_armed = status == NT_OK;
    return status;
}

static void forget(nt_reading *reading, uint32_t flags)
{
    for (int i = 0; i < NT_READS; ++i)
        *nt_reading_channel(reading, i) = NAN;
    reading->flags |= flags;
    reading->valid = 0;
}

static inline void keep(nt_reading *reading, uint32_t channel, double *value)
{
    if (!(reading->valid & 1u << channel))
        *value = NAN;
}

/* What a half does not call valid is no number, whatever stands there. */
static void keep_valid(nt_reading *reading)
{
    keep(reading, NT_READS_POSITION + NT_X, &reading->position[NT_X]);
    keep(reading, NT_READS_POSITION + NT_Y, &reading->position[NT_Y]);
    keep(reading, NT_READS_POSITION + NT_Z, &reading->position[NT_Z]);
    keep(reading, NT_READS_FELT + NT_X, &reading->felt[NT_X]);
    keep(reading, NT_READS_FELT + NT_Y, &reading->felt[NT_Y]);
    keep(reading, NT_READS_FELT + NT_Z, &reading->felt[NT_Z]);
    keep(reading, NT_READS_AMPLITUDE, &reading->amplitude);
    keep(reading, NT_READS_LAG, &reading->lag);
}

/* A device that fails is lost, whatever it says of it; a model that fails is the caller's matter. */
static int is_loss(const nt_hal *hal, nt_status status)
{
    return status != NT_OK && (status == NT_E_DEVICE || !hal->is_model);
}

nt_status nt_hal_read(nt_hal *hal)
{
    if (!hal->backend)
        return NT_E_STATE;
    const uint64_t sequence = hal->reading.sequence;
    const nt_status status = hal->backend->read(hal->context, &hal->reading);
    const int lost = is_loss(hal, status);
    if (lost || hal->is_lost)
        forget(&hal->reading, NT_SAMPLE_DEVICE_LOST | NT_SAMPLE_INVALID);
    else if (hal->reading.sequence < sequence)
        forget(&hal->reading, NT_SAMPLE_INVALID);
    else if ((hal->reading.valid & ALL_CHANNELS) != ALL_CHANNELS)
        keep_valid(&hal->reading);
    if (!(hal->reading.lateness >= 0.0))
        hal->reading.lateness = INFINITY; /* nobody knows how late: too late */
    return lost ? NT_OK : status;
}

nt_status nt_hal_write(nt_hal *hal, const nt_action *action)
{
    if (!hal->backend)
        return NT_E_STATE;
    const nt_status status = hal->backend->write(hal->context, action);
    hal->is_lost = is_loss(hal, status);
    return hal->is_lost ? NT_OK : status;
}

void nt_hal_disarm(nt_hal *hal)
{
    if (!hal->backend || !hal->is_armed)
        return;
    if (hal->backend->disarm)
        hal->backend->disarm(hal->context);
    hal->is_armed = 0;
}

void nt_hal_close(nt_hal *hal)
{
    if (!hal || !hal->backend)
        return;
    nt_hal_disarm(hal);
    if (hal->backend->close)
        hal->backend->close(hal->context);
    hal->backend = NULL;
    hal->context = NULL;
}

static double seconds_between(int64_t from, int64_t to)
{
    return (double)(int64_t)((uint64_t)to - (uint64_t)from) / 1e9; /* whatever a half calls its time */
}

/* Flags of both. Where one device alone is to blame the other one's numbers still count. */
static uint32_t join_flags(uint32_t master, uint32_t slave)
{
    const uint32_t bad = NT_SAMPLE_INVALID | NT_SAMPLE_DEVICE_LOST, both = master | slave;
    if (master & bad && !(slave & bad))
        return both | NT_SAMPLE_MASTER_ALONE;
    return slave & bad && !(master & bad) ? both | NT_SAMPLE_SLAVE_ALONE : both;
}

void nt_hal_join(const nt_hal *master, const nt_hal *slave, uint64_t tick, int64_t now, nt_sample *sample)
{
    const nt_reading *hand = &master->reading, *probe = &slave->reading;
    sample->tick = tick;
    sample->age = seconds_between(probe->time, now);
    sample->master_age = seconds_between(hand->time, now);
    sample->lateness = hand->lateness > probe->lateness ? hand->lateness : probe->lateness;
    sample->flags = join_flags(hand->flags, probe->flags);
    copy_axes(sample->master_position, hand->position);
    copy_axes(sample->operator_force, hand->felt);
    copy_axes(sample->stage_position, probe->position);
    copy_axes(sample->deflection, probe->felt);
    sample->amplitude = probe->amplitude;
    sample->lag = probe->lag;
}

nt_status nt_hal_sample(nt_hal *master, nt_hal *slave, uint64_t tick, int64_t now, nt_sample *sample)
{
    nt_status status = nt_hal_read(master);
    if (status == NT_OK)
        status = nt_hal_read(slave);
    if (status == NT_OK)
        nt_hal_join(master, slave, tick, now, sample);
    return status;
}

nt_status nt_hal_command(nt_hal *master, nt_hal *slave, const nt_command *command, nt_action *action)
{
    action->state = command->state;
    action->drive_amplitude = action->drive_frequency = 0.0;
    copy_axes(action->target, command->motor_force);
    const nt_status status = nt_hal_write(master, action);
    copy_axes(action->target, command->stage_position);
    action->drive_amplitude = command->drive_amplitude;
    action->drive_frequency = command->drive_frequency;
    const nt_status second = nt_hal_write(slave, action);
    return status == NT_OK ? second : status;
}
