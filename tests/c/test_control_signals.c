/* SPDX-License-Identifier: BSD-3-Clause
 * One period by its sums: what a sample is made into, what each mode does with it, x and y, and the stage's command.
 * Round numbers in a touch of a rig that has none of its own filters in the way. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "control/modes.h"
#include "control/observe.h"
#include "control/sideways.h"
#include "internal/control.h"
#include "larger.h"
#include "plain_touch.h"

static void signals_of_a_sample(void **unused)
{
    (void)unused;
    nt_touch touch = plain(NT_MODE_TOUCH);
    nt_touch_state state = begun(&touch);
    nt_sample sample = read_of(2.0, 3.0, 5.0, 1.5);
    sample.amplitude = 7.0;
    sample.lag = 8.0;
    nt_observe(&touch, &state, &sample);
    const nt_signals *s = &state.signals;
    assert_true(s->master_position == 2.0 && s->master_speed == 16.0 && s->smooth_speed == 8.0);
    assert_true(s->operator_force == 3.0 && s->smooth_force == 0.75);
    assert_true(s->stage_position == 5.0 && s->stage_speed == 40.0 && s->slave_force == 3.0);
    assert_true(state.amplitude == 7.0 && state.lag == 8.0 && state.projected_force == 3.0);
    assert_true(state.gaps.position == 0u && state.gaps.force == 0u && state.gaps.slave == 0u);
    assert_true(nt_observe_speed(&state) == 8.0);
    sample.stage_position[NT_Z] = 6.0;
    sample.master_position[NT_Z] = 3.0;
    nt_observe(&touch, &state, &sample);
    assert_true(s->stage_speed == 8.0 && s->master_speed == 8.0 && s->smooth_speed == 8.0);
    assert_true(s->smooth_force == 0.75 + 0.25 * (3.0 - 0.75));
    state.signals.smooth_force = 0.75;
    touch.rig.master.gauge = 0;
    nt_observe(&touch, &state, &sample);
    assert_true(s->operator_force == 0.0 && s->smooth_force == 0.75 * 0.75);
}

/* A gap of n periods: speeds are means over it, a filter is where it would be, and the hand is indexed anew. */
static void signals_after_a_gap(void **unused)
{
    (void)unused;
    nt_touch touch = plain(NT_MODE_TOUCH);
    nt_touch_state state = begun(&touch);
    const nt_sample sample = read_of(2.0, 3.0, 5.0, 1.5);
    state.supervisor.seen = 0u;
    for (int k = 0; k < 4; ++k)
        nt_observe(&touch, &state, &sample);
    assert_true(nt_observe_speed(&state) == 0.0 && state.gaps.slave == 4u);
    state.supervisor.seen = NT_SEES_MASTER;
    state.reference = 10.0;
    nt_observe(&touch, &state, &sample);
    const nt_signals *s = &state.signals;
    assert_true(s->master_speed == 16.0 / 5.0 && s->master_position == 2.0 && s->slave_force == 0.0);
    assert_true(fabs(s->smooth_speed - (1.0 - pow(0.5, 5.0)) * 3.2) < 1e-15);
    assert_true(state.offset == 10.0 - 0.5 * 2.0 && state.gaps.position == 0u && state.gaps.force == 5u);
    state.supervisor.seen = NT_SEES_OPERATOR;
    nt_observe(&touch, &state, &sample);
    assert_true(fabs(s->smooth_force - (1.0 - pow(0.75, 6.0)) * 3.0) < 1e-15);
    state.supervisor.seen = NT_SEES_ALL & ~(NT_SEES_MASTER | NT_SEES_OPERATOR);
    nt_observe(&touch, &state, &sample);
    assert_true(fabs(s->stage_speed - 5.0 / (7.0 * PERIOD)) < 1e-15 && s->slave_force == 3.0);
    state.supervisor.seen = NT_SEES_ALL & ~(NT_SEES_MASTER | NT_SEES_STAGE);
    state.gaps.slave = 0u;
    nt_observe(&touch, &state, &sample);
    assert_int_equal(state.gaps.slave, 1u); /* a part of the slave is none of it */
}

/* One reading that jumps by more than a spike may gives way to the middle one of the last three. */
static void a_jump_is_the_middle_of_three(void **unused)
{
    (void)unused;
    nt_touch touch = plain(NT_MODE_TOUCH);
    nt_touch_state state = begun(&touch);
    const double readings[] = {4.0, -20.0, 4.5, 10.0, 11.0, 20.0, 30.0, 1.0, 40.0};
    const double taken[] = {4.0, 0.0, 4.0, 4.5, 11.0, 11.0, 20.0, 20.0, 30.0};
    for (size_t i = 0; i < sizeof taken / sizeof *taken; ++i) {
        const nt_sample sample = read_of(0.0, 0.0, 0.0, readings[i]);
        nt_observe(&touch, &state, &sample);
        assert_true(state.signals.slave_force == 2.0 * taken[i]);
    }
}

