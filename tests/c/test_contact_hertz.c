/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "internal/contact.h"
#include "nanotouch/contact.h"

static const nt_contact silicon = {20e-9, 76.9e9, 0.144, 7e8};

/* F = K a delta, K = 4/3 E*, a^2 = R delta (paper, Eq. 4). */
static void is_the_published_law(void **state)
{
    (void)state;
    for (double d = 1e-15; d < 1e-6; d *= 3.7) {
        const nt_law_value value = nt_hertz_eval(&silicon, d);
        const double a = sqrt(20e-9 * d), F = 4.0 / 3.0 * 76.9e9 * a * d;
        assert_within(value.a, a, 4.0 * DBL_EPSILON * a);
        assert_within(value.F, F, 8.0 * DBL_EPSILON * F);
        assert_true(nt_hertz_force(&silicon, d) == value.F);
    }
    /* by hand: R = 20 nm, E* = 76.9 GPa, 1 nm: 4/3 * 76.9e9 * sqrt(20e-9) * (1e-9)^1.5 = 458.5 nN */
    assert_within(nt_hertz_force(&silicon, 1e-9), 458.5e-9, 0.1e-9);
}

/* U and k scale as delta^2.5 and delta^0.5: exact relations. */
static void energy_and_stiffness_belong_to_the_force(void **state)
{
    (void)state;
    for (double d = 1e-15; d < 1e-6; d *= 3.7) {
        const nt_law_value value = nt_hertz_eval(&silicon, d);
        assert_within(value.U, 0.4 * value.F * d, 4.0 * DBL_EPSILON * value.U);
        assert_within(value.k, 1.5 * value.F / d, 4.0 * DBL_EPSILON * value.k);
        const double h = 1e-4 * d;
        const double slope = (nt_hertz_force(&silicon, d + h) - nt_hertz_force(&silicon, d - h)) / (2.0 * h);
        assert_within(value.k, slope, 1e-8 * value.k); /* truncation (h/d)^2/24 */
    }
}

static void inversion(void **state)
{
    (void)state;
    for (double d = 1e-30; d < 1e3; d *= 9.1)
        assert_within(nt_hertz_indentation(&silicon, nt_hertz_force(&silicon, d)), d, 8.0 * DBL_EPSILON * d);
    assert_true(nt_hertz_indentation(&silicon, 0.0) == 0.0);
    assert_true(isnan(nt_hertz_indentation(&silicon, -1e-9)));
}

static void nothing_outside_and_nan_through(void **state)
{
    (void)state;
    const double apart[] = {0.0, -1e-300, -1.0, -INFINITY};
    for (size_t i = 0; i < sizeof apart / sizeof *apart; i++) {
        const nt_law_value value = nt_hertz_eval(&silicon, apart[i]);
        assert_true(value.U == 0.0 && value.F == 0.0 && value.k == 0.0 && value.a == 0.0);
    }
    const nt_law_value value = nt_hertz_eval(&silicon, NAN);
    assert_true(isnan(value.U) && isnan(value.F) && isnan(value.k) && isnan(value.a));
    assert_true(isnan(nt_hertz_indentation(&silicon, NAN)));
    assert_true(isinf(nt_hertz_force(&silicon, INFINITY)));
}

static void extremes_stay_finite(void **state)
{
    (void)state;
    for (double R = 1e-10; R < 2.0; R *= 1e2)
        for (double E = 1e2; E < 2e13; E *= 1e2) {
            const nt_contact contact = {R, E, 0.0, 0.0};
            for (double d = 1e-300; d < 1.0; d *= 1e10) {
                const nt_law_value value = nt_hertz_eval(&contact, d);
                assert_true(isfinite(value.U) && isfinite(value.F) && value.k > 0.0 && value.a > 0.0);
            }
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_the_published_law),
        cmocka_unit_test(energy_and_stiffness_belong_to_the_force),
        cmocka_unit_test(inversion),
        cmocka_unit_test(nothing_outside_and_nan_through),
        cmocka_unit_test(extremes_stay_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
