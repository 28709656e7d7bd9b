/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../reference/geometry_table.h"
#include "assertions.h"
#include "internal/contact.h"
#include "internal/geometry.h"
#include "larger.h"
#include "nanotouch/advanced/geometry.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* One of each kind, as a tip of some 20 nm. */
static const nt_shape tips[] = {
    {NT_SHAPE_PARABOLOID, 0, 20e-9, 0.0, 0.0}, {NT_SHAPE_SPHERE, 0, 20e-9, 0.0, 0.0},
    {NT_SHAPE_CONE, 0, 0.0, 0.6, 0.0},         {NT_SHAPE_CONE, 3, 0.0, 0.6, 0.0},
    {NT_SHAPE_CONE, 4, 0.0, 0.6, 0.0},         {NT_SHAPE_PUNCH, 0, 20e-9, 0.0, 0.0},
    {NT_SHAPE_BLUNTED, 0, 20e-9, 0.6, 0.0},    {NT_SHAPE_BLUNTED, 4, 20e-9, 0.6, 10e-9},
    {NT_SHAPE_TRUNCATED, 0, 20e-9, 0.6, 0.0},  {NT_SHAPE_TRUNCATED, 3, 20e-9, 0.6, 0.0},
};

/* Galin's integrals with 40 digits. The bound is in roundings (2^-53): measured 2 (a), 4 (F), 7 (U), 2
 * (indentation); libm's functions differ by a rounding or two. */
static void agrees_with_the_oracle(void **state)
{
    (void)state;
    double worst[4] = {0};
    for (size_t i = 0; i < COUNT(geometry_table); i++) {
        const nt_shape *shape = &geometry_table[i].shape;
        const double d = geometry_table[i].indentation, a = geometry_table[i].a, F = geometry_table[i].F;
        const double U = geometry_table[i].U;
        const nt_law_value value = nt_shape_eval(shape, 1.0, d);
        const double errors[4] = {fabs(value.a / a - 1.0), fabs(value.F / F - 1.0), fabs(value.U / U - 1.0),
                                  fabs(nt_shape_indentation(shape, 1.0, F) / d - 1.0)};
        for (int j = 0; j < 4; j++)
            worst[j] = larger(worst[j], errors[j] / (0.5 * DBL_EPSILON));
        assert_within(value.k, 2.0 * a, 1e-14 * value.k);
    }
    print_message("roundings: a %.1f, F %.1f, U %.1f, indentation %.1f\n", worst[0], worst[1], worst[2], worst[3]);
    for (int j = 0; j < 4; j++)
        assert_in_range(worst[j], 0, 24);
}

static double slope_of(const nt_shape *shape, double r)
{
    const double flank = shape->kind == NT_SHAPE_PARABOLOID ? 0.0 : 1.0 / tan(shape->half_angle), R = shape->radius;
    switch (shape->kind) {
    case NT_SHAPE_PARABOLOID:
        return r / R;
    case NT_SHAPE_SPHERE:
        return r / sqrt((R - r) * (R + r));
    case NT_SHAPE_BLUNTED:
        return r < (shape->transition > 0.0 ? shape->transition : R * flank) ? r / R : flank;
    case NT_SHAPE_TRUNCATED:
        return r < R ? 0.0 : flank;
    default:
        return shape->kind == NT_SHAPE_CONE ? flank : 0.0;
    }
}

/* Galin's integrals by the midpoint rule in r = a sin(t): second order, and first order of one cell at a kink. */
static void obeys_galins_integrals(void **state)
{
    (void)state;
    enum { N = 20000 };
    for (size_t i = 0; i < COUNT(tips); i++) {
        if (tips[i].sides != 0 || tips[i].kind == NT_SHAPE_PUNCH)
            continue;
        for (double d = 1e-10; d < 20e-9; d *= 2.7) {
            const nt_law_value value = nt_shape_eval(&tips[i], 1e9, d);
            double depth = 0.0, force = 0.0;
            for (int j = 0; j < N; j++) {
                const double t = (j + 0.5) * 0.5 * NT_PI / N, dt = 0.5 * NT_PI / N;
                const double slope = slope_of(&tips[i], value.a * sin(t));
                depth += value.a * slope * dt;
                force += 2e9 * value.a * value.a * sin(t) * sin(t) * slope * dt;
            }
            const double kink = tips[i].kind == NT_SHAPE_TRUNCATED ? 1e-4 * value.a / tan(0.6) : 1e-4 * d;
            assert_within(depth, d, kink);
            if (tips[i].kind != NT_SHAPE_TRUNCATED) /* whose F is 2 E* (a delta - Int g), punch and flank together */
                assert_within(force, value.F, 3e-4 * value.F);
            else
                assert_within(force, value.F, 2e9 * value.a * kink);
        }
    }
}

