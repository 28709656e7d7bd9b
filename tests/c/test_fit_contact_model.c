/* SPDX-License-Identifier: BSD-3-Clause
 * fit/contact_model.cpp, fit/models: the force at a position and its analytic derivatives, up to the tear. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/contact.h"
#include "internal/fit.h"
#include "larger.h"
#include "nanotouch/advanced/geometry.h"
#include "nanotouch/fit.h"

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g, expected %.17g +- %g", value, expected, tolerance);
}

/* E*, w, h0, t, delta0, F0, G, s */
static const double soft[NT_FIT_PARAMETERS] = {5e6, 0.05, 2e-9, 300e-9, 3e-9, 0.4e-9, 1e-3, 1.1};
static const double stiff[NT_FIT_PARAMETERS] = {80e9, 0.144, 0.2e-9, 300e-9, -2e-9, 0.0, 0.0, 0.97};

static nt_fit_options options_of(nt_fit_model model, double spring_constant)
{
    nt_fit_options options = nt_fit_defaults(model);
    options.spring_constant = spring_constant;
    options.tilt_position = 100e-9;
    return options;
}

static nt_fit_point point_at(const nt_fit_options *options, const double *value, double position)
{
    nt_fit_point point = {0};
    const nt_fit_data data = {&position, NULL, 1, 1, 1};
    assert_int_equal(nt_fit_model_n(options, value, &data, &point), NT_OK);
    return point;
}

/* The force of the contact itself: background and sensitivity taken off [N]. */
static double contact_force(const nt_fit_options *options, const double *value, double position)
{
    const double background =
        value[NT_FIT_FORCE_OFFSET] + value[NT_FIT_FORCE_TILT] * (position - options->tilt_position);
    return (point_at(options, value, position).force - background) * value[NT_FIT_SENSITIVITY];
}

/* The force satisfies the equation of the cantilever, with the laws themselves as reference. */
static void obeys_cantilever_equation(void **state)
{
    (void)state;
    for (int model = NT_FIT_HERTZ; model <= NT_FIT_MAUGIS; model++)
        for (int i = 0; i < 60; i++) {
            const nt_fit_options options = options_of((nt_fit_model)model, 0.3);
            const double position = -5e-9 + i * 1e-9, force = contact_force(&options, soft, position);
            const nt_fit_point point = point_at(&options, soft, position);
            if (!point.held)
                continue;
            const nt_contact contact = {options.radius, soft[0], model == NT_FIT_HERTZ ? 0.0 : soft[1],
                                        soft[1] / soft[2]};
            nt_contact_law law;
            assert_int_equal(nt_contact_law_init(&law, (nt_model)model, &contact), NT_OK);
            /* 1e-20 m: rounding of a position of 100 nm, and of a tilt of 0.1 nN that was taken off again */
            assert_near(point.indentation + force / 0.3, position - soft[NT_FIT_CONTACT_POINT], 1e-20);
            nt_law_value value;
            assert_int_equal(nt_contact_law_eval(&law, point.indentation, NT_BRANCH_STABLE, &value), NT_OK);
            assert_near(value.F, force, 1e-18);
        }
}

static void cone_and_pyramid(void **state)
{
    (void)state;
    for (int model = NT_FIT_CONE; model <= NT_FIT_PYRAMID; model++) {
        nt_fit_options options = options_of((nt_fit_model)model, 2.0);
        options.half_angle = 0.4;
        const double angle = model == NT_FIT_CONE ? 0.4 : nt_pyramid_equivalent_angle(4, 0.4);
        for (int i = 1; i < 40; i++) {
            const double position = soft[NT_FIT_CONTACT_POINT] + i * 2e-9;
            const nt_fit_point point = point_at(&options, soft, position);
            const double force = nt_cone_eval(soft[0], angle, point.indentation).F;
            assert_near(contact_force(&options, soft, position), force, 1e-18);
            assert_near(point.indentation + force / 2.0, i * 2e-9, 1e-20);
        }
        assert_near(contact_force(&options, soft, 0.0), 0.0, 1e-24);
    }
}

