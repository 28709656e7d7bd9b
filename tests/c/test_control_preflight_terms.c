/* SPDX-License-Identifier: BSD-3-Clause
 * The numbers of the preflight: how long and how far, means and drifts of the tare, the way drawn back, and each limit
 * from both sides. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "control/preflight.h"
#include "control_draws.h"
#include "core/rig.h"
#include "larger.h"
#include "nanotouch/advanced/control.h"

#define PI 3.14159265358979323846

/* What a rig without noise reads: each signal has a bias and a drift; the stage goes by `share` of its command. */
typedef struct readings {
    double deflection, deflection_drift, force, force_drift, share, rest;
} readings;

static nt_sample sample_of(const readings *of, double time, double command)
{
    nt_sample sample = {.flags = 0u};
    sample.deflection[NT_Z] = of->deflection + of->deflection_drift * time;
    sample.operator_force[NT_Z] = of->force + of->force_drift * time;
    sample.stage_position[NT_Z] = of->rest + of->share * command;
    return sample;
}

/* To the end; the state then. */
static nt_preflight_state run(const nt_preflight *preflight, const readings *of)
{
    nt_preflight_state state;
    memset(&state, 0, sizeof state);
    nt_command command = {.state = 0};
    for (int i = 0; state.verdict == NT_PREFLIGHT_RUNNING; ++i) {
        assert_true(i <= nt_preflight_time(preflight) / preflight->period);
        const nt_sample sample = sample_of(of, i * preflight->period, command.stage_position[NT_Z]);
        nt_preflight_step(preflight, &state, &sample, &command);
    }
    return state;
}

static nt_preflight usual(nt_settings *settings)
{
    const nt_rig rig = nt_rig_defaults();
    *settings = nt_settings_defaults(&rig);
    return nt_preflight_make(&rig, settings);
}

static void how_long_and_how_far(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(1);
    for (int i = 0; i < 300; ++i) {
        nt_rig rig = drawn_rig(&random);
        nt_settings settings = drawn_settings(&random, &rig);
        settings.gains.rate = between(&random, 50.0, 2e4); /* slow ones take 25 samples */
        rig.stage.resonance = between(&random, 20.0, 2000.0);
        rig.stage.travel = between(&random, 1e-8, 1e-5);
        rig.converters.dac_latency = between(&random, 1e-4, 1e-2);
        const double rate = settings.gains.rate, step = larger(rig.stage.resolution, rig.stage.command_resolution);
        const nt_preflight made = nt_preflight_make(&rig, &settings);
        const double move = larger(25.0, rate * larger(0.02, 10.0 / rig.stage.resonance));
        const int moves = (int)ceil(move + settings.gains.delay + rig.converters.dac_latency * rate);
        /* a product at a whole number may be rounded to either side */
        assert_true(fabs((double)made.move - moves) <= 1.0 && fabs(ceil(larger(25.0, 0.05 * rate)) - made.ticks) < 1.0);
        assert_true(alike(made.distance, smaller(larger(10e-9, 20.0 * step), 0.25 * rig.stage.travel), 1e-12));
        assert_true(alike(made.period, 1.0 / rate, 1e-15));
        assert_true(alike(nt_preflight_time(&made), (2.0 * made.ticks + 4.0 * made.move + 1.0) / rate, 1e-12));
    }
}

static void ticks_are_rounded_up(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    settings.gains.rate = 1000.0;
    settings.gains.delay = 1.25;
    assert_int_equal(nt_preflight_make(&rig, &settings).move, 27);
    settings.gains.rate = 1001.0;
    assert_int_equal(nt_preflight_make(&rig, &settings).ticks, 51);
}

static void the_tare_is_the_mean(void **state)
{
    (void)state;
    nt_settings settings;
    const nt_preflight made = usual(&settings);
    const double middle = (2.0 * made.ticks - 1.0) / 2.0 * made.period;
    const readings of = {2e-9, 1e-8, 0.1, 0.2, 1.0, 3e-9};
    const nt_preflight_state found = run(&made, &of);
    assert_int_equal(found.verdict, NT_PREFLIGHT_PASSED);
    assert_true(alike(found.tare.deflection, of.deflection + of.deflection_drift * middle, 1e-12));
    assert_true(alike(found.tare.operator_force, of.force + of.force_drift * middle, 1e-12));
    nt_sample sample = sample_of(&of, middle, 0.0);
    nt_tare_apply(&found.tare, &made.rig.probe, &sample);
    assert_true(fabs(sample.deflection[NT_Z]) < 1e-20 && fabs(sample.operator_force[NT_Z]) < 1e-12);
    assert_int_equal(sample.flags, 0u);
    sample.deflection[NT_Z] = -nt_probe_deflection_range(&made.rig.probe); /* at its end before the tare is taken off */
    nt_tare_apply(&found.tare, &made.rig.probe, &sample);
    assert_int_equal(sample.flags, NT_SAMPLE_SATURATED);
}

