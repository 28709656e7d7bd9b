/* SPDX-License-Identifier: BSD-3-Clause
 * A master of three axes: over a stage that has fewer, and where x and y alone become unstable. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/rig.h"
#include "internal/control.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/touch.h"

#define PI 3.14159265358979323846

static nt_touch touch;
static nt_touch_state state;

static nt_rig rig_of(double stage_axes)
{
    nt_rig rig = nt_rig_defaults();
    rig.master.axes = 3.0;
    rig.stage.axes = stage_axes;
    rig.probe.lateral_stiffness = 50.0;
    return rig;
}

static void open_touch(double stage_axes)
{
    const nt_rig rig = rig_of(stage_axes);
    const nt_settings settings = nt_settings_defaults(&rig);
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
}

/* In contact, and alive: the stage follows, and the deflection shows its noise. */
static nt_sample sample_at(uint64_t tick, const nt_command *last)
{
    nt_sample sample = {.tick = tick};
    sample.stage_position[NT_Z] = last->stage_position[NT_Z];
    sample.deflection[NT_Z] = 1e-9 + 1e-10 * (double)(tick % 2u);
    return sample;
}

/* The hand swings along the force of its motor, at 2 Hz, while x of the stage stands still: the motor pays. Returns the
 * first tick that is not RUN. */
static int swing_sideways(int ticks, nt_command *command)
{
    const double amplitude = 2e-4, most = 0.9 * touch.settings.limits.lateral_force / 50.0;
    *command = (nt_command){0};
    for (int i = 0; i < ticks; i++) {
        const double phase = 2.0 * PI * 2.0 * i * touch.period;
        nt_sample sample = sample_at((uint64_t)i, command);
        sample.master_position[NT_X] = amplitude * sin(phase);
        sample.deflection[NT_X] = most * cos(phase);
        nt_touch_step(&touch, &state, &sample, command);
        if (command->state != NT_RUN)
            return i;
    }
    return ticks;
}

static void a_motor_that_drives_x_alone_backs_off_and_holds(void **unused)
{
    (void)unused;
    nt_command command;
    open_touch(3.0);
    assert_true(touch.feels_sideways && touch.leads_sideways);
    const int held = swing_sideways(600000, &command);
    assert_in_range(held, 1, 599999);
    assert_int_equal(command.state, NT_HOLD);
    assert_true(command.reasons & NT_REASON_UNSTABLE && command.reasons & NT_REASON_BACKED_OFF);
    assert_true(state.passivity.gain == 1.0); /* nothing is wrong along z */
    assert_true(state.passivity_sideways[NT_X].gain < 0.05 && state.passivity_sideways[NT_Y].gain < 0.05);
}

/* x and y of the hand lead nothing, are not judged and push nothing back. */
static void a_stage_of_one_axis_follows_z_alone(void **unused)
{
    (void)unused;
    nt_command command = {0};
    open_touch(1.0);
    assert_false(touch.feels_sideways || touch.leads_sideways);
    for (int i = 0; i < 200; i++) {
        nt_sample sample = sample_at((uint64_t)i, &command);
        sample.master_position[NT_X] = i % 3 == 0 ? (double)NAN : 1e-3 * i;
        sample.deflection[NT_X] = 0.5 * touch.settings.limits.lateral_force / 50.0;
        nt_touch_step(&touch, &state, &sample, &command);
        assert_int_equal(command.state, NT_RUN);
        assert_true(command.stage_position[NT_X] == 0.0 && command.motor_force[NT_X] == 0.0);
    }
    const nt_rig one = rig_of(1.0), three = rig_of(3.0);
    const nt_settings settings = nt_settings_defaults(&one);
    const double along_z = nt_motor_bound_compute(&one, &settings).force;
    assert_true(fabs(nt_motor_bound_compute(&three, &settings).force - sqrt(3.0) * along_z) < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_motor_that_drives_x_alone_backs_off_and_holds),
        cmocka_unit_test(a_stage_of_one_axis_follows_z_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