/* Of sphere, three-sided pyramid and layers, by differences. */
static void gradient_of_the_shapes(void **state)
{
    (void)state;
    for (int model = NT_FIT_SPHERE; model <= NT_FIT_LAYER_CONE; model++) {
        nt_fit_options options = options_of((nt_fit_model)model, 0.0);
        const int layer = model >= NT_FIT_LAYER;
        options.half_angle = 0.4;
        double value[NT_FIT_PARAMETERS];
        for (int i = 0; i < NT_FIT_PARAMETERS; i++)
            value[i] = soft[i];
        value[NT_FIT_FOURTH] = layer ? 40e-9 : (double)NAN;
        for (int i = 1; i < 60; i++) { /* to several times the thickness: past the end of the polynomials */
            const double position = soft[NT_FIT_CONTACT_POINT] + i * 3e-9;
            const nt_fit_point point = point_at(&options, value, position);
            for (int p = 0; p < NT_FIT_OWN; p++) {
                if (!nt_fit_quantity_of(&options, (nt_fit_parameter)p).name)
                    continue;
                double force[2];
                for (int side = 0; side < 2; side++) {
                    double moved[NT_FIT_PARAMETERS];
                    for (int q = 0; q < NT_FIT_PARAMETERS; q++)
                        moved[q] = value[q] * (q == p ? 1.0 + (side ? 1e-5 : -1e-5) : 1.0);
                    force[side] = point_at(&options, moved, position).force;
                }
                const double by = (force[1] - force[0]) / (2e-5 * value[p]);
                assert_near(point.gradient[p], by, 1e-6 * fabs(by));
            }
        }
        assert_int_equal(nt_fit_quantity_of(&options, NT_FIT_FOURTH).name != NULL, layer);
    }
}

/* Without a cantilever the force stays at minus the pull-off force below the load fold. */
static void constant_below_load_fold(void **state)
{
    (void)state;
    const nt_fit_options options = options_of(NT_FIT_JKR, 0.0);
    assert_near(contact_force(&options, soft, -1e-6), -1.5 * NT_PI * options.radius * soft[1], 1e-21);
    const nt_fit_point point = point_at(&options, soft, -1e-6);
    assert_near(point.gradient[NT_FIT_WORK_OF_ADHESION], -1.5 * NT_PI * options.radius / 1.1, 1e-20);
    assert_true(point.gradient[NT_FIT_CONTACT_POINT] == 0.0);
    assert_false(point.held);
}

/* A stiff cantilever holds the contact beyond its lowest force: the force rises again, to where dX/ddelta = 0. There
 * the base stands at the smallest X of any equilibrium, which is searched for on the law itself. */
static void follows_the_unstable_branch_to_the_tear(void **state)
{
    (void)state;
    const double springs[] = {0.1, 1.0, 30.0};
    for (int model = NT_FIT_JKR; model <= NT_FIT_MAUGIS; model++)
        for (int spring = 0; spring < 3; spring++) {
            const nt_fit_options options = options_of((nt_fit_model)model, springs[spring]);
            const nt_contact contact = {options.radius, soft[0], soft[1], soft[1] / soft[2]};
            nt_contact_law law;
            assert_int_equal(nt_contact_law_init(&law, (nt_model)model, &contact), NT_OK);
            const double grip = nt_contact_law_grip_indentation(&law);
            double smallest = 1.0;
            for (int i = 1; i < 200000; i++) {
                nt_law_value value;
                assert_int_equal(nt_contact_law_eval(&law, grip + i * 1e-13, NT_BRANCH_STABLE, &value), NT_OK);
                smallest = smaller(smallest, grip + i * 1e-13 + value.F / springs[spring]);
            }
            double tear;
            assert_int_equal(nt_fit_tear_position(&options, soft, &tear), NT_OK);
            /* steps of 0.1 pm about a minimum, which the stiffest spring has close to the infinite slope at the grip
             * fold */
            assert_near(tear, soft[NT_FIT_CONTACT_POINT] + smallest, 2e-15);
            const nt_fit_point just_before = point_at(&options, soft, tear + 1e-9),
                               beyond = point_at(&options, soft, tear);
            assert_true(just_before.held);
            assert_false(beyond.held);
            assert_near(contact_force(&options, soft, tear - 1e-6), 0.0, 1e-21);
        }
    double untouched = 7.0;
    const nt_fit_options hertz = options_of(NT_FIT_HERTZ, 1.0), no_spring = options_of(NT_FIT_JKR, 0.0);
    assert_int_equal(nt_fit_tear_position(&hertz, soft, &untouched), NT_E_UNSUPPORTED);
    assert_int_equal(nt_fit_tear_position(&no_spring, soft, &untouched), NT_E_UNSUPPORTED);
    assert_true(untouched == 7.0);
}

