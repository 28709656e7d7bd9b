/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/lti.h"
#include "larger.h"

/* Chain of four integrators: phi and gamma are the powers T^k / k!, to a few roundings. */
static void integrators_give_taylor_powers(void **state)
{
    (void)state;
    const nt_lti chain = {.order = 4, .a = {{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}, {0, 0, 0, 0}}, .b = {0, 0, 0, 1}};
    for (double period = 1e-6; period < 20.0; period *= 10.0) {
        nt_lti d;
        assert_int_equal(nt_lti_discretise(&chain, period, &d), NT_OK);
        double error = 0.0, power = 1.0;
        for (int k = 1; k <= 4; k++) {
            power *= period / k;
            error = larger(error, fabs(d.b[4 - k] / power - 1.0));
            if (k < 4)
                error = larger(error, fabs(d.a[0][k] / power - 1.0));
        }
        assert_true(error < 2e-14);
    }
}

/* A rotation with decay: exp(-s T) (cos, sin; -sin, cos), from 1e-6 to 1000 rad. The error of the phase grows as
 * omega T in any method, because omega T itself is rounded. */
static void rotation_keeps_its_phase(void **state)
{
    (void)state;
    const double decay = 0.01;
    const nt_lti rotation = {.order = 2, .a = {{-decay, 1.0}, {-1.0, -decay}}, .b = {decay, 1.0}};
    for (double period = 1e-6; period < 2000.0; period *= 10.0) {
        nt_lti d;
        assert_int_equal(nt_lti_discretise(&rotation, period, &d), NT_OK);
        const double size = exp(-decay * period), c = size * cos(period), s = size * sin(period);
        double error = fabs(d.a[0][0] - c);
        error = larger(error, fabs(d.a[0][1] - s));
        error = larger(error, fabs(d.a[1][0] + s));
        error = larger(error, fabs(d.a[1][1] - c));
        /* gamma = A^-1 (phi - 1) B; A^-1 = (-decay, -1; 1, -decay) / (1 + decay^2). */
        const double p = (c - 1.0) * decay + s, q = -s * decay + (c - 1.0);
        error = larger(error, fabs(d.b[0] - (-decay * p - q) / (1.0 + decay * decay)));
        error = larger(error, fabs(d.b[1] - (p - decay * q) / (1.0 + decay * decay)));
        assert_true(error < 4e-15 * (1.0 + period));
    }
}

/* A fast decay beside a slow one: exact in both, whatever their ratio. */
static void stiff_decays_stay_exact(void **state)
{
    (void)state;
    for (double rate = 1.0; rate < 1e9; rate *= 10.0) {
        const nt_lti pair = {.order = 2, .a = {{-rate, 0.0}, {0.0, -0.5}}, .b = {rate, 0.5}};
        nt_lti d;
        assert_int_equal(nt_lti_discretise(&pair, 1.0, &d), NT_OK);
        assert_true(fabs(d.a[0][0] - exp(-rate)) < 4e-16);
        assert_true(fabs(d.b[0] + expm1(-rate)) < 1e-15);
        assert_true(fabs(d.a[1][1] - exp(-0.5)) < 1e-14 * rate); /* scaled along with the fast one */
        assert_true(fabs(d.a[1][1] - exp(-0.5)) < 1e-7);
    }
}

static void half_steps_compose(void **state)
{
    (void)state;
    const nt_lti system = {
        .order = 3, .a = {{-1.0, 2.0, 0.3}, {-4.0, 0.1, 0.7}, {0.2, -0.5, -2.0}}, .b = {0.4, -1.0, 0.9}};
    nt_lti whole, half;
    assert_int_equal(nt_lti_discretise(&system, 1.4, &whole), NT_OK);
    assert_int_equal(nt_lti_discretise(&system, 0.7, &half), NT_OK);
    for (int i = 0; i < 3; i++) {
        double b = half.b[i];
        for (int j = 0; j < 3; j++) {
            double a = 0.0;
            for (int k = 0; k < 3; k++)
                a += half.a[i][k] * half.a[k][j];
            assert_true(fabs(a - whole.a[i][j]) < 1e-14);
            b += half.a[i][j] * half.b[j];
        }
        assert_true(fabs(b - whole.b[i]) < 1e-14);
    }
}

static void refuses_what_it_cannot_do(void **state)
{
    (void)state;
    nt_lti d = {.order = 99};
    nt_lti system = {.order = 1, .a = {{-1.0}}, .b = {1.0}};
    assert_int_equal(nt_lti_discretise(&system, 0.0, &d), NT_E_RANGE);
    assert_int_equal(nt_lti_discretise(&system, -1.0, &d), NT_E_RANGE);
    assert_int_equal(nt_lti_discretise(&system, 1e13, &d), NT_E_RANGE);
    assert_int_equal(nt_lti_discretise(&system, (double)NAN, &d), NT_E_NOT_FINITE);
    system.b[0] = (double)INFINITY;
    assert_int_equal(nt_lti_discretise(&system, 1.0, &d), NT_E_NOT_FINITE);
    system.order = NT_LTI_MAX + 1;
    assert_int_equal(nt_lti_discretise(&system, 1.0, &d), NT_E_ARGUMENT);
    assert_int_equal(d.order, 99); /* untouched */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integrators_give_taylor_powers), cmocka_unit_test(rotation_keeps_its_phase),
        cmocka_unit_test(stiff_decays_stay_exact),        cmocka_unit_test(half_steps_compose),
        cmocka_unit_test(refuses_what_it_cannot_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
