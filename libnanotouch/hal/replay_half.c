/* SPDX-License-Identifier: BSD-3-Clause */
#include "nanotouch/advanced/hal_replay.h"

#include <math.h>
#include <stddef.h>

#include "core/problem.h"

/* A period's clock is rounded to whole ns, a row's time is not [ns]. */
#define ROUNDING 1

static nt_status check_times(const nt_replay_rows *rows, nt_problem *problem)
{
    if (!(rows->time[0] == 0.0))
        return nt_problem_set(problem, "time of the first row", "s", rows->time[0], 0.0, 0.0);
    for (int64_t i = 1; i < rows->count; ++i)
        if (!(rows->time[i] > rows->time[i - 1] && rows->time[i] <= NT_REPLAY_LONGEST))
            return nt_problem_set(problem, "time of a row, after the one before", "s", rows->time[i], rows->time[i - 1],
                                  NT_REPLAY_LONGEST);
    return NT_OK;
}

nt_status nt_replay_half_init(nt_replay_half *half, const nt_replay_rows *rows, nt_problem *problem)
{
    if (!half || !rows || !rows->time || !rows->position)
        return NT_E_ARGUMENT;
    if (rows->count < 1)
        return nt_problem_set(problem, "rows of a replay", "", (double)rows->count, 1.0, HUGE_VAL);
    if (rows->axes != 1 && rows->axes != NT_AXES)
        return nt_problem_set(problem, "axes of a replay (1 or 3)", "", rows->axes, 1.0, NT_AXES);
    *half = (nt_replay_half){.rows = *rows, .row = -1};
    return check_times(rows, problem);
}

static nt_status open_half(void *context, const nt_host *host, nt_problem *problem)
{
    (void)problem;
    ((nt_replay_half *)context)->host = host;
    return NT_OK;
}

static nt_status describe(void *context, nt_capabilities *capabilities)
{
    const nt_replay_rows *rows = &((nt_replay_half *)context)->rows;
    /* a rig of a hand with a motor stays as it was recorded: what the motor is told is what the hand would feel */
    capabilities->can = (rows->felt ? NT_CAN_FEEL : 0u) | NT_CAN_PUSH;
    capabilities->axes = rows->axes;
    capabilities->period = rows->count > 1 ? rows->time[rows->count - 1] / (double)(rows->count - 1) : 0.0;
    return NT_OK;
}

static nt_status arm(void *context)
{
    nt_replay_half *half = context;
    half->row = -1;
    return NT_OK;
}

static int64_t stamp(const nt_replay_half *half, int64_t row)
{
    return half->begun + (int64_t)(1e9 * half->rows.time[row] + 0.5);
}

static void give(const nt_replay_half *half, nt_reading *reading)
{
    const nt_replay_rows *rows = &half->rows;
    const int64_t at = NT_AXES * half->row;
    reading->sequence = (uint64_t)half->row + 1u;
    reading->time = stamp(half, half->row);
    reading->flags = 0;
    reading->valid = 0;
    for (int i = 0; i < NT_AXES; ++i) {
        const int is_measured = rows->axes == NT_AXES || i == NT_Z;
        reading->position[i] = is_measured ? rows->position[at + i] : (double)NAN;
        reading->felt[i] = is_measured && rows->felt ? rows->felt[at + i] : (double)NAN;
        reading->valid |= isfinite(reading->position[i]) ? 1u << (NT_READS_POSITION + i) : 0u;
        reading->valid |= isfinite(reading->felt[i]) ? 1u << (NT_READS_FELT + i) : 0u;
    }
}

static nt_status read_half(void *context, nt_reading *reading)
{
    nt_replay_half *half = context;
    const int64_t now = half->host->now(half->host);
    if (half->row < 0) {
        half->begun = now;
        half->row = 0;
    }
    while (half->row + 1 < half->rows.count && stamp(half, half->row + 1) <= now + ROUNDING)
        ++half->row;
    give(half, reading);
    return NT_OK;
}

static nt_status write_half(void *context, const nt_action *action)
{
    (void)context, (void)action;
    return NT_OK;
}

#define BACKEND(which)                                                                                                 \
    {.size = sizeof(nt_backend),                                                                                       \
     .version = NT_HAL_API_VERSION,                                                                                    \
     .name = "replay",                                                                                                 \
     .half = which,                                                                                                    \
     .open = open_half,                                                                                                \
     .describe = describe,                                                                                             \
     .arm = arm,                                                                                                       \
     .read = read_half,                                                                                                \
     .write = write_half}

const nt_backend *nt_replay_backend(nt_half half)
{
    static const nt_backend master = BACKEND(NT_HALF_MASTER), slave = BACKEND(NT_HALF_SLAVE);
    return half == NT_HALF_MASTER ? &master : &slave;
}
