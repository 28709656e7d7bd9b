/* SPDX-License-Identifier: BSD-3-Clause
 * fit/run.cpp: known answers are recovered, uncertainties are calibrated, what cannot be known is said. */
#define _POSIX_C_SOURCE 200809L /* dup2, fileno */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "nanotouch/fit.h"
#include "nanotouch/random.h"

enum { POINTS = 250 };

static const double truth[NT_FIT_PARAMETERS] = {5e6, 0.05, 2e-9, 3e-9, 0.0, 1.0}; /* lambda = 2.0 */

typedef struct {
    double position[POINTS], force[POINTS];
} curve;

static nt_fit_data data_of(const curve *made)
{
    return (nt_fit_data){made->position, made->force, POINTS, 1, 1};
}

static nt_fit_options options_of(nt_model model, double spring_constant)
{
    nt_fit_options options = nt_fit_defaults(model);
    options.spring_constant = spring_constant;
    options.parameter[NT_FIT_COHESIVE_RANGE].initial = truth[NT_FIT_COHESIVE_RANGE];
    return options;
}

/* A retraction from 80 nm to the smallest force, with white noise [N]. */
static void synthesise(const nt_fit_options *options, double noise, uint64_t seed, curve *made)
{
    nt_random random = nt_random_seed(seed);
    const double last = options->model == NT_HERTZ ? -10e-9 : options->spring_constant > 0.0 ? -1e-9 : -5e-9;
    for (int i = 0; i < POINTS; i++)
        made->position[i] = 80e-9 + (last - 80e-9) * i / (POINTS - 1);
    const nt_fit_data data = {made->position, made->force, POINTS, 1, 1};
    assert_int_equal(nt_fit_model_n(options, truth, &data, made->force), NT_OK);
    for (int i = 0; i < POINTS; i++)
        made->force[i] += noise * nt_random_normal(&random);
}

static nt_fit_result run(const nt_fit_options *options, const curve *made)
{
    const nt_fit_data data = data_of(made);
    nt_fit_result result;
    assert_int_equal(nt_fit_run(options, &data, &result, NULL), NT_OK);
    return result;
}

static void assert_relative(double value, double expected, double tolerance, const char *what)
{
    if (!(fabs(value - expected) <= tolerance * fabs(expected)))
        fail_msg("%s: %.12g, expected %.12g within %g", what, value, expected, tolerance);
}

static void exact_without_noise(void **state)
{
    (void)state;
    for (int model = NT_HERTZ; model <= NT_MAUGIS; model++)
        for (int spring = 0; spring < 2; spring++) {
            const nt_fit_options options = options_of((nt_model)model, spring ? 0.5 : 0.0);
            curve made;
            synthesise(&options, 0.0, 1, &made);
            const nt_fit_result result = run(&options, &made);
            assert_true(result.converged);
            for (int i = 0; i < NT_FIT_PARAMETERS; i++)
                if (!options.parameter[i].fixed && nt_fit_model_has((nt_model)model, (nt_fit_parameter)i)) {
                    assert_relative(result.value[i], truth[i], 1e-6, nt_fit_parameter_name((nt_fit_parameter)i));
                    assert_true(result.identifiable[i]);
                }
            assert_true(result.residual_rms < 1e-15); /* 1e-6 of the force */
        }
}

/* The range of adhesion comes out of a curve without noise, but not out of a real one: w, delta0 and h0 together
 * imitate another range to about a piconewton. */
static void range_needs_an_exact_curve(void **state)
{
    (void)state;
    nt_fit_options options = options_of(NT_MAUGIS, 0.0);
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
        if (options->parameter[i].fixed || !nt_fit_model_has(options->model, (nt_fit_parameter)i))
            continue;
        const double mean = sum[i] / SEEDS, deviation = sqrt(squares[i] / SEEDS - mean * mean);
        if (!(fabs(mean) < 3.0 / sqrt(SEEDS) && deviation > 0.8 && deviation < 1.2))
            fail_msg("model %d, k_c %g, %s: pull %.3f +- %.3f", options->model, options->spring_constant,
                     nt_fit_parameter_name((nt_fit_parameter)i), mean, deviation);
    }
}

static void sigma_is_calibrated(void **state)
{
    (void)state;
    for (int model = NT_HERTZ; model <= NT_MAUGIS; model++) {
        nt_fit_options options = options_of((nt_model)model, 0.5);
        check_pulls(&options, 50e-12, 0);
        check_pulls(&options, 50e-12, 1);
    }
}

