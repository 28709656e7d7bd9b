/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "contact/shapes/profile.h"

/* Sneddon's printed equations, which lose digits as (R/a)^2 for small a. */
static void is_sneddons_sphere(void **state)
{
    (void)state;
    for (double u = 0.05; u < 6.0; u *= 1.3) {
        const nt_profile_point point = nt_sphere_point(u);
        const double a = point.radius, log_ratio = log((1.0 + a) / (1.0 - a));
        assert_within(point.depth, 0.5 * a * log_ratio, 1e-11 * point.depth);
        assert_within(2.0 * point.force, 0.5 * (a * a + 1.0) * log_ratio - a, 1e-11 * point.force);
    }
}

/* Both forms of u - tanh(u) (change at u = 1) and of the second moment (change at a/R = 1/2) give the same there. */
static void forms_join(void **state)
{
    (void)state;
    const double joins[2] = {1.0, 0.54930614433405484570};
    for (int i = 0; i < 2; i++) {
        const nt_profile_point below = nt_sphere_point(joins[i] * (1.0 - 4.0 * DBL_EPSILON));
        const nt_profile_point above = nt_sphere_point(joins[i] * (1.0 + 4.0 * DBL_EPSILON));
        assert_within(above.force, below.force, 40.0 * DBL_EPSILON * above.force);
        assert_within(above.energy, below.energy, 60.0 * DBL_EPSILON * above.energy);
    }
}

/* Far beyond the sphere's own size: a = R, delta = u, F = E* R^2 (2 u - 1); U = u^2 - u + 1/3 + pi^2/36 (closed form at
 * t = 1: g^2 - 2 g (1/2) + u^2/3 + 1/3 - 2/3 (u^2/2 - pi^2/24)). */
static void far_end_is_a_cylinder(void **state)
{
    (void)state;
    const double u = 40.0, pi = acos(-1.0);
    const nt_profile_point point = nt_sphere_point(u);
    assert_within(point.radius, 1.0, DBL_EPSILON);
    assert_within(2.0 * point.force, 2.0 * u - 1.0, 1e-14 * u);
    assert_within(point.energy, u * u - u + 1.0 / 3.0 + pi * pi / 36.0, 1e-14 * u * u);
}

static void roots_are_found_from_the_smallest_to_the_largest(void **state)
{
    (void)state;
    for (double x = 1e-300; x < 1e300; x *= 37.0) {
        const double u = nt_sphere_find_depth(x), v = nt_sphere_find_force(x);
        assert_within(u * tanh(u), x, 4.0 * DBL_EPSILON * x);
        assert_within(nt_sphere_point(v).force, x, 8.0 * DBL_EPSILON * x);
    }
    assert_true(isnan(nt_sphere_find_depth(NAN)) && isnan(nt_sphere_find_force(NAN)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_sneddons_sphere),
        cmocka_unit_test(forms_join),
        cmocka_unit_test(far_end_is_a_cylinder),
        cmocka_unit_test(roots_are_found_from_the_smallest_to_the_largest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
