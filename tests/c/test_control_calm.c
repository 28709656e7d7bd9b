/* SPDX-License-Identifier: BSD-3-Clause
 * What is felt of a loop that is stable, where it has a closed form; against the simulated rig: tests/python/test_calm.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/rig.h"
#include "larger.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

#define PI 3.14159265358979323846

/* A loop of so little gain that nothing comes back: no steps, no noise. */
static nt_rig quiet(nt_settings *settings)
{
    nt_rig rig = nt_rig_defaults();
    *settings = nt_settings_defaults(&rig);
    settings->gains.alpha_p = 1e-9;
    rig.master.resolution = rig.stage.resolution = rig.stage.command_resolution = rig.stage.noise = 0.0;
    rig.probe.noise = rig.probe.resolution = rig.master.gauge_noise = rig.master.gauge_resolution = 0.0;
    return rig;
}

/* White noise behind y += c (u - y) keeps c/(2 - c) of its variance, c = (1 + K_f) times that of the low-pass of f_m.
 */
static void noise_of_the_probe_is_that_behind_the_low_pass(void **state)
{
    (void)state;
    for (double K_f = 0.0; K_f < 10.0; K_f += 3.0) {
        nt_settings settings;
        nt_rig rig = quiet(&settings);
        rig.probe.noise = 0.05;
        settings.gains.force_gain = K_f;
        const double low_pass = 1.0 - exp(-2.0 * PI * settings.gains.force_filter / settings.gains.rate);
        const double c = smaller(1.0, (1.0 + K_f) * low_pass);
        const double expected = 6.0 * settings.gains.alpha_f * nt_probe_force_noise(&rig.probe) * sqrt(c / (2.0 - c));
        const nt_calm found = nt_margins_calm(&rig, &settings, 600.0);
        assert_true(fabs(found.ripple / expected - 1.0) < 1e-3);
        assert_true(found.parts[NT_RIPPLE_PROBE] == found.ripple && found.parts[NT_RIPPLE_MASTER] == 0.0);
    }
}

/* At least a whole step: alpha_f k_eff alpha_p delta. */
static void a_step_of_the_master_is_whole(void **state)
{
    (void)state;
    nt_settings settings;
    nt_rig rig = quiet(&settings);
    rig.master.resolution = 1e-3;
    const double k_eff = 8.0 / (1.0 + 8.0 / 100.0);
    const nt_calm found = nt_margins_calm(&rig, &settings, 100.0);
    const double step = settings.gains.alpha_f * k_eff * settings.gains.alpha_p * 1e-3;
    assert_true(found.ripple >= step * (1.0 - 1e-12) && found.ripple < 1.5 * step);
}

/* Steps of the command that keep time with the stage's bare resonance: Q of them, behind the low-pass. A master that
 * throws the command over several of its steps at once breaks the time, but where the resonance comes back to them. */
static void steps_of_the_command_may_keep_time_with_the_resonance(void **state)
{
    (void)state;
    for (double Q = 5.0; Q < 1e3; Q *= 4.0) {
        nt_settings settings;
        nt_rig rig = quiet(&settings);
        rig.stage.command_resolution = 1e-9;
        rig.stage.quality = Q;
        settings.gains.stage_integral = 0.0;
        const double T = 1.0 / settings.gains.rate, K_f = settings.gains.force_gain, turn = 2.0 * PI * 450.0 * T;
        const double c = smaller(1.0, (1.0 + K_f) * (1.0 - exp(-2.0 * PI * settings.gains.force_filter * T)));
        const double low_pass = c / sqrt(1.0 - 2.0 * (1.0 - c) * cos(turn) + (1.0 - c) * (1.0 - c));
        const double k_eff = 8.0 / (1.0 + 8.0 / 600.0);
        const double expected = Q * settings.gains.alpha_f * k_eff * 1e-9 * low_pass;
        const nt_calm found = nt_margins_calm(&rig, &settings, 600.0);
        assert_true(fabs(found.ripple / expected - 1.0) < 0.03);
        rig.master.resolution = 3.99e-9 / settings.gains.alpha_p;
        assert_true(nt_margins_calm(&rig, &settings, 600.0).parts[NT_RIPPLE_STAGE_COMMAND] == found.ripple);
        rig.master.resolution = 4.01e-9 / settings.gains.alpha_p;
        assert_true(nt_margins_calm(&rig, &settings, 600.0).parts[NT_RIPPLE_STAGE_COMMAND] < found.ripple);
        settings.gains.stage_integral = 300.0;
        const nt_calm back = nt_margins_calm(&rig, &settings, 600.0);
        assert_true(back.parts[NT_RIPPLE_STAGE_COMMAND] > 0.8 * found.ripple);
    }
}

