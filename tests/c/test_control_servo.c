/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control/servo.h"
#include "nanotouch/random.h"

/* tau + f_m = (1 + K_f)(f_m - alpha_f f_s): at rest, and only there, f_m = alpha_f f_s, whatever K_f (erratum E16). */
static void rest_means_scaled_forces_agree(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(1);
    for (int i = 0; i < 1000; i++) {
        const nt_gains gains = {.force_gain = 100.0 * nt_random_uniform(&random),
                                .alpha_f = pow(10.0, 3.0 + 5.0 * nt_random_uniform(&random))};
        const double f_m = 5.0 * (2.0 * nt_random_uniform(&random) - 1.0), f_s = f_m / gains.alpha_f;
        assert_true(fabs(nt_servo_force(&gains, 1.0, f_s, f_m) + f_m) < 1e-12);
        const double other = 1.1 * f_s; /* off balance: the difference, amplified by 1 + K_f */
        const double net = nt_servo_force(&gains, 1.0, other, f_m) + f_m;
        assert_true(fabs(net - (1.0 + gains.force_gain) * (f_m - gains.alpha_f * other)) < 1e-12);
        /* the passivity observer takes K_f away, never the reflected force */
        assert_true(fabs(nt_servo_force(&gains, 0.0, other, f_m) + gains.alpha_f * other) < 1e-12);
    }
}

static void height_is_a_spring(void **state)
{
    (void)state;
    const nt_gains gains = {.height_stiffness = 3000.0};
    assert_true(fabs(nt_servo_height(&gains, 1e-3, 0.0) - 3.0) < 1e-12); /* higher: draws on */
    assert_true(fabs(nt_servo_height(&gains, 1e-3, 2e-3) + 3.0) < 1e-12);
}

static void fading_takes_energy_from_the_master(void **state)
{
    (void)state;
    const nt_master master = nt_rig_defaults().master;
    for (double speed = -1.0; speed <= 1.0; speed += 0.25) {
        const double force = nt_servo_fade(&master, 0.0, speed);
        assert_true(force * speed <= 0.0 && fabs(force) <= master.damping * fabs(speed));
        assert_true(nt_servo_fade(&master, 2.0, speed) == 2.0 + force);
    }
}

static void rate_and_amplitude_are_limited(void **state)
{
    (void)state;
    const nt_limits limits = {.motor_force = 5.0, .motor_rate = 2000.0};
    const double period = 1e-4, step = 0.2;
    double force = 0.0;
    for (int i = 0; i < 100; i++) {
        const double next = nt_servo_limit(&limits, period, force, 1e9);
        assert_true(next - force <= step * (1.0 + 1e-12) && next <= 5.0);
        force = next;
    }
    assert_true(force == 5.0);
    for (int i = 0; i < 100; i++) {
        const double next = nt_servo_limit(&limits, period, force, -1e9);
        assert_true(force - next <= step * (1.0 + 1e-12) && next >= -5.0);
        force = next;
    }
    assert_true(force == -5.0);
    assert_true(nt_servo_limit(&limits, period, 1.0, 1.1) == 1.1); /* inside the limits: as wanted */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rest_means_scaled_forces_agree),
        cmocka_unit_test(height_is_a_spring),
        cmocka_unit_test(fading_takes_energy_from_the_master),
        cmocka_unit_test(rate_and_amplitude_are_limited),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
