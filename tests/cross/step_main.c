/* SPDX-License-Identifier: BSD-3-Clause
 * A plan's force and the touch step in double and in single precision on bare metal: instructions, bytes, and how far
 * they are apart. The emulator has no cycles: it counts instructions. */
#include "../../apps/mcu/plan.h"
#include "nanotouch/interaction.h"
#include "nanotouch_single_of.h"
#include "tell.h"

#define SYSTICK ((volatile uint32_t *)0xE000E010u) /* control, reload, count down at 25 MHz */
#define STAGE_BOUND 0x1p-16                        /* of the stage's travel, as test_control_single holds it */
#define DEEPEST -0.4e-9                            /* gap at which the path turns [m] */
#define FARTHEST 20e-9                             /* and at which it begins and ends [m] */
enum { STEPS = 2000, NANOSECONDS = 40 /* of a count; with -icount shift=0 an instruction takes one of them */ };

static nt_plan plan; /* of the scene of plan.h */
static nt_touch touch;
static nt_touch_state state;
static ntf_touch single;
static ntf_touch_state single_state;
static double commands[STEPS];
static float gaps[STEPS]; /* to the sample, into it and back [m] */

/* Counts of all steps. */
typedef struct counts {
    uint32_t force, step;
} counts;

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

static counts count_double(void)
{
    nt_interaction_state contact = {0};
    nt_sample sample = {.operator_force = {0.0, 0.0, 1.0}};
    nt_command command = {.state = NT_RUN};
    counts found = {0, 0};
    for (int i = 0; i < STEPS; ++i) {
        const double gap = (double)gaps[i];
        uint32_t before = SYSTICK[2];
        nt_interaction_advance_gap(&plan, &contact, NULL, gap);
        const double force = nt_interaction_eval_gap(&plan, &contact, NULL, gap).F;
        found.force += since(before);
        before = SYSTICK[2];
        sample.tick = (uint64_t)i;
        sample.master_position[NT_Z] = 1e-7 * i;
        sample.stage_position[NT_Z] = command.stage_position[NT_Z];
        sample.deflection[NT_Z] = force / touch.rig.probe.spring_constant + 1e-10 * (i % 7);
        nt_touch_step(&touch, &state, &sample, &command);
        found.step += since(before);
        commands[i] = command.stage_position[NT_Z];
    }
    return found;
}

static counts count_single(double *apart)
{
    int attached = 0;
    ntf_sample sample = {.operator_force = {0.0f, 0.0f, 1.0f}};
    ntf_command command = {.state = NTF_RUN};
    counts found = {0, 0};
    for (int i = 0; i < STEPS; ++i) {
        uint32_t before = SYSTICK[2];
        const float force = ntf_force_table_eval(&plan_force, &attached, gaps[i]).force;
        found.force += since(before);
        before = SYSTICK[2];
        sample.tick = (uint64_t)i;
        sample.master_position[NTF_Z] = 1e-7f * (float)i;
        sample.stage_position[NTF_Z] = command.stage_position[NTF_Z];
        sample.deflection[NTF_Z] = force / single.rig.probe.spring_constant + 1e-10f * (float)(i % 7);
        ntf_touch_step(&single, &single_state, &sample, &command);
        found.step += since(before);
        const double difference = (double)command.stage_position[NTF_Z] - commands[i];
        *apart = difference > *apart ? difference : -difference > *apart ? -difference : *apart;
    }
    return found;
}

static void tell_counts(const char *of_force, const char *of_step, const char *of_both, counts found)
{
    tell(of_force, (uint64_t)found.force * NANOSECONDS / STEPS, 10);
    tell(of_step, (uint64_t)found.step * NANOSECONDS / STEPS, 10);
    tell(of_both, ((uint64_t)found.force + found.step) * NANOSECONDS / STEPS, 10);
}

static nt_status make_all(void)
{
    const nt_scene scene = nt_scene_defaults();
    const nt_plan_inputs inputs = {.scene = &scene};
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    nt_status status = nt_plan_make(&plan, &inputs, NULL);
    if (status == NT_OK)
        status = nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL);
    single = ntf_touch_of(&touch);
    state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
    single_state = ntf_touch_start(&single, 0.0f, 0.0f, 0.0f);
    for (int i = 0; i < STEPS; ++i)
        gaps[i] = (float)(FARTHEST + (DEEPEST - FARTHEST) * (i < STEPS / 2 ? i : STEPS - i) / (STEPS / 2));
    return status;
}

int main(void)
{
    if (make_all() != NT_OK || !counts_instructions())
        return 1;
    double apart = 0.0;
    const counts in_double = count_double(), in_single = count_single(&apart);
    tell_counts("instructions of a plan's force ", "of a touch step ", "of both ", in_double);
    tell_counts("in single precision: of a plan's force ", "of a touch step ", "of both ", in_single);
    tell("bytes of nt_plan, nt_touch and its state ", sizeof plan + sizeof touch + sizeof state, 10);
    tell("bytes of the table, ntf_touch and its state ",
         sizeof plan_force + sizeof plan_pieces + sizeof single + sizeof single_state, 10);
    tell("stage gone [pm] ", (uint64_t)(1e12 * commands[STEPS - 1]), 10);
    tell("stage apart, at most [am] ", (uint64_t)(1e18 * apart), 10);
    const int ran = state.supervisor.state == NT_RUN && single_state.supervisor.state == NTF_RUN;
    const int is_less = in_single.force + in_single.step < in_double.force + in_double.step;
    return ran && apart <= STAGE_BOUND * touch.rig.stage.travel && is_less ? 0 : 2;
}
