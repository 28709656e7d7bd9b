/* SPDX-License-Identifier: BSD-3-Clause
 * A step at a fixed rate, on absolute deadlines of the monotonic clock, so that late wake-ups do not add up. Periods
 * that are lost as a whole are skipped: a burst of steps to catch up would move the rig on samples that do not belong
 * to the time. */
#include <math.h>
#include <stddef.h>

#include "hal/clock.h"
#include "nanotouch/hal.h"

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
    const int64_t start = nt_clock_now();
    nt_status status = start != 0 ? NT_OK : NT_HAS_SYSTEM ? NT_E_DEVICE : NT_E_UNSUPPORTED;
    for (uint64_t tick = 0; tick < ticks && status == NT_OK; ++tick) {
        const int64_t deadline = start + (int64_t)tick * length;
        status = nt_clock_sleep_until(deadline);
        if (status != NT_OK)
            break;
        const int64_t now = nt_clock_now();
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