/* Just inside each limit it passes, just outside it is named with the value that was measured. */
static void each_limit_from_both_sides(void **state)
{
    (void)state;
    nt_settings settings;
    const nt_preflight made = usual(&settings);
    const nt_limits *limits = &settings.limits;
    const double middle = (2.0 * made.ticks - 1.0) / 2.0 * made.period;
    const struct {
        size_t field;
        double limit;
        nt_preflight_verdict bad;
        const char *name;
    } rules[] = {
        {offsetof(readings, deflection), limits->deflection_bias, NT_PREFLIGHT_DEFLECTION_BIAS, "deflection bias"},
        {offsetof(readings, deflection_drift), limits->deflection_drift, NT_PREFLIGHT_DEFLECTION_DRIFT,
         "deflection drift"},
        {offsetof(readings, force), limits->gauge_bias, NT_PREFLIGHT_GAUGE_BIAS, "gauge bias"},
        {offsetof(readings, force_drift), limits->gauge_drift, NT_PREFLIGHT_GAUGE_DRIFT, "gauge drift"},
    };
    for (int i = 0; i < 4; ++i) {
        for (int side = 0; side < 4; ++side) {
            const double value = (side & 1 ? -1.0 : 1.0) * (side & 2 ? 1.0 + 1e-9 : 1.0 - 1e-9) * rules[i].limit;
            readings of = {.share = 1.0};
            *(double *)((char *)&of + rules[i].field) = value;
            if (i == 1) /* the bias alone would not do */
                of.deflection = -value * middle;
            if (i == 3)
                of.force = -value * middle;
            const nt_preflight_state found = run(&made, &of);
            assert_int_equal(found.verdict, side & 2 ? rules[i].bad : NT_PREFLIGHT_PASSED);
            if (!(side & 2))
                continue;
            const nt_problem problem = nt_preflight_problem(&made, &found);
            assert_true(alike(found.measure, value, 1e-9) && problem.value == found.measure);
            assert_string_equal(problem.field, rules[i].name);
            assert_true(problem.minimum == -rules[i].limit && problem.maximum == rules[i].limit);
        }
    }
}

/* Half of the way at least, and of what hysteresis leaves of it; half more at most. */
static void the_stage_goes_back_by_enough(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    rig.stage.hysteresis = 0.15;
    const nt_settings settings = nt_settings_defaults(&rig);
    const nt_preflight made = nt_preflight_make(&rig, &settings);
    const struct {
        double share;
        int passes;
    } cases[] = {{0.5 * 0.7 - 1e-6, 0}, {0.5 * 0.7 + 1e-6, 1}, {1.5 - 1e-6, 1}, {1.5 + 1e-6, 0}, {-1.0, 0}, {0.0, 0}};
    for (int i = 0; i < 6; ++i) {
        const readings of = {.share = cases[i].share, .rest = 7e-9};
        const nt_preflight_state found = run(&made, &of);
        assert_int_equal(found.verdict, cases[i].passes ? NT_PREFLIGHT_PASSED : NT_PREFLIGHT_STAGE);
        if (cases[i].passes)
            continue;
        assert_int_equal(found.tick, 2u * made.ticks + 2u * made.move); /* told at once */
        const nt_problem problem = nt_preflight_problem(&made, &found);
        assert_true(fabs(problem.value + cases[i].share * made.distance) < 1e-9 * made.distance);
        assert_true(alike(problem.minimum, -1.5 * made.distance, 1e-12));
        assert_true(alike(problem.maximum, -0.35 * made.distance, 1e-12));
        assert_string_equal(problem.field, "stage sign test");
    }
}

/* Rest; back along half a cosine, wait, forth, wait; and each tick counts once. */
static void the_way_tick_by_tick(void **state)
{
    (void)state;
    nt_settings settings;
    const nt_preflight made = usual(&settings);
    nt_preflight_state now;
    memset(&now, 0, sizeof now);
    nt_command command = {.state = 0};
    const readings of = {.share = 1.0};
    const uint32_t tare = 2u * made.ticks, all = tare + 4u * made.move;
    for (uint32_t tick = 0; tick < all; ++tick) {
        const nt_sample sample = sample_of(&of, 0.0, command.stage_position[NT_Z]);
        const nt_preflight_verdict verdict = nt_preflight_step(&made, &now, &sample, &command);
        assert_int_equal(verdict, tick + 1u < all ? NT_PREFLIGHT_RUNNING : NT_PREFLIGHT_PASSED);
        const double phase = tick < tare ? 0.0 : (tick - tare + 1.0) / made.move;
        const double turned = smaller(phase, 1.0) - larger(0.0, smaller(phase - 2.0, 1.0)); /* 0 .. 1 .. 0 */
        const double expected = -made.distance * pow(sin(0.5 * PI * turned), 2.0);
        assert_true(fabs(command.stage_position[NT_Z] - expected) < 1e-12 * made.distance);
    }
    const nt_command before = command;
    const nt_sample bad = {.flags = NT_SAMPLE_EMERGENCY_STOP}; /* it is over: nothing is looked at */
    assert_int_equal(nt_preflight_step(&made, &now, &bad, &command), NT_PREFLIGHT_PASSED);
    assert_memory_equal(&before, &command, sizeof command);
    const nt_problem none = nt_preflight_problem(&made, &now);
    assert_true(none.field[0] == 0 && none.unit[0] == 0);
    assert_true(none.value == 0.0 && none.minimum == 0.0 && none.maximum == 0.0);
}