static void a_new_scale_counts_from_the_hand(void **unused)
{
    (void)unused;
    nt_touch touch = plain(NT_MODE_TOUCH);
    nt_touch_state state = begun(&touch);
    state.rescale.wanted.alpha_p = 0.75;
    const nt_sample sample = read_of(8.0, 0.0, 0.0, 0.0);
    nt_observe(&touch, &state, &sample);
    assert_true(state.signals.scaling.alpha_p == 0.75 && state.offset == (0.5 - 0.75) * 8.0);
}

/* A spring between hand and tool, a damper between tool and ground, in one implicit step. */
static void what_a_coupling_feels(void **unused)
{
    (void)unused;
    nt_touch touch = plain(NT_MODE_TOUCH);
    nt_touch_state state = begun(&touch);
    touch.law = nt_servo_impedance;
    touch.settings.gains.velocity_feedforward = 0.0;
    state.signals.master_position = 6.0;
    state.projected_force = 3.0;
    state.offset = 7.0;
    state.reference = 9.5;
    assert_true(nt_mode_run(&touch, &state) == -0.25 * 12.0); /* a quarter of the ramp */
    assert_true(state.signals.felt_force == 3.0 && state.signals.target == 10.0 && state.reference == 10.0);
    assert_true(state.engaged == 0.25 && state.supervisor.reasons == 0u);
    touch.passivity.damping = 3.0; /* what the observer adds comes on top */
    state.passivity.damping = 0.5;
    state.passivity.speed = 2.0;
    state.engaged = 0.0;
    assert_true(nt_mode_run(&touch, &state) == -0.25 * 12.0 - 3.0);
    state.passivity.damping = 0.0;
    touch.settings.gains.coupling_stiffness = 6.0;
    touch.settings.gains.coupling_damping = 0.25; /* 2 N/m over a period */
    state.stretch = 1.0;
    state.signals.master_speed = 8.0;
    nt_mode_run(&touch, &state);
    assert_true(state.stretch == (2.0 * (1.0 + 1.0) + 12.0) / 8.0); /* 2 */
    assert_true(state.signals.felt_force == 6.0 * 2.0 / 4.0 && state.signals.target == 0.5 * (6.0 - 2.0) + 7.0);
    assert_true(state.reference == 9.0 && state.engaged == 0.5);
    touch.settings.gains.ramp_time = 0.0;
    nt_mode_run(&touch, &state);
    assert_true(state.engaged == 1.0);
    state.offset = 100.0; /* further than a period allows, and then than there is travel */
    state.reference = 48.5;
    nt_mode_run(&touch, &state);
    assert_true(state.reference == 49.5 && state.supervisor.reasons == NT_REASON_COMMAND_LIMITED);
    nt_mode_run(&touch, &state);
    assert_true(state.reference == 50.0);
}

static void the_height_servo(void **unused)
{
    (void)unused;
    nt_touch touch = plain(NT_MODE_TOPOGRAPHY);
    nt_touch_state state = begun(&touch);
    nt_gains *gains = &touch.settings.gains;
    gains->set_point = 3.0;
    gains->height_gain = 4.0;
    gains->height_stiffness = 16.0;
    state.signals.slave_force = 2.0;
    state.signals.master_position = 3.0;
    state.reference = 2.0;
    state.offset = 0.5;
    const double force = nt_mode_run(&touch, &state); /* (3 - 2)/2 N/m times 4/s times 1/8 s */
    assert_true(state.reference == 2.25 && force == 0.25 * 16.0 * ((2.25 - 0.5) / 0.5 - 3.0));
    state.mode = state.wanted_mode = NT_MODE_TAPPING;
    touch.drive_amplitude = 2.0;
    touch.settings.tap.hold = 0;
    touch.settings.tap.set_amplitude = 0.75;
    state.amplitude = 1.75;
    nt_mode_run(&touch, &state);
    assert_true(state.reference == 2.25 + 0.5 * (1.75 - 1.5));
    touch.settings.tap.hold = 1;
    touch.settings.tap.set_phase = 0.6;
    const double lags[] = {0.8, 2.5};
    for (int i = 0; i < 2; ++i) { /* beyond 90 degrees the sine goes on as 2 - sin */
        state.lag = lags[i];
        const double before = state.reference, read = i ? 2.0 - sin(2.5) : sin(0.8);
        nt_mode_run(&touch, &state);
        assert_true(fabs(state.reference - before - 0.5 * 2.0 * (read - sin(0.6))) < 1e-14);
    }
    state.lag = 1.5707963267948966; /* cos is 6e-17 */
    const double before = state.reference;
    nt_mode_run(&touch, &state);
    assert_true(fabs(state.reference - before - 1.0 * (1.0 - sin(0.6))) < 1e-14);
}

