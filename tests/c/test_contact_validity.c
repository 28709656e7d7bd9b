/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "internal/contact.h"
#include "nanotouch/advanced/geometry.h"

static nt_contact_validity judge(nt_shape shape, double a, double indentation, double thickness)
{
    nt_contact_validity validity;
    assert_int_equal(nt_contact_validity_of(&shape, a, indentation, thickness, &validity), NT_OK);
    return validity;
}

static const nt_shape paraboloid = {NT_SHAPE_PARABOLOID, 0, 30e-9, 0.0, 0.0};
static const nt_shape sphere = {NT_SHAPE_SPHERE, 0, 30e-9, 0.0, 0.0};

/* Each quantity alone crosses its limit. */
static void ranges_end_where_they_say(void **state)
{
    (void)state;
    assert_int_equal(judge(paraboloid, 8.9e-9, 2e-9, INFINITY).outside, 0);
    assert_int_equal(judge(paraboloid, 9.1e-9, 2e-9, INFINITY).outside, NT_OUTSIDE_RADIUS_RATIO);
    assert_int_equal(judge(sphere, 13e-9, 5e-9, INFINITY).outside, 0); /* the sphere's law needs no a << R */
    const nt_contact_validity steep = judge(sphere, 14e-9, 6e-9, INFINITY);
    assert_int_equal(steep.outside, NT_OUTSIDE_SLOPE);
    assert_within(steep.slope, tan(asin(14.0 / 30.0)), 1e-15);
    assert_int_equal(judge(sphere, 15.1e-9, 7e-9, INFINITY).outside, NT_OUTSIDE_SLOPE | NT_OUTSIDE_STRAIN);
    assert_int_equal(judge(paraboloid, 5e-9, 1e-9, 49e-9).outside, NT_OUTSIDE_THICKNESS);
    assert_int_equal(judge(paraboloid, 5e-9, 1e-9, 51e-9).outside, 0);
    const nt_shape punch = {NT_SHAPE_PUNCH, 0, 30e-9, 0.0, 0.0};
    assert_int_equal(judge(punch, 30e-9, 9.9e-9, INFINITY).outside, 0);
    assert_int_equal(judge(punch, 30e-9, -10.1e-9, INFINITY).outside, NT_OUTSIDE_STRAIN);
}

static void cones_are_judged_by_their_slope(void **state)
{
    (void)state;
    for (int sides = 0; sides < 5; sides += sides == 0 ? 3 : 1) {
        const nt_shape flat = {NT_SHAPE_CONE, sides, 0.0, 1.2, 0.0}, sharp = {NT_SHAPE_CONE, sides, 0.0, 0.35, 0.0};
        assert_int_equal(judge(flat, 1e-9, 1e-9, INFINITY).outside, 0);
        assert_int_equal(judge(sharp, 1e-9, 1e-9, INFINITY).outside, NT_OUTSIDE_SLOPE | NT_OUTSIDE_STRAIN);
        assert_within(judge(sharp, 1e-9, 1e-9, INFINITY).strain, 0.2 / tan(0.35), 1e-15);
    }
}

/* A blunted cone is its cap first and its flank then. */
static void blunted_tip_changes_at_its_transition(void **state)
{
    (void)state;
    const nt_shape tip = {NT_SHAPE_BLUNTED, 0, 30e-9, 0.35, 20e-9};
    const nt_contact_validity cap = judge(tip, 3e-9, 1e-9, INFINITY), flank = judge(tip, 25e-9, 30e-9, INFINITY);
    assert_within(cap.radius_ratio, 0.1, 1e-15);
    assert_within(cap.slope, 0.1, 1e-15);
    assert_within(flank.radius_ratio, 20.0 / 30.0, 1e-15);
    assert_within(flank.slope, 1.0 / tan(0.35), 1e-15);
    assert_int_equal(cap.outside, 0);
    assert_int_equal(flank.outside, NT_OUTSIDE_RADIUS_RATIO | NT_OUTSIDE_SLOPE | NT_OUTSIDE_STRAIN);
}

