/* SPDX-License-Identifier: BSD-3-Clause
 * What the hand feels over frequency, and the paper's stage alone, against response_oracle.py; the bandwidth by its
 * definition; resolution and the verdicts by their formulas. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "../reference/loop_table.h"
#include "../reference/response_table.h"
#include "control_draws.h"
#include "core/complex_number.h"
#include "internal/control.h"
#include "internal/margins.h"
#include "larger.h"
#include "nanotouch/control.h"
#include "nanotouch/margins.h"

#define PI 3.14159265358979323846
enum { STIFFNESS = sizeof response_cases[0].in / sizeof(double) - 1 };

static void setup_of(const double *in, nt_rig *rig, nt_settings *settings)
{
    (void)loop_cases;
    *rig = nt_rig_defaults();
    *settings = nt_settings_defaults(rig);
    set_loop(in, rig, settings);
}

/* Re of C without what f_m makes of it, over its size: f_m is seen n + 1 periods late, behind the low-pass. */
static double llewellyn_of(const response_case *row, const nt_rig *rig, const nt_gains *gains)
{
    const double T = 1.0 / gains->rate, theta = 2.0 * PI * row->frequency * T, K = gains->force_gain;
    const double c = 1.0 - exp(-2.0 * PI * gains->force_filter * T);
    const double repeats = rig->converters.adc_rate > 0.0 ? larger(0.0, 1.0 / rig->converters.adc_rate - T) : 0.0;
    const double hold = rig->master.rate > 0.0 ? larger(0.0, 1.0 / rig->master.rate - T) : 0.0;
    const double dead = gains->delay * T + rig->converters.adc_latency + rig->converters.dac_latency + repeats;
    const double seen = (1.0 + floor((dead + 2.0 * hold) / T + 1e-9)) * theta;
    const double complex back = nt_complex(cos(theta), -sin(theta)), low_pass = c / (1.0 - (1.0 - c) * back);
    const double complex felt =
        nt_complex(row->path[0], row->path[1]) / (1.0 + K * low_pass * nt_complex(cos(seen), -sin(seen)));
    return creal(felt) / cabs(felt);
}

static void a_master_that_is_moved(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof response_cases / sizeof *response_cases; ++i) {
        const response_case *row = &response_cases[i];
        nt_rig rig;
        nt_settings settings;
        setup_of(row->in, &rig, &settings);
        const nt_loop_response found = nt_margins_response(&rig, &settings.gains, row->in[STIFFNESS], row->frequency);
        const double path = hypot(row->path[0], row->path[1]), z = hypot(row->impedance[0], row->impedance[1]);
        for (int k = 0; k < 2; ++k) { /* what has not settled yet is exp(-18) */
            assert_true(fabs(found.path[k] - row->path[k]) < 1e-6 * path);
            assert_true(fabs(found.impedance[k] - row->impedance[k]) < 1e-6 * z);
        }
        assert_true(fabs(found.llewellyn - llewellyn_of(row, &rig, &settings.gains)) < 1e-5);
        const double half = 0.5 * settings.gains.rate;
        assert_true(isfinite(nt_margins_response(&rig, &settings.gains, 10.0, half).path[0]));
        assert_true(isnan(nt_margins_response(&rig, &settings.gains, 10.0, half * (1.0 + 1e-12)).impedance[1]));
        assert_true(isnan(nt_margins_response(&rig, &settings.gains, 10.0, 0.0).llewellyn));
    }
}

/* |Z| over alpha_f alpha_p k_eff/w. */
static double ratio_at(const nt_rig *rig, const nt_gains *gains, double k, double frequency)
{
    const nt_loop_response at = nt_margins_response(rig, gains, k, frequency);
    const double k_c = rig->probe.spring_constant, k_r = gains->alpha_f * gains->alpha_p * k * k_c / (k + k_c);
    return hypot(at.impedance[0], at.impedance[1]) * 2.0 * PI * frequency / k_r;
}

static void the_bandwidth_by_its_definition(void **state)
{
    (void)state;
    int borders = 0;
    for (size_t i = 0; i < sizeof response_cases / sizeof *response_cases; i += 3) {
        nt_rig rig;
        nt_settings settings;
        const double *in = response_cases[i].in, k = in[STIFFNESS], three_db = sqrt(2.0);
        setup_of(in, &rig, &settings);
        const nt_gains *gains = &settings.gains;
        const double found = nt_margins_bandwidth(&rig, gains, k);
        assert_true(found > 0.0 && found <= 0.5 * gains->rate);
        for (double f = 1e-6 * gains->rate; f < 0.9999 * found; f *= 1.1) {
            const double ratio = ratio_at(&rig, gains, k, f);
            assert_true(ratio < three_db && ratio > 1.0 / three_db);
        }
        const double beyond = ratio_at(&rig, gains, k, found * (1.0 + 1e-9));
        const double at = ratio_at(&rig, gains, k, found * (1.0 - 1e-9));
        assert_true(at < three_db && at > 1.0 / three_db && (beyond >= three_db || beyond <= 1.0 / three_db));
        borders |= beyond > 1.0 ? 1 : 2;
        assert_true(isnan(nt_margins_bandwidth(&rig, gains, NAN)) && nt_margins_bandwidth(&rig, gains, 0.0) == 0.0);
    }
    assert_true(borders & 1);
}

