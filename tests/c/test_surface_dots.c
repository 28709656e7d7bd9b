/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "nanotouch/surface.h"

static void scatter_is_apart_inside_and_repeatable(void **state)
{
    (void)state;
    nt_dots dots, same, other;
    for (uint64_t seed = 0; seed < 20; seed++) {
        memset(&same, 0, sizeof same);
        memset(&dots, 0, sizeof dots);
        assert_int_equal(nt_dots_scatter(&dots, NT_DOTS_MAX, 500e-9, seed), NT_OK);
        assert_int_equal(nt_dots_scatter(&same, NT_DOTS_MAX, 500e-9, seed), NT_OK);
        assert_int_equal(nt_dots_scatter(&other, NT_DOTS_MAX, 500e-9, seed + 1), NT_OK);
        assert_int_equal(dots.count, NT_DOTS_MAX);
        for (int a = 0; a < dots.count; a++) {
            assert_true(dots.dot[a].x == same.dot[a].x && dots.dot[a].y == same.dot[a].y);
            assert_true(dots.dot[a].x != other.dot[a].x);
            const double d = dots.dot[a].diameter;
            assert_true(d >= 10e-9 && d <= 30e-9 && dots.dot[a].height == d / 3.0);
            assert_true(dots.dot[a].x >= d / 2 && dots.dot[a].x <= 500e-9 - d / 2);
            assert_true(dots.dot[a].y >= d / 2 && dots.dot[a].y <= 500e-9 - d / 2);
            for (int b = 0; b < a; b++)
                assert_true(hypot(dots.dot[a].x - dots.dot[b].x, dots.dot[a].y - dots.dot[b].y) >=
                            (d + dots.dot[b].diameter) / 2);
        }
    }
}

static void cap_is_a_sphere(void **state)
{
    (void)state;
    const nt_dots dots = {.count = 1, .dot = {{.x = 50e-9, .y = 20e-9, .diameter = 30e-9, .height = 10e-9}}};
    const double radius = (15e-9 * 15e-9 + 10e-9 * 10e-9) / 20e-9, centre = 10e-9 - radius;
    assert_true(fabs(nt_dots_height(&dots, 50e-9, 20e-9) - 10e-9) < 1e-23);
    for (double r = 0.0; r < 15e-9; r += 0.1e-9) {
        const double z = nt_dots_height(&dots, 50e-9 + 0.6 * r, 20e-9 - 0.8 * r);
        assert_true(fabs(hypot(r, z - centre) - radius) < 1e-22); /* every point at the radius from the centre */
    }
    assert_true(nt_dots_height(&dots, 50e-9 + 14.999999e-9, 20e-9) < 1e-13);
    assert_true(nt_dots_height(&dots, 50e-9, 36e-9) == 0.0);
    assert_true(isnan(nt_dots_height(&dots, (double)NAN, 0.0)) && isnan(nt_dots_height(&dots, 0.0, (double)NAN)));
}

static void refuses_what_does_not_fit(void **state)
{
    (void)state;
    nt_dots dots = {.count = -7};
    assert_int_equal(nt_dots_scatter(&dots, 0, 1e-6, 1), NT_E_RANGE);
    assert_int_equal(nt_dots_scatter(&dots, NT_DOTS_MAX + 1, 1e-6, 1), NT_E_RANGE);
    assert_int_equal(nt_dots_scatter(&dots, 5, -1e-6, 1), NT_E_RANGE);
    assert_int_equal(nt_dots_scatter(&dots, 5, (double)NAN, 1), NT_E_NOT_FINITE);
    assert_int_equal(nt_dots_scatter(&dots, 64, 60e-9, 1), NT_E_CAPACITY);
    assert_int_equal(nt_dots_scatter(&dots, 1, 5e-9, 1), NT_E_CAPACITY);
    assert_int_equal(dots.count, -7); /* untouched */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scatter_is_apart_inside_and_repeatable),
        cmocka_unit_test(cap_is_a_sphere),
        cmocka_unit_test(refuses_what_does_not_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
