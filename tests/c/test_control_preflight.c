/* SPDX-License-Identifier: BSD-3-Clause
 * Tare and sign test on sensors and stages of every kind. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control/preflight.h"
#include "core/rig.h"
#include "larger.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/advanced/random.h"

/* What is wrong with the rig. */
typedef struct trouble {
    double bias, drift;           /* of the deflection [m], [m/s] */
    double hand_bias, hand_drift; /* of the gauge [N], [N/s] */
    double gain;                  /* of the stage [-] */
    uint32_t flags;
    nt_preflight_verdict verdict;
    const char *field;
} trouble;

static nt_preflight_state fly(const nt_preflight *preflight, const trouble *wrong, double *highest)
{
    nt_preflight_state state = {.verdict = NT_PREFLIGHT_RUNNING};
    nt_command command = {0};
    nt_random random = nt_random_seed(4);
    for (long tick = 0; tick < 1000000 && state.verdict == NT_PREFLIGHT_RUNNING; tick++) {
        const double t = (double)tick * preflight->period;
        const nt_sample sample = {
            .deflection[NT_Z] = wrong->bias + wrong->drift * t + 1e-9 * nt_random_normal(&random),
            .operator_force[NT_Z] = 0.02 * round((wrong->hand_bias + wrong->hand_drift * t) / 0.02),
            .stage_position[NT_Z] = 1e-9 * round(wrong->gain * command.stage_position[NT_Z] / 1e-9),
            .flags = wrong->flags};
        nt_preflight_step(preflight, &state, &sample, &command);
        *highest = larger(*highest, command.stage_position[NT_Z]);
        assert_true(fabs(command.stage_position[NT_Z]) <= preflight->distance * (1.0 + 1e-12));
    }
    return state;
}

static void every_trouble_is_refused_by_name(void **state)
{
    (void)state;
    static const trouble cases[] = {
        {.gain = 1.0, .verdict = NT_PREFLIGHT_PASSED, .field = ""},
        {.gain = 0.7, .bias = 30e-9, .hand_bias = 0.4, .verdict = NT_PREFLIGHT_PASSED, .field = ""},
        {.gain = 1.0, .bias = -34e-9, .verdict = NT_PREFLIGHT_DEFLECTION_BIAS, .field = "deflection bias"},
        {.gain = 1.0, .drift = 0.12e-6, .verdict = NT_PREFLIGHT_DEFLECTION_DRIFT, .field = "deflection drift"},
        {.gain = 1.0, .hand_bias = 0.6, .verdict = NT_PREFLIGHT_GAUGE_BIAS, .field = "gauge bias"},
        {.gain = 1.0, .hand_drift = -2.0, .verdict = NT_PREFLIGHT_GAUGE_DRIFT, .field = "gauge drift"},
        {.gain = -1.0, .verdict = NT_PREFLIGHT_STAGE, .field = "stage sign test"},
        {.gain = 0.0, .verdict = NT_PREFLIGHT_STAGE, .field = "stage sign test"},
        {.gain = 2.0, .verdict = NT_PREFLIGHT_STAGE, .field = "stage sign test"},
        {.gain = 1.0, .bias = NAN, .verdict = NT_PREFLIGHT_BAD_SAMPLE, .field = "a sample before arming"},
        {.gain = 1.0,
         .flags = NT_SAMPLE_EMERGENCY_STOP,
         .verdict = NT_PREFLIGHT_BAD_SAMPLE,
         .field = "emergency stop before arming"},
        {.gain = 1.0,
         .flags = NT_SAMPLE_SATURATED | NT_SAMPLE_DEVICE_LOST,
         .verdict = NT_PREFLIGHT_BAD_SAMPLE,
         .field = "device lost before arming"},
        {.gain = 1.0,
         .flags = NT_SAMPLE_LIMIT_SWITCH | NT_SAMPLE_INVALID,
         .verdict = NT_PREFLIGHT_BAD_SAMPLE,
         .field = "limit switch before arming"},
        {.gain = 1.0,
         .flags = NT_SAMPLE_SATURATED | NT_SAMPLE_INVALID,
         .verdict = NT_PREFLIGHT_BAD_SAMPLE,
         .field = "deflection at the end of its range before arming"},
        {.gain = 1.0,
         .flags = NT_SAMPLE_INVALID,
         .verdict = NT_PREFLIGHT_BAD_SAMPLE,
         .field = "invalid sample before arming"},
    };
    const nt_rig rig = nt_rig_defaults();
    for (double rate = 300.0; rate < 200e3; rate *= 5.0) {
        nt_settings settings = nt_settings_defaults(&rig);
        settings.gains.rate = rate;
        const nt_preflight preflight = nt_preflight_make(&rig, &settings);
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
            double highest = 0.0;
            const nt_preflight_state found = fly(&preflight, &cases[i], &highest);
            assert_int_equal(found.verdict, cases[i].verdict);
            const nt_problem problem = nt_preflight_problem(&preflight, &found);
            assert_string_equal(problem.field, cases[i].field);
            if (problem.field[0] && isfinite(problem.value))
                assert_true(problem.value < problem.minimum || problem.value > problem.maximum);
            assert_true(highest <= 0.0); /* never towards the sample */
        }
    }
}

