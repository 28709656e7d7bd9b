/* SPDX-License-Identifier: BSD-3-Clause
 * fit/custom_model.cpp: a law of the user's own through the C interface, against a built-in one and known answers. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/fit.h"

enum { POINTS = 400 };

/* Hertz, written by a user; the context is R. */
static nt_status hertz(const nt_fit_options *options, const double *value, long count, const double *indentation,
                       double *force)
{
    const double R = *(const double *)options->law->context;
    for (long i = 0; i < count; i++)
        force[i] = indentation[i] > 0.0 ? 4.0 / 3.0 * value[0] * sqrt(R) * pow(indentation[i], 1.5) : 0.0;
    return NT_OK;
}

/* Any exponent: F = A (delta/1 nm)^n. */
static nt_status power(const nt_fit_options *options, const double *value, long count, const double *indentation,
                       double *force)
{
    (void)options;
    for (long i = 0; i < count; i++)
        force[i] = indentation[i] > 0.0 ? value[0] * pow(indentation[i] / 1e-9, value[1]) : 0.0;
    return NT_OK;
}

static nt_status refuses(const nt_fit_options *options, const double *value, long count, const double *indentation,
                         double *force)
{
    (void)options, (void)value, (void)count, (void)indentation, (void)force;
    return NT_E_UNSUPPORTED;
}

static double radius = 20e-9;

static nt_fit_law hertz_law(void)
{
    return (nt_fit_law){"my hertz", 1, {{"effective_modulus", "Pa", NAN, 1.0, 1e14}}, hertz, &radius};
}

static nt_fit_law power_law(void)
{
    return (nt_fit_law){
        "power", 2, {{"prefactor", "N", NAN, 1e-14, 1e-6}, {"exponent", "", 1.2, 0.5, 4.0}}, power, NULL};
}

static void make(const nt_fit_options *options, const double *value, double *position, double *force)
{
    nt_random random = nt_random_seed(4);
    nt_fit_point points[POINTS];
    for (int i = 0; i < POINTS; i++)
        position[i] = 60e-9 - 90e-9 * i / (POINTS - 1);
    const nt_fit_data data = {position, force, POINTS, 1, 1};
    assert_int_equal(nt_fit_model_n(options, value, &data, points), NT_OK);
    for (int i = 0; i < POINTS; i++)
        force[i] = points[i].force + options->force_noise * nt_random_normal(&random);
}

/* The same law, once built in with analytic derivatives, once the user's: same model, same fit. */
static void equals_the_built_in(void **state)
{
    (void)state;
    const double truth[NT_FIT_PARAMETERS] = {5e6, 0.0, 0.0, 0.0, 3e-9, 0.0, 0.0, 1.0};
    const nt_fit_law law = hertz_law();
    for (int spring = 0; spring < 2; spring++) {
        nt_fit_options own = nt_fit_defaults_for(&law), built_in = nt_fit_defaults(NT_FIT_HERTZ);
        own.spring_constant = built_in.spring_constant = spring ? 0.2 : 0.0;
        own.force_noise = built_in.force_noise = 20e-12;
        double position[POINTS], force[POINTS];
        make(&built_in, truth, position, force);
        const nt_fit_data data = {position, force, POINTS, 1, 1};
        nt_fit_point mine[POINTS], theirs[POINTS];
        assert_int_equal(nt_fit_model_n(&own, truth, &data, mine), NT_OK);
        assert_int_equal(nt_fit_model_n(&built_in, truth, &data, theirs), NT_OK);
        for (int i = 0; i < POINTS; i++) {
            assert_true(fabs(mine[i].force - theirs[i].force) < 1e-9 * 10e-9);
            for (int p = 0; p < NT_FIT_PARAMETERS; p++) /* central differences: 1e-8; at first touch k is not smooth */
                if (fabs(theirs[i].indentation) > 1e-11)
                    assert_true(fabs(mine[i].gradient[p] - theirs[i].gradient[p]) <=
                                1e-7 * larger(fabs(theirs[i].gradient[p]), fabs(theirs[0].gradient[p])));
        }
        nt_fit_result a, b;
        assert_int_equal(nt_fit_run(&own, &data, &a, NULL), NT_OK);
        assert_int_equal(nt_fit_run(&built_in, &data, &b, NULL), NT_OK);
        assert_true(fabs(a.value[0] - b.value[0]) < 1e-3 * b.sigma[0]);
        assert_true(fabs(a.sigma[0] - b.sigma[0]) < 1e-3 * b.sigma[0]);
        assert_true(isnan(a.pull_off_force) && isnan(a.contact_radius));
    }
}

static void two_parameters_are_recovered(void **state)
{
    (void)state;
    const double truth[NT_FIT_PARAMETERS] = {2e-12, 2.1, 0.0, 0.0, 3e-9, 0.0, 0.0, 1.0};
    const nt_fit_law law = power_law();
    nt_fit_options options = nt_fit_defaults_for(&law);
    options.spring_constant = 0.1;
    options.force_noise = 5e-12;
    double position[POINTS], force[POINTS];
    make(&options, truth, position, force);
    const nt_fit_data data = {position, force, POINTS, 1, 1};
    nt_fit_result result;
    assert_int_equal(nt_fit_run(&options, &data, &result, NULL), NT_OK);
    assert_true(result.converged && result.identifiable[1]);
    for (int i = 0; i < 2; i++)
        assert_true(fabs(result.value[i] - truth[i]) < 4.0 * result.sigma[i]);
    assert_true(result.sigma[1] < 0.05);
    assert_string_equal(nt_fit_quantity_of(&options, (nt_fit_parameter)1).name, "exponent");
    assert_null(nt_fit_quantity_of(&options, (nt_fit_parameter)2).name);
}

static void bad_laws_are_refused(void **state)
{
    (void)state;
    double position[POINTS], force[POINTS];
    for (int i = 0; i < POINTS; i++)
        position[i] = 1e-9 * i, force[i] = 1e-12 * i * i;
    const nt_fit_data data = {position, force, POINTS, 1, 1};
    nt_fit_result result;
    nt_problem problem;
    nt_fit_law law = hertz_law();
    nt_fit_options options = nt_fit_defaults_for(&law);
    law.force = refuses;
    assert_int_equal(nt_fit_run(&options, &data, &result, &problem), NT_E_NO_CONVERGENCE);
    law.force = NULL;
    assert_int_equal(nt_fit_run(&options, &data, &result, &problem), NT_E_ARGUMENT);
    law.force = hertz;
    law.count = NT_FIT_OWN + 1;
    assert_int_equal(nt_fit_run(&options, &data, &result, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "law.count");
    law.count = 1;
    law.parameter[0].minimum = 2e14;
    assert_int_equal(nt_fit_run(&options, &data, &result, &problem), NT_E_RANGE);
    options.law = NULL;
    assert_int_equal(nt_fit_run(&options, &data, &result, &problem), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equals_the_built_in),
        cmocka_unit_test(two_parameters_are_recovered),
        cmocka_unit_test(bad_laws_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
