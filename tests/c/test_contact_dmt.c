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
#include "nanotouch/material.h"

static const nt_contact silicon = {20e-9, 76.9e9, 0.144, 7e8};

/* Hertz under a constant pull 2 pi R w (paper, Eq. 9). */
static void is_hertz_minus_the_pull_off_force(void **state)
{
    (void)state;
    const double pull_off = 2.0 * NT_PI * 20e-9 * 0.144;
    assert_within(nt_dmt_pull_off_force(&silicon), pull_off, 4.0 * DBL_EPSILON * pull_off);
    assert_true(nt_dmt_force(&silicon, 0.0) == -nt_dmt_pull_off_force(&silicon));
    for (double d = 1e-14; d < 1e-7; d *= 2.3) {
        const nt_law_value value = nt_dmt_eval(&silicon, d), hertz = nt_hertz_eval(&silicon, d);
        assert_within(value.F, hertz.F - pull_off, 4.0 * DBL_EPSILON * (hertz.F + pull_off));
        assert_within(value.U, hertz.U - pull_off * d, 4.0 * DBL_EPSILON * (hertz.U + pull_off * d));
        assert_true(value.k == hertz.k && value.a == hertz.a && nt_dmt_force(&silicon, d) == value.F);
    }
}

static void inversion(void **state)
{
    (void)state;
    for (double d = 1e-12; d < 1e-6; d *= 1.9) {
        const nt_law_value value = nt_dmt_eval(&silicon, d);
        const double rounding = (fabs(value.F) + nt_dmt_pull_off_force(&silicon)) / value.k;
        assert_within(nt_dmt_indentation(&silicon, value.F), d, 8.0 * DBL_EPSILON * (d + rounding));
    }
    assert_true(nt_dmt_indentation(&silicon, -nt_dmt_pull_off_force(&silicon)) == 0.0);
    assert_true(isnan(nt_dmt_indentation(&silicon, -1.001 * nt_dmt_pull_off_force(&silicon))));
}

static void apart_no_adhesion_and_nan(void **state)
{
    (void)state;
    const nt_law_value apart = nt_dmt_eval(&silicon, -1e-300), nan = nt_dmt_eval(&silicon, NAN);
    assert_true(apart.U == 0.0 && apart.F == 0.0 && apart.k == 0.0 && apart.a == 0.0);
    assert_true(isnan(nan.U) && isnan(nan.F) && isnan(nan.k) && isnan(nan.a));
    const nt_contact hertz = {20e-9, 76.9e9, 0.0, 0.0};
    for (double d = -1e-9; d < 1e-8; d += 1e-10)
        assert_true(nt_dmt_force(&hertz, d) == nt_hertz_force(&hertz, d));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_hertz_minus_the_pull_off_force),
        cmocka_unit_test(inversion),
        cmocka_unit_test(apart_no_adhesion_and_nan),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
