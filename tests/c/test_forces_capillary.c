/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "force_laws.h"
#include "internal/forces.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

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

FORCE_LAW(nt_capillary, nt_capillary_eval)

/* The same rules as all laws: held below 2e, where the films touch. */
static void rules(void **state)
{
    (void)state;
    const force_law law = {nt_capillary_eval_at, nt_capillary_eval_over, &water, nt_capillary_forms_at(&water)};
    assert_ends(&law);
    assert_array(&law);
    const nt_law_value at = nt_capillary_eval(&water, 10e-9), deep = nt_capillary_eval(&water, -INFINITY);
    assert_true(deep.F == at.F && deep.k == 0.0 && isinf(deep.U) && deep.U < 0.0);
    assert_true(nt_capillary_eval(&water, 0.0).F == at.F && nt_capillary_eval(&water, -5e-324).k == 0.0);
}

/* There and back: nothing until the films touch at 2e = 10 nm, then a bridge until 2e + 2 r1 = 12.12 nm; the work that
 * is lost in a cycle is that of pulling the bridge apart, half of 4 pi gamma R times 2 r1. */
static void bridge_forms_and_ruptures(void **state)
{
    (void)state;
    enum { N = 4001 };
    const double full = 4.0 * NT_PI * 0.072 * 30e-9, step = 16e-9 / (N - 1);
    static double gap[2 * N], F[2 * N];
    for (int i = 0; i < N; i++)
        gap[i] = gap[2 * N - 1 - i] = 16e-9 - i * step;
    int bridged = 0;
    const nt_strided there = {.in = gap, .F = F, .count = N, .in_stride = 1, .out_stride = 1};
    nt_capillary_trace_n(&water, &bridged, &there);
    assert_int_equal(bridged, 1);
    const nt_strided back = {.in = gap + N, .F = F + N, .count = N, .in_stride = 1, .out_stride = 1};
    nt_capillary_trace_n(&water, &bridged, &back);
    assert_int_equal(bridged, 0);
    double lost = 0.0;
    for (int i = 0; i < N; i++) {
        assert_true((F[i] == 0.0) == (gap[i] > nt_capillary_forms_at(&water)));
        assert_within(F[2 * N - 1 - i], nt_capillary_eval(&water, gap[i]).F, 0.0);
        lost += (F[i] - F[2 * N - 1 - i]) * step;
    }
    assert_within(nt_capillary_ruptures_at(&water), 12.12e-9, 1e-22);
    assert_within(lost, 0.5 * full * 2.12e-9, full * step);
}

static void bridge_is_a_state(void **state)
{
    (void)state;
    assert_int_equal(nt_capillary_advance(&water, 0, 10.001e-9), 0);
    assert_int_equal(nt_capillary_advance(&water, 0, 10e-9), 1);
    assert_int_equal(nt_capillary_advance(&water, 0, -1.0), 1);
    assert_int_equal(nt_capillary_advance(&water, 1, 12.11e-9), 1);
    assert_int_equal(nt_capillary_advance(&water, 1, 12.13e-9), 0);
    assert_int_equal(nt_capillary_advance(&water, 1, INFINITY), 0);
    for (int bridged = 0; bridged < 2; bridged++) {
        assert_int_equal(nt_capillary_advance(&water, bridged, NAN), bridged);
        const double gap = NAN;
        double F = 0.0;
        int now = bridged;
        nt_capillary_trace_n(&water, &now, &(nt_strided){.in = &gap, .F = &F, .count = 1});
        assert_true(isnan(F) && now == bridged);
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
        cmocka_unit_test(rules),
        cmocka_unit_test(bridge_forms_and_ruptures),
        cmocka_unit_test(bridge_is_a_state),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
