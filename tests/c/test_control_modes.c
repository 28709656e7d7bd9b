/* SPDX-License-Identifier: BSD-3-Clause
 * Modes, clutch, virtual coupling and laws of one's own on a plant without noise. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "larger.h"
#include "touch_fixture.h"

static nt_settings settings_of(const nt_rig *rig)
{
    nt_settings settings = nt_settings_defaults(rig);
    settings.limits.stage_speed = 50e-6;
    return settings;
}

/* From 20 nm to 4 um above, on soft and hard, slow and fast: the surface is found, the force never passes the set-point
 * by more than the approach goes in the two periods and the stage's lag, and the set-point is held. */
static void an_approach_finds_the_surface_from_any_height(void **state)
{
    (void)state;
    const nt_rig rig = quiet_rig();
    for (double height = 20e-9; height < 4.5e-6; height *= 3.7)
        for (double stiffness = 0.1; stiffness < 1e5; stiffness *= 10.0)
            for (double speed = 0.1e-6; speed < 30e-6; speed *= 6.0) {
                nt_settings settings = settings_of(&rig);
                settings.gains.approach_speed = speed;
                settings.limits.indentation = 5e-6;
                if (height / speed > 4.0)
                    continue; /* takes its time */
                bench b;
                assert_int_equal(bench_open(&b, &rig, &settings, NT_MODE_APPROACH), NT_OK);
                b.surface = height;
                b.stiffness = stiffness;
                const double k_c = rig.probe.spring_constant, k_eff = k_c * stiffness / (k_c + stiffness);
                const double depth = settings.gains.set_point / k_eff;
                if (height + depth > 0.5 * rig.stage.travel)
                    continue; /* out of reach */
                bench_run(&b, 0.0, 1.3 * (height + depth) / speed + 30.0 / settings.gains.height_gain * k_c / k_eff);
                assert_int_equal(b.state.phase, NT_PHASE_DONE);
                assert_int_equal(b.command.state, NT_RUN);
                const double overshoot = speed * (2e-4 + 1.5e-3) * k_eff;
                assert_true(b.largest_force < settings.gains.set_point * (1.0 + 1e-6) + overshoot);
                assert_true(fabs(bench_force(&b) - settings.gains.set_point) < 1e-3 * settings.gains.set_point);
                assert_true(b.fastest_motor == 0.0); /* the operator's hand is left alone */
            }
}

static void an_approach_without_a_surface_stops_at_the_end_of_travel(void **state)
{
    (void)state;
    const nt_rig rig = quiet_rig();
    nt_settings settings = settings_of(&rig);
    settings.gains.approach_speed = 20e-6;
    bench b;
    assert_int_equal(bench_open(&b, &rig, &settings, NT_MODE_APPROACH), NT_OK);
    b.surface = 1.0;
    bench_run(&b, 0.0, rig.stage.travel / 20e-6);
    assert_int_equal(b.state.phase, NT_PHASE_DOWN);
    assert_true(b.command.reasons & NT_REASON_COMMAND_LIMITED);
    assert_true(fabs(b.command.stage_position[NT_Z] - 0.5 * rig.stage.travel) < 1e-12);
}

/* Found, then touched: the switch moves nothing, and the hand takes over where the stage stands. */
static void an_approach_goes_over_into_touch(void **state)
{
    (void)state;
    const nt_rig rig = quiet_rig();
    const nt_settings settings = settings_of(&rig);
    bench b;
    assert_int_equal(bench_open(&b, &rig, &settings, NT_MODE_APPROACH), NT_OK);
    bench_run(&b, 0.0, 1.0);
    assert_int_equal(b.state.phase, NT_PHASE_DONE);
    b.fastest_stage = 0.0;
    assert_int_equal(nt_touch_set_mode(&b.state, NT_MODE_TOUCH), NT_OK);
    const double push = settings.gains.alpha_f * settings.gains.set_point;
    bench_run(&b, push, 0.05);
    assert_int_equal(b.state.mode, NT_MODE_TOUCH);
    bench_run(&b, push, 4.0);
    assert_true(b.fastest_stage < settings.limits.stage_speed * b.touch.period);
    assert_true(fabs(settings.gains.alpha_f * bench_force(&b) - push) < 1e-6 * push);
    assert_int_equal(nt_touch_set_mode(&b.state, (nt_mode)9), NT_E_ARGUMENT);
}

