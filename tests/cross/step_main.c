/* SPDX-License-Identifier: BSD-3-Clause
 * The touch step in double and in single precision on bare metal: instructions, bytes, and how far they are apart. The
 * emulator has no cycles: it counts instructions. */
#include "nanotouch_single_of.h"
#include "tell.h"

#define SYSTICK ((volatile uint32_t *)0xE000E010u) /* control, reload, count down at 25 MHz */
#define STAGE_BOUND 0x1p-16                        /* of the stage's travel, as test_control_single holds it */
enum { STEPS = 2000, NANOSECONDS = 40 /* of a count; with -icount shift=0 an instruction takes one of them */ };

static nt_touch touch;
static nt_touch_state state;
static ntf_touch single;
static ntf_touch_state single_state;
static double commands[STEPS];

static uint32_t since(uint32_t before)
{
    return (before - SYSTICK[2]) & 0xFFFFFFu;
}

/* Is a count what it is taken for? A loop of 200 000 instructions tells. */
static int counts_instructions(void)
{
    uint32_t left = 100000;
    SYSTICK[1] = 0xFFFFFFu;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5; /* on, the processor's clock, no interrupt */
    const uint32_t before = SYSTICK[2];
    __asm__ volatile("1: subs %0, %0, #1\n bne 1b" : "+r"(left) : : "cc");
    const uint32_t found = since(before) * NANOSECONDS;
    return found > 198000 && found < 202000;
}

static uint32_t count_double(void)
{
    nt_sample sample = {.operator_force = {0.0, 0.0, 1.0}};
    nt_command command = {.state = NT_RUN};
    uint32_t counts = 0;
    for (int i = 0; i < STEPS; ++i) {
        const uint32_t before = SYSTICK[2];
        sample.tick = (uint64_t)i;
        sample.master_position[NT_Z] = 1e-7 * i;
        sample.stage_position[NT_Z] = command.stage_position[NT_Z];
        sample.deflection[NT_Z] = 1e-9 * (i % 7);
        nt_touch_step(&touch, &state, &sample, &command);
        counts += since(before);
        commands[i] = command.stage_position[NT_Z];
    }
    return counts;
}

static uint32_t count_single(double *apart)
{
    ntf_sample sample = {.operator_force = {0.0f, 0.0f, 1.0f}};
    ntf_command command = {.state = NTF_RUN};
    uint32_t counts = 0;
    for (int i = 0; i < STEPS; ++i) {
        const uint32_t before = SYSTICK[2];
        sample.tick = (uint64_t)i;
        sample.master_position[NTF_Z] = 1e-7f * (float)i;
        sample.stage_position[NTF_Z] = command.stage_position[NTF_Z];
        sample.deflection[NTF_Z] = 1e-9f * (float)(i % 7);
        ntf_touch_step(&single, &single_state, &sample, &command);
        counts += since(before);
        const double difference = (double)command.stage_position[NTF_Z] - commands[i];
        *apart = difference > *apart ? difference : -difference > *apart ? -difference : *apart;
    }
    return counts;
}

int main(void)
{
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    if (nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL) != NT_OK || !counts_instructions())
        return 1;
    single = ntf_touch_of(&touch);
    state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
    single_state = ntf_touch_start(&single, 0.0f, 0.0f, 0.0f);
    double apart = 0.0;
    const uint32_t in_double = count_double(), in_single = count_single(&apart);
    tell("instructions of a touch step ", (uint64_t)in_double * NANOSECONDS / STEPS, 10);
    tell("instructions of a touch step in single precision ", (uint64_t)in_single * NANOSECONDS / STEPS, 10);
    tell("bytes of nt_touch and its state ", sizeof touch + sizeof state, 10);
    tell("bytes of ntf_touch and its state ", sizeof single + sizeof single_state, 10);
    tell("stage gone [pm] ", (uint64_t)(1e12 * commands[STEPS - 1]), 10);
    tell("stage apart, at most [am] ", (uint64_t)(1e18 * apart), 10);
    const int ran = state.supervisor.state == NT_RUN && single_state.supervisor.state == NTF_RUN;
    return ran && apart <= STAGE_BOUND * rig.stage.travel && in_single < in_double ? 0 : 2;
}
