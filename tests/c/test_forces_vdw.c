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

static const nt_vdw gold = {30e-9, 2.03e-19, 0.0, 0.165e-9}; /* the paper's Fig. 6 */

/* Hamaker's sum over the sphere, slice by slice: U = -H/6 Int (2Rx - x^2)/(s + x)^3 dx, F = -H/2 Int (..)/(s + x)^4 dx,
 * x = 0 .. 2R, with x = s (exp(u) - 1) by Simpson's rule. */
static void slices(double s, double *U, double *F)
{
    enum { N = 4000 };
    const double R = gold.radius, top = log1p(2.0 * R / s);
    *U = *F = 0.0;
    for (int i = 0; i <= N; i++) {
        const double u = top * i / N, z = s * exp(u), x = s * expm1(u);
        const double weight = (i == 0 || i == N ? 1.0 : i % 2 ? 4.0 : 2.0) * top / N / 3.0;
        *U -= weight * gold.hamaker_constant / 6.0 * (2.0 * R * x - x * x) / (z * z);
        *F -= weight * gold.hamaker_constant / 2.0 * (2.0 * R * x - x * x) / (z * z * z);
    }
}

static void is_hamakers_sphere(void **state)
{
    (void)state;
    for (double h = 0.2e-9; h < 1e-5; h *= 1.7) {
        double U, F;
        slices(h, &U, &F);
        const nt_law_value value = nt_vdw_eval(&gold, h);
        assert_within(value.U, U, 1e-9 * -U); /* Simpson: (top/N)^4 */
        assert_within(value.F, F, 1e-9 * -F);
    }
}

/* Far away, where the terms of the energy cancel to 1e-14 of themselves: -16/9 H R^3/s^3 (1/r^6 between a ball and a
 * half-space: U = -2 H R^3/(9 s^3)), up to 3 R/s. */
static void far_field(void **state)
{
    (void)state;
    for (double s = 1e-4; s < 1.0; s *= 10.0) {
        const double R = gold.radius, far = -2.0 / 9.0 * gold.hamaker_constant * pow(R / s, 3.0);
        assert_within(nt_vdw_eval(&gold, s).U, far, 3.1 * R / s * -far + 1e-14 * -far);
    }
}

/* Both expressions of the energy meet where one takes over from the other (R/(s + R) = 0.3): no step beyond rounding,
 * and the slope is the force on both sides. */
static void energy_is_smooth_where_the_series_takes_over(void **state)
{
    (void)state;
    const double s = gold.radius * 0.7 / 0.3, h = 1e-13;
    const nt_law_value left = nt_vdw_eval(&gold, s - h), right = nt_vdw_eval(&gold, s + h);
    assert_within(left.U - right.U, (left.F + right.F) * h, 1e-14 * -left.U);
}

FORCE_LAW(nt_vdw, nt_vdw_eval)
FORCE_LAW(nt_vdw, nt_vdw_derjaguin_eval)

static void rules(void **state)
{
    (void)state;
    const force_law sphere = {nt_vdw_eval_at, nt_vdw_eval_over, &gold, gold.minimum_gap};
    const force_law derjaguin = {nt_vdw_derjaguin_eval_at, nt_vdw_derjaguin_eval_over, &gold, gold.minimum_gap};
    assert_keeps_the_rules(&sphere);
    assert_keeps_the_rules(&derjaguin);
}

/* F = -dU/dh and k = -dF/dh; five points, truncation (step/s)^4. */
static void force_is_the_slope_of_the_energy(void **state)
{
    (void)state;
    const nt_vdw rough = {30e-9, 2.03e-19, 1e-9, 0.165e-9};
    for (double gap = 0.2e-9; gap < 1e-5; gap *= 1.6) {
        const double h = 2e-3 * gap;
        for (int derjaguin = 0; derjaguin < 2; derjaguin++) {
            nt_law_value at[5];
            for (int i = 0; i < 5; i++) {
                const double here = gap + (i - 2) * h;
                at[i] = derjaguin ? nt_vdw_derjaguin_eval(&rough, here) : nt_vdw_eval(&rough, here);
            }
            const double F = -(8.0 * (at[3].U - at[1].U) - (at[4].U - at[0].U)) / (12.0 * h);
            const double k = -(8.0 * (at[3].F - at[1].F) - (at[4].F - at[0].F)) / (12.0 * h);
            assert_within(at[2].F, F, 1e-9 * fabs(F));
            assert_within(at[2].k, k, 1e-9 * fabs(k));
            assert_true(at[2].F < 0.0 && at[2].k < 0.0 && at[2].U < 0.0 && at[2].a == 0.0);
        }
    }
}

