/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/surface.h"

static void defaults_are_tgz_03(void **state)
{
    (void)state;
    const nt_grating g = nt_grating_defaults();
    assert_true(g.period == 3e-6 && g.height == 480e-9 && g.duty == 0.5 && g.offset == 0.75e-6);
    assert_true(nt_grating_height(&g, 0.5e-6, 0.0) == 0.0);
    assert_true(nt_grating_height(&g, 0.8e-6, 0.0) == 480e-9);
    assert_true(nt_grating_height(&g, 2.2e-6, 0.0) == 480e-9);
    assert_true(nt_grating_height(&g, 2.3e-6, 0.0) == 0.0);
}

/* Periodic on both sides of 0, the same along y, and the ridge takes its share. */
static void repeats_and_keeps_its_duty(void **state)
{
    (void)state;
    const nt_grating g = {.period = 1e-6, .height = 1e-7, .duty = 0.3, .offset = -0.2e-6};
    int ridge = 0;
    for (int k = 0; k < 10000; k++) {
        const double x = -5e-6 + (k + 0.5) * 1e-9;
        const double z = nt_grating_height(&g, x, 0.0);
        assert_true(z == nt_grating_height(&g, x + 7e-6, 3.0));
        ridge += z > 0.0;
    }
    assert_int_equal(ridge, 3000);
}

static void nan_in_nan_out(void **state)
{
    (void)state;
    const nt_grating g = nt_grating_defaults();
    assert_true(isnan(nt_grating_height(&g, (double)NAN, 0.0)));
    assert_true(isnan(nt_grating_height(&g, 0.0, (double)NAN)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_tgz_03),
        cmocka_unit_test(repeats_and_keeps_its_duty),
        cmocka_unit_test(nan_in_nan_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
