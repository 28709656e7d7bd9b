/* SPDX-License-Identifier: BSD-3-Clause
 * JKR against its own equations at high precision (tests/reference/jkr_oracle.py). */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../reference/jkr_table.h"
#include "assertions.h"
#include "internal/contact.h"
#include "larger.h"
#include "nanotouch/contact.h"
#include "nanotouch/material.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static const nt_contact reduced = {1.0, 0.75, 1.0 / NT_PI, 0.0}; /* K = R = pi w = 1 */
static const nt_contact silicon = {20e-9, 76.9e9, 0.144, 0.0};

static nt_law_value eval(const nt_contact *contact, double indentation, nt_branch branch)
{
    nt_law_value value;
    assert_int_equal(nt_jkr_eval(contact, indentation, branch, &value), NT_OK);
    return value;
}

/* 32 roundings (2^-53), conditioned by what one rounding of the indentation does: k d for the force, for a and k their
 * own slopes, which grow as 1/Z and 1/Z^3 towards the fold at Z^2 = d - d_f. */
static void states_agree_with_the_oracle(void **state)
{
    (void)state;
    const double bar = 16.0 * DBL_EPSILON, fold = nt_jkr_pull_off_indentation(&reduced);
    for (size_t i = 0; i < COUNT(jkr_states); i++) {
        const double d = jkr_states[i].d, P = jkr_states[i].P, k = jkr_states[i].k, a = jkr_states[i].a;
        const nt_law_value value = eval(&reduced, d, jkr_states[i].unstable ? NT_BRANCH_UNSTABLE : NT_BRANCH_STABLE);
        const double near = fabs(d) / (d - fold);
        assert_within(value.F, P, bar * (larger(fabs(P), 1.5) + fabs(k * d)));
        assert_within(value.k, k, bar * (fabs(k) * (1.0 + near) + 1.0));
        assert_within(value.a, a, bar * (a + fabs(d) / sqrt(d - fold)));
        assert_within(value.U, jkr_states[i].U, bar * (fabs(jkr_states[i].U) + fabs(P * d) + 1.0));
    }
}

/* a^3 = (R/K)(F + 3 pi w R + sqrt(6 pi w R F + (3 pi w R)^2)), delta = a^2/R - sqrt(8 pi w a/(3K)), in SI. */
static void is_the_published_law_in_si(void **state)
{
    (void)state;
    const double R = silicon.radius, K = 4.0 / 3.0 * silicon.effective_modulus, W = NT_PI * silicon.work_of_adhesion;
    for (double F = -1.4 * W * R; F < 100.0 * W * R; F += 0.31 * W * R) {
        const double a = cbrt(R / K * (F + 3.0 * W * R + sqrt(6.0 * W * R * F + 9.0 * W * W * R * R)));
        const double d = a * a / R - sqrt(8.0 * W * a / (3.0 * K));
        double found;
        assert_int_equal(nt_jkr_indentation(&silicon, F, NT_BRANCH_STABLE, &found), NT_OK);
        assert_within(found, d, 1e-14 * (a * a / R + fabs(d)));
        const nt_law_value value = eval(&silicon, d, NT_BRANCH_STABLE);
        assert_within(value.a, a, 1e-12 * a);
        assert_within(value.F, F, 1e-13 * (W * R + fabs(F) + fabs(value.k) * a * a / R));
    }
}

static void fold_values(void **state)
{
    (void)state;
    const double fold = nt_jkr_pull_off_indentation(&reduced);
    assert_within(fold, -3.0 / cbrt(36.0), DBL_EPSILON);
    const nt_law_value value = eval(&reduced, fold, NT_BRANCH_STABLE);
    assert_within(value.a, cbrt(1.0 / 6.0), 1e-15);
    assert_within(value.F, -5.0 / 6.0, 1e-15);
    assert_true(value.k < -1e6 && isfinite(value.k) && eval(&reduced, fold, NT_BRANCH_UNSTABLE).k > 1e6);
    assert_within(nt_jkr_pull_off_force(&reduced), 1.5, 1e-15);
    double d;
    assert_int_equal(nt_jkr_indentation(&reduced, -1.5, NT_BRANCH_STABLE, &d), NT_OK);
    assert_within(eval(&reduced, d, NT_BRANCH_STABLE).a, cbrt(1.5), 1e-7); /* square-root conditioned in the load */
    assert_int_equal(nt_jkr_indentation(&reduced, 0.0, NT_BRANCH_STABLE, &d), NT_OK);
    assert_within(eval(&reduced, d, NT_BRANCH_STABLE).a, cbrt(6.0), 1e-14);
}

