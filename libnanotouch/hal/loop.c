/* SPDX-License-Identifier: BSD-3-Clause
 * The only POSIX file of the portable part: a step at a fixed rate, on absolute deadlines of the monotonic clock, so
 * that late wake-ups do not add up. */
#if defined(__unix__) || defined(__APPLE__)
#define _POSIX_C_SOURCE 200809L
#include <time.h>
#endif

#include <math.h>
#include <stddef.h>

#include "nanotouch/hal.h"

#if defined(__linux__)

static double seconds_between(const struct timespec *from, const struct timespec *to)
{
    return (double)(to->tv_sec - from->tv_sec) + 1e-9 * (double)(to->tv_nsec - from->tv_nsec);
}

static void add_nanoseconds(struct timespec *time, long nanoseconds)
{
    time->tv_nsec += nanoseconds;
    while (time->tv_nsec >= 1000000000L) {
        time->tv_nsec -= 1000000000L;
        ++time->tv_sec;
    }
}

static void count(nt_loop_statistics *statistics, double delay, double period)
{
    ++statistics->ticks;
    statistics->late += delay > 0.2 * period;
    statistics->missed += delay > period;
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
    struct timespec deadline;
    if (clock_gettime(CLOCK_MONOTONIC, &deadline) != 0)
        return NT_E_DEVICE;
    const long nanoseconds = lround(period * 1e9);
    for (uint64_t tick = 0; tick < ticks; ++tick) {
        struct timespec now;
        while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, NULL) != 0) {
        } /* interrupted by a signal: sleep on */
        if (clock_gettime(CLOCK_MONOTONIC, &now) != 0)
            return NT_E_DEVICE;
        count(&found, seconds_between(&deadline, &now), period);
        if (step(context, tick) != 0)
            break;
        add_nanoseconds(&deadline, nanoseconds);
    }
    if (statistics)
        *statistics = found;
    return NT_OK;
}

#else

nt_status nt_loop_run(double period, uint64_t ticks, nt_loop_step step, void *context, nt_loop_statistics *statistics)
{
    (void)period, (void)ticks, (void)step, (void)context, (void)statistics;
    return NT_E_UNSUPPORTED;
}

#endif
