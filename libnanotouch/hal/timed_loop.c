/* SPDX-License-Identifier: BSD-3-Clause
 * The loop with its phases timed. A clock read costs some 20 ns, four of them a period. */
#include <math.h>
#include <stddef.h>

#include "hal/clock.h"
#include "hal/timing.h"
#include "nanotouch/advanced/timing.h"
#include "nanotouch/hal.h"

typedef struct timed {
    const nt_loop_phases *phases;
    nt_timing *timing;
    int64_t length; /* of a period [ns] */
} timed;

static int run_phases(const timed *t, uint64_t tick, double lateness, int64_t at[NT_LOOP_PHASES])
{
    const nt_loop_phases *do_it = t->phases;
    at[0] = nt_clock_now();
    int stop = do_it->read ? do_it->read(do_it->context, tick, lateness) : 0;
    at[1] = nt_clock_now();
    stop |= do_it->compute && !stop ? do_it->compute(do_it->context) : 0;
    at[2] = nt_clock_now();
    stop |= do_it->write && !stop ? do_it->write(do_it->context) : 0;
    at[3] = nt_clock_now();
    return stop;
}

static int step(void *context, uint64_t tick, double lateness)
{
    const timed *t = context;
    nt_timing *timing = t->timing;
    int64_t at[NT_LOOP_PHASES] = {0};
    const int stop = run_phases(t, tick, lateness, at);
    const int64_t late = (int64_t)llround(1e9 * lateness),
                  within = late % t->length; /* lost periods are counted apart */
    const int64_t slack = t->length - within - (at[3] - at[0]);
    nt_histogram_add(&timing->phases[NT_LOOP_WAKE], late);
    for (int i = 0; i < 3; ++i)
        nt_histogram_add(&timing->phases[NT_LOOP_READ + i], at[i + 1] - at[i]);
    nt_histogram_add(&timing->phases[NT_LOOP_SLACK], slack);
    timing->overrun += slack < 0;
    ++timing->ticks;
    return stop;
}

nt_status nt_loop_run_timed(double period, uint64_t ticks, const nt_loop_phases *phases, nt_timing *timing)
{
    if (!phases || !timing)
        return NT_E_ARGUMENT;
    const int usable = isfinite(period) && period >= 1e-6 && period < 1.0;
    timed t = {phases, timing, usable ? (int64_t)llround(1e9 * period) : 1};
    nt_loop_statistics statistics = {.missed = 0};
    const nt_status status = nt_loop_run(period, ticks, step, &t, &statistics);
    timing->missed += statistics.missed;
    return status;
}
