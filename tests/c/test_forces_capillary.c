/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/forces.h"
#include "nanotouch/material.h"

static void assert_within(double value, double expected, double bound)
{
    if (!(fabs(value - expected) <= bound))
        fail_msg("%.17g differs from %.17g by %g, bound %g", value, expected, fabs(value - expected), bound);
}


static const nt_capillary water = {30e-9, 0.072, 1.06e-9, 5e-9}; /* the paper's Fig. 6 */

/* The literal bracket inside its range, and erratum E3 outside: -152.6 nN at 0.198 nm is clamped to -27.14 nN, and
 * +36.9 nN at 15 nm, a repulsive meniscus, to nothing. */
static void fig_6(void **state)
{
    (void)state;
    const double gap[] = {0.198e-9, 1e-9, 5e-9, 12e-9, 15e-9, 30e-9};
    const double clamped[] = {-27.14e-9, -27.14e-9, -27.14e-9, -1.54e-9, 0.0, 0.0};
    for (size_t i = 0; i < sizeof gap / sizeof *gap; i++)
        assert_within(nt_capillary_eval(&water, gap[i]).F, clamped[i], 0.005e-9);
}

/* In contact it is the adhesion w = 2 gamma_L of DMT, 2 pi R w: the same force seen from two sides (erratum E5b). */
static void contact_value_is_the_dmt_pull_off(void **state)
{
    (void)state;
    const double pull_off = 2.0 * NT_PI * water.radius * 2.0 * water.surface_tension;
    assert_within(nt_capillary_eval(&water, 0.0).F, -pull_off, 1e-14 * pull_off);
}

/* Work of pulling the bridge apart: triangle of height F and base 2 r1, plus the flat part below 2e. */
static void energy_is_the_work_of_separation(void **state)
{
    (void)state;
    const double F = 4.0 * NT_PI * 0.072 * 30e-9, length = 2.0 * 1.06e-9;
    assert_within(nt_capillary_eval(&water, 10e-9).U, -0.5 * F * length, 1e-13 * F * length);
    assert_within(nt_capillary_eval(&water, 4e-9).U, -0.5 * F * length - 6e-9 * F, 1e-13 * F * 1e-8);
    assert_true(nt_capillary_eval(&water, 10e-9 + length).U == 0.0);
}

/* The energy is quadratic piece by piece: central differences are exact up to rounding. */
static void force_is_the_slope_of_the_energy(void **state)
{
    (void)state;
    const double h = 1e-11, full = 4.0 * NT_PI * 0.072 * 30e-9;
    for (double gap = 1.1e-9; gap < 14e-9; gap += 0.2e-9) {
        const nt_law_value left = nt_capillary_eval(&water, gap - h), right = nt_capillary_eval(&water, gap + h);
        const nt_law_value value = nt_capillary_eval(&water, gap);
        assert_within(value.F, -(right.U - left.U) / (2.0 * h), 1e-9 * full);
        assert_within(value.k, -(right.F - left.F) / (2.0 * h), 1e-9 * full / 1e-9);
        assert_true(value.F <= 0.0 && value.F >= -full * (1.0 + DBL_EPSILON));
    }
}

/* Water at 20 C: gamma V_m/(R T) = 0.54 nm; r = 0.54 nm/ln(1/RH) (Israelachvili: 1.6 nm at 70 %, 0.5 nm at 37 %). */
static void kelvin_radius_of_water(void **state)
{
    (void)state;
    assert_within(nt_kelvin_radius(0.0728, 18.07e-6, 293.15, exp(-1.0)), 0.5397e-9, 0.0002e-9);
    assert_within(nt_kelvin_radius(0.0728, 18.07e-6, 293.15, 0.4), 0.589e-9, 0.001e-9);
    assert_within(nt_kelvin_radius(0.0728, 18.07e-6, 293.15, 0.61), 1.09e-9, 0.01e-9); /* erratum E4: r1 = 1.06 nm */
    const double no[] = {0.0, 1.0, 1.2, -0.1, NAN};
    for (size_t i = 0; i < sizeof no / sizeof *no; i++)
        assert_true(isnan(nt_kelvin_radius(0.0728, 18.07e-6, 293.15, no[i])));
}

static void nan_and_check(void **state)
{
    (void)state;
    const nt_law_value value = nt_capillary_eval(&water, NAN);
    assert_true(isnan(value.U) && isnan(value.F));
    nt_problem problem;
    assert_int_equal(nt_capillary_check(&water, NULL), NT_OK);
    assert_int_equal(nt_capillary_check(&(nt_capillary){30e-9, 0.072, 0.0, 5e-9}, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "meniscus_radius");
    assert_int_equal(nt_capillary_check(&(nt_capillary){30e-9, INFINITY, 1e-9, 5e-9}, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "surface_tension");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fig_6),
        cmocka_unit_test(contact_value_is_the_dmt_pull_off),
        cmocka_unit_test(energy_is_the_work_of_separation),
        cmocka_unit_test(force_is_the_slope_of_the_energy),
        cmocka_unit_test(kelvin_radius_of_water),
        cmocka_unit_test(nan_and_check),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
