/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale against 11 580 random cases in each direction (tests/reference/maugis_cases.py), lambda 1e-12 .. 1e12,
 * 30 % within 1e-10 .. 1 of a fold. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "larger.h"
#include "maugis_fixture.h"

/* other = load or indentation, the one that is not given; rate, radius_rate: its slope and that of a. */
typedef struct {
    double lambda;
    int unstable;
    double given, other, a, rate, radius_rate;
} reference;

static const reference indentations[] = {
#include "../reference/maugis_indentations.inc"
};
static const reference loads[] = {
#include "../reference/maugis_loads.inc"
#include "internal/contact.h"
};

static nt_maugis prepared(double lambda)
{
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
    nt_maugis maugis;
    assert_int_equal(nt_maugis_init_lambda(&maugis, &contact, lambda), NT_OK);
    return maugis;
}

/* Error in units of 2^-53 of what one rounding of the result and one of the input amount to; none of a radius of 0
 * whose rate is 0, too. */
static double ulps(double error, double scale, double rate, double given)
{
    return error == 0.0 ? 0.0 : fabs(error) / (UNIT_ROUNDING * (scale + fabs(rate * given)));
}

/* Measured: force 17, radius 7. Raw: where k d is not above the force, 1e-13. */
static void forces_at_indentations(void **state)
{
    (void)state;
    nt_maugis maugis = {.lambda = 0.0};
    double worst = 0.0, worst_radius = 0.0;
    for (size_t i = 0; i < COUNT(indentations); i++) {
        const reference *r = &indentations[i];
        if (maugis.lambda != r->lambda)
            maugis = prepared(r->lambda);
        const nt_law_value value = eval(&maugis, r->given, branch_of(r->unstable));
        const double force = larger(fabs(r->other), nt_maugis_pull_off_force(&maugis));
        worst = larger(worst, ulps(value.F - r->other, force, r->rate, r->given));
        worst_radius = larger(worst_radius, ulps(value.a - r->a, r->a, r->radius_rate, r->given));
        if (fabs(r->rate * r->given) < force)
            assert_within(value.F, r->other, 1e-13 * force);
    }
    print_message("F: %.1f, a: %.1f\n", worst, worst_radius);
    assert_true(worst <= 32.0 && worst_radius <= 32.0);
    assert_true(COUNT(indentations) > 11000);
}

/* Measured: 20. */
static void indentations_at_loads(void **state)
{
    (void)state;
    nt_maugis maugis = {.lambda = 0.0};
    double worst = 0.0;
    for (size_t i = 0; i < COUNT(loads); i++) {
        const reference *r = &loads[i];
        if (maugis.lambda != r->lambda)
            maugis = prepared(r->lambda);
        double value;
        assert_int_equal(nt_maugis_indentation(&maugis, r->given, branch_of(r->unstable), &value, NULL), NT_OK);
        const double scale = fabs(r->other) + fabs(maugis.folds.pull_off_indentation);
        worst = larger(worst, ulps(value - r->other, scale, r->rate, r->given));
    }
    print_message("delta: %.1f\n", worst);
    assert_true(worst <= 32.0);
    assert_true(COUNT(loads) > 11000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forces_at_indentations),
        cmocka_unit_test(indentations_at_loads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