/* A contact of small lambda lives on without touching (branch.c, apart) where the cantilever is stiff enough. */
static void follows_the_contact_that_does_not_touch(void **state)
{
    (void)state;
    const double value[NT_FIT_PARAMETERS] = {5e6, 0.05, 20e-9, 0.0, 0.0, 0.0, 0.0, 1.0}; /* lambda = 0.2 */
    const nt_fit_options options = options_of(NT_FIT_MAUGIS, 5.0);
    const nt_contact contact = {options.radius, value[0], value[1], value[1] / value[2]};
    nt_contact_law law;
    assert_int_equal(nt_contact_law_init(&law, NT_MAUGIS, &contact), NT_OK);
    double tear;
    int apart = 0;
    assert_int_equal(nt_fit_tear_position(&options, value, &tear), NT_OK);
    for (int i = 1; i < 1000; i++) {
        const nt_fit_point point = point_at(&options, value, tear + i * 0.03e-9);
        if (!point.held)
            continue;
        nt_law_value there;
        assert_int_equal(nt_contact_law_eval(&law, point.indentation, NT_BRANCH_STABLE, &there), NT_OK);
        assert_near(point.force, there.F, 1e-9 * 6e-9);
        apart += there.a == 0.0;
    }
    assert_true(apart > 10);
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
    static const double natural[NT_FIT_PARAMETERS] = {0, 0, 0, 0, 1e-10, 1e-10, 1e-3, 0};
    const nt_fit_point point = point_at(options, value, position);
    for (int i = 0; i < NT_FIT_PARAMETERS; i++) {
        const char *name = nt_fit_quantity_of(options, (nt_fit_parameter)i).name;
        if (name == NULL) {
            assert_true(point.gradient[i] == 0.0);
            continue;
        }
        const double size = natural[i] > 0.0 ? natural[i] : fabs(value[i]), h = 1e-3 * size;
        const double fine = difference(options, value, position, i, h / 2.0);
        const double numeric = fine + (fine - difference(options, value, position, i, h)) / 3.0;
        const double tolerance = 1e-7 * larger(fabs(point.force), 1e-9) / size;
        if (fabs(numeric - point.gradient[i]) > tolerance)
            fail_msg("model %d, k_c %g, X %g, %s: %.12g, difference %.12g", options->model, options->spring_constant,
                     position, name, point.gradient[i], numeric);
    }
}

static void gradient_matches_differences(void **state)
{
    (void)state;
    for (int model = 0; model < NT_FIT_CUSTOM; model++)
        for (int spring = 0; spring < 2; spring++)
            for (int i = 1; i < 12; i++) { /* off the kinks of the second derivative at first touch and fold */
                const nt_fit_options options = options_of((nt_fit_model)model, spring ? 3.0 : 0.0);
                check_gradient(&options, soft, soft[NT_FIT_CONTACT_POINT] + i * 4.1e-9);
                if (spring || model != NT_FIT_DMT)
                    check_gradient(&options, stiff, stiff[NT_FIT_CONTACT_POINT] + i * (spring ? 5.1e-9 : 0.51e-9));
            }
}

/* The same beyond the lowest force, where the cantilever is stiff enough, and on the straight continuation. */
static void gradient_beyond_the_lowest_force(void **state)
{
    (void)state;
    for (int model = NT_FIT_JKR; model <= NT_FIT_MAUGIS; model++) {
        const nt_fit_options options = options_of((nt_fit_model)model, 20.0);
        double tear;
        assert_int_equal(nt_fit_tear_position(&options, soft, &tear), NT_OK);
        check_gradient(&options, soft, tear - 0.02e-9);
        check_gradient(&options, soft, tear - 20e-9);
        for (int i = 1; i < 8; i++)
            check_gradient(&options, soft, tear + i * 0.9e-9);
    }
}