/* Down to the set-point, up by the length, at the speed; the spring is a straight line in it. */
static void a_curve_goes_down_and_up_once(void **state)
{
    (void)state;
    const nt_rig rig = quiet_rig();
    const nt_settings settings = settings_of(&rig);
    bench b;
    assert_int_equal(bench_open(&b, &rig, &settings, NT_MODE_CURVE), NT_OK);
    double deepest = 0.0, last = 0.0;
    int turns = 0, direction = 1;
    for (int i = 0; i < 20000; i++) {
        bench_tick(&b);
        const double step = b.state.reference - last;
        last = b.state.reference;
        deepest = larger(deepest, b.state.reference);
        if (step * direction < 0.0)
            direction = -direction, turns++;
        assert_true(fabs(step) <= settings.gains.approach_speed * b.touch.period * (1.0 + 1e-9));
    }
    assert_int_equal(turns, 1);
    assert_int_equal(b.state.phase, NT_PHASE_DONE);
    const double k_eff = 8.0 * 40.0 / 48.0;
    assert_true(fabs(deepest - b.surface - settings.gains.set_point / k_eff) < 3e-9); /* seen, and the stage's lag */
    assert_true(fabs(deepest - b.state.reference - settings.gains.curve_length) < 1e-12);
    assert_true(b.largest_force < settings.gains.set_point + 3e-9 * k_eff);
    assert_int_equal(nt_touch_set_mode(&b.state, NT_MODE_CURVE), NT_OK); /* once more */
    bench_run(&b, 0.0, 2.0);
    assert_int_equal(b.state.phase, NT_PHASE_DONE);
    assert_true(fabs(b.state.turn - deepest) < 1e-9);
}

/* Clutch: pressed, let go, the master moves elsewhere, coupled again: the stage has not noticed. */
static void a_clutch_indexes_the_master_anew(void **state)
{
    (void)state;
    const nt_rig rig = quiet_rig();
    const nt_settings settings = settings_of(&rig);
    bench b;
    assert_int_equal(bench_open(&b, &rig, &settings, NT_MODE_TOUCH), NT_OK);
    bench_run(&b, 1.0, 4.0);
    const double stage = b.command.stage_position[NT_Z], x = b.x;
    nt_touch_clutch(&b.state, 1);
    b.fastest_motor = 0;
    bench_run(&b, -0.5, 0.5);
    assert_true(b.x < x - 1e-3);
    assert_true(fabs(b.command.stage_position[NT_Z] - stage) < 1e-13 && b.command.motor_force[NT_Z] == 0.0);
    assert_true(b.fastest_motor < 0.3 && b.command.state == NT_RUN);
    nt_touch_clutch(&b.state, 0);
    bench_run(&b, 1.0, 0.001);
    assert_true(fabs(b.command.stage_position[NT_Z] - stage) < 1e-9);
    bench_run(&b, 1.0, 4.0);
    assert_true(fabs(settings.gains.alpha_f * bench_force(&b) - 1.0) < 1e-6);
    assert_int_equal(b.state.passivity.trips, 0);
}

/* Ripple of the tip's force at rest, peak to peak, pressed with 1 N [N at the hand]. */
static double ripple(bench *b)
{
    bench_run(b, 1.0, 3.0);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; i < 2000; i++) {
        bench_tick(b);
        low = smaller(low, bench_force(b));
        high = larger(high, bench_force(b));
    }
    return (high - low) * b->touch.settings.gains.alpha_f;
}

/* A contact that is far too stiff for this K_f, alone and behind a coupling that is soft enough by R1. The observer's
 * hands are tied. */
