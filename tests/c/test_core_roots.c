/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/roots.h"

static double shifted_cube(double x, const void *context)
{
    return x * x * x - *(const double *)context;
}

static double steep(double x, const void *context)
{
    (void)context;
    return tanh(1e6 * (x - 0.3)); /* flat but for a millionth of the bracket */
}

static double triple_root(double x, const void *context)
{
    (void)context;
    return (x - 1.0) * (x - 1.0) * (x - 1.0);
}

static double broken(double x, const void *context)
{
    (void)context;
    return x < 0.0 ? -1.0 : (double)NAN;
}

/* Chandrupatla stops at neighbouring doubles: 1 ulp of cbrt, itself within 1 ulp. */
static void finds_roots_to_the_last_bits(void **state)
{
    (void)state;
    for (double c = 1e-30; c < 1e30; c *= 7.3) {
        const double bracket[2] = {0.0, 2.0 * cbrt(c) + 1e-3};
        double root;
        nt_solve_info info;
        assert_int_equal(nt_root_find(shifted_cube, &c, bracket, &root, &info), NT_OK);
        assert_true(fabs(root - cbrt(c)) <= 2.0 * DBL_EPSILON * cbrt(c));
        assert_in_range(info.iterations, 2, 120);
    }
}

static void finds_hard_roots(void **state)
{
    (void)state;
    const double bracket[2] = {-10.0, 20.0};
    double root;
    assert_int_equal(nt_root_find(steep, NULL, bracket, &root, NULL), NT_OK);
    assert_true(fabs(root - 0.3) < 1e-15);
    assert_int_equal(nt_root_find(triple_root, NULL, bracket, &root, NULL), NT_OK);
    assert_true(fabs(root - 1.0) < 1e-5); /* a triple root: flat below the rounding of x^3 */
}

static void refuses_what_is_no_bracket(void **state)
{
    (void)state;
    const double c = 8.0, bracket[2] = {3.0, 4.0}, wide[2] = {-1.0, 1.0};
    double root = -7.0;
    assert_int_equal(nt_root_find(shifted_cube, &c, bracket, &root, NULL), NT_E_RANGE);
    assert_int_equal(nt_root_find(broken, NULL, wide, &root, NULL), NT_E_NOT_FINITE);
    assert_true(root == -7.0);
}

static void root_at_an_end(void **state)
{
    (void)state;
    const double c = 8.0, bracket[2] = {2.0, 4.0};
    double root;
    assert_int_equal(nt_root_find(shifted_cube, &c, bracket, &root, NULL), NT_OK);
    assert_true(root == 2.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_roots_to_the_last_bits),
        cmocka_unit_test(finds_hard_roots),
        cmocka_unit_test(refuses_what_is_no_bracket),
        cmocka_unit_test(root_at_an_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
