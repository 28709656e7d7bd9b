/* SPDX-License-Identifier: BSD-3-Clause
 * The defaults of a rig, and what a touch needs in each period, by their formulas on random rigs. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control_draws.h"
#include "internal/control.h"
#include "larger.h"
#include "nanotouch/control.h"
#include "nanotouch/touch.h"

#define PI 3.14159265358979323846
#define EXACT 1e-11
enum { DRAWS = 100 };

static void defaults_of_a_rig(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(6);
    for (int i = 0; i < DRAWS; ++i) {
        nt_rig rig = drawn_rig(&random);
        rig.master.gauge = i % 2;
        rig.stage.command_resolution *= i % 4 ? 1.0 : 30.0; /* so that its steps decide */
        rig.stage.resolution *= i % 5 ? 1.0 : 100.0;
        rig.probe.spring_constant *= i % 3 ? 1.0 : 0.01; /* so soft that a tenth of its range is below 0.1 uN */
        const double range = rig.probe.range * rig.probe.sensitivity, most = rig.probe.spring_constant * range;
        const double e = rig.stage.command_resolution, coarser = larger(e, rig.stage.resolution);
        const double steps = smaller(10.0, rig.stage.quality / PI) * e + 2.0 * coarser;
        const double lost = 2.0 * rig.stage.hysteresis, after = lost / (1.0 - lost) * 20e-6 / 60.0;
        const nt_settings s = nt_settings_defaults(&rig);
        assert_true(alike(s.gains.alpha_p, 0.4e-6 / rig.master.travel, EXACT));
        assert_true(alike(s.gains.alpha_f, 2.0 * rig.master.gauge_range / (most + 0.6e-6), EXACT));
        assert_true(alike(s.gains.set_point, smaller(0.1e-6, 0.1 * most), EXACT));
        assert_true(alike(s.limits.force, 0.85 * most, EXACT) && alike(s.limits.lateral_force, 0.85 * most, EXACT));
        assert_true(alike(s.limits.follow_error, larger(0.1e-6, steps) + after, EXACT));
        assert_true(alike(s.limits.deflection_bias, 0.1 * range, EXACT));
        assert_true(alike(s.limits.deflection_drift, 0.3 * range, EXACT));
        assert_true(alike(s.limits.gauge_bias, 0.1 * rig.master.gauge_range, EXACT));
        assert_true(alike(s.limits.gauge_drift, 0.3 * rig.master.gauge_range, EXACT));
        assert_true(s.limits.motor_force == rig.master.max_force);
        assert_int_equal(s.control.choice, rig.master.gauge ? NT_CONTROL_DEFAULT : NT_CONTROL_IMPEDANCE);
        nt_tap tap = s.tap;
        tap.lock_in = 3e-3;
        assert_true(alike(nt_tap_lag(&rig, &tap), 3e-3 + rig.probe.quality / (PI * rig.probe.resonance), EXACT));
    }
}

/* As docs/control.md lists them. */
static void defaults_that_no_rig_changes(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_gains g = nt_settings_defaults(&rig).gains;
    const nt_limits l = nt_settings_defaults(&rig).limits;
    assert_true(g.rate == 10e3 && g.alpha_f_approach == 1.0 && g.alpha_f_retract == 1.0 && g.force_gain == 2.0);
    assert_true(g.force_filter == 200.0 && g.velocity_feedforward == 0.0 && g.stage_damping == 0.7);
    assert_true(g.stage_integral == 60.0 && g.stage_proportional == 0.5 && g.ramp_time == 0.1);
    assert_true(g.height_gain == 300.0 && g.height_stiffness == 3000.0 && g.approach_speed == 1e-6);
    assert_true(g.curve_length == 0.5e-6 && g.delay == 1.0);
    assert_true(l.indentation == 0.3e-6 && l.stage_speed == 20e-6 && l.lateral_speed == 20e-6 &&
                l.motor_rate == 2000.0);
    assert_true(l.motor_power == 2.0 && l.retract_distance == 0.5e-6 && l.retract_speed == 10e-6);
    assert_true(l.follow_time == 0.05);
    nt_settings settings = nt_settings_defaults(&rig);
    settings.control.choice = (nt_control_choice)(NT_CONTROL_OWN + 1);
    assert_int_equal(nt_settings_check(&settings, NULL), NT_E_ARGUMENT);
    settings.control.choice = NT_CONTROL_OWN;
    assert_int_equal(nt_settings_check(&settings, NULL), NT_E_ARGUMENT);
    settings.control.law = nt_servo_default;
    assert_int_equal(nt_settings_check(&settings, NULL), NT_OK);
    assert_non_null(nt_settings_fields(NULL));
}