/* One point in ten of the deepest third is far off: least squares is pulled away, Cauchy's loss is not. */
static void robust_loss_resists_outliers(void **state)
{
    (void)state;
    nt_fit_options options = options_of(NT_JKR, 0.5);
    curve made;
    synthesise(&options, 20e-12, 3, &made);
    for (int i = 0; i < POINTS / 3; i += 10)
        made.force[i] += 5e-9;
    const nt_fit_result plain = run(&options, &made);
    options.loss = NT_LOSS_CAUCHY;
    options.loss_scale = 50e-12;
    const nt_fit_result robust = run(&options, &made);
    const double error = fabs(robust.value[0] - truth[0]);
    assert_true(error < 4.0 * robust.sigma[0]);
    assert_true(error < 0.1 * fabs(plain.value[0] - truth[0]));
}

/* Silicon on silicon under a cantilever of 0.2 N/m: the contact is 3000 times stiffer than the spring, and the
 * deflection sensitivity is known to 2 % only. Neither E* nor, without a measured pull-off, w can come out of such a
 * curve. */
static void stiff_contact_is_not_determined(void **state)
{
    (void)state;
    const double silicon[NT_FIT_PARAMETERS] = {77e9, 0.144, 0.2e-9, 0.0, 0.0, 1.0};
    nt_fit_options options = nt_fit_defaults(NT_JKR);
    options.spring_constant = 0.2;
    options.force_noise = 20e-12;
    options.compliance_sigma = 0.02;
    options.parameter[NT_FIT_COMPLIANCE].fixed = 0;
    curve made;
    nt_random random = nt_random_seed(5);
    for (int i = 0; i < POINTS; i++)
        made.position[i] = 60e-9 - 0.4e-9 * i;
    const nt_fit_data data = data_of(&made);
    assert_int_equal(nt_fit_model_n(&options, silicon, &data, made.force), NT_OK);
    for (int i = 0; i < POINTS; i++)
        made.force[i] += options.force_noise * nt_random_normal(&random);
    options.pull_off_force = 13.57e-9; /* 1.5 pi w R */
    options.pull_off_sigma = 30e-12;
    const nt_fit_result result = run(&options, &made);
    assert_false(result.identifiable[NT_FIT_EFFECTIVE_MODULUS]);
    assert_non_null(strstr(result.message, "effective_modulus"));
    assert_true(result.identifiable[NT_FIT_WORK_OF_ADHESION]); /* from the pull-off force */
    assert_relative(result.value[NT_FIT_WORK_OF_ADHESION], 0.144, 4.0 * 30e-12 / 13.57e-9, "w");
}