static void a_coupling_calms_a_contact_that_is_too_stiff(void **state)
{
    (void)state;
    const nt_rig rig = quiet_rig();
    nt_settings settings = settings_of(&rig);
    settings.gains.force_gain = 100.0;
    settings.gains.alpha_f *= 10.0;
    settings.limits.stage_speed = rig.stage.max_speed;
    for (int coupled = 0; coupled < 2; coupled++) {
        settings.gains.coupling_stiffness = coupled ? 500.0 : 0.0;
        settings.gains.coupling_damping = coupled ? 20.0 : 0.0;
        bench b;
        assert_int_equal(bench_open(&b, &rig, &settings, NT_MODE_TOUCH), NT_OK);
        b.touch.passivity.due = 0.0;
        b.touch.passivity.dead_zone = 1e9;
        b.stiffness = 1e4;
        const double found = ripple(&b);
        print_message("%s: ripple %.3g N\n", coupled ? "behind a coupling" : "alone", found);
        assert_true(coupled ? found < 1e-6 : found > 0.1);
        if (!coupled)
            continue;
        assert_true(fabs(settings.gains.alpha_f * bench_force(&b) - 1.0) < 1e-6); /* the force is true all the same */
        const double from = b.x, stage = b.command.stage_position[NT_Z];
        bench_run(&b, 1.5, 3.0); /* 0.5 N more: softer than the coupling alone */
        assert_true(b.x - from > 0.5 / 500.0 && b.command.stage_position[NT_Z] > stage);
    }
}

static nt_effort half_force(void *context, const nt_gains *gains, const nt_signals *signals)
{
    ++*(int *)context;
    (void)gains;
    return (nt_effort){-0.5 * signals->scaling.alpha_f * signals->slave_force, signals->target};
}

static nt_effort nonsense(void *context, const nt_gains *gains, const nt_signals *signals)
{
    (void)gains;
    (void)signals;
    const int calls = ++*(int *)context;
    return (nt_effort){calls > 3 ? (double)NAN : 1e9, calls > 3 ? 0.0 : 1e9};
}

static void a_law_of_ones_own_stands_under_the_same_limits(void **state)
{
    (void)state;
    const nt_rig rig = quiet_rig();
    nt_settings settings = settings_of(&rig);
    bench b;
    int calls = 0;
    settings.control = (nt_control){NT_CONTROL_OWN, half_force, &calls};
    assert_int_equal(bench_open(&b, &rig, &settings, NT_MODE_TOUCH), NT_OK);
    bench_run(&b, 1.0, 12.0);
    assert_true(calls == 120000 || calls == 120001);
    assert_true(fabs(0.5 * settings.gains.alpha_f * bench_force(&b) - 1.0) < 1e-6);
    calls = 0;
    settings.control.law = nonsense;
    assert_int_equal(bench_open(&b, &rig, &settings, NT_MODE_TOUCH), NT_OK);
    static const nt_state expected[] = {NT_RUN, NT_RUN, NT_RUN, NT_HOLD, NT_RETRACT};
    for (int i = 0; i < 5; i++) {
        bench_tick(&b);
        assert_int_equal(b.command.state, expected[i]);
        assert_true(isfinite(b.command.motor_force[NT_Z]) && isfinite(b.command.stage_position[NT_Z]));
    }
    assert_true(b.command.reasons & NT_REASON_LAW);
    assert_true(b.fastest_motor <= settings.limits.motor_rate * b.touch.period * (1.0 + 1e-12));
    assert_true(b.fastest_stage <= 1.1 * settings.limits.stage_speed * b.touch.period);
    settings.control.law = NULL;
    assert_int_equal(bench_open(&b, &rig, &settings, NT_MODE_TOUCH), NT_E_ARGUMENT);
}