static void what_a_touch_needs_in_each_period(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(7);
    for (int i = 0; i < DRAWS; ++i) {
        nt_rig rig = drawn_rig(&random);
        nt_settings settings = drawn_settings(&random, &rig);
        settings.gains.delay = i % 2 ? 300.0 : 2.6;
        settings.limits.force = 1e-8;
        settings.gains.set_point = 1e-8; /* of the limit: allowed */
        settings.limits.motor_force = rig.master.max_force;
        rig.converters = (nt_converters){.adc_bits = 0.0};
        rig.stage.max_speed = settings.limits.stage_speed = settings.limits.retract_speed;
        rig.master.gauge = i % 3 != 0;
        settings.control.choice = rig.master.gauge ? NT_CONTROL_DEFAULT : NT_CONTROL_IMPEDANCE;
        settings.gains.velocity_feedforward = between(&random, 0.1, 0.7);
        nt_touch touch;
        assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
        const double T = 1.0 / settings.gains.rate, corner = settings.gains.force_filter;
        assert_true(alike(touch.period, T, EXACT) && touch.delay == (i % 2 ? NT_TOUCH_SENT - 1u : 3u));
        assert_true(alike(touch.force_filter, 1.0 - exp(-2.0 * PI * corner * T), EXACT));
        assert_true(alike(touch.speed_filter, 1.0 - exp(-2.0 * PI * 20.0 * T), EXACT));
        assert_true(alike(touch.stage_step, settings.limits.stage_speed * T, EXACT));
        assert_true(alike(touch.stage_end, 0.5 * rig.stage.travel, EXACT));
        assert_true(alike(touch.motor_step, settings.limits.motor_rate * T, EXACT));
        const double volts = sqrt(pow(rig.probe.noise / 6.0, 2.0) + pow(rig.probe.resolution, 2.0));
        const double motion = 4.0 * (settings.limits.stage_speed + settings.limits.lateral_speed) * T;
        assert_true(alike(touch.spike, 12.0 * rig.probe.sensitivity * volts + motion, EXACT));
        assert_true(touch.passivity.damping == rig.master.damping);
        assert_true(touch.passivity.credit == (rig.master.gauge ? 0.0 : rig.master.damping));
        const double share = 0.2 * (1.0 - settings.gains.velocity_feedforward);
        assert_true(alike(touch.passivity.due, share * rig.master.damping * T, EXACT));
        assert_true(touch.passivity_sideways.force_gain == 0.0);
        assert_true(touch.passivity_sideways.credit == rig.master.damping);
        const double step = larger(larger(rig.master.resolution, 1e-3 * rig.master.travel),
                                   rig.stage.resolution / settings.gains.alpha_p);
        const double most = smaller(rig.master.gauge_range, settings.gains.alpha_f * settings.limits.lateral_force);
        assert_true(alike(touch.passivity_sideways.dead_zone, most * step, EXACT));
        assert_true(touch.drive_amplitude == 0.0 && touch.supervisor.amplitude.most == 0.0);
        assert_true(isinf(touch.borders[0][0]) && touch.borders[0][0] < 0.0 && isinf(touch.borders[1][1]));
    }
}

static nt_status refusal(const nt_rig *rig, const nt_settings *settings, nt_mode mode, nt_problem *problem)
{
    nt_touch touch;
    return nt_touch_make(&touch, rig, settings, mode, problem);
}

