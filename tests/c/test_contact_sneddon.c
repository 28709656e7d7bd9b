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
#include "nanotouch/contact.h"
#include "nanotouch/material.h"

/* Sneddon's integrals for a rigid profile f(r) of contact radius a:
 *     delta = a Int_0^a f'(r)/sqrt(a^2 - r^2) dr,     F = 2 E* Int_0^a r^2 f'(r)/sqrt(a^2 - r^2) dr,
 * with r = a sin(t) the midpoint rule converges. For a cone f' = cot(psi). */
static void cone_obeys_sneddons_integrals(void **state)
{
    (void)state;
    const double E = 1e9, a = 10e-9;
    enum { N = 20000 };
    for (double psi = 0.1; psi < 1.5; psi += 0.2) {
        double depth = 0.0, force = 0.0;
        for (int i = 0; i < N; i++) {
            const double t = (i + 0.5) * 0.5 * NT_PI / N, dt = 0.5 * NT_PI / N, slope = 1.0 / tan(psi);
            depth += a * slope * dt;
            force += 2.0 * E * a * a * sin(t) * sin(t) * slope * dt;
        }
        const nt_law_value value = nt_cone_eval(E, psi, depth);
        assert_within(value.a, a, 1e-12 * a);
        assert_within(value.F, force, 1e-12 * force);
    }
}

/* Erratum E6: the paper's a = pi tan(psi) delta/2 is pi^2/4 = 2.467 times too large. */
static void cone_radius_corrects_the_paper(void **state)
{
    (void)state;
    const double printed = NT_PI * tan(0.5) * 1e-9 / 2.0;
    assert_within(printed / nt_cone_eval(1e9, 0.5, 1e-9).a, 2.467, 1e-3);
}

/* Central differences of a polynomial: exact up to rounding for the punch, to (h/delta)^2/3 for the cone. */
static void forces_are_slopes_of_energies(void **state)
{
    (void)state;
    for (double d = 1e-12; d < 1e-6; d *= 3.0) {
        const double h = 1e-4 * d;
        const nt_law_value cone = nt_cone_eval(1e9, 0.4, d), punch = nt_punch_eval(1e9, 5e-9, d);
        const double cone_slope = (nt_cone_eval(1e9, 0.4, d + h).U - nt_cone_eval(1e9, 0.4, d - h).U) / (2.0 * h);
        const double punch_slope = (nt_punch_eval(1e9, 5e-9, d + h).U - nt_punch_eval(1e9, 5e-9, d - h).U) / (2.0 * h);
        assert_within(cone.F, cone_slope, 1e-8 * cone.F);
        assert_within(punch.F, punch_slope, 1e-11 * punch.F);
        assert_within(cone.k, 2.0 * cone.F / d, 4.0 * DBL_EPSILON * cone.k);
        assert_within(punch.k, punch.F / d, 4.0 * DBL_EPSILON * punch.k);
    }
}

static void punch_is_linear(void **state)
{
    (void)state;
    const nt_law_value value = nt_punch_eval(1e9, 5e-9, 2e-9); /* 2 * 1e9 * 5e-9 * 2e-9 = 20 nN */
    assert_within(value.F, 20e-9, 1e-22);
    assert_true(value.a == 5e-9);
}

static void nothing_outside_and_nan_through(void **state)
{
    (void)state;
    assert_true(nt_cone_eval(1e9, 0.4, -1e-9).F == 0.0 && nt_punch_eval(1e9, 5e-9, 0.0).a == 0.0);
    assert_true(isnan(nt_cone_eval(1e9, 0.4, NAN).F) && isnan(nt_punch_eval(1e9, 5e-9, NAN).F));
    assert_true(isnan(nt_cone_eval(NAN, 0.4, 1e-9).F) && isnan(nt_punch_eval(1e9, NAN, 1e-9).F));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cone_obeys_sneddons_integrals),   cmocka_unit_test(cone_radius_corrects_the_paper),
        cmocka_unit_test(forces_are_slopes_of_energies),   cmocka_unit_test(punch_is_linear),
        cmocka_unit_test(nothing_outside_and_nan_through),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
