/* SPDX-License-Identifier: BSD-3-Clause
 * What both simulated halves have: when a conversion ends, what was measured a latency ago, which command acts. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "hal/sim/parts.h"

#define T 1e-4
static nt_plan plan; /* not looked into */

static nt_sim_link link_of(double own_rate, double adc_rate, double adc_latency, double delay)
{
    nt_rig rig = nt_rig_defaults();
    rig.converters.adc_rate = adc_rate;
    rig.converters.adc_latency = adc_latency;
    const nt_sim_setup setup = {.plan = &plan, .rig = &rig, .period = T, .clearance = 1e-8, .delay = delay};
    nt_sim_link link;
    assert_int_equal(nt_sim_link_init(&link, &setup, own_rate), NT_OK);
    return link;
}

/* The slower of a half's own rate and the converter's counts; 0 is none; faster than the loop is each tick. */
static void conversions_come_at_the_slower_rate(void **state)
{
    (void)state;
    static const struct {
        double own, converter;
        int count; /* in 10 000 ticks, the first one included */
    } cases[] = {{0.0, 0.0, 10000}, {125.0, 0.0, 125},      {0.0, 3000.0, 3000},
                 {125.0, 3e3, 125}, {4000.0, 3000.0, 3000}, {1e6, 0.0, 10000}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        nt_sim_link link = link_of(cases[i].own, cases[i].converter, 0.0, 0.0);
        int count = 0;
        for (link.tick = 0; link.tick < 10000; link.tick++)
            count += nt_sim_is_converted(&link);
        assert_in_range(count, cases[i].count, cases[i].count + 1);
    }
}

/* On straight lines between ticks, so a signal that is straight in time is seen exactly a latency late. */
static void a_moment_is_seen_a_latency_late(void **state)
{
    (void)state;
    static double moments[NT_SIM_SLOTS][2];
    const double latencies[] = {0.0, 0.3 * T, T, 7.75 * T, 200.0 * T};
    for (size_t i = 0; i < sizeof latencies / sizeof *latencies; i++) {
        nt_sim_link link = link_of(0.0, 0.0, latencies[i], 0.0);
        for (link.tick = 0; link.tick < 1000; link.tick++) {
            const double now = (double)link.tick;
            moments[link.tick % NT_SIM_SLOTS][0] = 3.0 * now;
            moments[link.tick % NT_SIM_SLOTS][1] = -now;
            if (now < latencies[i] / T + 1.0)
                continue;
            double seen[2];
            nt_sim_moment_before(&link, moments, seen);
            assert_true(fabs(seen[0] - 3.0 * (now - latencies[i] / T)) < 1e-9);
            assert_true(fabs(seen[1] + (now - latencies[i] / T)) < 1e-9);
        }
    }
}

/* A delay of 2.25 periods: the command of three ticks ago acts in the first quarter, that of two ago in the rest. */
static void a_command_acts_after_its_delay(void **state)
{
    (void)state;
    static double pending[NT_SIM_SLOTS][NT_AXES];
    nt_sim_link link = link_of(0.0, 0.0, 0.0, 2.25);
    assert_true(link.delay == 2 && fabs(link.fraction - 0.25) < 1e-12);
    for (link.tick = 0; link.tick < 1000; link.tick++) {
        pending[link.tick % NT_SIM_SLOTS][NT_Z] = (double)link.tick;
        if (link.tick < 3)
            continue;
        assert_true(nt_sim_acting(&link, pending, 0)[NT_Z] == (double)link.tick - 3.0);
        assert_true(nt_sim_acting(&link, pending, 1)[NT_Z] == (double)link.tick - 2.0);
    }
}

static void steps_round_to_the_nearest(void **state)
{
    (void)state;
    assert_true(nt_sim_in_steps(2.6, 1.0) == 3.0 && nt_sim_in_steps(-0.4, 0.25) == -0.5);
    assert_true(nt_sim_in_steps(0.123, 0.0) == 0.123);
}

static void what_is_too_late_is_refused(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    nt_sim_setup setup = {.plan = &plan, .rig = &rig, .period = T, .clearance = 1e-8, .delay = NT_SIM_DELAY_MAX};
    nt_sim_link link;
    assert_int_equal(nt_sim_link_init(&link, &setup, 0.0), NT_OK);
    rig.converters.dac_latency = 0.1 * T; /* the sum counts */
    assert_int_equal(nt_sim_link_init(&link, &setup, 0.0), NT_E_RANGE);
    rig.converters.dac_latency = 0.0;
    rig.converters.adc_latency = (NT_SIM_DELAY_MAX + 1) * T;
    assert_int_equal(nt_sim_link_init(&link, &setup, 0.0), NT_E_RANGE);
    assert_int_equal(nt_sim_check_setup(&(nt_sim_setup){.plan = &plan}), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(conversions_come_at_the_slower_rate), cmocka_unit_test(a_moment_is_seen_a_latency_late),
        cmocka_unit_test(a_command_acts_after_its_delay),      cmocka_unit_test(steps_round_to_the_nearest),
        cmocka_unit_test(what_is_too_late_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
