/* SPDX-License-Identifier: BSD-3-Clause
 * When a lift helps, when a stage goes the wrong way, when a sensor is dead: each rule at its border, on round numbers.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control/lift.h"
#include "control/stuck.h"
#include "internal/control.h"
#include "larger.h"

/* A force counts as grown by more than 1 N and 1 nm of the lever. */
static nt_supervisor plain(void)
{
    return (nt_supervisor){.free_force = 1.0, .spring_constant = 1e9, .turn_slack = 2.0};
}

static nt_supervisor_state in_a_lift(double expected)
{
    return (nt_supervisor_state){.state = NT_RETRACT,
                                 .lift = NT_LIFT_GOES,
                                 .lifts = 1,
                                 .expected = expected,
                                 .turn = 20.0,
                                 .turn_position = 20.0,
                                 .lift_force = 5.0};
}

static void a_lift_begins_where_the_stop_does(void **unused)
{
    (void)unused;
    const nt_supervisor s = plain();
    assert_true(nt_lift_tolerance(&s) == 2.0);
    nt_supervisor_state state = {.state = NT_RUN, .lift = NT_LIFT_WAITS, .expected = 7.0, .growth_run = 2u};
    assert_true(nt_lift_helps(&s, &state, 3.0, 0.0));
    assert_true(state.lift == NT_LIFT_GOES && state.stopped == 7.0 && state.turn == 7.0 && state.lift_force == 3.0);
    assert_int_equal(state.growth_run, 0u);
    assert_true(nt_lift_helps(&s, &state, -3.0, 0.0) && state.lift_force == 0.0); /* a pull is let go of */
    state = in_a_lift(10.0);
    state.lifts = 0; /* it stands: it begins anew when it is told to go, from where it stopped */
    state.stopped = 3.0;
    assert_true(nt_lift_helps(&s, &state, 9.0, 0.0));
    assert_true(state.turn == 10.0 && state.lift_force == 9.0 && state.stopped == 3.0);
}

/* Until it should have turned the force may grow; from then on not by more than the tolerance, three times. */
static void a_force_that_grows_in_a_lift(void **unused)
{
    (void)unused;
    const nt_supervisor s = plain();
    nt_supervisor_state state = in_a_lift(18.0); /* of the slack: it need not have turned */
    assert_true(nt_lift_helps(&s, &state, 8.0, 20.0) && state.lift_force == 8.0);
    assert_true(nt_lift_helps(&s, &state, 6.0, 20.0) && state.lift_force == 8.0 && state.growth_run == 0u);
    state.expected = 17.9;
    for (int i = 0; i < 5; ++i)
        assert_true(nt_lift_helps(&s, &state, 10.0, 20.0) && state.growth_run == 0u);
    const double more = nextafter(10.0, 11.0);
    assert_true(nt_lift_helps(&s, &state, more, 20.0) && nt_lift_helps(&s, &state, more, 20.0));
    assert_true(nt_lift_helps(&s, &state, 10.0, 20.0) && state.growth_run == 0u); /* not in a row */
    nt_supervisor_state risen = state;
    for (uint32_t k = 1; k <= 3; ++k) {
        assert_int_equal(nt_lift_helps(&s, &state, more, 18.0), k < 3u);
        assert_int_equal(state.growth_run, k);
    }
    assert_int_equal(state.lift, NT_LIFT_GIVEN_UP);
    for (int k = 0; k < 5; ++k) /* it is read to rise by more than the slack: the frame comes down faster */
        assert_true(nt_lift_helps(&s, &risen, more, nextafter(18.0, 0.0)));
    assert_int_equal(risen.lift, NT_LIFT_GOES);
}

/* One that waits goes by the force alone: when it grows it tries, from there. */
static void a_lift_that_waits_tries_once(void **unused)
{
    (void)unused;
    const nt_supervisor s = plain();
    nt_supervisor_state state = in_a_lift(25.0);
    state.lift = NT_LIFT_WAITS;
    state.lifts = 0;
    for (int k = 1; k <= 3; ++k) {
        assert_true(nt_lift_helps(&s, &state, 7.5, -100.0));
        assert_int_equal(state.lift, k < 3 ? NT_LIFT_WAITS : NT_LIFT_TRIES);
    }
    assert_true(state.turn == 25.0 && state.lift_force == 7.5 && state.growth_run == 0u);
    for (int k = 1; k <= 3; ++k)
        assert_int_equal(nt_lift_helps(&s, &state, 9.75, -100.0), k < 3);
    assert_int_equal(state.lift, NT_LIFT_GIVEN_UP);
}

static nt_supervisor_state rising(void)
{
    const nt_supervisor s = plain();
    nt_supervisor_state state = in_a_lift(20.0);
    state.lifts = 0;
    assert_true(nt_lift_rises(&s, &state, 50.0));
    assert_true(state.turn_position == 50.0 && state.top_position == 50.0 && isinf(state.fall_position));
    state.lifts = 1;
    return state;
}