/* In JKR the loads alone do not tell where the contact is: F0 and w and delta0 of four flat points, for instance. */
static void null_space_is_reported(void **state)
{
    (void)state;
    nt_fit_options options = options_of(NT_HERTZ, 0.0);
    options.parameter[NT_FIT_CONTACT_POINT] = (nt_fit_start){0.0, -1.0, 1.0, 1};
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

static void no_state_between_fits(void **state)
{
    (void)state;
    const nt_fit_options a = options_of(NT_MAUGIS, 0.5), b = options_of(NT_DMT, 0.0);
    curve first, second;
    synthesise(&a, 50e-12, 1, &first);
    synthesise(&b, 50e-12, 2, &second);
    const nt_fit_result before = run(&a, &first);
    (void)run(&b, &second);
    const nt_fit_result after = run(&a, &first);
    assert_memory_equal(before.value, after.value, sizeof before.value);
    assert_memory_equal(before.covariance, after.covariance, sizeof before.covariance);
    assert_string_equal(before.message, after.message);
}

/* Strides and order of the points do not matter. */
static void strided_and_reversed_data(void **state)
{
    (void)state;
    const nt_fit_options options = options_of(NT_JKR, 0.5);
    curve made;
    synthesise(&options, 50e-12, 1, &made);
    double rows[POINTS][3];
    for (int i = 0; i < POINTS; i++) {
        rows[i][0] = made.position[i];
        rows[i][2] = made.force[i];
    }
    const nt_fit_data reversed = {rows[POINTS - 1], rows[POINTS - 1] + 2, POINTS, -3, -3};
    nt_fit_result result;
    assert_int_equal(nt_fit_run(&options, &reversed, &result, NULL), NT_OK);
    assert_relative(result.value[0], run(&options, &made).value[0], 1e-6, "modulus"); /* summation order only */
}

static void bad_input_is_refused(void **state)
{
    (void)state;
    const nt_fit_options good = options_of(NT_JKR, 0.5);
    curve made;
    synthesise(&good, 0.0, 1, &made);
    nt_fit_data data = data_of(&made);
    nt_fit_result result = {.iterations = -7};
    nt_problem problem;

    nt_fit_options bad = good;
    bad.radius = 0.0;
    assert_int_equal(nt_fit_run(&bad, &data, &result, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "radius");
    bad = good;
    bad.force_noise = NAN;
    assert_int_equal(nt_fit_run(&bad, &data, &result, &problem), NT_E_NOT_FINITE);
    bad = good;
    bad.model = (nt_model)9;
    assert_int_equal(nt_fit_run(&bad, &data, &result, &problem), NT_E_RANGE);
    bad = good;
    bad.pull_off_sigma = 1e-12; /* without the noise of the force its weight is unknown */
    assert_int_equal(nt_fit_run(&bad, &data, &result, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "force_noise");
    bad = good;
    bad.parameter[NT_FIT_EFFECTIVE_MODULUS].initial = -1.0;
    assert_int_equal(nt_fit_run(&bad, &data, &result, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "effective_modulus.initial");
    bad = good;
    bad.parameter[NT_FIT_WORK_OF_ADHESION].fixed = 1; /* at what? */
    assert_int_equal(nt_fit_run(&bad, &data, &result, &problem), NT_E_NOT_FINITE);

    data.count = 5;
    assert_int_equal(nt_fit_run(&good, &data, &result, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "data.count");
    data.count = POINTS;
    made.force[17] = NAN;
    assert_int_equal(nt_fit_run(&good, &data, &result, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "data.force");
    made.force[17] = 12.0; /* N: surely nN were meant */
    assert_int_equal(nt_fit_run(&good, &data, &result, &problem), NT_E_RANGE);
    data.force = NULL;
    assert_int_equal(nt_fit_run(&good, &data, &result, &problem), NT_E_ARGUMENT);
    assert_int_equal(nt_fit_run(NULL, &data, &result, NULL), NT_E_ARGUMENT);
    assert_int_equal(result.iterations, -7); /* untouched on failure */
}

/* Curves on which a fit has nothing to hold on to: they may fail or not, but neither crash nor hang. */
static void absurd_curves_end(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 40; seed++) {
        nt_fit_options options = options_of((nt_model)(seed % 4), seed % 8 < 4 ? 0.0 : 0.5);
        curve made;
        nt_random random = nt_random_seed(seed);
        const double scale = pow(10.0, -(double)(seed % 13));
        for (int i = 0; i < POINTS; i++) {
            made.position[i] = scale * tanh(nt_random_normal(&random));
            made.force[i] = scale * tanh(nt_random_normal(&random));
        }
        const nt_fit_data data = data_of(&made);
        nt_fit_result result;
        const nt_status status = nt_fit_run(&options, &data, &result, NULL);
        assert_true(status == NT_OK || status == NT_E_NO_CONVERGENCE);
    }
}

/* Everything above once more, with both streams of the process in a file that has to stay empty. */
static void nothing_is_printed(void **state)
{
    (void)state;
    FILE *capture = tmpfile();
    assert_non_null(capture);
    fflush(NULL);
    const int out = dup(STDOUT_FILENO), err = dup(STDERR_FILENO);
    dup2(fileno(capture), STDOUT_FILENO);
    dup2(fileno(capture), STDERR_FILENO);
    exact_without_noise(NULL);
    stiff_contact_is_not_determined(NULL);
    null_space_is_reported(NULL);
    bad_input_is_refused(NULL);
    absurd_curves_end(NULL);
    fflush(NULL);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    close(out);
    close(err);
    fseek(capture, 0, SEEK_END);
    const long printed = ftell(capture);
    fclose(capture);
    assert_int_equal(printed, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_without_noise),
        cmocka_unit_test(range_needs_an_exact_curve),
        cmocka_unit_test(sigma_is_calibrated),
        cmocka_unit_test(robust_loss_resists_outliers),
        cmocka_unit_test(stiff_contact_is_not_determined),
        cmocka_unit_test(null_space_is_reported),
        cmocka_unit_test(no_state_between_fits),
        cmocka_unit_test(strided_and_reversed_data),
        cmocka_unit_test(bad_input_is_refused),
        cmocka_unit_test(absurd_curves_end),
        cmocka_unit_test(nothing_is_printed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