/* Samples are at most two periods old: repeated at most three times, with a latency twice where that is a period at
 * most, or once; at the border it is made, just above it is refused with it. */
static void the_rate_at_which_samples_get_stale(void **state)
{
    (void)state;
    const struct {
        double each, latency, rate;
    } cases[] = {{0.0, 1e-4, 2e4}, {4e3, 0.0, 12e3}, {4e3, 1e-5, 8e3}, {4e3, 2e-4, 5e3}, {4e3, 2.4e-4, 1.0 / 2.4e-4},
                 {4e3, 3e-4, 4e3}, {4e3, 1e-3, 2e3}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        nt_rig rig = nt_rig_defaults();
        rig.converters.adc_rate = cases[i].each;
        rig.converters.adc_latency = cases[i].latency;
        nt_settings settings = nt_settings_defaults(&rig);
        nt_problem problem;
        settings.gains.rate = cases[i].rate * (1.0 - 1e-12);
        assert_int_equal(refusal(&rig, &settings, NT_MODE_TOUCH, &problem), NT_OK);
        settings.gains.rate = cases[i].rate * (1.0 + 1e-12);
        assert_int_equal(refusal(&rig, &settings, NT_MODE_TOUCH, &problem), NT_E_RANGE);
        assert_string_equal(problem.field, "gains.rate");
        assert_true(alike(problem.maximum, cases[i].rate, EXACT) && problem.minimum == 0.0);
    }
}