static void paraboloid_is_hertz(void **state)
{
    (void)state;
    const nt_contact hertz = {.radius = 20e-9, .effective_modulus = 1e9};
    for (double d = 1e-15; d < 1e-6; d *= 7.0) {
        const nt_law_value value = nt_shape_eval(&tips[0], 1e9, d), expected = nt_hertz_eval(&hertz, d);
        assert_true(value.F == expected.F && value.U == expected.U && value.a == expected.a);
        assert_within(nt_shape_indentation(&tips[0], 1e9, value.F), d, 8.0 * DBL_EPSILON * d);
    }
}

/* F = dU/ddelta and k = dF/ddelta by central differences: h = 1e-4 delta leaves h^2/delta^2 and rounding/1e-4. */
static void force_and_stiffness_are_derivatives(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(tips); i++)
        for (double d = 1e-12; d < 2e-6; d *= 3.7) {
            const double h = 1e-4 * d;
            const nt_law_value at = nt_shape_eval(&tips[i], 1e9, d);
            const nt_law_value up = nt_shape_eval(&tips[i], 1e9, d + h), down = nt_shape_eval(&tips[i], 1e9, d - h);
            assert_within((up.U - down.U) / (2.0 * h), at.F, 3e-8 * at.F);
            assert_within((up.F - down.F) / (2.0 * h), at.k, 1e-7 * at.k);
            assert_within(at.k, 2e9 * at.a, 1e-14 * at.k);
        }
}

/* Any radius, modulus and indentation: finite, positive, ordered, and delta(F(delta)) = delta to 2^-53 times a few. */
static void inverse_returns_at_all_scales(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(tips); i++)
        for (double R = 1e-10; R <= 1.0; R *= 1e5)
            for (double E = 1e2; E <= 1e13; E *= 3e5) {
                nt_shape shape = tips[i];
                shape.radius *= R / 20e-9;
                shape.transition *= R / 20e-9;
                double last = 0.0;
                for (double d = 1e-15; d <= 1.0; d *= 33.0) {
                    const nt_law_value value = nt_shape_eval(&shape, E, d);
                    assert_true(isfinite(value.U) && isfinite(value.k) && value.U > 0.0 && value.a > 0.0);
                    assert_true(value.F > last && (shape.kind != NT_SHAPE_SPHERE || value.a <= R));
                    last = value.F;
                    assert_within(nt_shape_indentation(&shape, E, value.F), d, 24.0 * DBL_EPSILON * d);
                }
            }
}

/* The sphere is close to Hertz: F = F_H (1 - delta/(10 R)), a = a_H (1 - delta/(6 R)), next terms of order (delta/R)^2,
 * with coefficients below 1/20 and 1/10 (series of u tanh u and (1 + tanh^2 u) u - tanh u). */
static void sphere_goes_to_hertz_with_the_right_slope(void **state)
{
    (void)state;
    for (double x = 1e-7; x < 0.1; x *= 3.0) {
        const nt_shape sphere = {NT_SHAPE_SPHERE, 0, 1.0, 0.0, 0.0};
        const nt_contact paraboloid = {.radius = 1.0, .effective_modulus = 1.0};
        const nt_law_value exact = nt_shape_eval(&sphere, 1.0, x), hertz = nt_hertz_eval(&paraboloid, x);
        assert_within(exact.F / hertz.F, 1.0 - x / 10.0, x * x / 20.0 + 1e-14);
        assert_within(exact.a / hertz.a, 1.0 - x / 6.0, x * x / 10.0 + 1e-14);
        assert_within(exact.U / hertz.U, 1.0 - x / 14.0, x * x / 20.0 + 1e-14); /* Int of the above */
    }
}

