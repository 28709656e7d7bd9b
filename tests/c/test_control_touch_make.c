/* SPDX-License-Identifier: BSD-3-Clause
 * The defaults of a rig, and what a touch needs in each period, by their formulas on random rigs. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control_draws.h"
#include "larger.h"
#include "nanotouch/scaling.h"
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_of_a_rig),
        cmocka_unit_test(defaults_that_no_rig_changes),
        cmocka_unit_test(what_a_touch_needs_in_each_period),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