static void what_the_rig_cannot_keep_by_number(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings usual = nt_settings_defaults(&rig);
    const double saturation = rig.probe.spring_constant * rig.probe.range * rig.probe.sensitivity;
    const struct {
        size_t field;
        double most;
    } cases[] = {{offsetof(nt_settings, limits.force), saturation},
                 {offsetof(nt_settings, gains.set_point), usual.limits.force},
                 {offsetof(nt_settings, limits.stage_speed), rig.stage.max_speed},
                 {offsetof(nt_settings, limits.retract_speed), rig.stage.max_speed},
                 {offsetof(nt_settings, limits.motor_force), rig.master.max_force}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        nt_settings settings = usual;
        double *field = (double *)((char *)&settings + cases[i].field);
        nt_problem problem;
        *field = cases[i].most;
        assert_int_equal(refusal(&rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
        *field = nextafter(cases[i].most, 1.0 + 2.0 * cases[i].most);
        assert_int_equal(refusal(&rig, &settings, NT_MODE_TOUCH, &problem), NT_E_RANGE);
        assert_true(problem.value == *field && alike(problem.maximum, cases[i].most, EXACT));
        assert_int_equal(refusal(&rig, &settings, NT_MODE_TOUCH, NULL), NT_E_RANGE);
    }
}

/* A projection needs a master of one axis and a lever that shows x and y; K_f a gauge, but not by impedance. */
static void what_needs_what(void **state)
{
    (void)state;
    for (int i = 0; i < 16; ++i) {
        nt_rig rig = nt_rig_defaults();
        rig.master.axes = i & 1 ? 3.0 : 1.0;
        rig.probe.lateral_stiffness = i & 2 ? 100.0 : 0.0;
        nt_settings settings = nt_settings_defaults(&rig);
        settings.gains.projection_x = i & 4 ? 0.5 : 0.0;
        settings.gains.projection_y = i & 8 ? -0.5 : 0.0;
        nt_problem problem;
        const nt_status status = refusal(&rig, &settings, NT_MODE_TOUCH, &problem);
        const int needs = i & 12, has = !(i & 1) && i & 2;
        assert_int_equal(status, needs && !has ? NT_E_RANGE : NT_OK);
        if (status != NT_OK)
            assert_true(problem.value == (i & 4 && i & 8 ? 1.0 : 0.5));
    }
    for (int i = 0; i < 8; ++i) {
        nt_rig rig = nt_rig_defaults();
        rig.master.gauge = i & 1;
        nt_settings settings = nt_settings_defaults(&rig);
        settings.gains.force_gain = i & 2 ? 0.5 : 0.0;
        settings.control.choice = i & 4 ? NT_CONTROL_IMPEDANCE : NT_CONTROL_PAPER;
        assert_int_equal(refusal(&rig, &settings, NT_MODE_TOUCH, NULL), i == 2 ? NT_E_RANGE : NT_OK);
    }
}

/* A held phase is told within a tenth of the resonance's width, f0/Q/2 to either side. */
static void a_lever_that_taps(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    const double f0 = rig.probe.resonance, width = 0.05 * f0 / rig.probe.quality;
    const double off[] = {-1.0 - 1e-9, -1.0 + 1e-9, 1.0 - 1e-9, 1.0 + 1e-9};
    for (int i = 0; i < 4; ++i) {
        const int inside = i == 1 || i == 2;
        nt_problem problem;
        settings.tap.frequency = f0 + off[i] * width;
        settings.tap.hold = 1;
        assert_int_equal(refusal(&rig, &settings, NT_MODE_TAPPING, &problem), inside ? NT_OK : NT_E_RANGE);
        if (!inside)
            assert_true(alike(problem.minimum, f0 - width, EXACT) && alike(problem.maximum, f0 + width, EXACT));
        assert_int_equal(refusal(&rig, &settings, NT_MODE_TOUCH, &problem), NT_OK);
        settings.tap.hold = 0;
        assert_int_equal(refusal(&rig, &settings, NT_MODE_TAPPING, &problem), NT_OK);
    }
    nt_rig other = rig;
    double wide; /* of a quality whose border is a number without rounding */
    do {
        other.probe.quality *= 1.001;
        wide = 0.05 * f0 / other.probe.quality;
    } while ((f0 + wide) - f0 != wide);
    settings.tap.hold = 1;
    settings.tap.frequency = f0 + wide;
    assert_int_equal(refusal(&other, &settings, NT_MODE_TAPPING, NULL), NT_OK);
    settings.tap.hold = 0;
    settings.tap.free_amplitude = 3e-9;
    settings.tap.frequency = f0 + width;
    nt_touch touch;
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TAPPING, NULL), NT_OK);
    assert_true(touch.drive_amplitude == 3e-9 && touch.drive_frequency == settings.tap.frequency);
    assert_true(touch.supervisor.amplitude.most == 1.5 * 3e-9);
    settings.tap.hold = 1;
    settings.tap.frequency = 0.0;
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TAPPING, NULL), NT_OK);
    assert_true(touch.drive_frequency == f0);
    assert_int_equal(refusal(&rig, &settings, (nt_mode)(NT_MODE_TAPPING + 1), NULL), NT_E_ARGUMENT);
    nt_touch_state begun = nt_touch_start(&touch, 0.25, 1.0, 2.0);
    assert_true(begun.passivity.gain == 1.0 && begun.passivity_sideways[0].gain == 1.0);
    assert_true(begun.passivity_sideways[1].gain == 1.0 && begun.signals.gain_factor == 1.0);
    assert_true(begun.passivity.last_hand.position == 0.25 && begun.offset == -0.25 * settings.gains.alpha_p);
    assert_true(isnan(begun.hand_at[0]) && isnan(begun.stage_at[1]) && begun.command.stage_position[NT_Y] == 2.0);
    nt_command command;
    nt_sample sample = {.amplitude = 3e-9, .lag = 1.5, .stage_position = {1.0, 2.0, 0.0}};
    nt_touch_step(&touch, &begun, &sample, &command);
    assert_true(command.drive_amplitude == 3e-9 && command.drive_frequency == f0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_of_a_rig),
        cmocka_unit_test(defaults_that_no_rig_changes),
        cmocka_unit_test(what_a_touch_needs_in_each_period),
        cmocka_unit_test(the_rate_at_which_samples_get_stale),
        cmocka_unit_test(what_the_rig_cannot_keep_by_number),
        cmocka_unit_test(what_needs_what),
        cmocka_unit_test(a_lever_that_taps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