/* A tip that has snapped in before the first tick: its stiff contact may cost seconds to simulate until a mean is
 * known. */
static void a_saturated_reading_is_refused_at_once(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    const nt_sample saturated = {.deflection[NT_Z] = -nt_probe_deflection_range(&rig.probe)};
    for (int wide = 0; wide < 2; ++wide) {
        settings.limits.deflection_bias =
            wide ? 1e-6 : 33e-9; /* who allows for a bias of the whole range has it tared */
        const nt_preflight preflight = nt_preflight_make(&rig, &settings);
        nt_preflight_state begun = {.verdict = NT_PREFLIGHT_RUNNING};
        nt_command command = {0};
        nt_preflight_step(&preflight, &begun, &saturated, &command);
        assert_int_equal(begun.verdict, wide ? NT_PREFLIGHT_RUNNING : NT_PREFLIGHT_DEFLECTION_BIAS);
        assert_true(wide || begun.measure == saturated.deflection[NT_Z]);
        assert_true(command.stage_position[NT_Z] == 0.0);
    }
}

/* The mean of at least 50 samples of 1 nm noise, five sigma. */
static void the_tare_is_the_bias(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    const nt_preflight preflight = nt_preflight_make(&rig, &settings);
    const trouble biased = {.gain = 1.0, .bias = -17e-9, .hand_bias = 0.3};
    double highest = 0.0;
    const nt_preflight_state found = fly(&preflight, &biased, &highest);
    assert_int_equal(found.verdict, NT_PREFLIGHT_PASSED);
    assert_true(fabs(found.tare.deflection + 17e-9) < 5e-9 / sqrt(2.0 * preflight.ticks));
    assert_true(fabs(found.tare.operator_force - 0.3) < 1e-12);
    nt_sample sample = {.deflection[NT_Z] = -17e-9, .operator_force[NT_Z] = 1.3};
    nt_tare_apply(&found.tare, &rig.probe, &sample);
    assert_true(fabs(sample.deflection[NT_Z]) < 1e-9 && fabs(sample.operator_force[NT_Z] - 1.0) < 1e-12);
    assert_int_equal(sample.flags, 0);
    sample.deflection[NT_Z] =
        nt_probe_deflection_range(&rig.probe); /* saturation is the electronics', not the tare's */
    nt_tare_apply(&found.tare, &rig.probe, &sample);
    assert_int_equal(sample.flags, NT_SAMPLE_SATURATED);
}

static void without_a_gauge_none_is_asked(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    rig.master.gauge = 0;
    const nt_settings settings = nt_settings_defaults(&rig);
    const nt_preflight preflight = nt_preflight_make(&rig, &settings);
    const trouble none = {.gain = 1.0, .hand_bias = NAN};
    double highest = 0.0;
    assert_int_equal(fly(&preflight, &none, &highest).verdict, NT_PREFLIGHT_PASSED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_trouble_is_refused_by_name),
        cmocka_unit_test(a_saturated_reading_is_refused_at_once),
        cmocka_unit_test(the_tare_is_the_bias),
        cmocka_unit_test(without_a_gauge_none_is_asked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
