/* SPDX-License-Identifier: BSD-3-Clause
 * The only POSIX file of the portable part: a step at a fixed rate, on absolute deadlines of the monotonic clock, so
 * that late wake-ups do not add up. Periods that are lost as a whole are skipped: a burst of steps to catch up would
 * move the rig on samples that do not belong to the time. */
#if defined(__linux__)
#define _POSIX_C_SOURCE 200809L
#endif

#include <math.h>
#include <stddef.h>

#include "nanotouch/hal.h"

#if defined(__linux__)

#include <errno.h>
#include <time.h>

static const int64_t second = 1000000000; /* [ns] */

static nt_status read_clock(int64_t *now)
{
    struct timespec time;
    if (clock_gettime(CLOCK_MONOTONIC, &time) != 0)
        return NT_E_DEVICE;
    *now = time.tv_sec * second + time.tv_nsec;
    return NT_OK;
}

static nt_status sleep_until(int64_t deadline)
{
    const struct timespec time = {.tv_sec = (time_t)(deadline / second), .tv_nsec = (long)(deadline % second)};
    int error;
    do /* interrupted by a signal: sleep on */
        error = clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, NULL);
    while (error == EINTR);
    return error == 0 ? NT_OK : NT_E_DEVICE;
}

static void count(nt_loop_statistics *statistics, double delay, double period)
{
    ++statistics->ticks;
    statistics->late += delay > 0.2 * period;
    if (delay > statistics->worst_delay)
        statistics->worst_delay = delay;
    statistics->mean_delay += (delay - statistics->mean_delay) / (double)statistics->ticks;
}

nt_status nt_loop_run(double period, uint64_t ticks, nt_loop_step step, void *context, nt_loop_statistics *statistics)
{
    if (!step)
        return NT_E_ARGUMENT;
    if (!isfinite(period))
        return NT_E_NOT_FINITE;
    if (period < 1e-6 || period > 0.999)
        return NT_E_RANGE;
    nt_loop_statistics found = {0, 0, 0, 0.0, 0.0};
    const int64_t length = (int64_t)llround(period * 1e9);
    int64_t now, start;
    nt_status status = read_clock(&start);
    for (uint64_t tick = 0; tick < ticks && status == NT_OK; ++tick) {
        const int64_t deadline = start + (int64_t)tick * length;
        status = sleep_until(deadline);
        if (status == NT_OK)
            status = read_clock(&now);
        if (status != NT_OK)
            break;
        const double lateness = 1e-9 * (double)(now - deadline);
        count(&found, lateness, period);
        const uint64_t lost = (uint64_t)((now - deadline) / length);
        found.missed += lost;
        tick += lost;
        if (tick >= ticks || step(context, tick, lateness) != 0)
            break;
    }
    if (statistics)
        *statistics = found;
    return status;
}

#else

nt_status nt_loop_run(double period, uint64_t ticks, nt_loop_step step, void *context, nt_loop_statistics *statistics)
{
    (void)period, (void)ticks, (void)step, (void)context, (void)statistics;
    return NT_E_UNSUPPORTED;
}

#endif