/* The same for lambda from the DMT to the JKR end, where the derivative by the range changes character. */
static void range_derivative_at_every_lambda(void **state)
{
    (void)state;
    const nt_fit_options options = options_of(NT_FIT_MAUGIS, 0.0);
    for (double range = 1e-11; range < 1e-7; range *= 3.0) {
        const double value[NT_FIT_PARAMETERS] = {5e6, 0.05, range, 0.0, 0.0, 0.0, 0.0, 1.0};
        for (int i = 1; i < 6; i++)
            check_gradient(&options, value, i * 6e-9);
    }
}

/* lambda -> infinity is JKR: 1e-4 at h0 = 1e-11 m, lambda = 400 (the difference falls as lambda^-2). */
static void maugis_tends_to_jkr(void **state)
{
    (void)state;
    const nt_fit_options maugis = options_of(NT_FIT_MAUGIS, 3.0), jkr = options_of(NT_FIT_JKR, 3.0);
    const double value[NT_FIT_PARAMETERS] = {5e6, 0.05, 1e-11, 0.0, 0.0, 0.0, 0.0, 1.0};
    for (int i = -1; i < 20; i++) {
        const nt_fit_point a = point_at(&maugis, value, i * 2e-9), b = point_at(&jkr, value, i * 2e-9);
        assert_near(a.force, b.force, 1e-4 * 4.7e-9);
        assert_near(a.gradient[NT_FIT_EFFECTIVE_MODULUS], b.gradient[NT_FIT_EFFECTIVE_MODULUS], 1e-4 * 4.7e-9 / 5e6);
    }
}

static void bad_values_are_refused(void **state)
{
    (void)state;
    const nt_fit_options options = options_of(NT_FIT_JKR, 0.0);
    nt_fit_point point = {.force = 7.0};
    double value[NT_FIT_PARAMETERS], position = NAN;
    const nt_fit_data data = {&position, NULL, 1, 1, 1};
    for (int i = 0; i < NT_FIT_PARAMETERS; i++)
        value[i] = soft[i];
    assert_int_equal(nt_fit_model_n(&options, value, &data, &point), NT_E_NOT_FINITE);
    position = 0.0;
    value[NT_FIT_EFFECTIVE_MODULUS] = -1.0;
    assert_int_equal(nt_fit_model_n(&options, value, &data, &point), NT_E_RANGE);
    value[NT_FIT_EFFECTIVE_MODULUS] = NAN;
    assert_int_equal(nt_fit_model_n(&options, value, &data, &point), NT_E_NOT_FINITE);
    assert_int_equal(nt_fit_model_n(NULL, value, &data, &point), NT_E_ARGUMENT);
    assert_true(point.force == 7.0);
    assert_null(nt_fit_quantity_of(&options, NT_FIT_COHESIVE_RANGE).name);
    assert_string_equal(nt_fit_quantity_of(&options, NT_FIT_WORK_OF_ADHESION).unit, "J/m^2");
    assert_string_equal(nt_fit_describe(NT_FIT_PYRAMID).name, "pyramid");
    assert_null(nt_fit_describe((nt_fit_model)99).name);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(obeys_cantilever_equation),
        cmocka_unit_test(cone_and_pyramid),
        cmocka_unit_test(gradient_of_the_shapes),
        cmocka_unit_test(constant_below_load_fold),
        cmocka_unit_test(follows_the_unstable_branch_to_the_tear),
        cmocka_unit_test(follows_the_contact_that_does_not_touch),
        cmocka_unit_test(gradient_matches_differences),
        cmocka_unit_test(gradient_beyond_the_lowest_force),
        cmocka_unit_test(range_derivative_at_every_lambda),
        cmocka_unit_test(maugis_tends_to_jkr),
        cmocka_unit_test(bad_values_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
