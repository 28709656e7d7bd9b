/* SPDX-License-Identifier: BSD-3-Clause
 * apps/mcu's touch on emulated chips, here and on bare metal: the set-point is found, held, and nothing is exceeded. */
#include <math.h>

#include "../../apps/mcu/touch.h"
#include "../c/simulated_bus.h"

#ifdef NT_BARE_METAL
void say(const char *text);
#else
#include <stdio.h>
static void say(const char *text)
{
    (void)fputs(text, stdout);
}
#endif

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

/* "name 1234" with the number in thousandths or hexadecimal: no printf on bare metal. */
static void tell(const char *name, uint64_t value, unsigned base)
{
    char digits[24] = {0};
    int at = 22;
    do
        digits[--at] = "0123456789abcdef"[value % base];
    while (value /= base);
    digits[22] = '\n';
    say(name);
    say(digits + at);
}

#ifdef NT_BARE_METAL
#define SYSTICK ((volatile uint32_t *)0xE000E010u) /* control, reload, count down at 25 MHz */
enum { STEPS = 2000, NANOSECONDS = 40 /* of a count; with -icount shift=0 an instruction takes one of them */ };

/* Is a count what it is taken for? A loop of 200 000 instructions tells. */
static int counts_instructions(void)
{
    uint32_t left = 100000;
    const uint32_t before = SYSTICK[2];
    __asm__ volatile("1: subs %0, %0, #1\n bne 1b" : "+r"(left) : : "cc");
    const uint32_t found = ((before - SYSTICK[2]) & 0xFFFFFFu) * NANOSECONDS;
    return found > 198000 && found < 202000;
}

/* The emulator has no cycles: it counts instructions. */
static void tell_instructions(void)
{
    static nt_touch touch;
    static nt_touch_state state;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    if (nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL) != NT_OK)
        return;
    state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
    nt_sample sample = {.operator_force = {0.0, 0.0, 1.0}};
    nt_command command = {.state = NT_RUN};
    SYSTICK[1] = 0xFFFFFFu;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5; /* on, the processor's clock, no interrupt */
    if (!counts_instructions())
        return;
    const uint32_t before = SYSTICK[2];
    for (int i = 0; i < STEPS; ++i) {
        sample.tick = (uint64_t)i;
        sample.master_position[NT_Z] = 1e-7 * i;
        sample.stage_position[NT_Z] = command.stage_position[NT_Z];
        sample.deflection[NT_Z] = 1e-9 * (i % 7);
        nt_touch_step(&touch, &state, &sample, &command);
    }
    const uint32_t counts = (before - SYSTICK[2]) & 0xFFFFFFu;
    tell("instructions of a touch step ", (uint64_t)counts * NANOSECONDS / STEPS, 10);
    tell("bytes of nt_touch and its state ", sizeof touch + sizeof state, 10);
}
#else
static void tell_instructions(void)
{
}
#endif

int main(void)
{
    bus = simulated_bus_after_power_up();
    const board at = {
        .exchange = exchange, .bus = &bus, .host = {sizeof(nt_host), NT_HAL_API_VERSION, now, 0, 0}, .wait = wait};
    const outcome found = touch_run(&at, 60000);
    const double held = found.force, lifted = simulated_travel(&bus);
    tell("status ", (uint64_t)found.status, 10);
    tell("state ", found.state, 10);
    tell("ticks ", (uint64_t)found.ticks, 10);
    tell("force [pN] ", (uint64_t)(held > 0.0 ? 1e12 * held : 0.0), 10);
    tell("largest [pN] ", (uint64_t)(1e12 * found.largest), 10);
    tell("travel [nm] ", (uint64_t)(1e9 * found.travel), 10);
    tell("commands ", found.command_sum, 16);
    tell_instructions();
    const int is_held = held > 0.5e-7 && found.largest < 2e-6 && found.travel > SURFACE;
    const int is_lifted = lifted <= found.travel - 1e-6 + 1e-10;
    return found.status == NT_OK && found.state == NT_RUN && is_held && is_lifted ? 0 : 1;
}
