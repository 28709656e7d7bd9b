/* SPDX-License-Identifier: BSD-3-Clause */
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

/* A usual silicon tip: 10 nm apex, 20 degrees, 10 um high, gold sample. */
static const nt_vdw_tip silicon = {10e-9, 2.7e-19, 0.35, 10e-6, 0.0, 0.2e-9};
FORCE_LAW(nt_vdw_tip, nt_vdw_tip_eval)
static const force_law law = {nt_vdw_tip_eval_at, nt_vdw_tip_eval_over, &silicon, 0.2e-9};

/* r^2 of the tip at height x above the apex. */
static double profile(double x)
{
    const double R = silicon.radius, touch = R * (1.0 - sin(silicon.half_angle));
    if (x < touch)
        return 2.0 * R * x - x * x;
    const double r = R * cos(silicon.half_angle) + (x - touch) * tan(silicon.half_angle);
    return r * r;
}

/* Hamaker's sum, slice by slice: U = -H/6 Int r^2/z^3, F = -H/2 Int r^2/z^4, by Simpson in ln z from `from` to `to`. */
static void slices(double s, double from, double to, nt_law_value *sum)
{
    enum { N = 4000 };
    const double step = log((s + to) / (s + from)) / N;
    for (int i = 0; i <= N; i++) {
        const double z = (s + from) * exp(i * step), x = i == 0 ? from : i == N ? to : z - s;
        const double weight = (i == 0 || i == N ? 1.0 : i % 2 ? 4.0 : 2.0) * step / 3.0 * profile(x);
        sum->U -= weight * silicon.hamaker_constant / 6.0 / (z * z);
        sum->F -= weight * silicon.hamaker_constant / 2.0 / (z * z * z);
    }
}

static void is_hamakers_sum(void **state)
{
    (void)state;
    const double touch = silicon.radius * (1.0 - sin(silicon.half_angle));
    for (double h = 0.2e-9; h < 1e-4; h *= 1.7) {
        nt_law_value sum = {0};
        slices(h, 0.0, touch, &sum);
        slices(h, touch, touch + silicon.height, &sum);
        const nt_law_value value = nt_vdw_tip_eval(&silicon, h);
        assert_within(value.U, sum.U, 1e-9 * -sum.U); /* Simpson */
        assert_within(value.F, sum.F, 1e-9 * -sum.F);
    }
}

/* Argento and French, J. Appl. Phys. 80 (1996) 6081, for a cone without end. Here it ends at 10 um: short of it by
 * Int_L r^2/z^4 = tan^2(theta)/L. */
static void is_argento_and_frenchs_rounded_cone(void **state)
{
    (void)state;
    const double R = silicon.radius, H = silicon.hamaker_constant, g = silicon.half_angle, s = sin(g);
    for (double h = 0.2e-9; h < 100e-9; h *= 1.7) {
        const double base = R + h - R * s;
        const double apex = H * R * R * (1.0 - s) * (R * s - h * s - R - h) / (6.0 * h * h * base * base);
        const double cone = -H * tan(g) * (h * s + R * s + R * cos(2.0 * g)) / (6.0 * cos(g) * base * base);
        const double rest = -H / 2.0 * tan(g) * tan(g) / silicon.height;
        assert_within(nt_vdw_tip_eval(&silicon, h).F, apex + cone - rest, 0.03 * -rest + 1e-12 * -apex);
    }
}

/* Close up the cone does not matter; far from a small tip nothing but its volume does: U = -H V/(6 pi s^3). */
static void limits(void **state)
{
    (void)state;
    const nt_vdw sphere = {10e-9, 2.7e-19, 0.0, 0.2e-9};
    assert_within(nt_vdw_tip_eval(&silicon, 0.2e-9).F / nt_vdw_eval(&sphere, 0.2e-9).F, 1.0, 0.001);
    const nt_vdw_tip hemisphere = {10e-9, 2.7e-19, 0.0, 0.0, 0.0, 0.2e-9};
    const double s = 1e-3, volume = 2.0 / 3.0 * NT_PI * 1e-24, far = -2.7e-19 * volume / (6.0 * NT_PI * s * s * s);
    assert_within(nt_vdw_tip_eval(&hemisphere, s).U, far, 4.0 * 10e-9 / s * -far);
    const nt_vdw_tip rod = {10e-9, 2.7e-19, 0.0, 5e-9, 0.0, 0.2e-9};
    const double more = NT_PI * 1e-16 * 5e-9 / volume;
    assert_within(nt_vdw_tip_eval(&rod, s).U, far * (1.0 + more), 4.0 * 15e-9 / s * -far * (1.0 + more));
}

static void slopes(void **state)
{
    (void)state;
    assert_slopes(&law, (double[]){0.21e-9, 1e-2}, (nt_law_value){0});
}

static void rules(void **state)
{
    (void)state;
    assert_keeps_the_rules(&law);
    nt_problem problem;
    const nt_vdw_tip rough = {10e-9, 2.7e-19, 0.35, 10e-6, 1e-9, 0.2e-9};
    const double F = nt_vdw_tip_eval(&silicon, 1.5e-9).F;
    assert_within(nt_vdw_tip_eval(&rough, 1e-9).F, F, 1e-14 * -F);
    assert_int_equal(nt_vdw_tip_check(&silicon, NULL), NT_OK);
    assert_int_equal(nt_vdw_tip_check(&(nt_vdw_tip){10e-9, 2e-19, 1.6, 1e-5, 0.0, 1e-10}, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "half_angle");
    assert_int_equal(nt_vdw_tip_check(&(nt_vdw_tip){10e-9, 2e-19, 0.3, NAN, 0.0, 1e-10}, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "height");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_hamakers_sum), cmocka_unit_test(is_argento_and_frenchs_rounded_cone),
        cmocka_unit_test(limits),          cmocka_unit_test(slopes),
        cmocka_unit_test(rules),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