/* Erratum E1: H R/(6 h^2) against the sphere, R = 30 nm. The first row is the paper's Fig. 6 at a0 = 0.198 nm. */
static void derjaguin_form_overestimates_as_stated(void **state)
{
    (void)state;
    assert_within(nt_vdw_derjaguin_eval(&gold, 0.198e-9).F, -25.89e-9, 0.01e-9);
    assert_within(nt_vdw_derjaguin_eval(&gold, 12e-9).F, -0.0070e-9, 0.0001e-9);
    const double gap[] = {0.2e-9, 1e-9, 3e-9, 10e-9, 30e-9, 100e-9};
    const double excess[] = {0.007, 0.034, 0.1025, 0.36, 1.25, 6.11};
    for (size_t i = 0; i < sizeof gap / sizeof *gap; i++) {
        const double ratio = nt_vdw_derjaguin_eval(&gold, gap[i]).F / nt_vdw_eval(&gold, gap[i]).F;
        assert_within(ratio - 1.0, excess[i], 0.02 * excess[i] + 0.0005);
    }
}

/* Erratum E2: the paper's factor (h/(h + b/2))^2 on H R/(6 h^2) is the gap h + b/2, algebraic and finite at contact. */
static void roughness_shifts_the_gap(void **state)
{
    (void)state;
    const nt_vdw rough = {30e-9, 2.03e-19, 1e-9, 0.165e-9};
    const double gap[] = {0.2e-9, 1e-9, 10e-9}, factor[] = {0.08, 0.44, 0.91};
    for (size_t i = 0; i < sizeof gap / sizeof *gap; i++) {
        const double printed = pow(gap[i] / (gap[i] + 0.5e-9), 2.0) * nt_vdw_derjaguin_eval(&gold, gap[i]).F;
        const double F = nt_vdw_derjaguin_eval(&rough, gap[i]).F;
        assert_within(F, printed, 1e-14 * -F);
        assert_within(F / nt_vdw_derjaguin_eval(&gold, gap[i]).F, factor[i], 0.005);
    }
    assert_true(isfinite(nt_vdw_eval(&rough, 0.0).F));
}

static void held_below_the_minimum_gap(void **state)
{
    (void)state;
    const nt_law_value at = nt_vdw_eval(&gold, gold.minimum_gap);
    for (double gap = -1e-6; gap < gold.minimum_gap; gap += 1.3e-8) {
        const nt_law_value value = nt_vdw_eval(&gold, gap);
        assert_true(value.F == at.F && value.k == 0.0);
        assert_within(value.U, at.U + at.F * (gold.minimum_gap - gap), 1e-15 * fabs(value.U));
    }
    assert_true(isnan(nt_vdw_eval(&gold, NAN).F) && isnan(nt_vdw_eval(&gold, NAN).U));
    const nt_law_value away = nt_vdw_eval(&gold, INFINITY);
    assert_true(away.U == 0.0 && away.F == 0.0 && away.k == 0.0);
}

static void check_names_the_field(void **state)
{
    (void)state;
    nt_problem problem;
    assert_int_equal(nt_vdw_check(&gold, NULL), NT_OK);
    assert_int_equal(nt_vdw_check(&(nt_vdw){30e-9, 2e-19, -1e-9, 1e-10}, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "roughness");
    assert_int_equal(nt_vdw_check(&(nt_vdw){30e-9, NAN, 0.0, 1e-10}, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "hamaker_constant");
    assert_int_equal(nt_vdw_check(&(nt_vdw){30e-9, 2e-19, 0.0, 0.0}, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "minimum_gap");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_hamakers_sphere),
        cmocka_unit_test(far_field),
        cmocka_unit_test(energy_is_smooth_where_the_series_takes_over),
        cmocka_unit_test(force_is_the_slope_of_the_energy),
        cmocka_unit_test(derjaguin_form_overestimates_as_stated),
        cmocka_unit_test(roughness_shifts_the_gap),
        cmocka_unit_test(held_below_the_minimum_gap),
        cmocka_unit_test(check_names_the_field),
        cmocka_unit_test(rules),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
