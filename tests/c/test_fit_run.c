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
#include "internal/fit.h"
#include "larger.h"

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

enum { BRANCH = 1000, DRAWS = 100 };

static double between(nt_random *random, double low, double high) /* equally likely logarithms */
{
    return low * pow(high / low, 0.5 * erfc(-nt_random_normal(random) / sqrt(2.0)));
}

/* Both branches of a random contact of this law, 1 % to 20 % of the radius deep; radius, k and h0 go into the recipe.
 */
static nt_curve draw(uint64_t seed, nt_fit_recipe *recipe, double z[2][BRANCH], double force[2][BRANCH])
{
    static nt_fit_point point[BRANCH];
    double position[BRANCH], largest = 0.0, tear;
    nt_random random = nt_random_seed(seed);
    nt_fit_options *options = &recipe->options;
    const double R = options->radius = between(&random, 5e-9, 5e-6), k = between(&random, 0.01, 40.0);
    const double E = between(&random, 1e4, 1e11), w = between(&random, 1e-4, 0.2),
                 deep = R * between(&random, 0.01, 0.2);
    const double base = deep + 4.0 / 3.0 * E * sqrt(R) * pow(deep, 1.5) / k, pull = 1.5 * 3.14159265 * w * R;
    const double away = 3.0 * base + 4.0 * (pull / k + cbrt(pull * pull / (E * E * R)));
    const double value[NT_FIT_PARAMETERS] = {E, w, 0.3e-9, 0.0, 0.0, 0.0, 0.0, 1.0 + 0.03 * nt_random_normal(&random)};
    const double share = between(&random, 1e-4, 2e-2); /* of noise in the largest force */
    for (int i = 0; i < BRANCH; i++)
        position[i] = base - (base + away) * i / (BRANCH - 1);
    nt_fit_options there = nt_fit_defaults(options->model);
    there.radius = R;
    there.spring_constant = k;
    options->parameter[NT_FIT_COHESIVE_RANGE].initial = value[NT_FIT_COHESIVE_RANGE];
    const nt_fit_data data = {position, NULL, BRANCH, 1, 1};
    assert_int_equal(nt_fit_model_n(&there, value, &data, point), NT_OK);
    assert_int_equal(nt_fit_tear_position(&there, value, &tear), NT_OK);
    for (int i = 0; i < BRANCH; i++)
        largest = position[i] > tear ? larger(largest, fabs(point[i].force)) : largest;
    for (int branch = 0; branch < 2; branch++)
        for (int i = 0; i < BRANCH; i++) {
            const int at = branch ? i : BRANCH - 1 - i;
            z[branch][i] = -position[at];
            force[branch][i] = (position[at] < (branch ? tear : 0.0) ? 0.0 : point[at].force) +
                               share * largest * nt_random_normal(&random);
        }
    return (nt_curve){{z[0], force[0], BRANCH}, {z[1], force[1], BRANCH}, k, 0.0, 0.0};
}

/* Laws with adhesion have several minima: one curve in seven ended in a wrong one when a fit had but one start, and
 * some when it was weighed again from its beginning. */
static void random_adhesive_curves_end_at_their_noise(void **state)
{
    (void)state;
    static double z[2][BRANCH], force[2][BRANCH];
    const nt_fit_model models[] = {NT_FIT_JKR, NT_FIT_MAUGIS};
    for (int m = 0; m < 2; m++) {
        int elsewhere = 0;
        for (uint64_t seed = 1; seed <= DRAWS; seed++) {
            nt_fit_recipe recipe = nt_fit_recipe_defaults(models[m]);
            const nt_curve drawn = draw(seed, &recipe, z, force);
            const nt_fit_curves one = {&drawn, 1, 1};
            nt_fit_outcome outcome;
            assert_int_equal(nt_fit_batch(&recipe, &one, &outcome), NT_OK);
            elsewhere += outcome.status != NT_OK || outcome.fit.residual_rms > 2.0 * outcome.reading.noise;
        }
        assert_in_range(elsewhere, 0, 1); /* 4 of 1000 */
    }
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
        cmocka_unit_test(random_adhesive_curves_end_at_their_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
