/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "dynamics/dynamics.h"
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
            assert_int_equal(nt_master_model_init(&model, &master, NULL, period), NT_OK);
            nt_master_state now = {0};
            for (int k = 1; k <= 100; k++) {
                nt_master_step(&model, &now, force, 0.0);
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
    assert_int_equal(nt_master_model_init(&model, &master, NULL, 1e-3), NT_OK);
    nt_master_state now = {0};
    for (int k = 0; k < 1000; k++)
        nt_master_step(&model, &now, 0.05, 0.0);
    assert_true(fabs(now.position - 0.25) < 1e-12 && fabs(now.speed - 0.5) < 1e-12);
}

static void half_steps_compose(void **state)
{
    (void)state;
    const nt_master master = nt_rig_defaults().master;
    nt_master_model whole, half;
    assert_int_equal(nt_master_model_init(&whole, &master, NULL, 1e-3), NT_OK);
    assert_int_equal(nt_master_model_init(&half, &master, NULL, 0.5e-3), NT_OK);
    nt_master_state a = {1e-3, 1e-3, 0.0}, b = a;
    for (int k = 0; k < 100; k++) {
        const double force = 0.2 * sin(0.3 * k);
        nt_master_step(&whole, &a, force, 0.0);
        nt_master_step(&half, &b, force, 0.0);
        nt_master_step(&half, &b, force, 0.0);
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
    assert_int_equal(nt_master_model_init(&model, &master, NULL, 1e-4), NT_OK);
    for (double side = -1.0; side <= 1.0; side += 2.0) {
        nt_master_state now = {0};
        for (int k = 0; k < 20000; k++) {
            nt_master_step(&model, &now, side * 5.0, 0.0);
            assert_true(fabs(now.position) <= 0.01);
        }
        assert_true(now.position == side * 0.01 && now.speed == 0.0);
        nt_master_step(&model, &now, -side * 1.0, 0.0);
        assert_true(side * now.position < 0.01 && side * now.speed < 0.0);
    }
}

static nt_master_model model_of(const nt_master *master, const nt_hand *hand, double period)
{
    nt_master_model model;
    assert_int_equal(nt_master_model_init(&model, master, hand, period), NT_OK);
    return model;
}

/* Under b v' = f - f_C: slides to 0 after m/b ln(1 + b v0/f_C) when let go, then sticks, to the last bit. */
static void friction_stops_and_holds(void **state)
{
    (void)state;
    nt_master master = nt_rig_defaults().master;
    master.friction = 0.3;
    const double v0 = 0.02, time = 0.1 / 100.0 * log1p(100.0 * v0 / 0.3); /* 2 ms */
    const double way = 0.1 / 100.0 * (v0 - 0.3 / 100.0 * log1p(100.0 * v0 / 0.3));
    for (double period = 1e-5; period < 2e-2; period *= 10.0) {
        const nt_master_model model = model_of(&master, NULL, period);
        nt_master_state now = {.speed = v0};
        for (double t = 0.0; t < time + 3.0 * period; t += period)
            nt_master_step(&model, &now, 0.0, 0.0);
        assert_true(now.speed == 0.0 && now.acceleration == 0.0);
        assert_true(fabs(now.position / way - 1.0) < 1e-11);
        const double stood = now.position;
        for (int k = 0; k < 100; k++)
            nt_master_step(&model, &now, k % 2 ? 0.3 : -0.29, 0.0);
        assert_true(now.position == stood && now.speed == 0.0); /* no chatter */
        nt_master_step(&model, &now, 0.31, 0.0);
        assert_true(now.position > stood);
    }
}

/* Exact means: one long step is many short ones, through sticking and turning, held by a hand with mass and spring. */
static void friction_composes(void **state)
{
    (void)state;
    nt_master master = nt_rig_defaults().master;
    master.friction = 0.2;
    static const nt_hand hands[] = {{0}, {.mass = 0.05, .damping = 2.0, .stiffness = 1000.0}, {.stiffness = 5e4}};
    for (int h = 0; h < 3; h++)
        for (int soft = 0; soft < 2; soft++) {
            master.damping = soft ? 0.5 : 100.0;
            const nt_master_model whole = model_of(&master, &hands[h], 1e-2), part = model_of(&master, &hands[h], 1e-4);
            nt_master_state a = {0}, b = {0};
            int still = 0;
            for (int k = 0; k < 60; k++) {
                const double force = k % 7 == 6 ? 0.0 : 1.5 * sin(0.9 * k);
                nt_master_step(&whole, &a, force, 1e-4);
                for (int i = 0; i < 100; i++)
                    nt_master_step(&part, &b, force, 1e-4);
                assert_true(fabs(a.position - b.position) < 1e-13 && fabs(a.speed - b.speed) < 1e-10);
                still += a.speed == 0.0;
            }
            assert_true(h == 0 || soft || still > 5);
        }
}

/* What the gauge reads is what moves the master: m x'' = motor + f_m - b x' - friction. */
static void grip_force_balances_the_master(void **state)
{
    (void)state;
    nt_master master = nt_rig_defaults().master;
    master.friction = 0.1;
    const nt_hand hand = {.mass = 0.08, .damping = 3.0, .stiffness = 800.0};
    const nt_master_model model = model_of(&master, &hand, 1e-3);
    nt_master_state now = {0};
    nt_hand_state holds = {.to = {.force = {[NT_Z] = 1.0}}, .rest = 2e-4, .random_force = 0.25};
    for (int k = 0; k < 200; k++) {
        const double motor = -0.6 * cos(0.4 * k);
        nt_master_step(&model, &now, motor + nt_hand_effort(&holds), holds.rest);
        const double force = nt_master_grip_force(&model, &now, nt_hand_effort(&holds), holds.rest);
        const double friction = now.speed > 0.0 ? 0.1 : -0.1;
        const double rest = motor + force - 100.0 * now.speed - 0.1 * now.acceleration;
        assert_true(now.speed != 0.0 ? fabs(rest - friction) < 1e-12 : fabs(rest) <= 0.1 + 1e-12);
    }
    assert_true(nt_hand_effort(&holds) == 1.25);
}

static void refuses_bad_masters_and_periods(void **state)
{
    (void)state;
    nt_master master = nt_rig_defaults().master;
    nt_master_model model;
    assert_int_equal(nt_master_model_init(&model, &master, NULL, 0.0), NT_E_RANGE);
    assert_int_equal(nt_master_model_init(&model, &master, NULL, (double)NAN), NT_E_NOT_FINITE);
    assert_int_equal(nt_master_model_init(&model, &master, NULL, (double)INFINITY), NT_E_NOT_FINITE);
    master.mass = 0.0;
    assert_int_equal(nt_master_model_init(&model, &master, NULL, 1e-3), NT_E_RANGE);
}

static void nan_is_not_hidden(void **state)
{
    (void)state;
    const nt_master master = nt_rig_defaults().master;
    nt_master_model model;
    assert_int_equal(nt_master_model_init(&model, &master, NULL, 1e-4), NT_OK);
    nt_master_state now = {0};
    nt_master_step(&model, &now, (double)NAN, 0.0);
    assert_true(isnan(now.position) && isnan(now.speed));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(step_response_is_exact),
        cmocka_unit_test(undamped_falls_freely),
        cmocka_unit_test(half_steps_compose),
        cmocka_unit_test(end_stops_are_hard_and_inelastic),
        cmocka_unit_test(friction_stops_and_holds),
        cmocka_unit_test(friction_composes),
        cmocka_unit_test(grip_force_balances_the_master),
        cmocka_unit_test(refuses_bad_masters_and_periods),
        cmocka_unit_test(nan_is_not_hidden),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
