/* SPDX-License-Identifier: BSD-3-Clause
 * Derivatives of the force by the parameters of a contact: against differences of the force, which has references of
 * its own; refusals. Against mpmath: tests/python/test_contact_gradient.py. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/contact_derivatives.h"
#include "nanotouch/material.h"

/* Force with parameter i (the indentation, R, E*, w, sigma0) moved by a part of itself. */
static double moved_force(nt_model model, const double at[5], int i, double part)
{
    double now[5];
    for (int j = 0; j < 5; j++)
        now[j] = j == i ? at[j] * (1.0 + part) : at[j];
    const nt_contact contact = {now[1], now[2], now[3], now[4]};
    nt_contact_law law;
    nt_law_value value;
    assert_int_equal(nt_contact_law_init(&law, model, &contact), NT_OK);
    assert_int_equal(nt_contact_law_eval(&law, now[0], NT_BRANCH_STABLE, &value), NT_OK);
    return value.F;
}

/* Five points: truncation of the fourth order, 1e-12, and rounding, 1e-15 of the force over a step of 1e-3. */
static void derivatives_are_slopes_of_the_force(void **state)
{
    (void)state;
    static const nt_model models[] = {NT_HERTZ, NT_DMT, NT_JKR, NT_MAUGIS};
    const double R = 20e-9, w = 0.05, h = 1e-3;
    for (double E = 1e5; E < 1e12; E *= 30.0)
        for (double range = 1e-10; range < 2e-8; range *= 5.0)
            for (double part = 0.02; part < 10.0; part *= 3.0)
                for (int m = 0; m < 4; m++) {
                    const double unit = cbrt(NT_PI * NT_PI * w * w * R / (16.0 / 9.0 * E * E));
                    const double at[5] = {part * unit, R, E, w, w / range};
                    const nt_contact contact = {R, E, w, w / range};
                    nt_contact_law law;
                    nt_contact_derivatives got;
                    assert_int_equal(nt_contact_law_init(&law, models[m], &contact), NT_OK);
                    assert_int_equal(nt_contact_law_derivatives(&law, at[0], NT_BRANCH_STABLE, &got), NT_OK);
                    const double found[5] = {got.by_indentation, got.by_radius, got.by_effective_modulus,
                                             got.by_work_of_adhesion, got.by_cohesive_stress};
                    const double scale = fabs(moved_force(models[m], at, 0, 0.0)) + NT_PI * w * R;
                    for (int i = 0; i < 5; i++) {
                        const double near = moved_force(models[m], at, i, h) - moved_force(models[m], at, i, -h);
                        const double far =
                            moved_force(models[m], at, i, 2.0 * h) - moved_force(models[m], at, i, -2.0 * h);
                        const double slope = (8.0 * near - far) / (12.0 * h);
                        assert_true(fabs(found[i] * at[i] - slope) < 1e-9 * scale);
                    }
                }
}

static void refuses_what_the_law_refuses(void **state)
{
    (void)state;
    const nt_contact contact = nt_contact_defaults();
    nt_contact_law law;
    nt_contact_derivatives got = {.by_radius = 7.0};
    assert_int_equal(nt_contact_law_init(&law, NT_JKR, &contact), NT_OK);
    assert_int_equal(nt_contact_law_derivatives(&law, NAN, NT_BRANCH_STABLE, &got), NT_E_NOT_FINITE);
    assert_int_equal(nt_contact_law_derivatives(&law, 1e-6, NT_BRANCH_UNSTABLE, &got), NT_E_NO_SOLUTION);
    assert_int_equal(nt_contact_law_derivatives(&law, 0.0, (nt_branch)9, &got), NT_E_ARGUMENT);
    assert_true(got.by_radius == 7.0);
    assert_int_equal(nt_contact_law_derivatives(&law, -1.0, NT_BRANCH_STABLE, &got), NT_OK); /* apart */
    assert_true(got.by_radius == 0.0 && got.by_indentation == 0.0 && got.by_work_of_adhesion == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(derivatives_are_slopes_of_the_force),
        cmocka_unit_test(refuses_what_the_law_refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