/* Two slacks below its top a stage may turn and ring; from where that is seen it may go on by one more. */
static void a_stage_that_falls_on(void **unused)
{
    (void)unused;
    const nt_supervisor s = plain();
    nt_supervisor_state state = rising();
    assert_true(nt_lift_rises(&s, &state, 40.0) && state.top_position == 40.0);
    assert_true(nt_lift_rises(&s, &state, 44.0) && isinf(state.fall_position));
    assert_true(nt_lift_rises(&s, &state, 45.0) && state.fall_position == 45.0);
    for (int k = 0; k < 5; ++k)
        assert_true(nt_lift_rises(&s, &state, 47.0) && state.fall_run == 0u && state.fall_position == 45.0);
    const double more = nextafter(47.0, 48.0);
    assert_true(nt_lift_rises(&s, &state, more) && nt_lift_rises(&s, &state, more) && state.fall_run == 2u);
    assert_true(nt_lift_rises(&s, &state, 47.0) && state.fall_run == 0u);
    nt_supervisor_state slips = state;
    assert_true(nt_lift_rises(&s, &slips, 44.0) && isinf(slips.fall_position)); /* back: it was a slip */
    for (uint32_t k = 1; k <= 3; ++k)
        assert_int_equal(nt_lift_rises(&s, &state, more), k < 3u);
    assert_int_equal(state.lift, NT_LIFT_WAITS);
    for (int i = 0; i < 3; ++i) { /* nothing is asked of one that is not told to lift, waits, or is no stop */
        nt_supervisor_state other = slips;
        other.fall_run = 2u;
        other.fall_position = 0.0;
        other.state = i == 0 ? NT_HOLD : NT_RETRACT;
        other.lift = i == 1 ? NT_LIFT_TRIES : NT_LIFT_GOES;
        other.lifts = i != 2;
        assert_true(nt_lift_rises(&s, &other, 60.0) && other.top_position == 60.0 && other.fall_run == 0u);
    }
}

static void how_far_a_stop_lifts(void **unused)
{
    (void)unused;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    nt_touch touch;
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    const double distance = settings.limits.retract_distance;
    nt_touch_state state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
    const double lifts[] = {distance, 0.0, distance, 0.0};
    for (int i = 0; i < 4; ++i) {
        state.supervisor.lift = (nt_lift)i;
        assert_true(nt_lift_distance(&touch, &state) == lifts[i]);
    }
    state.supervisor.lift = NT_LIFT_GOES;
    for (int i = 0; i < 4; ++i) { /* all of it once more, when all is gone and force shows */
        state.supervisor.presses = i & 1;
        state.retracted = i & 2 ? distance : 0.5 * distance;
        const double before = state.retracted;
        nt_lift_distance(&touch, &state);
        assert_true(state.retracted == (i == 3 ? 0.0 : before));
    }
}

/* A sensor that seems stuck is tried: the probe steps away by twenty steps of the read-out, no more. */
static void a_stuck_sensor_is_stepped_away_from(void **unused)
{
    (void)unused;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    nt_touch touch;
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    nt_touch_state state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
    state.supervisor.deflection =
        (nt_stuck){.run = NT_STUCK_SAMPLES, .noise_samples = 200u, .band = 1e-12, .position = {0.0, 0.0, 50e-9}};
    for (int k = 0; k < 40; ++k) {
        const nt_sample sample = {.stage_position = {0.0, 0.0, state.reference}};
        nt_command command;
        nt_touch_step(&touch, &state, &sample, &command);
        assert_int_equal(command.state, NT_HOLD);
    }
    assert_true(fabs(state.retracted - 20.0 * rig.stage.resolution) < 1e-20);
    assert_true(fabs(state.reference + 20.0 * rig.stage.resolution) < 1e-20);
}

/* A reading whose noise is an alternation of +-1/2 about `middle`. */
static double reading(int k, double middle)
{
    return middle + (k % 2 ? 0.5 : -0.5);
}

/* Mean |difference| 1 is sigma 1/1.128379; a quarter of that, or of what is declared, is the band. */
static void the_noise_that_is_learnt(void **unused)
{
    (void)unused;
    const double declared[] = {10.0, 0.5};
    for (int i = 0; i < 2; ++i) {
        const nt_stuck_limits limits = {3.0, declared[i]};
        nt_stuck stuck = {.value = NAN};
        const double position[NT_AXES] = {1.0, 2.0, 3.0};
        for (int k = 0; k < 200; ++k) {
            assert_true(stuck.band == 0.0);
            /* the second block is the quietest: the others are twice as loud */
            const double size = k >= 50 && k < 100 ? 1.0 : 2.0;
            assert_int_equal(nt_stuck_judge(&limits, &stuck, size * reading(k, 0.0), position, 0), NT_RUN);
        }
        const double sum = 49.0 * 1.0 + 1.5; /* the step from the first block into it */
        assert_true(fabs(stuck.noise - sum / (1.128379 * 50.0)) < 1e-12);
        const double least = smaller(declared[i], stuck.noise);
        assert_true(fabs(stuck.band - 0.25 * least) < 1e-15);
        const nt_stuck learnt = stuck;
        nt_stuck_judge(&limits, &stuck, 100.0, position, 0);
        assert_true(stuck.noise == learnt.noise && stuck.band == learnt.band && stuck.noise_samples == 200u);
        assert_true(stuck.value == 100.0 && stuck.position[NT_Y] == 2.0);
        nt_stuck_judge(&limits, &stuck, 0.0, position, 0);
        nt_stuck_judge(&limits, &stuck, -stuck.band, position, 0);
        assert_int_equal(stuck.run, 1u); /* of the band: no noise */
        nt_stuck_judge(&limits, &stuck, -nextafter(stuck.band, 1.0), position, 0);
        assert_int_equal(stuck.run, 0u);
    }
}