/* kappa x = -m x'' - b x': the peak is 1/(2 zeta sqrt(1 - zeta^2)), where delays and the stage are fast. */
static void a_heavy_master_rings(void **state)
{
    (void)state;
    for (double zeta = 0.05; zeta < 0.6; zeta *= 2.0) {
        nt_settings settings;
        nt_rig rig = quiet(&settings);
        rig.stage.resonance = 1e5;
        rig.stage.quality = 0.5;
        settings.gains.rate = 1e6;
        settings.gains.delay = settings.gains.stage_integral = 0.0;
        settings.gains.alpha_p = 1e-5;
        rig.master.mass = 1.0;
        const double kappa = (1.0 + settings.gains.force_gain) * settings.gains.alpha_f * 1e-5 * 8.0;
        rig.master.damping = 2.0 * zeta * sqrt(kappa);
        const nt_calm found = nt_margins_calm(&rig, &settings, (double)INFINITY);
        assert_true(fabs(found.ringing * 2.0 * zeta * sqrt(1.0 - zeta * zeta) - 1.0) < 0.03);
        assert_int_equal(found.margin<1.0, found.ringing> NT_RINGING_MOST);
    }
}

/* A master's step that the stage takes longer for than a period adds that to the delay of R1. */
static void a_slow_stage_costs_margin(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    const nt_margins margins = nt_margins_compute(&rig, &settings.gains, 600.0);
    assert_true(fabs(nt_margins_calm(&rig, &settings, 600.0).slewing / margins.margin - 1.0) < 1e-12);
    settings.limits.stage_speed = settings.gains.alpha_p * rig.master.resolution / 5e-3;
    const double delay = margins.loop_delay + 5e-3 - 1.0 / settings.gains.rate;
    const nt_calm found = nt_margins_calm(&rig, &settings, 600.0);
    assert_true(fabs(found.slewing * delay / (margins.margin * margins.loop_delay) - 1.0) < 1e-12);
}

static void where_nothing_can_be_told(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    assert_true(isinf(nt_margins_calm(&rig, &settings, 0.0).margin));
    rig.master.motor = 0;
    assert_true(isinf(nt_margins_calm(&rig, &settings, 600.0).margin));
    rig.master.motor = 1;
    rig.master.damping = 0.0;
    assert_true(isnan(nt_margins_calm(&rig, &settings, 600.0).margin));
    rig.master.damping = 100.0;
    rig.converters.dac_latency = 1.0;
    settings.gains.rate = 1e6;
    assert_true(isnan(nt_margins_calm(&rig, &settings, 600.0).margin));
}

/* A step of the deflection's converter is whole, however little it is at the hand, and does not keep time. */
static void a_step_of_the_probe_is_whole(void **state)
{
    (void)state;
    nt_settings settings;
    nt_rig rig = quiet(&settings);
    rig.probe.resolution = 1e-3;
    settings.gains.force_filter = 10.0;
    settings.gains.alpha_f = 1e4;
    const double step = 1e4 * 8.0 * rig.probe.sensitivity * 1e-3;
    const nt_calm found = nt_margins_calm(&rig, &settings, 600.0);
    assert_true(fabs(found.parts[NT_RIPPLE_PROBE] / step - 1.0) < 1e-12 &&
                found.ripple == found.parts[NT_RIPPLE_PROBE]);
}

