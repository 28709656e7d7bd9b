/* SPDX-License-Identifier: BSD-3-Clause
 * fit/uncertainty.cpp: uncertainties are calibrated, what cannot be known is said. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "fit_curve.h"
#include "internal/fit.h"

/* The range of adhesion comes out of a curve without noise, but not out of a real one: w, delta0 and h0 together
 * imitate another range to about a piconewton. */
static void range_needs_an_exact_curve(void **state)
{
    (void)state;
    nt_fit_options options = options_of(NT_FIT_MAUGIS, 0.0);
    options.parameter[NT_FIT_COHESIVE_RANGE].fixed = 0;
    options.parameter[NT_FIT_COHESIVE_RANGE].initial = NAN;
    curve made;
    synthesise(&options, 0.0, 1, &made);
    nt_fit_result result = run(&options, &made);
    assert_relative(result.value[NT_FIT_COHESIVE_RANGE], truth[NT_FIT_COHESIVE_RANGE], 1e-4, "range");
    assert_true(result.identifiable[NT_FIT_COHESIVE_RANGE]);
    synthesise(&options, 20e-12, 1, &made);
    result = run(&options, &made);
    assert_false(result.identifiable[NT_FIT_COHESIVE_RANGE]);
    assert_non_null(strstr(result.message, "cohesive_range"));
    assert_true(result.identifiable[NT_FIT_EFFECTIVE_MODULUS]);
    assert_relative(result.value[NT_FIT_EFFECTIVE_MODULUS], truth[NT_FIT_EFFECTIVE_MODULUS], 0.03, "modulus");
}

/* (value - truth)/sigma over many seeds: mean 0 within 3/sqrt(n), standard deviation 1; its own standard error is
 * 1/sqrt(2 n) = 0.06 at n = 150, so 0.8 .. 1.2 is three of them. */
static void check_pulls(const nt_fit_options *options, double noise, int known)
{
    enum { SEEDS = 150 };
    double sum[NT_FIT_PARAMETERS] = {0}, squares[NT_FIT_PARAMETERS] = {0};
    nt_fit_options with = *options;
    with.force_noise = known ? noise : 0.0;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        curve made;
        synthesise(options, noise, seed, &made);
        const nt_fit_result result = run(&with, &made);
        for (int i = 0; i < NT_FIT_PARAMETERS; i++)
            if (result.sigma[i] > 0.0) {
                const double pull = (result.value[i] - truth[i]) / result.sigma[i];
                sum[i] += pull;
                squares[i] += pull * pull;
            }
    }
    for (int i = 0; i < NT_FIT_PARAMETERS; i++) {
        if (!is_free(options, i))
            continue;
        const double mean = sum[i] / SEEDS, deviation = sqrt(squares[i] / SEEDS - mean * mean);
        if (!(fabs(mean) < 3.0 / sqrt(SEEDS) && deviation > 0.8 && deviation < 1.2))
            fail_msg("model %d, k_c %g, %s: pull %.3f +- %.3f", options->model, options->spring_constant,
                     name_of(options, i), mean, deviation);
    }
}

static void sigma_is_calibrated(void **state)
{
    (void)state;
    for (int model = 0; model < NT_FIT_CUSTOM; model++) {
        nt_fit_options options = options_of((nt_fit_model)model, 0.5);
        check_pulls(&options, 50e-12, 0);
        check_pulls(&options, 50e-12, 1);
    }
}

/* A baseline that is known to an uncertainty only: its parameters are fitted with that as a datum, and what they cost
 * shows in sigma. Over 150 seeds with another error of the baseline each the pulls have the width 1 (+- 0.06). */
