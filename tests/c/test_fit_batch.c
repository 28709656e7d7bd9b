/* SPDX-License-Identifier: BSD-3-Clause
 * Many recorded curves at once: each as if it were alone, whatever the threads and the others. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <string.h>

#include "nanotouch/fit.h"

enum { POINTS = 400, CURVES = 12 };

static const double radius = 20e-9, modulus = 2e8, spring_constant = 1.0, noise = 20e-12;
static const double contact_point = 100e-9, depth = 30e-9, clearance = 200e-9, offset = 1e-9, tilt = 1e-3;

static double z_[2][POINTS], force_[CURVES][2][POINTS];

/* Force of Hertz at a height of the base: delta + F/k_c = contact point - z, by bisection. */
static double hertz(double z)
{
    double low = 0.0, high = contact_point - z;
    if (high <= 0.0)
        return 0.0;
    for (int i = 0; i < 80; i++) {
        const double delta = 0.5 * (low + high);
        const double force = 4.0 / 3.0 * modulus * sqrt(radius) * pow(delta, 1.5);
        if (delta + force / spring_constant > contact_point - z)
            high = delta;
        else
            low = delta;
    }
    return 4.0 / 3.0 * modulus * sqrt(radius) * pow(low, 1.5);
}

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

static nt_curve curve_of(int i)
{
    const nt_curve_segment approach = {z_[0], force_[i][0], POINTS}, retract = {z_[1], force_[i][1], POINTS};
    const nt_curve curve = {approach, retract, spring_constant, 0.0, 0.0};
    return curve;
}

static int make(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int i = 0; i < POINTS; i++) {
        z_[1][i] = contact_point - depth + (depth + clearance) * i / (POINTS - 1);
        z_[0][POINTS - 1 - i] = z_[1][i];
    }
    for (int c = 0; c < CURVES; c++)
        for (int branch = 0; branch < 2; branch++)
            for (int i = 0; i < POINTS; i++) {
                const double z = z_[branch][i];
                double sum = -6.0; /* of twelve uniform numbers: Gaussian enough, variance 1 */
                for (int k = 0; k < 12; k++)
                    sum += uniform(&seed);
                force_[c][branch][i] = hertz(z) + offset + tilt * z + noise * sum;
            }
    return 0;
}

static nt_fit_recipe recipe_of(void)
{
    nt_fit_recipe recipe = nt_fit_recipe_defaults(NT_FIT_HERTZ);
    recipe.options.radius = radius;
    return recipe;
}

static void run(const nt_curve *curves, int count, int threads, nt_fit_outcome *outcome)
{
    const nt_fit_recipe recipe = recipe_of();
    const nt_fit_curves all = {curves, count, threads};
    assert_int_equal(nt_fit_batch(&recipe, &all, outcome), NT_OK);
}

static void finds_modulus_contact_point_and_baseline(void **state)
{
    (void)state;
    nt_fit_outcome outcome[CURVES];
    nt_curve curves[CURVES];
    double pull = 0.0;
    for (int i = 0; i < CURVES; i++)
        curves[i] = curve_of(i);
    run(curves, CURVES, 2, outcome);
    for (int i = 0; i < CURVES; i++) {
        const nt_fit_result *fit = &outcome[i].fit;
        assert_int_equal(outcome[i].status, NT_OK);
        assert_true(fit->identifiable[NT_FIT_EFFECTIVE_MODULUS]);
        /* five standard uncertainties: less than one in a million; and the uncertainty is a useful one */
        assert_true(fabs(fit->value[NT_FIT_EFFECTIVE_MODULUS] - modulus) < 5.0 * fit->sigma[NT_FIT_EFFECTIVE_MODULUS]);
        assert_true(fit->sigma[NT_FIT_EFFECTIVE_MODULUS] < 0.1 * modulus);
        assert_true(fabs(-fit->value[NT_FIT_CONTACT_POINT] - contact_point) < 5.0 * fit->sigma[NT_FIT_CONTACT_POINT]);
        assert_true(fabs(outcome[i].reading.baseline_tilt - tilt) < 0.1 * tilt); /* 20 pN over 0.2 um: 1e-5 N/m */
        assert_true(fabs(outcome[i].reading.noise - noise) < 0.3 * noise);       /* the contact's slope is in it too */
        assert_true(outcome[i].reading.pull_off_force.value == 0.0);
        pull += (fit->value[NT_FIT_EFFECTIVE_MODULUS] - modulus) / fit->sigma[NT_FIT_EFFECTIVE_MODULUS] / CURVES;
    }
    assert_true(fabs(pull) < 4.0 / sqrt(CURVES)); /* no common bias */
}