/* The least margin names its rule; where there is none, or no number, the first. */
static void which_rule_it_is(void **state)
{
    (void)state;
    nt_settings settings;
    nt_rig rig = quiet(&settings);
    nt_rig coarse = rig, heavy = rig;
    coarse.master.resolution = 1e-2;
    heavy.master.mass = 1.0;
    heavy.master.damping = 0.5; /* below 1 N s/m it is still one */
    settings.limits.stage_speed = 20e-6;
    assert_string_equal(nt_margins_calm(&coarse, &settings, 600.0).rule, "ripple");
    settings.gains.alpha_f = 1e4;
    assert_string_equal(nt_margins_calm(&heavy, &settings, 600.0).rule, "ringing");
    rig.master.resolution = 1e-6;
    settings.limits.stage_speed = settings.gains.alpha_p * 1e-6 / 1.5; /* 1.5 s for a step */
    const nt_calm slow = nt_margins_calm(&rig, &settings, 600.0);
    assert_string_equal(slow.rule, "slewing");
    assert_true(fabs(slow.margin * 1.5 / slow.slewing - 1.0) < 1e-12);
    settings.limits.stage_speed = settings.gains.alpha_p * 1e-6 / 0.5; /* half a second: the same */
    const nt_calm faster = nt_margins_calm(&rig, &settings, 600.0);
    assert_true(fabs(faster.margin * 1.5 / faster.slewing - 1.0) < 1e-12);
    assert_string_equal(nt_margins_calm(&rig, &settings, 0.0).rule, "ripple");
    rig.master.damping = 0.0;
    assert_string_equal(nt_margins_calm(&rig, &settings, 600.0).rule, "ripple");
}

/* Just four steps of the command at once keep no time; a dead time of 10 000 periods is still one. */
static void borders_of_what_is_reckoned(void **state)
{
    (void)state;
    nt_settings settings;
    nt_rig rig = quiet(&settings);
    settings.gains.stage_integral = 0.0;
    rig.stage.quality = 50.0;
    settings.gains.alpha_p = 0x1p-15;
    rig.stage.command_resolution = 0x1p-34;
    rig.master.resolution = 0x1p-17; /* times alpha_p: four of them */
    const double four = nt_margins_calm(&rig, &settings, 600.0).parts[NT_RIPPLE_STAGE_COMMAND];
    rig.master.resolution = 0x1p-17 * (1.0 - 1e-12);
    assert_true(nt_margins_calm(&rig, &settings, 600.0).parts[NT_RIPPLE_STAGE_COMMAND] > 1.5 * four);
    settings.gains.rate = 0x1p13;
    settings.gains.delay = 1000.0;
    rig.converters.dac_latency = 9000.0 * 0x1p-13;
    assert_true(isfinite(nt_margins_calm(&rig, &settings, 600.0).ringing));
    rig.converters.dac_latency = 9001.0 * 0x1p-13;
    assert_true(isnan(nt_margins_calm(&rig, &settings, 600.0).ringing));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_of_the_probe_is_that_behind_the_low_pass),
        cmocka_unit_test(a_step_of_the_master_is_whole),
        cmocka_unit_test(a_heavy_master_rings),
        cmocka_unit_test(a_slow_stage_costs_margin),
        cmocka_unit_test(where_nothing_can_be_told),
        cmocka_unit_test(borders_of_what_is_reckoned),
        cmocka_unit_test(a_step_of_the_probe_is_whole),
        cmocka_unit_test(which_rule_it_is),
        cmocka_unit_test(steps_of_the_command_may_keep_time_with_the_resonance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
