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

static const nt_rim rims[] = {{0.0, 0.3}, {0.2, 0.3}, {0.3, 0.3}, {0.0, 2.7}, {2.7, 2.7}};

/* At the rim itself: Hertz on a cap, nothing on a flat. */
static void starts_from_the_cap(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof rims / sizeof rims[0]; i++) {
        const double cap = rims[i].cap;
        const nt_profile_point point = nt_rim_point(&rims[i], 0.0);
        assert_true(point.radius == 1.0);
        assert_within(point.depth, cap, DBL_EPSILON * cap);
        assert_within(point.force, 2.0 / 3.0 * cap, 2.0 * DBL_EPSILON * cap);
        assert_within(point.energy, 8.0 / 15.0 * cap * cap, 4.0 * DBL_EPSILON * cap * cap);
    }
}

/* dF = 2 E* a ddelta and dU = F ddelta along w, by central differences of step 1e-4: h^2 and rounding/h. */
static void differentials_hold_along_the_branch(void **state)
{
    (void)state;
    const double h = 1e-4;
    for (size_t i = 0; i < sizeof rims / sizeof rims[0]; i++)
        for (double w = 2e-4; w < 30.0; w = 1.2 * w + 0.01) {
            const nt_profile_point at = nt_rim_point(&rims[i], w);
            const nt_profile_point up = nt_rim_point(&rims[i], w + h), down = nt_rim_point(&rims[i], w - h);
            const double step = up.depth - down.depth;
            assert_within(up.force - down.force, at.radius * step, 1e-7 * at.radius * step + 1e-15 * at.force);
            assert_within(up.energy - down.energy, 2.0 * at.force * step, 1e-7 * at.force * step + 1e-15 * at.energy);
        }
}

/* The two series of Int gd (change at tanh(w/2) = sqrt(2) - 1, w = ln(1 + sqrt 2)) give the same there. */
static void forms_join(void **state)
{
    (void)state;
    const double w = log(1.0 + sqrt(2.0));
    const nt_profile_point below = nt_rim_point(&rims[0], w - 1e-7), above = nt_rim_point(&rims[0], w + 1e-7);
    const nt_profile_point at = nt_rim_point(&rims[0], w);
    assert_within(above.energy + below.energy, 2.0 * at.energy, 1e-12 * at.energy); /* second difference */
}

static void roots_are_found_from_the_smallest_to_the_largest(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof rims / sizeof rims[0]; i++)
        for (double x = 1e-305; x < 1e100; x *= 37.0) {
            const double depth = rims[i].cap + x, force = 2.0 / 3.0 * rims[i].cap + x;
            assert_within(nt_rim_point(&rims[i], nt_rim_find_depth(&rims[i], depth)).depth, depth, 1e-13 * depth);
            assert_within(nt_rim_point(&rims[i], nt_rim_find_force(&rims[i], force)).force, force, 1e-13 * force);
        }
    assert_true(isnan(nt_rim_find_depth(&rims[0], NAN)) && isnan(nt_rim_find_force(&rims[0], NAN)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(starts_from_the_cap),
        cmocka_unit_test(differentials_hold_along_the_branch),
        cmocka_unit_test(forms_join),
        cmocka_unit_test(roots_are_found_from_the_smallest_to_the_largest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