/* A wide end is the cap or the punch, a narrow one the cone: with the next order, a b/delta correction. */
static void blunted_goes_to_paraboloid_and_cone(void **state)
{
    (void)state;
    const nt_shape blunted = {NT_SHAPE_BLUNTED, 0, 1e-6, 0.4, 0.0},
                   paraboloid = {NT_SHAPE_PARABOLOID, 0, 1e-6, 0.0, 0.0};
    assert_true(nt_shape_eval(&blunted, 1e9, 1e-9).F == nt_shape_eval(&paraboloid, 1e9, 1e-9).F);
    for (double b = 1e-10; b > 1e-15; b /= 10.0) {
        const nt_shape flat = {NT_SHAPE_TRUNCATED, 0, b, 0.4, 0.0}, cone = {NT_SHAPE_CONE, 0, 0.0, 0.4, 0.0};
        const nt_shape cap = {NT_SHAPE_BLUNTED, 0, b, 0.4, 0.0};
        const double F = nt_shape_eval(&cone, 1e9, 1e-7).F;
        assert_within(nt_shape_eval(&flat, 1e9, 1e-7).F / F - 1.0, 0.0, 30.0 * b / 1e-7);
        assert_within(nt_shape_eval(&cap, 1e9, 1e-7).F / F - 1.0, 0.0, 30.0 * b / 1e-7);
        assert_true(nt_shape_eval(&flat, 1e9, 1e-7).F > F && nt_shape_eval(&cap, 1e9, 1e-7).F > F);
    }
    const nt_shape flat = {NT_SHAPE_TRUNCATED, 0, 1e-6, 0.4, 0.0}, punch = {NT_SHAPE_PUNCH, 0, 1e-6, 0.0, 0.0};
    const double shallow = nt_shape_eval(&flat, 1e9, 1e-13).F / nt_shape_eval(&punch, 1e9, 1e-13).F;
    assert_within(shallow, 1.0, 1e-13 / 1e-6); /* F/(2 E* b delta) = 1 + O((delta/b)^2) */
}

/* The blunted cone is continuous in F, k, U at its transition, tangent or not. */
static void joins_without_a_step(void **state)
{
    (void)state;
    for (int tangent = 0; tangent < 2; tangent++) {
        const nt_shape shape = {NT_SHAPE_BLUNTED, 0, 20e-9, 0.6, tangent ? 0.0 : 10e-9};
        const double b = tangent ? 20e-9 / tan(0.6) : 10e-9, touch = b * b / 20e-9;
        const nt_law_value before = nt_shape_eval(&shape, 1e9, touch * (1.0 - 1e-12));
        const nt_law_value after = nt_shape_eval(&shape, 1e9, touch * (1.0 + 1e-12));
        assert_within(after.F, before.F, 4e-12 * before.F);
        assert_within(after.U, before.U, 6e-12 * before.U);
        assert_within(after.a, before.a, 4e-12 * before.a);
    }
}

/* Rico et al. 2005 write the blunted pyramid with tan(psi_eq) = pi tan(psi)/(2 sqrt 2); with that cone their printed
 * equations are ours: F/(2 E*) = a delta - theta a^2/2 (pi/2 - asin(b/a)) - a^3/(3 R) + s (theta b/2 + s^2/(3 R)). */
static void blunted_cone_is_as_published(void **state)
{
    (void)state;
    const double E = 5e3, R = 50e-9, b = 20e-9, psi = atan(NT_PI * tan(0.35) / (2.0 * sqrt(2.0))),
                 theta = 1.0 / tan(psi);
    const nt_shape shape = {NT_SHAPE_BLUNTED, 0, R, psi, b};
    for (double d = 1.1 * b * b / R; d < 1e-6; d *= 2.0) {
        const nt_law_value value = nt_shape_eval(&shape, E, d);
        const double a = value.a, s = sqrt(a * a - b * b), phi = 0.5 * NT_PI - asin(b / a);
        assert_within(a / R * (a - s) + theta * a * phi, d, 1e-13 * d);
        const double F =
            2.0 * E *
            (a * d - 0.5 * theta * a * a * phi - a * a * a / (3.0 * R) + s * (0.5 * theta * b + s * s / (3.0 * R)));
        assert_within(value.F, F, 1e-12 * F);
    }
}

static void pyramids_are_equivalent_cones(void **state)
{
    (void)state;
    const int sides[2] = {3, 4};
    const double coefficient[2] = {0.87960, 0.73762};
    for (int i = 0; i < 2; i++) {
        const nt_shape pyramid = {NT_SHAPE_CONE, sides[i], 0.0, 0.35, 0.0};
        const double F = nt_shape_eval(&pyramid, 1e9, 1e-7).F;
        assert_within(F, coefficient[i] * 1e9 * tan(0.35) * 1e-14, 1e-14 * F);
    }
    assert_true(nt_pyramid_equivalent_angle(0, 0.35) == 0.35);
    assert_true(isnan(nt_pyramid_equivalent_angle(5, 0.35)) && isnan(nt_pyramid_equivalent_angle(4, NAN)));
}