/* Without a gauge: the force that the hand feels is alpha_f f_s, f_m is never read, other laws are refused. */
static void a_master_without_a_gauge_is_felt_by_impedance(void **state)
{
    (void)state;
    nt_rig rig = quiet_rig();
    rig.master.gauge = 0;
    nt_settings settings = settings_of(&rig);
    assert_int_equal(settings.control.choice, NT_CONTROL_IMPEDANCE);
    bench b;
    assert_int_equal(bench_open(&b, &rig, &settings, NT_MODE_TOUCH), NT_OK);
    for (int i = 0; i < 80000; i++) {
        b.push = 1.0;
        bench_tick(&b);
        b.sample.operator_force[NT_Z] = NAN;
        assert_int_equal(b.command.state, NT_RUN);
    }
    assert_true(fabs(settings.gains.alpha_f * bench_force(&b) - 1.0) < 1e-6);
    assert_int_equal(b.state.passivity.trips, 0);
    settings.control.choice = NT_CONTROL_DEFAULT;
    nt_problem problem = {0};
    assert_int_equal(nt_touch_make(&b.touch, &rig, &settings, NT_MODE_TOUCH, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "gains.force_gain");
}

/* One reading that cannot be is not felt; a true jump is, one period later. */
static void a_spike_does_not_reach_the_hand(void **state)
{
    (void)state;
    const nt_rig rig = quiet_rig();
    const nt_settings settings = settings_of(&rig);
    bench b;
    assert_int_equal(bench_open(&b, &rig, &settings, NT_MODE_TOUCH), NT_OK);
    bench_run(&b, 1.0, 4.0);
    const double before = b.command.motor_force[NT_Z], normal = b.sample.deflection[NT_Z];
    nt_sample sample = b.sample;
    for (int i = 0; i < 20; i++) {
        sample.deflection[NT_Z] = i == 5 ? 100e-9 : i < 10 ? normal : normal + 50e-9;
        nt_touch_step(&b.touch, &b.state, &sample, &b.command);
        if (i <= 10)
            assert_true(fabs(b.command.motor_force[NT_Z] - before) < 1e-3);
    }
    assert_true(b.command.motor_force[NT_Z] < before - 1.0);
}

/* Ticks of a hand that holds still, over a stage that is there at once. */
static void hold_still(bench *b, int ticks)
{
    for (int i = 0; i < ticks; i++) {
        for (int axis = NT_X; axis <= NT_Z; axis++)
            b->sample.stage_position[axis] = b->command.stage_position[axis];
        b->sample.deflection[NT_Z] = 1e-12 * sin(1.7 * i);
        nt_touch_step(&b->touch, &b->state, &b->sample, &b->command);
    }
}

/* A hand of three axes goes farther than the limit lets the tip follow. What is left of that way is gone with a stop,
 * or a clutch: the tip goes nowhere that the hand does not go then. */
static void a_way_that_a_stop_cuts_short_does_not_go_on(void **state)
{
    (void)state;
    nt_rig rig = quiet_rig();
    rig.master.axes = 3.0;
    const nt_settings settings = settings_of(&rig);
    for (int clutch = 0; clutch <= 1; clutch++) {
        bench b;
        assert_int_equal(bench_open(&b, &rig, &settings, NT_MODE_TOUCH), NT_OK);
        b.sample.stage_position[NT_X] = b.sample.stage_position[NT_Y] = 0.0;
        hold_still(&b, 2000);
        b.sample.master_position[NT_X] += 5e-3;
        hold_still(&b, 10);
        const double x = b.command.stage_position[NT_X];
        assert_true(x > 0.0 && x < 0.5 * settings.gains.alpha_p * 5e-3);
        if (clutch)
            nt_touch_clutch(&b.state, 1);
        else
            b.sample.flags = NT_SAMPLE_EMERGENCY_STOP;
        hold_still(&b, 1000);
        b.sample.flags = 0;
        nt_touch_clutch(&b.state, 0);
        assert_int_equal(nt_touch_arm(&b.state, 1), NT_OK);
        hold_still(&b, 2000);
        assert_int_equal(b.command.state, NT_RUN);
        assert_true(b.command.stage_position[NT_X] == x);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_approach_finds_the_surface_from_any_height),
        cmocka_unit_test(an_approach_without_a_surface_stops_at_the_end_of_travel),
        cmocka_unit_test(an_approach_goes_over_into_touch),
        cmocka_unit_test(a_curve_goes_down_and_up_once),
        cmocka_unit_test(a_clutch_indexes_the_master_anew),
        cmocka_unit_test(a_coupling_calms_a_contact_that_is_too_stiff),
        cmocka_unit_test(a_law_of_ones_own_stands_under_the_same_limits),
        cmocka_unit_test(a_master_without_a_gauge_is_felt_by_impedance),
        cmocka_unit_test(a_spike_does_not_reach_the_hand),
        cmocka_unit_test(a_way_that_a_stop_cuts_short_does_not_go_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
