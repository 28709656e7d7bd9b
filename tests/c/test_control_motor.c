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

/* 50 ms for a small force, then |F| T is what it may be, and at last the rate of one axis is the end of it. */
static void a_fade_is_as_short_as_the_hand_needs(void **state)
{
    (void)state;
    const double product = 6e-3, rate = 2000.0;
    const double small[] = {0.0, 0.0, -0.1}, medium[] = {0.3, 0.0, -0.4}, large[] = {3.0, -5.0, 4.0};
    assert_true(nt_motor_fade_time(product, rate, small) == 0.05);
    assert_true(fabs(nt_motor_fade_time(product, rate, medium) - 0.012) < 1e-15); /* 6e-3/0.5 */
    assert_true(nt_motor_fade_time(product, rate, large) == 2.5e-3);              /* not 6e-3/7.07 = 0.85 ms */
}

/* In a line from what it was; engaged falls with it, and goes on from there. */
static void a_force_fades_in_a_line(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    nt_touch touch;
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    nt_touch_state fades = nt_touch_start(&touch, 0.0, 0.0, 0.0);
    fades.fade.left = 1.0;
    fades.engaged = 0.5;
    fades.command.motor_force[NT_Z] = -2.0;
    const double time = nt_motor_fade_time(touch.fade_product, settings.limits.motor_rate, fades.command.motor_force);
    for (int i = 1; i <= 60; i++) {
        const double left = nt_motor_fade(&touch, &fades), line = 1.0 - i * touch.period / time;
        assert_true(fabs(left - (line > 0.0 ? line : 0.0)) < 1e-12);
        assert_true(fabs(fades.engaged - 0.5 * left) < 1e-12);
        assert_true(nt_motor_faded(&touch, &fades, NT_Z, 0.0) == -2.0 * left);
        assert_true(nt_motor_faded(&touch, &fades, NT_Z, 0.3) == -2.0 * left); /* a brake already: no more of it */
        const double driving = nt_motor_faded(&touch, &fades, NT_Z, -0.01);    /* it drives: braked with 0.5 b v */
        assert_true(fabs(driving - (2.0 * left > 0.5 ? 0.5 - 2.0 * left : 0.0)) < 1e-12);
        assert_true(nt_motor_faded(&touch, &fades, NT_Z, -1.0) == 0.0); /* and never turned round */
    }
    assert_true(time < 60 * touch.period);
}

/* A small force fades as a large one does; what is left of it at last is gone; what was taken away does not come back.
 */
static void a_small_force_fades(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    nt_touch touch;
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    nt_touch_state fades = nt_touch_start(&touch, 0.0, 0.0, 0.0);
    for (int side = -1; side <= 1; side += 2) {
        fades.fade.left = 0.5;
        fades.fade.from[NT_Z] = side * 0.5;
        fades.command.motor_force[NT_Z] = side * 0.5;
        assert_true(nt_motor_faded(&touch, &fades, NT_Z, 0.0) == side * 0.25);
        const double braked = 0.25 - 0.5 * rig.master.damping * 1e-3;
        assert_true(fabs(nt_motor_faded(&touch, &fades, NT_Z, side * 1e-3) - side * braked) < 1e-15);
        fades.command.motor_force[NT_Z] = side * 0.1;
        assert_true(nt_motor_faded(&touch, &fades, NT_Z, 0.0) == side * 0.1);
        fades.command.motor_force[NT_Z] = -side * 0.1;
        assert_true(nt_motor_faded(&touch, &fades, NT_Z, 0.0) == 0.0);
    }
    fades.fade = (nt_fade){.left = 2e-6, .step = 1e-6};
    fades.engaged = 1.0;
    assert_true(nt_motor_fade(&touch, &fades) == 0.0 && fades.engaged == 0.0 && fades.fade.left == 0.0);
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
        cmocka_unit_test(a_fade_is_as_short_as_the_hand_needs),
        cmocka_unit_test(a_force_fades_in_a_line),
        cmocka_unit_test(a_small_force_fades),
        cmocka_unit_test(rate_and_amplitude_are_limited),
        cmocka_unit_test(power_is_limited_where_the_motor_drives),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