static void what_is_no_number_or_no_contact(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(tips); i++) {
        const nt_law_value apart = nt_shape_eval(&tips[i], 1e9, -1e-9), none = nt_shape_eval(&tips[i], 1e9, 0.0);
        assert_true(apart.F == 0.0 && apart.U == 0.0 && apart.k == 0.0 && apart.a == 0.0 && none.a == 0.0);
        assert_true(nt_shape_eval(&tips[i], 1e9, -INFINITY).F == 0.0);
        assert_true(isnan(nt_shape_eval(&tips[i], 1e9, NAN).F) && isnan(nt_shape_eval(&tips[i], 1e9, INFINITY).U));
        assert_true(isnan(nt_shape_eval(&tips[i], NAN, 1e-9).F));
        const double tiny = nt_shape_eval(&tips[i], 1e9, 4e-320).F; /* denormal */
        assert_true(tiny >= 0.0 && tiny < 1e-290);
        assert_true(nt_shape_indentation(&tips[i], 1e9, 0.0) == 0.0);
        assert_true(nt_shape_indentation(&tips[i], 1e9, 1e-310) >= 0.0);
        assert_true(isnan(nt_shape_indentation(&tips[i], 1e9, -1e-9)) &&
                    isnan(nt_shape_indentation(&tips[i], 1e9, NAN)));
        assert_true(isnan(nt_shape_indentation(&tips[i], 1e9, INFINITY)));
    }
}

static void check_names_the_field(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(tips); i++)
        assert_int_equal(nt_shape_check(&tips[i], NULL), NT_OK);
    nt_problem problem = {0};
    nt_shape shape = {NT_SHAPE_SPHERE, 0, 2.0, 0.0, 0.0};
    assert_int_equal(nt_shape_check(&shape, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "radius");
    shape = (nt_shape){NT_SHAPE_CONE, 0, 0.0, NAN, 0.0};
    assert_int_equal(nt_shape_check(&shape, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "half_angle");
    shape = (nt_shape){NT_SHAPE_CONE, 5, 0.0, 0.3, 0.0};
    assert_int_equal(nt_shape_check(&shape, &problem), NT_E_ARGUMENT);
    assert_string_equal(problem.field, "sides");
    shape = (nt_shape){NT_SHAPE_BLUNTED, 0, 1e-8, 1.2, 1e-8}; /* cot 1.2 = 0.39 */
    assert_int_equal(nt_shape_check(&shape, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "transition");
    assert_within(problem.maximum, 1e-8 / tan(1.2), 1e-22);
    shape.kind = (nt_shape_kind)17;
    assert_int_equal(nt_shape_check(&shape, &problem), NT_E_ARGUMENT);
    assert_string_equal(problem.field, "kind");
    assert_string_equal(nt_shape_name(NT_SHAPE_TRUNCATED), "truncated");
    assert_string_equal(nt_shape_name((nt_shape_kind)17), "unknown");
}

static void arrays_are_the_scalar_law(void **state)
{
    (void)state;
    const double in[6] = {1e-9, 0.0, 2e-9, 0.0, NAN, 0.0};
    double F[3], a[3];
    const nt_strided arrays = {.in = in, .F = F, .a = a, .count = 3, .in_stride = 2, .out_stride = 1};
    nt_shape_eval_n(&tips[1], 1e9, &arrays);
    assert_true(F[0] == nt_shape_eval(&tips[1], 1e9, 1e-9).F && a[1] == nt_shape_eval(&tips[1], 1e9, 2e-9).a);
    assert_true(isnan(F[2]) && isnan(a[2]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_the_oracle),
        cmocka_unit_test(obeys_galins_integrals),
        cmocka_unit_test(paraboloid_is_hertz),
        cmocka_unit_test(force_and_stiffness_are_derivatives),
        cmocka_unit_test(inverse_returns_at_all_scales),
        cmocka_unit_test(sphere_goes_to_hertz_with_the_right_slope),
        cmocka_unit_test(blunted_goes_to_paraboloid_and_cone),
        cmocka_unit_test(joins_without_a_step),
        cmocka_unit_test(blunted_cone_is_as_published),
        cmocka_unit_test(pyramids_are_equivalent_cones),
        cmocka_unit_test(what_is_no_number_or_no_contact),
        cmocka_unit_test(check_names_the_field),
        cmocka_unit_test(arrays_are_the_scalar_law),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
