/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control/motor.h"

static void height_is_a_spring(void **state)
{
    (void)state;
    const nt_gains gains = {.height_stiffness = 3000.0};
    assert_true(fabs(nt_motor_height(&gains, 1e-3, 0.0) - 3.0) < 1e-12); /* higher: draws on */
    assert_true(fabs(nt_motor_height(&gains, 1e-3, 2e-3) + 3.0) < 1e-12);
}

static void fading_takes_energy_from_the_master(void **state)
{
    (void)state;
    const nt_master master = nt_rig_defaults().master;
    for (double speed = -1.0; speed <= 1.0; speed += 0.25) {
        const double force = nt_motor_fade(&master, 0.0, speed);
        assert_true(force * speed <= 0.0 && fabs(force) <= master.damping * fabs(speed));
        assert_true(nt_motor_fade(&master, 2.0, speed) == 2.0 + force);
    }
}

static void rate_and_amplitude_are_limited(void **state)
{
    (void)state;
    const nt_limits limits = {.motor_force = 5.0, .motor_rate = 2000.0, .motor_power = 2.0};
    const double step = 0.2;
    double force = 0.0;
    for (int i = 0; i < 100; i++) {
        const double next = nt_motor_limit(&limits, step, force, 1e9, 0.0);
        assert_true(next - force <= step * (1.0 + 1e-12) && next <= 5.0);
        force = next;
    }
    assert_true(force == 5.0);
    for (int i = 0; i < 100; i++) {
        const double next = nt_motor_limit(&limits, step, force, -1e9, 0.0);
        assert_true(force - next <= step * (1.0 + 1e-12) && next >= -5.0);
        force = next;
    }
    assert_true(force == -5.0);
    assert_true(nt_motor_limit(&limits, step, 1.0, 1.1, 0.0) == 1.1); /* inside the limits: as wanted */
}

/* Driving the hand costs power, braking it does not; the limits of rate and amplitude hold first. */
static void power_is_limited_where_the_motor_drives(void **state)
{
    (void)state;
    const nt_limits limits = {.motor_force = 5.0, .motor_rate = 2000.0, .motor_power = 0.2};
    for (double speed = -0.5; speed <= 0.5; speed += 0.01)
        for (double wanted = -6.0; wanted <= 6.0; wanted += 0.5) {
            const double force = nt_motor_limit(&limits, 100.0, 0.0, wanted, speed);
            assert_true(force * speed <= limits.motor_power * (1.0 + 1e-12) && fabs(force) <= 5.0);
            if (wanted * speed <= limits.motor_power && fabs(wanted) <= 5.0)
                assert_true(force == wanted);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(height_is_a_spring),
        cmocka_unit_test(fading_takes_energy_from_the_master),
        cmocka_unit_test(rate_and_amplitude_are_limited),
        cmocka_unit_test(power_is_limited_where_the_motor_drives),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