static void branches_under_grips(void **state)
{
    (void)state;
    const double fold = nt_jkr_pull_off_indentation(&silicon);
    nt_law_value value = {.F = 7.0};
    assert_true(eval(&silicon, nextafter(fold, -1.0), NT_BRANCH_STABLE).F == 0.0);
    assert_true(eval(&silicon, fold, NT_BRANCH_STABLE).F < 0.0);
    assert_int_equal(nt_jkr_eval(&silicon, 1.001 * fold, NT_BRANCH_UNSTABLE, &value), NT_E_NO_SOLUTION);
    assert_int_equal(nt_jkr_eval(&silicon, 0.0, NT_BRANCH_UNSTABLE, &value), NT_E_NO_SOLUTION);
    assert_true(value.F == 7.0);
    assert_true(eval(&silicon, -1e-300, NT_BRANCH_APPROACH).F == 0.0);
    assert_true(eval(&silicon, 0.0, NT_BRANCH_APPROACH).F == eval(&silicon, 0.0, NT_BRANCH_STABLE).F);
    for (double part = 0.05; part < 1.0; part += 0.1)
        assert_true(eval(&silicon, part * fold, NT_BRANCH_UNSTABLE).a <
                    eval(&silicon, part * fold, NT_BRANCH_STABLE).a);
}

/* F = dU/d(delta), k = dF/d(delta), five points, truncation h^4; h is small beside the distance from the fold. */
static void force_is_the_slope_of_the_energy(void **state)
{
    (void)state;
    const double fold = nt_jkr_pull_off_indentation(&reduced);
    for (double step = 0.05; step < 50.0; step *= 1.3)
        for (int unstable = 0; unstable <= (step < 0.8); unstable++) {
            const double h = 1e-3 * smaller(step, 0.9 - step > 0.0 ? 0.9 - step : step);
            nt_law_value at[5];
            for (int i = 0; i < 5; i++)
                at[i] = eval(&reduced, fold + step + (i - 2) * h, unstable ? NT_BRANCH_UNSTABLE : NT_BRANCH_STABLE);
            const double F = (8.0 * (at[3].U - at[1].U) - (at[4].U - at[0].U)) / (12.0 * h);
            const double k = (8.0 * (at[3].F - at[1].F) - (at[4].F - at[0].F)) / (12.0 * h);
            assert_within(at[2].F, F, 1e-9 * (1.0 + fabs(F)));
            assert_within(at[2].k, k, 1e-9 * (1.0 + fabs(k)));
        }
}

static void inversion(void **state)
{
    (void)state;
    for (double P = -1.49; P < 1e6; P += 0.01 + fabs(P))
        for (int unstable = 0; unstable <= (P < 0.0); unstable++) {
            const nt_branch branch = unstable ? NT_BRANCH_UNSTABLE : NT_BRANCH_STABLE;
            double d;
            assert_int_equal(nt_jkr_indentation(&reduced, P, branch, &d), NT_OK);
            /* under grips everything above a = (1/6)^(1/3) is stable, also between the two folds */
            const double a = eval(&reduced, d, NT_BRANCH_STABLE).a;
            const int held = !unstable || P < -5.0 / 6.0;
            const nt_law_value value = eval(&reduced, d, held ? NT_BRANCH_STABLE : NT_BRANCH_UNSTABLE);
            assert_within(value.F, P, 1e-12 * (2.0 + fabs(P) + fabs(value.k * d)));
            assert_true(a >= value.a);
        }
    double d = 7.0;
    assert_int_equal(nt_jkr_indentation(&reduced, -1.51, NT_BRANCH_STABLE, &d), NT_E_NO_SOLUTION);
    assert_int_equal(nt_jkr_indentation(&reduced, 0.0, NT_BRANCH_UNSTABLE, &d), NT_E_NO_SOLUTION);
    assert_true(d == 7.0);
}

static void no_adhesion_is_hertz_and_bad_input_is_refused(void **state)
{
    (void)state;
    const nt_contact hertz = {20e-9, 76.9e9, 0.0, 0.0};
    double indentation;
    for (double d = -1e-9; d < 1e-8; d += 1e-10)
        assert_true(eval(&hertz, d, NT_BRANCH_STABLE).F == nt_hertz_force(&hertz, d));
    assert_int_equal(nt_jkr_indentation(&hertz, 1e-9, NT_BRANCH_STABLE, &indentation), NT_OK);
    assert_true(indentation == nt_hertz_indentation(&hertz, 1e-9));
    nt_law_value value = {.F = 7.0};
    const double bad[] = {NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < COUNT(bad); i++) {
        assert_int_equal(nt_jkr_eval(&silicon, bad[i], NT_BRANCH_STABLE, &value), NT_E_NOT_FINITE);
        assert_int_equal(nt_jkr_indentation(&silicon, bad[i], NT_BRANCH_STABLE, &value.F), NT_E_NOT_FINITE);
    }
    assert_int_equal(nt_jkr_eval(&silicon, 0.0, (nt_branch)9, &value), NT_E_ARGUMENT);
    assert_true(value.F == 7.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_agree_with_the_oracle),
        cmocka_unit_test(is_the_published_law_in_si),
        cmocka_unit_test(fold_values),
        cmocka_unit_test(branches_under_grips),
        cmocka_unit_test(force_is_the_slope_of_the_energy),
        cmocka_unit_test(inversion),
        cmocka_unit_test(no_adhesion_is_hertz_and_bad_input_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