static void uncertain_baseline_enters_sigma(void **state)
{
    (void)state;
    enum { SEEDS = 150 };
    const double level = 40e-12, tilt = 4e-4;
    nt_fit_options options = options_of(NT_FIT_HERTZ, 0.5);
    options.force_noise = 50e-12;
    options.tilt_position = -200e-9;
    double squares = 0.0, narrow = 0.0;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        curve made;
        synthesise(&options, options.force_noise, seed, &made);
        nt_random random = nt_random_seed(1000 + seed);
        const double off = level * nt_random_normal(&random), slope = tilt * nt_random_normal(&random);
        for (int i = 0; i < POINTS; i++)
            made.force[i] += off + slope * (made.position[i] - options.tilt_position);
        nt_fit_options with = options;
        with.parameter[NT_FIT_FORCE_OFFSET] = (nt_fit_start){0.0, -1.0, 1.0, level, 0};
        with.parameter[NT_FIT_FORCE_TILT] = (nt_fit_start){0.0, -1e3, 1e3, tilt, 0};
        const nt_fit_result result = run(&with, &made), blind = run(&options, &made);
        const double error = result.value[0] - truth[0];
        squares += error * error / (result.sigma[0] * result.sigma[0]);
        const double wrong = blind.value[0] - truth[0];
        narrow += wrong * wrong / (blind.sigma[0] * blind.sigma[0]);
    }
    const double deviation = sqrt(squares / SEEDS);
    if (!(deviation > 0.8 && deviation < 1.2))
        fail_msg("width of the pulls %.3f", deviation);
    assert_true(sqrt(narrow / SEEDS) > 1.5); /* without the datum the intervals are too narrow */
}

/* Silicon on silicon under a cantilever of 0.2 N/m: the contact is 3000 times stiffer than the spring, and the
 * deflection sensitivity is known to 2 % only. Neither E* nor, without a measured pull-off, w can come out of such a
 * curve. */
static void stiff_contact_is_not_determined(void **state)
{
    (void)state;
    const double silicon[NT_FIT_PARAMETERS] = {77e9, 0.144, 0.2e-9, 0.0, 0.0, 0.0, 0.0, 1.0};
    nt_fit_options options = nt_fit_defaults(NT_FIT_JKR);
    options.spring_constant = 0.2;
    options.force_noise = 20e-12;
    options.parameter[NT_FIT_SENSITIVITY] = (nt_fit_start){1.0, 0.1, 10.0, 0.02, 0};
    curve made;
    nt_random random = nt_random_seed(5);
    for (int i = 0; i < POINTS; i++)
        made.position[i] = 60e-9 - (60e-9 + 13.5e-9 / 0.2) * i / (POINTS - 1);
    fill(&options, silicon, &made);
    for (int i = 0; i < POINTS; i++)
        made.force[i] += options.force_noise * nt_random_normal(&random);
    assert_int_equal(nt_fit_tear_position(&options, silicon, &options.tear_position), NT_OK);
    options.tear_sigma = 30e-12 / options.spring_constant; /* of 13.57 nN = 1.5 pi w R */
    const nt_fit_result result = run(&options, &made);
    assert_false(result.identifiable[NT_FIT_EFFECTIVE_MODULUS]);
    assert_non_null(strstr(result.message, "effective_modulus"));
    assert_true(result.identifiable[NT_FIT_WORK_OF_ADHESION]); /* from the place of the tear */
    assert_relative(result.value[NT_FIT_WORK_OF_ADHESION], 0.144, 4.0 * 30e-12 / 13.57e-9, "w");
}

/* In JKR the loads alone do not tell where the contact is: F0 and w and delta0 of four flat points, for instance. */
static void null_space_is_reported(void **state)
{
    (void)state;
    nt_fit_options options = options_of(NT_FIT_HERTZ, 0.0);
    options.parameter[NT_FIT_CONTACT_POINT] = (nt_fit_start){0.0, -1.0, 1.0, 0.0, 1};
    options.parameter[NT_FIT_FORCE_OFFSET].fixed = 0;
    curve made;
    for (int i = 0; i < POINTS; i++) { /* never in contact: E* has no influence at all */
        made.position[i] = -1e-9 * (i + 1);
        made.force[i] = i % 2 ? 1e-12 : -1e-12;
    }
    const nt_fit_result result = run(&options, &made);
    assert_true(isinf(result.sigma[NT_FIT_EFFECTIVE_MODULUS]));
    assert_false(result.identifiable[NT_FIT_EFFECTIVE_MODULUS]);
    assert_true(result.sigma[NT_FIT_FORCE_OFFSET] < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(range_needs_an_exact_curve),      cmocka_unit_test(sigma_is_calibrated),
        cmocka_unit_test(uncertain_baseline_enters_sigma), cmocka_unit_test(stiff_contact_is_not_determined),
        cmocka_unit_test(null_space_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
