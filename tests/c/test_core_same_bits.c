/* SPDX-License-Identifier: BSD-3-Clause
 * Against the C library in long double, which is exact to 2^-64 on x86-64; where it is a double, to one ulp more. */
#include <float.h>

#include "assertions.h"
#include "core/same_bits.h"
#include "nanotouch/advanced/random.h"

#define BOUND (LDBL_MANT_DIG > DBL_MANT_DIG ? DBL_EPSILON : 2.0 * DBL_EPSILON)
enum { DRAWS = 200000 };

/* Of either sign, over all magnitudes between 10^-limit and 10^limit. */
static double draw(nt_random *random, double limit)
{
    const double size = pow(10.0, limit * (2.0 * nt_random_uniform(random) - 1.0));
    return nt_random_uniform(random) < 0.5 ? -size : size;
}

static void cube_roots_are_within_an_ulp(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(1);
    for (int i = 0; i < DRAWS; ++i) {
        const double x = draw(&random, 307.0);
        assert_within((double)((long double)cube_root(x) / cbrtl((long double)x) - 1.0L), 0.0, BOUND);
    }
}

static void cubes_have_whole_roots(void **state)
{
    (void)state;
    for (int i = -1000; i <= 1000; ++i)
        assert_within(cube_root((double)i * i * i), i, DBL_EPSILON * fabs((double)i));
    for (int i = -300; i <= 300; ++i)
        assert_true(cube_root(ldexp(1.0, 3 * i)) == ldexp(1.0, i));
    assert_true(cube_root(ldexp(1.0, -1074)) > 0.0 && cube_root(DBL_MAX) < 1e103); /* the ends */
}

static void what_is_no_number_stays_so(void **state)
{
    (void)state;
    assert_true(isnan(cube_root((double)NAN)) && isnan(hypotenuse((double)NAN, 1.0)) &&
                isnan(power_of_two((double)NAN)));
    assert_true(cube_root((double)INFINITY) == (double)INFINITY && cube_root(-(double)INFINITY) == -(double)INFINITY);
    assert_true(cube_root(0.0) == 0.0 && signbit(cube_root(-0.0)));
}

static void lengths_are_within_an_ulp(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(2);
    for (int i = 0; i < DRAWS; ++i) {
        const double a = draw(&random, 145.0), b = a * draw(&random, 4.0);
        assert_within((double)((long double)hypotenuse(a, b) / hypotl((long double)a, (long double)b) - 1.0L), 0.0,
                      BOUND);
    }
    assert_true(hypotenuse(3.0, -4.0) == 5.0 && hypotenuse(0.0, -2.0) == 2.0);
}

static void powers_of_two_are_exact_where_whole(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(3);
    for (int i = -999; i < 1000; ++i)
        assert_true(power_of_two((double)i) == ldexp(1.0, i));
    for (int i = 0; i < DRAWS; ++i) {
        const double x = 1000.0 * (2.0 * nt_random_uniform(&random) - 1.0);
        /* of the product in the exponent half an ulp, of exp less than one */
        assert_within((double)((long double)power_of_two(x) / exp2l((long double)x) - 1.0L), 0.0, 2.0 * BOUND);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cube_roots_are_within_an_ulp),        cmocka_unit_test(cubes_have_whole_roots),
        cmocka_unit_test(what_is_no_number_stays_so),          cmocka_unit_test(lengths_are_within_an_ulp),
        cmocka_unit_test(powers_of_two_are_exact_where_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