static void an_approach_step_by_step(void **unused)
{
    (void)unused;
    nt_touch touch = plain(NT_MODE_APPROACH);
    nt_touch_state state = begun(&touch);
    nt_gains *gains = &touch.settings.gains;
    gains->set_point = 10.0;
    gains->height_gain = 1.0;
    gains->approach_speed = 2.0; /* a quarter in a period */
    touch.supervisor.free_force = 1.0;
    state.signals.slave_force = 1.0;
    nt_mode_run(&touch, &state);
    assert_true(state.reference == 0.25); /* free air */
    state.signals.slave_force = 8.0;
    nt_mode_run(&touch, &state);
    assert_true(state.reference == 0.25 + 0.125 && state.phase == NT_PHASE_DOWN); /* (10 - 8)/2/8 */
    state.signals.slave_force = 2.0;
    nt_mode_run(&touch, &state);
    assert_true(state.reference == 0.375 + 0.25); /* no faster than in air */
    state.signals.slave_force = 30.0;
    nt_mode_run(&touch, &state);
    assert_true(state.reference == 0.625 - 0.25 && state.phase == NT_PHASE_DONE);
    state.phase = NT_PHASE_DOWN;
    state.signals.slave_force = nextafter(9.0, 0.0);
    nt_mode_run(&touch, &state);
    assert_true(state.phase == NT_PHASE_DOWN);
    state.signals.slave_force = 9.0; /* nine tenths of it: found */
    nt_mode_run(&touch, &state);
    assert_true(state.phase == NT_PHASE_DONE);
}

static void a_curve_step_by_step(void **unused)
{
    (void)unused;
    nt_touch touch = plain(NT_MODE_CURVE);
    nt_touch_state state = begun(&touch);
    touch.settings.gains.set_point = 10.0;
    touch.settings.gains.approach_speed = 2.0;
    touch.settings.gains.curve_length = 0.625;
    state.signals.slave_force = nextafter(10.0, 0.0);
    nt_mode_run(&touch, &state);
    assert_true(state.reference == 0.25 && state.turn == 0.25 && state.phase == NT_PHASE_DOWN);
    state.signals.slave_force = 10.0;
    nt_mode_run(&touch, &state);
    assert_true(state.turn == 0.5 && state.phase == NT_PHASE_UP);
    const double way[] = {0.25, 0.0, -0.125, -0.125};
    for (int k = 0; k < 4; ++k) {
        nt_mode_run(&touch, &state);
        assert_true(state.reference == way[k]);
        assert_int_equal(state.phase, k < 2 ? NT_PHASE_UP : NT_PHASE_DONE);
    }
    state.phase = NT_PHASE_DOWN; /* at the end of travel it turns */
    state.reference = 49.875;
    state.signals.slave_force = 0.0;
    nt_mode_run(&touch, &state);
    assert_true(state.reference == 50.0 && state.phase == NT_PHASE_UP);
    state.reference = -49.875; /* and is done at the other */
    state.turn = 0.0;
    touch.settings.gains.curve_length = 100.0;
    nt_mode_run(&touch, &state);
    assert_true(state.reference == -50.0 && state.phase == NT_PHASE_DONE);
}

/* By the clock: a period and what the tick is late. */
static void a_stop_lifts_so_far(void **unused)
{
    (void)unused;
    nt_touch touch = plain(NT_MODE_TOUCH);
    nt_touch_state state = begun(&touch);
    touch.settings.limits.retract_speed = 2.0;
    state.supervisor.late = 0.125;
    state.signals.master_position = 3.0;
    state.stretch = 1.0;
    nt_mode_stop(&touch, &state, 1.25);
    assert_true(state.reference == -0.5 && state.retracted == 0.5);
    assert_true(state.offset == -0.5 - 0.5 * 3.0 && state.stretch == 0.0);
    nt_mode_stop(&touch, &state, 1.25);
    nt_mode_stop(&touch, &state, 1.25);
    nt_mode_stop(&touch, &state, 1.25);
    assert_true(state.reference == -1.25 && state.retracted == 1.25);
    state.reference = -49.875;
    nt_mode_stop(&touch, &state, 2.0);
    assert_true(state.reference == -50.0 && state.retracted == 1.75);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(signals_of_a_sample),           cmocka_unit_test(signals_after_a_gap),
        cmocka_unit_test(a_jump_is_the_middle_of_three), cmocka_unit_test(a_new_scale_counts_from_the_hand),
        cmocka_unit_test(what_a_coupling_feels),         cmocka_unit_test(the_height_servo),
        cmocka_unit_test(an_approach_step_by_step),      cmocka_unit_test(a_curve_step_by_step),
        cmocka_unit_test(a_stop_lifts_so_far),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
