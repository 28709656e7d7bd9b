/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/dynamics.h"

/* From rest under a constant force: v = f/b (1 - e^-x), position = f m/b^2 (x - 1 + e^-x), x = b t/m. The factor in x
 * is taken from its series below 0.1, where the closed form cancels. */
static double ramp_factor(double x)
{
    if (x > 0.1)
        return x + expm1(-x);
    double term = x * x / 2.0, sum = term;
    for (int k = 3; k < 20; k++)
        sum += term *= -x / k;
    return sum;
}

static void step_response_is_exact(void **state)
{
    (void)state;
    const double force = 0.01;
    for (double damping = 1.0; damping <= 1e4; damping *= 10.0)
        for (double period = 1e-6; period < 2e-2; period *= 10.0) {
            nt_master master = nt_rig_defaults().master;
            master.damping = damping;
            master.travel = 10.0;
            nt_master_model model;
            assert_int_equal(nt_master_model_init(&model, &master, period), NT_OK);
            nt_master_state now = {0};
            for (int k = 1; k <= 100; k++) {
                nt_master_step(&model, &now, force);
                const double x = damping * k * period / master.mass;
                const double position = force * master.mass / (damping * damping) * ramp_factor(x);
                const double speed = -force / damping * expm1(-x);
                assert_true(fabs(now.position / position - 1.0) < 1e-12); /* 100 roundings, and those of x */
                assert_true(fabs(now.speed / speed - 1.0) < 1e-12);
            }
        }
}

static void undamped_falls_freely(void **state)
{
    (void)state;
    nt_master master = nt_rig_defaults().master;
    master.damping = 0.0;
    master.travel = 10.0;
    nt_master_model model;
    assert_int_equal(nt_master_model_init(&model, &master, 1e-3), NT_OK);
    nt_master_state now = {0};
    for (int k = 0; k < 1000; k++)
        nt_master_step(&model, &now, 0.05);
    assert_true(fabs(now.position - 0.25) < 1e-12 && fabs(now.speed - 0.5) < 1e-12);
}

static void half_steps_compose(void **state)
{
    (void)state;
    const nt_master master = nt_rig_defaults().master;
    nt_master_model whole, half;
    assert_int_equal(nt_master_model_init(&whole, &master, 1e-3), NT_OK);
    assert_int_equal(nt_master_model_init(&half, &master, 0.5e-3), NT_OK);
    nt_master_state a = {1e-3, 1e-3}, b = a;
    for (int k = 0; k < 100; k++) {
        const double force = 0.2 * sin(0.3 * k);
        nt_master_step(&whole, &a, force);
        nt_master_step(&half, &b, force);
        nt_master_step(&half, &b, force);
        assert_true(fabs(a.position - b.position) < 1e-13 * 1e-2);
        assert_true(fabs(a.speed - b.speed) < 1e-13 * 1e-2);
    }
}

/* A stop holds the arm without bounce or penetration, on both sides, and lets go at once. */
static void end_stops_are_hard_and_inelastic(void **state)
{
    (void)state;
    const nt_master master = nt_rig_defaults().master;
    nt_master_model model;
    assert_int_equal(nt_master_model_init(&model, &master, 1e-4), NT_OK);
    for (double side = -1.0; side <= 1.0; side += 2.0) {
        nt_master_state now = {0};
        for (int k = 0; k < 20000; k++) {
            nt_master_step(&model, &now, side * 5.0);
            assert_true(fabs(now.position) <= 0.01);
        }
        assert_true(now.position == side * 0.01 && now.speed == 0.0);
        nt_master_step(&model, &now, -side * 1.0);
        assert_true(side * now.position < 0.01 && side * now.speed < 0.0);
    }
}

static void refuses_bad_masters_and_periods(void **state)
{
    (void)state;
    nt_master master = nt_rig_defaults().master;
    nt_master_model model;
    assert_int_equal(nt_master_model_init(&model, &master, 0.0), NT_E_RANGE);
    assert_int_equal(nt_master_model_init(&model, &master, (double)NAN), NT_E_NOT_FINITE);
    assert_int_equal(nt_master_model_init(&model, &master, (double)INFINITY), NT_E_NOT_FINITE);
    master.mass = 0.0;
    assert_int_equal(nt_master_model_init(&model, &master, 1e-3), NT_E_RANGE);
}

static void nan_is_not_hidden(void **state)
{
    (void)state;
    const nt_master master = nt_rig_defaults().master;
    nt_master_model model;
    assert_int_equal(nt_master_model_init(&model, &master, 1e-4), NT_OK);
    nt_master_state now = {0};
    nt_master_step(&model, &now, (double)NAN);
    assert_true(isnan(now.position) && isnan(now.speed));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(step_response_is_exact),
        cmocka_unit_test(undamped_falls_freely),
        cmocka_unit_test(half_steps_compose),
        cmocka_unit_test(end_stops_are_hard_and_inelastic),
        cmocka_unit_test(refuses_bad_masters_and_periods),
        cmocka_unit_test(nan_is_not_hidden),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
