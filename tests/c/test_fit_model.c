/* SPDX-License-Identifier: BSD-3-Clause
 * fit/model.cpp: the force at a position and its analytic derivatives. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/fit.h"
#include "nanotouch/material.h"

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g, expected %.17g +- %g", value, expected, tolerance);
}

static const double soft[NT_FIT_PARAMETERS] = {5e6, 0.05, 2e-9, 3e-9, 0.4e-9, 1.1};
static const double stiff[NT_FIT_PARAMETERS] = {80e9, 0.144, 0.2e-9, -2e-9, 0.0, 0.97};

static nt_fit_options options_of(nt_model model, double spring_constant)
{
    nt_fit_options options = nt_fit_defaults(model);
    options.spring_constant = spring_constant;
    return options;
}

static nt_fit_point point_at(const nt_fit_options *options, const double *value, double position)
{
    nt_fit_point point = {0};
    assert_int_equal(nt_fit_model_at(options, value, position, &point), NT_OK);
    return point;
}

/* The force satisfies the equation of the cantilever, with the laws themselves as reference. */
static void obeys_cantilever_equation(void **state)
{
    (void)state;
    for (int model = NT_HERTZ; model <= NT_MAUGIS; model++)
        for (int i = 0; i < 60; i++) {
            const nt_fit_options options = options_of((nt_model)model, 2.0);
            const nt_fit_point point = point_at(&options, soft, -5e-9 + i * 1e-9);
            const nt_contact contact = {options.radius, soft[0], model == NT_HERTZ ? 0.0 : soft[1], soft[1] / soft[2]};
            nt_contact_law law;
            assert_int_equal(nt_contact_law_init(&law, (nt_model)model, &contact), NT_OK);
            const double force = point.force - soft[NT_FIT_FORCE_OFFSET];
            const double travel = point.indentation + soft[NT_FIT_COMPLIANCE] * force / 2.0;
            /* 1e-21 m: rounding of a position of 60 nm */
            assert_near(travel, -5e-9 + i * 1e-9 - soft[NT_FIT_CONTACT_POINT], 1e-21);
            nt_law_value value;
            assert_int_equal(nt_contact_law_eval(&law, point.indentation, NT_BRANCH_STABLE, &value), NT_OK);
            if (force > -nt_contact_law_pull_off_force(&law) * (1 - 1e-9))
                assert_near(value.F, force, 1e-18);
        }
}

/* Below the load fold the force stays at minus the pull-off force. */
static void constant_below_load_fold(void **state)
{
    (void)state;
    const nt_fit_options options = options_of(NT_JKR, 0.0);
    const nt_fit_point point = point_at(&options, soft, -1e-6);
    assert_near(point.force - soft[NT_FIT_FORCE_OFFSET], -1.5 * NT_PI * options.radius * soft[1], 1e-22);
    assert_near(point.gradient[NT_FIT_WORK_OF_ADHESION], -1.5 * NT_PI * options.radius, 1e-20);
    assert_true(point.gradient[NT_FIT_CONTACT_POINT] == 0.0);
}

/* dF/dparameter against central differences in steps h and h/2, extrapolated: error O(h^4). With h = 1e-3 relative the
 * truncation is below 1e-8 of F/parameter, rounding below 1e-11: 1e-7 of the largest derivative in the row is asked. */
static double difference(const nt_fit_options *options, const double *value, double position, int parameter, double h)
{
    double up[NT_FIT_PARAMETERS], down[NT_FIT_PARAMETERS];
    for (int i = 0; i < NT_FIT_PARAMETERS; i++)
        up[i] = down[i] = value[i];
    up[parameter] += h;
    down[parameter] -= h;
    return (point_at(options, up, position).force - point_at(options, down, position).force) / (2.0 * h);
}