/* The limit a/R = 0.3 of the paraboloid is where it is 0.9 % stiffer than the sphere that it stands for. */
static void radius_limit_is_worth_one_percent(void **state)
{
    (void)state;
    const double d = 30e-9 * NT_VALID_RADIUS_RATIO * NT_VALID_RADIUS_RATIO;
    const double ratio = nt_shape_eval(&paraboloid, 1e9, d).F / nt_shape_eval(&sphere, 1e9, d).F;
    assert_within(ratio, 1.009, 0.0005);
}

/* The thickness limit: Dimitriadis et al. 2002, Eq. 12, bonded and incompressible, at chi = a/t = 0.1. */
static void thickness_limit_is_worth_thirteen_percent(void **state)
{
    (void)state;
    const double x = NT_VALID_THICKNESS_RATIO;
    const double factor = 1.0 + 1.133 * x + 1.283 * x * x + 0.769 * pow(x, 3.0) + 0.0975 * pow(x, 4.0);
    assert_within(factor, 1.127, 0.001);
}

/* Erratum E13: "MD can be used for all cases": rubber of 0.6 MPa, w = 0.144, R = 30 nm rests at a = 132 nm, a/R = 4.4.
 */
static void finds_the_papers_rubber(void **state)
{
    (void)state;
    const nt_contact rubber = {30e-9, 0.6e6 / 0.75, 0.144, nt_cohesive_stress_atomic(0.144, 0.2e-9)};
    nt_maugis maugis;
    assert_int_equal(nt_maugis_init(&maugis, &rubber), NT_OK);
    const double a = maugis.folds.zero_load_radius * maugis.radius_scale;
    const double d = maugis.folds.zero_load_indentation * maugis.indentation_scale;
    const nt_contact_validity validity = judge(paraboloid, a, d, INFINITY);
    assert_within(validity.radius_ratio, 4.4, 0.1);
    assert_int_equal(validity.outside, NT_OUTSIDE_RADIUS_RATIO | NT_OUTSIDE_SLOPE | NT_OUTSIDE_STRAIN);
}

static void nothing_touches_nothing_is_outside(void **state)
{
    (void)state;
    const nt_shape cone = {NT_SHAPE_CONE, 0, 0.0, 0.35, 0.0};
    const nt_contact_validity apart = judge(cone, 0.0, -5e-9, 10e-9);
    assert_true(apart.outside == 0 && apart.slope == 0.0 && apart.strain == 0.0);
    nt_contact_validity validity;
    assert_int_equal(nt_contact_validity_of(&cone, NAN, 0.0, 1.0, &validity), NT_E_NOT_FINITE);
    assert_int_equal(nt_contact_validity_of(&cone, 1e-9, INFINITY, 1.0, &validity), NT_E_NOT_FINITE);
    assert_int_equal(nt_contact_validity_of(&cone, 1e-9, 0.0, NAN, &validity), NT_E_NOT_FINITE);
    assert_int_equal(nt_contact_validity_of(&cone, -1e-9, 0.0, 1.0, &validity), NT_E_RANGE);
    assert_int_equal(nt_contact_validity_of(&cone, 1e-9, 0.0, 0.0, &validity), NT_E_RANGE);
    assert_true(isinf(judge(sphere, 31e-9, 1e-6, INFINITY).slope)); /* no sphere has such a radius */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranges_end_where_they_say),
        cmocka_unit_test(cones_are_judged_by_their_slope),
        cmocka_unit_test(blunted_tip_changes_at_its_transition),
        cmocka_unit_test(radius_limit_is_worth_one_percent),
        cmocka_unit_test(thickness_limit_is_worth_thirteen_percent),
        cmocka_unit_test(finds_the_papers_rubber),
        cmocka_unit_test(nothing_touches_nothing_is_outside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