/* The last half of the wait alone tells where the stage is, and the tare alone where it was. */
static void what_is_looked_at(void **state)
{
    (void)state;
    nt_settings settings;
    const nt_preflight made = usual(&settings);
    const uint32_t tare = 2u * made.ticks, from = tare + 2u * made.move - made.move / 2u, to = tare + 2u * made.move;
    for (int wrong = 0; wrong < 4; ++wrong) { /* one reading that spoils the mean: before and in the half, and after */
        const uint32_t at[] = {from - 1u, from, to - 1u, to};
        nt_preflight_state now;
        memset(&now, 0, sizeof now);
        nt_command command = {.state = 0};
        while (now.verdict == NT_PREFLIGHT_RUNNING) {
            const readings of = {.share = 1.0, .rest = now.tick == at[wrong] ? made.distance * made.move : 0.0};
            const nt_sample sample = sample_of(&of, 0.0, command.stage_position[NT_Z]);
            nt_preflight_step(&made, &now, &sample, &command);
        }
        assert_int_equal(now.verdict, wrong == 1 || wrong == 2 ? NT_PREFLIGHT_STAGE : NT_PREFLIGHT_PASSED);
    }
}

/* A deflection at the end of its range is refused at once, where the limit does not allow for that. */
static void a_saturated_reading(void **state)
{
    (void)state;
    nt_settings settings;
    nt_preflight made = usual(&settings);
    const double range = nt_probe_deflection_range(&made.rig.probe);
    readings of = {.deflection = range, .share = 1.0};
    assert_int_equal(run(&made, &of).verdict, NT_PREFLIGHT_DEFLECTION_BIAS);
    assert_int_equal(run(&made, &of).tick, 1u);
    of.deflection = range * (1.0 - 1e-12);
    assert_int_equal(run(&made, &of).verdict, NT_PREFLIGHT_DEFLECTION_BIAS);
    assert_int_equal(run(&made, &of).tick, 2u * made.ticks);
    made.limits.deflection_bias = range;
    of.deflection = range;
    assert_int_equal(run(&made, &of).verdict, NT_PREFLIGHT_PASSED);
}

static void bad_samples_are_named(void **state)
{
    (void)state;
    nt_settings settings;
    nt_preflight made = usual(&settings);
    const struct {
        uint32_t flags;
        const char *field;
    } cases[] = {
        {NT_SAMPLE_EMERGENCY_STOP | NT_SAMPLE_DEVICE_LOST, "emergency stop before arming"},
        {NT_SAMPLE_DEVICE_LOST | NT_SAMPLE_LIMIT_SWITCH, "device lost before arming"},
        {NT_SAMPLE_LIMIT_SWITCH | NT_SAMPLE_SATURATED, "limit switch before arming"},
        {NT_SAMPLE_SATURATED | NT_SAMPLE_INVALID, "deflection at the end of its range before arming"},
        {NT_SAMPLE_INVALID, "invalid sample before arming"},
    };
    for (int i = 0; i < 8; ++i) {
        nt_preflight_state now;
        memset(&now, 0, sizeof now);
        nt_command command = {.state = 0};
        nt_sample sample = {.flags = i < 5 ? cases[i].flags : 0u};
        if (i == 5)
            sample.deflection[NT_Z] = NAN;
        if (i == 6)
            sample.stage_position[NT_Z] = (double)INFINITY;
        if (i == 7)
            sample.operator_force[NT_Z] = NAN;
        assert_int_equal(nt_preflight_step(&made, &now, &sample, &command), NT_PREFLIGHT_BAD_SAMPLE);
        const nt_problem problem = nt_preflight_problem(&made, &now);
        assert_string_equal(problem.field, i < 5 ? cases[i].field : "a sample before arming");
        assert_string_equal(problem.unit, i < 5 ? "no|yes" : "");
        assert_true(i < 5 ? problem.value == 1.0 && problem.minimum == 0.0 && problem.maximum == 0.0
                          : isnan(problem.value) && problem.minimum < 0.0 && isinf(problem.minimum) &&
                                problem.maximum > 0.0 && isinf(problem.maximum));
    }
    made.rig.master.gauge = 0; /* nobody reads it, and nothing is tared */
    readings of = {.force = NAN, .share = 1.0};
    assert_int_equal(run(&made, &of).verdict, NT_PREFLIGHT_PASSED);
    of.force = 1e3;
    assert_true(run(&made, &of).tare.operator_force == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(how_long_and_how_far),
        cmocka_unit_test(ticks_are_rounded_up),
        cmocka_unit_test(the_tare_is_the_mean),
        cmocka_unit_test(each_limit_from_both_sides),
        cmocka_unit_test(the_stage_goes_back_by_enough),
        cmocka_unit_test(the_way_tick_by_tick),
        cmocka_unit_test(what_is_looked_at),
        cmocka_unit_test(a_saturated_reading),
        cmocka_unit_test(bad_samples_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