static void check_gradient(const nt_fit_options *options, const double *value, double position)
{
    static const double natural[NT_FIT_PARAMETERS] = {0, 0, 0, 1e-10, 1e-10, 0};
    const nt_fit_point point = point_at(options, value, position);
    for (int i = 0; i < NT_FIT_PARAMETERS; i++) {
        const double size = natural[i] > 0.0 ? natural[i] : fabs(value[i]), h = 1e-3 * size;
        const double fine = difference(options, value, position, i, h / 2.0);
        const double numeric = fine + (fine - difference(options, value, position, i, h)) / 3.0;
        const double tolerance = 1e-7 * fmax(fabs(point.force), 1e-9) / size;
        if (fabs(numeric - point.gradient[i]) > tolerance)
            fail_msg("model %d, k_c %g, X %g, %s: %.12g, difference %.12g", options->model, options->spring_constant,
                     position, nt_fit_parameter_name((nt_fit_parameter)i), point.gradient[i], numeric);
    }
}

static void gradient_matches_differences(void **state)
{
    (void)state;
    for (int model = NT_HERTZ; model <= NT_MAUGIS; model++)
        for (int spring = 0; spring < 2; spring++)
            for (int i = 1; i < 12; i++) { /* off the kinks of the second derivative at first touch and fold */
                const nt_fit_options options = options_of((nt_model)model, spring ? 3.0 : 0.0);
                check_gradient(&options, soft, soft[NT_FIT_CONTACT_POINT] + i * 4.1e-9);
                if (spring || model != NT_DMT)
                    check_gradient(&options, stiff, stiff[NT_FIT_CONTACT_POINT] + i * (spring ? 5.1e-9 : 0.51e-9));
            }
}

/* The same for lambda from the DMT to the JKR end, where the derivative by the range changes character. */
static void range_derivative_at_every_lambda(void **state)
{
    (void)state;
    const nt_fit_options options = options_of(NT_MAUGIS, 0.0);
    for (double range = 1e-11; range < 1e-7; range *= 3.0) {
        const double value[NT_FIT_PARAMETERS] = {5e6, 0.05, range, 0.0, 0.0, 1.0};
        for (int i = 1; i < 6; i++)
            check_gradient(&options, value, i * 6e-9);
    }
}

/* lambda -> infinity is JKR: 1e-4 at h0 = 1e-11 m, lambda = 400 (the difference falls as lambda^-2). */
static void maugis_tends_to_jkr(void **state)
{
    (void)state;
    const nt_fit_options maugis = options_of(NT_MAUGIS, 3.0), jkr = options_of(NT_JKR, 3.0);
    const double value[NT_FIT_PARAMETERS] = {5e6, 0.05, 1e-11, 0.0, 0.0, 1.0};
    for (int i = -5; i < 20; i++) {
        const nt_fit_point a = point_at(&maugis, value, i * 2e-9), b = point_at(&jkr, value, i * 2e-9);
        assert_near(a.force, b.force, 1e-4 * 4.7e-9);
        assert_near(a.gradient[NT_FIT_EFFECTIVE_MODULUS], b.gradient[NT_FIT_EFFECTIVE_MODULUS], 1e-4 * 4.7e-9 / 5e6);
    }
}

static void bad_values_are_refused(void **state)
{
    (void)state;
    const nt_fit_options options = options_of(NT_JKR, 0.0);
    nt_fit_point point = {.force = 7.0};
    double value[NT_FIT_PARAMETERS];
    for (int i = 0; i < NT_FIT_PARAMETERS; i++)
        value[i] = soft[i];
    assert_int_equal(nt_fit_model_at(&options, value, NAN, &point), NT_E_NOT_FINITE);
    value[NT_FIT_EFFECTIVE_MODULUS] = -1.0;
    assert_int_equal(nt_fit_model_at(&options, value, 0.0, &point), NT_E_RANGE);
    value[NT_FIT_EFFECTIVE_MODULUS] = NAN;
    assert_int_equal(nt_fit_model_at(&options, value, 0.0, &point), NT_E_NOT_FINITE);
    assert_int_equal(nt_fit_model_at(NULL, value, 0.0, &point), NT_E_ARGUMENT);
    assert_true(point.force == 7.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(obeys_cantilever_equation),    cmocka_unit_test(constant_below_load_fold),
        cmocka_unit_test(gradient_matches_differences), cmocka_unit_test(range_derivative_at_every_lambda),
        cmocka_unit_test(maugis_tends_to_jkr),          cmocka_unit_test(bad_values_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