static void eq_17_alone(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof printed_cases / sizeof *printed_cases; ++i) {
        nt_rig rig;
        nt_settings settings;
        setup_of(printed_cases[i].in, &rig, &settings);
        const double found = nt_servo_stage_margin(&rig, &settings);
        /* in ratios of 1.001, and what grows so slowly that a run does not show it */
        assert_true(fabs(found / printed_cases[i].limit - 1.0) < 1.5e-3);
        settings.control.choice = NT_CONTROL_DEFAULT;
        assert_true(isinf(nt_servo_stage_margin(&rig, &settings)));
        settings.control.choice = NT_CONTROL_PAPER;
        settings.gains.stage_proportional = 0.0;
        settings.gains.stage_derivative = 0.0;
        assert_true(isinf(nt_servo_stage_margin(&rig, &settings))); /* nothing drives it */
    }
}

static void how_many_steps_there_are(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(1);
    for (int i = 0; i < 100; ++i) {
        nt_rig rig = drawn_rig(&random);
        nt_gains gains = nt_settings_defaults(&rig).gains;
        rig.master.gauge = i % 2;
        rig.probe.noise = i % 3 ? rig.probe.noise : 1e-7; /* or a step of the stage is the coarser */
        const double path = between(&random, 1e-7, 1e-5), k_c = rig.probe.spring_constant;
        const double step = larger(rig.stage.command_resolution, rig.stage.resolution);
        const double force = k_c * larger(rig.probe.sensitivity * rig.probe.noise, step);
        const nt_resolution found = nt_resolution_compute(&rig, &gains, path);
        assert_true(found.slave_step == step && alike(found.slave_force, force, 1e-12));
        assert_true(alike(found.slave_steps, path / step, 1e-12));
        assert_true(alike(found.force_steps, 2.0 * k_c * rig.probe.range * rig.probe.sensitivity / force, 1e-12));
        assert_true(alike(found.master_steps, rig.master.travel / rig.master.resolution, 1e-12));
        const double gauge = 2.0 * rig.master.gauge_range / rig.master.gauge_resolution;
        assert_true(alike(found.gauge_steps, rig.master.gauge ? gauge : 0.0, 1e-12));
        assert_true(alike(found.master_travel, path / gains.alpha_p, 1e-12));
        assert_true(alike(found.master_force, gains.alpha_f * force, 1e-12));
    }
}

/* Which rule decides, and by how much, in each mode. */
static void the_verdicts(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof loop_cases / sizeof *loop_cases; ++i) {
        nt_rig rig;
        nt_settings settings;
        setup_of(loop_cases[i].in, &rig, &settings);
        nt_margins m;
        const double k = loop_cases[i].in[STIFFNESS];
        const nt_servo_equivalent as = nt_servo_equivalent_of(&rig, &settings, k);
        const double K_f = as.gains.force_gain;
        const nt_verdict touch = nt_margins_judge(&rig, &settings, k, NT_MODE_TOUCH, &m);
        const struct {
            double margin;
            const char *rule;
        } rules[] = {{m.margin, "R1 contact"},
                     {m.exact_limit / m.loop_stiffness, "exact contact"},
                     {K_f > 0.0 ? m.force_gain_limit / K_f : HUGE_VAL, "exact K_f"},
                     {rig.master.max_force / m.quantisation_step, "R4 steps"},
                     {rig.master.max_force / (3.0 * m.force_noise), "R5 noise"},
                     {m.coupling_margin, "virtual coupling"},
                     {nt_servo_stage_margin(&rig, &settings), "stage of Eq. 17"}};
        for (size_t r = 0; r < sizeof rules / sizeof *rules; ++r) {
            assert_true(touch.margin <= rules[r].margin);
            assert_true((touch.margin == rules[r].margin) == (strcmp(touch.rule, rules[r].rule) == 0));
        }
        assert_true(isinf(nt_margins_judge(&rig, &settings, k, NT_MODE_CURVE, &m).margin));
        const nt_verdict height = nt_margins_judge(&rig, &settings, k, NT_MODE_TOPOGRAPHY, &m);
        assert_true(height.margin == m.height_margin);
        assert_string_equal(height.rule, "height servo");
        const nt_verdict taps = nt_margins_judge(&rig, &settings, k, NT_MODE_TAPPING, &m);
        const double hop = 0.5 / settings.gains.rate;
        rig.master.motor = 0; /* half of the loop's delay is not the servo's: the motor's hop */
        nt_margins without;
        (void)nt_margins_judge(&rig, &settings, k, NT_MODE_TOPOGRAPHY, &without);
        const double softened = as.gains.coupling_stiffness > 0.0 ? m.loop_stiffness / (1.0 + K_f) : HUGE_VAL;
        const double k_c = rig.probe.spring_constant, scale = as.gains.alpha_f * as.gains.alpha_p;
        const double share = isinf(softened) ? k / (k + k_c) : softened / (scale * k_c);
        const double lag = 1.0 / (without.height_margin * settings.gains.height_gain * share);
        assert_true(lag > hop);
        const double tap_lag = lag + nt_tap_lag(&rig, &settings.tap);
        assert_true(alike(taps.margin, smaller(m.height_margin, 1.0 / (settings.gains.height_gain * tap_lag)), 1e-9));
        assert_string_equal(taps.rule, "amplitude servo");
        const nt_verdict blind = nt_margins_judge(&rig, &settings, k, NT_MODE_TOUCH, &m);
        const int paper = settings.control.choice == NT_CONTROL_PAPER;
        const double stage =
            paper ? nt_servo_stage_margin(&rig, &settings) : m.integral_limit / as.gains.stage_integral;
        assert_true(alike(blind.margin, smaller(m.coupling_margin, stage), 1e-12));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_master_that_is_moved),
        cmocka_unit_test(the_bandwidth_by_its_definition),
        cmocka_unit_test(eq_17_alone),
        cmocka_unit_test(how_many_steps_there_are),
        cmocka_unit_test(the_verdicts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
