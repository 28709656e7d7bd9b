/* SPDX-License-Identifier: BSD-3-Clause
 * What the sampled loop is made of: where poles lie, dead times and holds, another hand, a coupling. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control/sampled.h"
#include "control_draws.h"
#include "larger.h"

#define PI 3.14159265358979323846

/* Folded back to 0 .. pi, as samples see it. */
static void where_the_poles_lie(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(1);
    for (int i = 0; i < 300; ++i) {
        const double m = between(&random, 0.1, 10.0), w = between(&random, 10.0, 3000.0), T = 1e-3;
        const double zeta = i % 3 ? between(&random, 0.01, 0.9) : between(&random, 1.1, 3.0);
        const nt_sampled part = nt_sampled_make(m, 2.0 * zeta * m * w, m * w * w, T, 0.0);
        const double turn = zeta < 1.0 ? w * sqrt(1.0 - zeta * zeta) * T : 0.0;
        const double angle = fabs(turn - 2.0 * PI * round(turn / (2.0 * PI)));
        assert_true(fabs(nt_sampled_angle(&part) - angle) < 1e-6); /* a root of a difference near 0 */
    }
}

static void dead_times_and_holds(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    nt_gains gains = nt_settings_defaults(&rig).gains;
    gains.rate = 1000.0;
    gains.delay = 2.0;
    rig.converters = (nt_converters){.adc_latency = 3e-4, .dac_latency = 5e-4};
    assert_true(alike(nt_sampled_dead_time(&rig, &gains), 2e-3 + 8e-4, 1e-12));
    const double rates[] = {0.5, 400.0, 1000.0, 2000.0}, more[] = {1.999, 1.5e-3, 0.0, 0.0};
    for (int i = 0; i < 4; ++i) {
        rig.converters.adc_rate = rig.master.rate = rates[i];
        assert_true(alike(nt_sampled_dead_time(&rig, &gains), 2.8e-3 + more[i], 1e-12));
        assert_true(fabs(nt_sampled_master_hold(&rig, &gains) - more[i]) < 1e-15);
    }
    rig.master.rate = 0.0;
    assert_true(nt_sampled_master_hold(&rig, &gains) == 0.0);
    gains.coupling_stiffness = 0.5;
    gains.coupling_damping = 2.5e-4; /* 0.25 N/m over a period */
    const nt_sampled_tool tool = nt_sampled_loop_make(&rig, &gains).tool;
    assert_true(alike(tool.give, 2.0, 1e-12) && alike(tool.kept, 1.0 / 3.0, 1e-12) &&
                alike(tool.drag, 0.5 / 3.0, 1e-12));
}

static void in_another_hand(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    const nt_gains gains = nt_settings_defaults(&rig).gains;
    rig.hand = (nt_hand){.mass = 0.02, .damping = 3.0, .stiffness = 200.0};
    rig.converters.dac_latency = 0.3e-4;
    rig.master.rate = 2e3;
    const nt_sampled_loop loop = nt_sampled_loop_make(&rig, &gains);
    const nt_hand other = {.mass = 0.07, .damping = 5.0, .stiffness = 900.0};
    const nt_sampled_loop held = nt_sampled_loop_held(&loop, &other);
    rig.hand = other;
    const nt_sampled_loop same = nt_sampled_loop_make(&rig, &gains);
    assert_true(held.hand.mass == other.mass && held.hand.damping == other.damping);
    assert_true(alike(held.master.mass, same.master.mass, 1e-12) &&
                alike(held.master.damping, same.master.damping, 1e-12));
    assert_true(held.master.stiffness == 900.0 && held.master.whole == same.master.whole && held.master.whole == 9);
    for (int i = 0; i < 2; ++i)
        assert_true(alike(held.master.late[i], same.master.late[i], 1e-9) &&
                    alike(held.master.early[i], same.master.early[i], 1e-9));
}

/* No more than a thousand million periods are counted, and a rounded whole number is one. */
static void whole_periods(void **state)
{
    (void)state;
    for (int n = 1; n < 2000; n *= 3)
        for (int side = -1; side <= 1; ++side) {
            const nt_sampled part = nt_sampled_make(1.0, 1.0, 0.0, 1e-3, n * 1e-3 * (1.0 + 1e-13 * side));
            assert_int_equal(part.whole, n);
        }
    assert_int_equal(nt_sampled_make(1.0, 1.0, 0.0, 1e-3, 1e9).whole, 1000000000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(where_the_poles_lie),
        cmocka_unit_test(dead_times_and_holds),
        cmocka_unit_test(in_another_hand),
        cmocka_unit_test(whole_periods),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