static void threads_and_neighbours_change_no_bit(void **state)
{
    (void)state;
    static nt_fit_outcome alone[CURVES], together[CURVES];
    nt_curve curves[CURVES];
    for (int i = 0; i < CURVES; i++) {
        curves[i] = curve_of(i);
        run(&curves[i], 1, 1, &alone[i]);
    }
    for (int threads = 0; threads <= 5; threads++) {
        run(curves, CURVES, threads, together);
        for (int i = 0; i < CURVES; i++) {
            assert_memory_equal(alone[i].fit.value, together[i].fit.value, sizeof alone[i].fit.value);
            assert_memory_equal(alone[i].fit.sigma, together[i].fit.sigma, sizeof alone[i].fit.sigma);
            assert_int_equal(alone[i].flags, together[i].flags);
        }
    }
}

static void bad_curves_say_what_is_wrong(void **state)
{
    (void)state;
    static double bad[4][POINTS];
    nt_curve curves[7];
    nt_fit_outcome outcome[7];
    for (int i = 0; i < 7; i++)
        curves[i] = curve_of(i);
    for (int i = 0; i < 4; i++)
        memcpy(bad[i], force_[i][0], sizeof bad[i]);
    bad[0][7] = NAN;
    bad[1][3] = 1e12;
    for (int i = 0; i < POINTS; i++)
        bad[2][i] = 1e-9;
    for (int i = 0; i < 3; i++)
        curves[i].approach.force = bad[i];
    curves[3].approach.count = 0;
    curves[4].approach.count = NT_CURVE_FEWEST - 1;
    curves[5].spring_constant = -1.0;
    run(curves, 7, 2, outcome);
    const nt_status expected[7] = {NT_E_NOT_FINITE, NT_E_RANGE, NT_E_RANGE, NT_E_RANGE, NT_E_RANGE, NT_E_RANGE, NT_OK};
    const char *field[6] = {"force", "force", "force (span)", "approach.count", "approach.count", "spring_constant"};
    for (int i = 0; i < 7; i++)
        assert_int_equal(outcome[i].status, expected[i]);
    for (int i = 0; i < 6; i++) {
        assert_string_equal(outcome[i].problem.field, field[i]);
        assert_true(isnan(outcome[i].fit.value[NT_FIT_EFFECTIVE_MODULUS]));
        assert_true(isnan(outcome[i].fit.residual_rms));
        assert_int_equal(outcome[i].flags, 0);
    }
    assert_true(isnan(outcome[0].reading.noise));
    assert_true(outcome[3].reading.noise > 0.0); /* the retraction was read */
}

static void wrong_recipes_are_refused(void **state)
{
    (void)state;
    nt_problem problem;
    nt_fit_recipe recipe = recipe_of();
    assert_int_equal(nt_fit_recipe_check(&recipe, &problem), NT_OK);
    recipe.sensitivity_uncertainty = -0.1;
    assert_int_equal(nt_fit_recipe_check(&recipe, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "sensitivity_uncertainty");
    recipe = recipe_of();
    recipe.highest_force = recipe.lowest_force;
    assert_int_equal(nt_fit_recipe_check(&recipe, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "highest_force");
    recipe = recipe_of();
    recipe.options.radius = -1.0;
    assert_int_equal(nt_fit_recipe_check(&recipe, &problem), NT_E_RANGE);
    const nt_curve curve = curve_of(0);
    const nt_fit_curves one = {&curve, 1, 1};
    nt_fit_outcome outcome;
    assert_int_equal(nt_fit_batch(&recipe, &one, &outcome), NT_E_RANGE);
    recipe = recipe_of();
    assert_int_equal(nt_fit_batch(&recipe, NULL, &outcome), NT_E_ARGUMENT);
    assert_int_equal(nt_fit_batch(&recipe, &one, NULL), NT_E_ARGUMENT);
    const nt_fit_curves none = {NULL, 0, 0};
    assert_int_equal(nt_fit_batch(&recipe, &none, NULL), NT_OK);
}

static void a_window_limits_what_is_fitted(void **state)
{
    (void)state;
    nt_fit_recipe recipe = recipe_of();
    const nt_curve curve = curve_of(0);
    const nt_fit_curves one = {&curve, 1, 1};
    nt_fit_outcome all, part, none;
    assert_int_equal(nt_fit_batch(&recipe, &one, &all), NT_OK);
    recipe.lowest_force = 10e-9; /* of 25 nN: the beginning of the contact is left out */
    assert_int_equal(nt_fit_batch(&recipe, &one, &part), NT_OK);
    assert_int_equal(part.status, NT_OK);
    assert_true(part.fit.sigma[NT_FIT_CONTACT_POINT] > all.fit.sigma[NT_FIT_CONTACT_POINT]);
    recipe.lowest_force = 1e-3;
    assert_int_equal(nt_fit_batch(&recipe, &one, &none), NT_OK);
    assert_int_equal(none.status, NT_E_RANGE);
    assert_string_equal(none.problem.field, "points left to fit");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_modulus_contact_point_and_baseline),
        cmocka_unit_test(threads_and_neighbours_change_no_bit),
        cmocka_unit_test(bad_curves_say_what_is_wrong),
        cmocka_unit_test(wrong_recipes_are_refused),
        cmocka_unit_test(a_window_limits_what_is_fitted),
    };
    return cmocka_run_group_tests(tests, make, NULL);
}
