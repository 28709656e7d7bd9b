/* SPDX-License-Identifier: BSD-3-Clause
 * apps/mcu's touch on emulated chips, here and on bare metal: the set-point is found, held, and nothing is exceeded.
 * Then without a lever, above the plan's sample: it jumps into the water, and holds the same set-point. */
#include "../../apps/mcu/touch.h"
#include "../c/simulated_bus.h"
#include "tell.h"

static simulated_bus bus;
static int64_t clock_now; /* [ns] */

static nt_status exchange(void *context, int converter, const nt_transfer *transfers, int count)
{
    for (int i = 0; i < count; ++i)
        simulated_frame(context, converter, transfers[i].out, transfers[i].in, transfers[i].count);
    return NT_OK;
}

static int64_t now(const nt_host *host)
{
    (void)host;
    return clock_now;
}

static void wait(void *context)
{
    (void)context;
    clock_now += 100000;
}

static outcome touch(int has_no_lever)
{
    bus = simulated_bus_after_power_up();
    const board at = {.exchange = exchange,
                      .bus = &bus,
                      .host = {sizeof(nt_host), NT_HAL_API_VERSION, now, 0, 0},
                      .has_no_lever = has_no_lever,
                      .wait = wait};
    const outcome found = touch_run(&at, 60000);
    tell("status ", (uint64_t)found.status, 10);
    tell("state ", found.state, 10);
    tell("ticks ", (uint64_t)found.ticks, 10);
    tell("force [pN] ", (uint64_t)(found.force > 0.0 ? 1e12 * found.force : 0.0), 10);
    tell("largest [pN] ", (uint64_t)(1e12 * found.largest), 10);
    tell("strongest pull [pN] ", (uint64_t)(-1e12 * found.weakest), 10);
    tell("travel [nm] ", (uint64_t)(1e9 * found.travel), 10);
    tell("commands ", found.command_sum, 16);
    return found;
}

/* The set-point of the plan is 100 nN. */
static int is_good(const outcome *found)
{
    const int is_held = found->force > 0.5e-7 && found->force < 1.5e-7 && found->largest < 2e-6;
    const int is_lifted = simulated_travel(&bus) <= found->travel - 1e-6 + 1e-10;
    return found->status == NT_OK && found->state == NT_RUN && is_held && is_lifted;
}

int main(void)
{
    const outcome measured = touch(0);
    if (!is_good(&measured) || measured.travel <= SURFACE)
        return 1;
    const outcome modelled = touch(1);
    return is_good(&modelled) && modelled.weakest < -5e-9 ? 0 : 2; /* it pulled, as humid air does */
}
