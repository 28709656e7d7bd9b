/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "force_laws.h"
#include "internal/forces.h"
#include "larger.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

/* Two brushes of 10 nm with a chain every 2 nm. */
static const nt_steric brush = {1e-6, 20e-9, 2e-9, 298.15, 0.5e-9};
FORCE_LAW(nt_steric, nt_steric_eval)
FORCE_LAW(nt_steric, nt_steric_exponential_eval)
static const force_law full = {nt_steric_eval_at, nt_steric_eval_over, &brush, 0.5e-9};
static const force_law exponential = {nt_steric_exponential_eval_at, nt_steric_exponential_eval_over, &brush, 0.5e-9};

/* Alexander and de Gennes' pressure of plates as printed, in units of kT/s^3, y = h/T. */
static double pressure(double y)
{
    return pow(1.0 / y, 9.0 / 4.0) - pow(y, 3.0 / 4.0);
}

/* Int_y^1 pressure and its own integral, Int_y^1 (x - y) pressure(x) dx, by Simpson in ln x. */
static void integrals(double y, double *once, double *twice)
{
    enum { N = 2000 };
    const double step = -log(y) / N;
    *once = *twice = 0.0;
    for (int i = 0; i <= N; i++) {
        const double x = i == N ? 1.0 : y * exp(i * step), weight = i == 0 || i == N ? 1.0 : i % 2 ? 4.0 : 2.0;
        *once += weight * step / 3.0 * x * pressure(x);
        *twice += weight * step / 3.0 * x * (x - y) * pressure(x);
    }
}

static void is_the_integral_of_the_pressure(void **state)
{
    (void)state;
    const double scale = 2.0 * NT_PI * brush.radius * NT_BOLTZMANN * brush.temperature / pow(brush.spacing, 3.0);
    for (double y = 0.026; y < 1.0; y += y < 0.9 ? 0.05 : 0.013) {
        double once, twice;
        integrals(y, &once, &twice);
        const nt_law_value value = nt_steric_eval(&brush, y * brush.thickness);
        assert_within(value.k, scale * pressure(y), 1e-13 * scale * pow(y, -2.25));
        assert_within(value.F, scale * brush.thickness * once, 1e-9 * value.F); /* Simpson */
        assert_within(value.U, scale * brush.thickness * brush.thickness * twice, 1e-9 * value.U);
    }
}

/* Where the brushes only just touch, t = 1 - h/T << 1: p = 3 t kT/s^3, so F/(2 pi R T) = 3 t^2/2 and U/(2 pi R T^2) =
 * t^3/2; the terms of the closed form cancel there to 1e-8 and 1e-12 of themselves. */
static void just_touching(void **state)
{
    (void)state;
    const double scale = 2.0 * NT_PI * brush.radius * NT_BOLTZMANN * brush.temperature / pow(brush.spacing, 3.0);
    const double T = brush.thickness, h = T * (1.0 - 1e-4), t = (T - h) / T; /* t is exact for this h */
    const nt_law_value value = nt_steric_eval(&brush, h);
    assert_within(value.k, scale * 3.0 * t, 2e-4 * value.k);
    assert_within(value.F, scale * T * 1.5 * t * t, 2e-4 * value.F);
    assert_within(value.U, scale * T * T * 0.5 * t * t * t, 2e-4 * value.U);
    assert_true(value.U > 0.0 && value.F > 0.0);
    assert_true(nt_steric_eval(&brush, T).F == 0.0 && nt_steric_eval(&brush, 2.0 * T).U == 0.0);
}

/* Series and closed form meet at h = T exp(-0.5). */
static void smooth_where_the_series_takes_over(void **state)
{
    (void)state;
    const double h = brush.thickness * exp(-0.5), step = 1e-14 * h;
    const nt_law_value left = nt_steric_eval(&brush, h - step), right = nt_steric_eval(&brush, h + step);
    assert_within(left.U, right.U + 2.0 * step * left.F, 1e-14 * left.U);
    assert_within(left.F, right.F + 2.0 * step * left.k, 1e-13 * left.F);
}

/* Israelachvili: p is about 100 kT/s^3 exp(-2 pi h/T) for 0.2 < h/T < 0.9. There it is within 24 %, on both sides. */
static void exponential_approximation(void **state)
{
    (void)state;
    double worst = 0.0;
    for (double y = 0.2; y <= 0.9001; y += 0.01) {
        const double ratio = nt_steric_exponential_eval(&brush, y * 20e-9).k / nt_steric_eval(&brush, y * 20e-9).k;
        worst = larger(worst, fabs(ratio - 1.0));
    }
    assert_within(worst, 0.233, 0.002);
}

static void slopes(void **state)
{
    (void)state;
    const nt_law_value scale = {.U = 1e-17, .F = 1e-9, .k = 0.1}; /* two orders below kT/s^3's */
    assert_slopes(&full, (double[]){0.51e-9, 19e-9}, scale);
    assert_slopes(&exponential, (double[]){0.51e-9, 40e-9}, (nt_law_value){0});
}

static void rules(void **state)
{
    (void)state;
    nt_problem problem;
    assert_keeps_the_rules(&full);
    assert_keeps_the_rules(&exponential);
    assert_int_equal(nt_steric_check(&brush, NULL), NT_OK);
    assert_int_equal(nt_steric_check(&(nt_steric){1e-6, 20e-9, 0.0, 298.0, 1e-9}, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "spacing");
    assert_int_equal(nt_steric_check(&(nt_steric){1e-6, 20e-9, 2e-9, NAN, 1e-9}, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "temperature");
    const nt_steric thin = {1e-6, 1e-9, 2e-9, 298.15, 1e-7}; /* held at a gap where there is no force yet */
    assert_true(nt_steric_eval(&thin, 0.5e-9).F == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_the_integral_of_the_pressure),
        cmocka_unit_test(just_touching),
        cmocka_unit_test(smooth_where_the_series_takes_over),
        cmocka_unit_test(exponential_approximation),
        cmocka_unit_test(slopes),
        cmocka_unit_test(rules),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
