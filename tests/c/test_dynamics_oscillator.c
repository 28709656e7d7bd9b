/* SPDX-License-Identifier: BSD-3-Clause
 * The closed forms against the matrix exponential (core/lti.h), which knows nothing of them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/lti.h"
#include "dynamics/oscillator.h"
#include "larger.h"

/* m = 1, w0 = 1 s^-1; damping from none through critical to 1e6, steps from 1e-9 to 100 rad. Relative to the size of
 * each entry; the exponential itself is good to its norm times 2^-52, the phase to w t. */
static void agrees_with_the_matrix_exponential(void **state)
{
    (void)state;
    static const double dampings[] = {0.0, 1e-7, 0.01, 1.0, 1.999999, 2.0, 2.000001, 3.0, 100.0};
    for (size_t i = 0; i < sizeof dampings / sizeof *dampings; i++)
        for (double t = 1e-9; t < 200.0; t *= 3.0) {
            const nt_oscillator_constants c = {1.0, dampings[i], 1.0};
            const nt_oscillator o = nt_oscillator_over(&c, t);
            const nt_lti continuous = {.order = 2, .a = {{0.0, 1.0}, {-1.0, -dampings[i]}}, .b = {0.0, 1.0}};
            nt_lti d;
            assert_int_equal(nt_lti_discretise(&continuous, t, &d), NT_OK);
            double error = fabs((o.xv - d.a[0][1]) / smaller(t, 1.0));
            error = larger(error, fabs((o.vf - d.b[1]) / smaller(t, 1.0)));
            error = larger(error, fabs((o.xf - d.b[0]) / smaller(t * t, 1.0)));
            error = larger(error, fabs(o.vv - d.a[1][1]));
            error = larger(error, fabs(1.0 - o.k * o.xf - d.a[0][0]));
            assert_true(error < 1e-14 * (1.0 + t) * (1.0 + dampings[i]));
        }
}

/* Without a spring: m x'' + b x' = f, and without damping: t^2/2. */
static void springless_limits(void **state)
{
    (void)state;
    for (double t = 1e-6; t < 1e3; t *= 10.0) {
        const nt_oscillator_constants free = {2.0, 0.0, 0.0}, drag = {2.0, 6.0, 0.0};
        nt_oscillator o = nt_oscillator_over(&free, t);
        assert_true(fabs(o.xf / (t * t / 4.0) - 1.0) < 1e-15 && o.vv == 1.0 && o.xv == t);
        o = nt_oscillator_over(&drag, t);
        assert_true(fabs(o.vf / (-expm1(-3.0 * t) / 6.0) - 1.0) < 1e-14);
        assert_true(fabs(o.vv - exp(-3.0 * t)) < 1e-15);
        if (t > 1.0)
            assert_true(fabs(o.xf / ((t + expm1(-3.0 * t) / 3.0) / 6.0) - 1.0) < 1e-14);
    }
}

/* Where the speed is said to be 0 it is 0, and nowhere before. */
static void turns_when_the_speed_is_zero(void **state)
{
    (void)state;
    static const double dampings[] = {0.0, 0.3, 2.0, 7.0}, pulls[] = {-40.0, -3.0, -0.5, 0.0, 0.5, 9.0};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 6; j++)
            for (double stiffness = 0.0; stiffness < 3.0; stiffness += 1.0) {
                const nt_oscillator_constants c = {1.0, dampings[i], stiffness};
                for (double speed = -2.0; speed < 3.0; speed += 4.0) {
                    const double until = nt_oscillator_turns_after(&c, pulls[j], speed);
                    assert_true(until > 0.0);
                    const double last = smaller(until, 50.0);
                    for (double share = 0.05; share < 0.96; share += 0.1) {
                        const nt_oscillator o = nt_oscillator_over(&c, share * last);
                        assert_true((o.vv * speed + o.vf * pulls[j]) * speed > 0.0 ||
                                    exp(-0.5 * dampings[i] * last) < 1e-14);
                    }
                    const nt_oscillator o = nt_oscillator_over(&c, until);
                    if (until < 50.0)
                        assert_true(fabs(o.vv * speed + o.vf * pulls[j]) < 1e-13 * 40.0);
                }
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_the_matrix_exponential),
        cmocka_unit_test(springless_limits),
        cmocka_unit_test(turns_when_the_speed_is_zero),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
