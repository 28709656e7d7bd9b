/* SPDX-License-Identifier: BSD-3-Clause
 * Folds of Maugis-Dugdale against the mpmath solution of the printed equations (tests/reference/maugis_folds.py). */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "contact/maugis/folds.h"
#include "larger.h"
#include "maugis_fixture.h"

typedef struct {
    double lambda;
    double pull_off_load, pull_off_radius, pull_off_indentation;
    double grip_load, grip_radius, grip_indentation;
    double zero_load_radius, zero_load_indentation;
} reference;

static const reference folds[] = {
#include "../reference/maugis_folds.inc"
};

/* In units of 2^-53 of the value. Loads and indentations are differences of terms some times larger; the displacement
 * fold begins at lambda_0, where its radius rises from 0: an error of lambda counts there as lambda/(lambda -
 * lambda_0). Measured: 28 (of an indentation, a^2 less as much again) and, of the radius of the grip, 13. */
static double worst_of(const reference *r)
{
    const nt_maugis maugis = reduced(r->lambda);
    const nt_maugis_folds *f = &maugis.folds;
    const double pairs[][2] = {
        {f->pull_off_load, r->pull_off_load},
        {f->pull_off_radius, r->pull_off_radius},
        {f->grip_load, r->grip_load},
        {f->grip_indentation, r->grip_indentation},
        {f->zero_load_radius, r->zero_load_radius},
        {f->zero_load_indentation, r->zero_load_indentation},
    };
    double worst = 0.0;
    for (size_t i = 0; i < COUNT(pairs); i++)
        worst = larger(worst, fabs(pairs[i][0] - pairs[i][1]) / (UNIT_ROUNDING * fabs(pairs[i][1])));
    const double square = r->pull_off_radius * r->pull_off_radius; /* d = a^2 - .. */
    const double d = larger(fabs(r->pull_off_indentation), square);
    return larger(worst, fabs(f->pull_off_indentation - r->pull_off_indentation) / (UNIT_ROUNDING * d));
}

static void folds_are_right_to_rounding(void **state)
{
    (void)state;
    double worst = 0.0, worst_grip = 0.0;
    for (size_t i = 0; i < COUNT(folds); i++) {
        const nt_maugis maugis = reduced(folds[i].lambda);
        const double a = folds[i].grip_radius, beyond = fabs(folds[i].lambda - 0.93794745721071221);
        worst = larger(worst, worst_of(&folds[i]));
        assert_int_equal(maugis.folds.grip_in_contact, a > 0.0);
        assert_int_equal(maugis.fold_y > 0.0, a > 0.0);
        if (a > 0.0)
            worst_grip = larger(worst_grip, fabs(maugis.folds.grip_radius / a - 1.0) / UNIT_ROUNDING /
                                                (1.0 + 0.5 * UNIT_ROUNDING / beyond));
        else
            assert_true(maugis.folds.grip_radius == 0.0);
    }
    print_message("worst %.3g, radius of the grip %.3g\n", worst, worst_grip);
    assert_true(worst < 32.0);
    assert_true(worst_grip < 32.0);
}

/* No step where one polynomial ends and the next begins, and none at lambda = 1, where the variable changes. */
static void folds_are_continuous(void **state)
{
    (void)state;
    for (int i = 1; i < 8; i++) {
        const double t = i / 8.0, at[] = {t * t, 1.0 / t, 1.0};
        for (size_t j = 0; j < COUNT(at); j++) {
            const nt_maugis below = reduced(nextafter(at[j], 0.0)), above = reduced(nextafter(at[j], HUGE_VAL));
            assert_within(above.load_fold_y, below.load_fold_y, 8.0 * DBL_EPSILON * below.load_fold_y);
            assert_within(above.folds.zero_load_radius, below.folds.zero_load_radius,
                          8.0 * DBL_EPSILON * below.folds.zero_load_radius);
        }
    }
}

/* The ends of what is valid are DMT and JKR: loads -2 and -1.5, at a = 0 and 1.5^(1/3) (JKR: a^3 = 3/2). */
static void ends_are_dmt_and_jkr(void **state)
{
    (void)state;
    const nt_maugis dmt = reduced(NT_MAUGIS_LAMBDA_MIN), jkr = reduced(NT_MAUGIS_LAMBDA_MAX);
    assert_within(dmt.folds.pull_off_load, -2.0, 4.0 * DBL_EPSILON);
    assert_within(dmt.folds.pull_off_radius, 0.0, 1e-10);
    assert_within(jkr.folds.pull_off_load, -1.5, 4.0 * DBL_EPSILON);
    assert_within(jkr.folds.pull_off_radius, cbrt(1.5), 8.0 * DBL_EPSILON);
    assert_within(jkr.folds.grip_load, -5.0 / 6.0, 8.0 * DBL_EPSILON);
    assert_true(nt_maugis_grip_parameter(0.9379474572107121) == 0.0);
    assert_true(nt_maugis_grip_parameter(0.9379474572107124) > 0.0);
    assert_true(nt_maugis_grip_parameter(5.8) == reduced(5.8).fold_y);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(folds_are_right_to_rounding),
        cmocka_unit_test(folds_are_continuous),
        cmocka_unit_test(ends_are_dmt_and_jkr),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
