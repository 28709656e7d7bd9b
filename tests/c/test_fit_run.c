/* SPDX-License-Identifier: BSD-3-Clause
 * fit/run.cpp, fit/linear.cpp, fit/options.cpp: known answers are recovered, nonsense is refused. */
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

#include "fit_curve.h"

static void exact_without_noise(void **state)
{
    (void)state;
    for (int model = 0; model < NT_FIT_CUSTOM; model++)
        for (int spring = 0; spring < 2; spring++) {
            const nt_fit_options options = options_of((nt_fit_model)model, spring ? 0.5 : 0.0);
            curve made;
            synthesise(&options, 0.0, 1, &made);
            const nt_fit_result result = run(&options, &made);
            assert_true(result.converged);
            for (int i = 0; i < NT_FIT_PARAMETERS; i++)
                if (is_free(&options, i)) {
                    assert_relative(result.value[i], truth[i], 1e-6, name_of(&options, i));
                    assert_true(result.identifiable[i]);
                }
            assert_true(result.residual_rms < 1e-15); /* 1e-6 of the force */
        }
}

/* One point in ten of the deepest third is far off: least squares is pulled away, Cauchy's loss is not. */
static void robust_loss_resists_outliers(void **state)
{
    (void)state;
    nt_fit_options options = options_of(NT_FIT_JKR, 0.5);
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

/* Hertz over the indentation about a given contact point is solved in closed form; it is the least-squares solution,
 * so the search, forced by a datum that says nothing, finds the same. */
static void closed_form_is_the_least_squares_solution(void **state)
{
    (void)state;
    for (int model = 0; model < NT_FIT_CUSTOM; model++) {
        if (model > NT_FIT_HERTZ && model < NT_FIT_CONE)
            continue;
        nt_fit_options options = options_of((nt_fit_model)model, 0.0);
        options.force_noise = 50e-12;
        options.parameter[NT_FIT_CONTACT_POINT].fixed = 1;
        options.parameter[NT_FIT_CONTACT_POINT].initial = truth[NT_FIT_CONTACT_POINT];
        options.parameter[NT_FIT_FORCE_OFFSET].fixed = 0;
        options.parameter[NT_FIT_FORCE_TILT].fixed = 0;
        curve made;
        synthesise(&options, options.force_noise, 11, &made);
        const nt_fit_result direct = run(&options, &made);
        options.parameter[NT_FIT_FORCE_OFFSET].sigma = 1.0; /* 1 N: says nothing */
        const nt_fit_result searched = run(&options, &made);
        assert_int_equal(direct.iterations, 0);
        assert_true(searched.iterations > 0);
        for (int i = 0; i < NT_FIT_PARAMETERS; i++)
            if (is_free(&options, i)) {
                assert_true(fabs(direct.value[i] - searched.value[i]) < 1e-3 * direct.sigma[i]);
                assert_relative(searched.sigma[i], direct.sigma[i], 1e-3, name_of(&options, i));
            }
    }
}

static void no_state_between_fits(void **state)
{
    (void)state;
    const nt_fit_options a = options_of(NT_FIT_MAUGIS, 0.5), b = options_of(NT_FIT_DMT, 0.0);
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
    const nt_fit_options options = options_of(NT_FIT_JKR, 0.5);
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
    const nt_fit_options good = options_of(NT_FIT_JKR, 0.5);
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
    bad.model = (nt_fit_model)9;
    assert_int_equal(nt_fit_run(&bad, &data, &result, &problem), NT_E_RANGE);
    bad = good;
    bad.tear_sigma = 1e-12; /* without the noise of the force its weight is unknown */
    assert_int_equal(nt_fit_run(&bad, &data, &result, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "force_noise");
    bad = good;
    bad.parameter[NT_FIT_EFFECTIVE_MODULUS].initial = -1.0;
    assert_int_equal(nt_fit_run(&bad, &data, &result, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "effective_modulus");
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
        nt_fit_options options = options_of((nt_fit_model)(seed % 6), seed % 8 < 4 ? 0.0 : 0.5);
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
        cmocka_unit_test(robust_loss_resists_outliers),
        cmocka_unit_test(closed_form_is_the_least_squares_solution),
        cmocka_unit_test(no_state_between_fits),
        cmocka_unit_test(strided_and_reversed_data),
        cmocka_unit_test(bad_input_is_refused),
        cmocka_unit_test(absurd_curves_end),
        cmocka_unit_test(nothing_is_printed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