/* The first block counts 49 differences. */
static void the_first_block(void **unused)
{
    (void)unused;
    const nt_stuck_limits limits = {3.0, 10.0};
    nt_stuck stuck = {.value = NAN};
    const double position[NT_AXES] = {0.0};
    for (int k = 0; k < 50; ++k) {
        assert_true(stuck.noise == 0.0);
        nt_stuck_judge(&limits, &stuck, reading(k, 7.0), position, 0);
    }
    assert_true(fabs(stuck.noise - 49.0 / (1.128379 * 50.0)) < 1e-12 && stuck.noise_sum == 0.0);
}

/* 50 readings without noise and more than the distance along any axis: HOLD; as many again: LATCHED. */
static void a_dead_sensor_by_number(void **unused)
{
    (void)unused;
    const nt_stuck_limits limits = {3.0, 1.0};
    for (int axis = 0; axis < NT_AXES; ++axis) {
        nt_stuck stuck = {.value = NAN};
        double position[NT_AXES] = {1.0, 2.0, 4.0};
        nt_stuck_judge(&limits, &stuck, 9.0, position, 0); /* the first tells nothing */
        assert_int_equal(stuck.run, 0u);
        position[axis] += 3.0; /* the distance is not yet a way */
        for (uint32_t k = 1; k <= 120; ++k) {
            assert_int_equal(nt_stuck_judge(&limits, &stuck, 9.0, position, 0), NT_RUN);
            assert_int_equal(stuck.run, k < 50u ? k : 50u);
        }
        position[axis] += axis ? 1.0 : -7.0;
        for (uint32_t k = 51; k <= 120; ++k) {
            assert_int_equal(nt_stuck_judge(&limits, &stuck, 9.0, position, 0), k < 100u ? NT_HOLD : NT_LATCHED);
            assert_int_equal(stuck.run, k < 100u ? k : 100u);
        }
        assert_int_equal(nt_stuck_judge(&limits, &stuck, 9.0, position, 1), NT_RUN); /* at the end of its range */
        assert_true(stuck.run == 0u && stuck.position[axis] == position[axis]);
        const nt_stuck_limits untold = {0.0, 1.0};
        stuck.run = 100u;
        assert_int_equal(nt_stuck_judge(&untold, &stuck, 9.0, position, 0), NT_RUN);
    }
}

/* Armed again it begins anew; what it has learnt of its sensors and of the way stays. */
static void armed_again(void **unused)
{
    (void)unused;
    nt_supervisor_state state = nt_supervisor_start();
    state.state = NT_LATCHED;
    state.reasons = NT_REASON_STUCK;
    state.deflection = (nt_stuck){.run = 9u, .band = 2.0, .position = {1.0, 2.0, 3.0}};
    state.amplitude = (nt_stuck){.run = 9u, .band = 3.0};
    state.surface = 4.0;
    state.indentation = 5.0;
    state.late_ticks = 6u;
    state.expected = 7.0;
    state.off_run = state.invalid_run = state.late_run = 8u;
    assert_int_equal(nt_supervisor_arm(&state, 0), NT_E_STATE);
    assert_int_equal(nt_supervisor_arm(&state, 1), NT_OK);
    assert_true(state.state == NT_RUN && state.reasons == 0u && state.deflection.run == 0u &&
                state.amplitude.run == 0u);
    assert_true(state.deflection.band == 2.0 && state.amplitude.band == 3.0 && state.deflection.position[NT_Z] == 0.0);
    assert_true(state.deflection.position[NT_X] == 1.0 && state.surface == 4.0 && state.indentation == 5.0);
    assert_true(state.late_ticks == 6u && state.expected == 7.0);
    assert_true(state.off_run == 0u && state.invalid_run == 0u && state.late_run == 0u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lift_begins_where_the_stop_does),
        cmocka_unit_test(a_force_that_grows_in_a_lift),
        cmocka_unit_test(a_lift_that_waits_tries_once),
        cmocka_unit_test(a_stage_that_falls_on),
        cmocka_unit_test(how_far_a_stop_lifts),
        cmocka_unit_test(the_noise_that_is_learnt),
        cmocka_unit_test(a_stuck_sensor_is_stepped_away_from),
        cmocka_unit_test(armed_again),
        cmocka_unit_test(the_first_block),
        cmocka_unit_test(a_dead_sensor_by_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
