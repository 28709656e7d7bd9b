/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale against the mpmath solution of its printed equations (tests/reference/maugis_oracle.py). */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../reference/maugis_table.h"
#include "internal/contact.h"
#include "larger.h"
#include "maugis_fixture.h"

/* The error in units of 2^-53 (1 + what one rounding of the indentation does to the result). Measured: force 12,
 * energy 10, stiffness 13, radius 5. */
static void states_agree_with_the_oracle(void **state)
{
    (void)state;
    const double bar = 32.0 * UNIT_ROUNDING;
    nt_maugis maugis = {.lambda = 0.0};
    for (size_t i = 0; i < COUNT(maugis_states); i++) {
        const double d = maugis_states[i].d, P = maugis_states[i].P, k = maugis_states[i].k, a = maugis_states[i].a;
        if (maugis.lambda != maugis_states[i].lambda)
            maugis = reduced(maugis_states[i].lambda);
        const nt_law_value value = eval(&maugis, d, branch_of(maugis_states[i].unstable));
        const double force = larger(fabs(P), nt_maugis_pull_off_force(&maugis));
        const double energy = fabs(maugis_states[i].U) + fabs(P * d) + force;
        assert_within(value.F, P, bar * (force + fabs(k * d)));
        assert_within(value.U, maugis_states[i].U, bar * energy);
        assert_within(value.k, k, bar * (fabs(k) + fabs(maugis_states[i].dk_dd * d)));
        assert_within(value.a, a, bar * (a + fabs(maugis_states[i].da_dd * d)));
    }
}

/* Away from the folds, where k d is of the order of the force, the force is right to 1e-12 of itself. */
static void forces_are_right_to_1e_12_away_from_folds(void **state)
{
    (void)state;
    nt_maugis maugis = {.lambda = 0.0};
    size_t checked = 0;
    for (size_t i = 0; i < COUNT(maugis_states); i++) {
        const double d = maugis_states[i].d, P = maugis_states[i].P;
        if (fabs(maugis_states[i].k * d) > 100.0 * fabs(P))
            continue;
        if (maugis.lambda != maugis_states[i].lambda)
            maugis = reduced(maugis_states[i].lambda);
        assert_within(eval(&maugis, d, branch_of(maugis_states[i].unstable)).F, P, 1e-12 * fabs(P));
        checked++;
    }
    assert_true(checked > COUNT(maugis_states) / 2);
}

/* 1/k is what one rounding of the force does to the indentation. Measured: 9. */
static void indentations_agree_with_the_oracle(void **state)
{
    (void)state;
    nt_maugis maugis = {.lambda = 0.0};
    for (size_t i = 0; i < COUNT(maugis_loads); i++) {
        const double d = maugis_loads[i].d, P = maugis_loads[i].P;
        if (maugis.lambda != maugis_loads[i].lambda)
            maugis = reduced(maugis_loads[i].lambda);
        double value;
        nt_solve_info info;
        const nt_branch branch = branch_of(maugis_loads[i].unstable);
        assert_int_equal(nt_maugis_indentation(&maugis, P, branch, &value, &info), NT_OK);
        assert_in_range(info.iterations, 0, 20);
        const double force = larger(fabs(P), nt_maugis_pull_off_force(&maugis));
        const double scale = fabs(d) + fabs(maugis.folds.pull_off_indentation) + fabs(force / maugis_loads[i].k);
        assert_within(value, d, 32.0 * UNIT_ROUNDING * scale);
    }
}

/* A fold is flat in its own control: its load or indentation is right to rounding; the rest is found as the root of a
 * derivative and nearly so. */
static void folds_agree_with_the_oracle(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(maugis_fold_values); i++) {
        const nt_maugis maugis = reduced(maugis_fold_values[i].lambda);
        const nt_maugis_folds *folds = &maugis.folds;
        assert_int_equal(folds->grip_in_contact, maugis_fold_values[i].grip_in_contact);
        assert_within(folds->pull_off_load, maugis_fold_values[i].pull_off_load, 1e-14);
        assert_within(folds->pull_off_radius, maugis_fold_values[i].pull_off_radius, 1e-12 * folds->pull_off_radius);
        assert_within(folds->pull_off_indentation, maugis_fold_values[i].pull_off_indentation, 1e-13);
        assert_within(folds->grip_load, maugis_fold_values[i].grip_load, 1e-12 * fabs(folds->grip_load));
        assert_within(folds->grip_radius, maugis_fold_values[i].grip_radius, 1e-12);
        assert_within(folds->grip_indentation, maugis_fold_values[i].grip_indentation,
                      1e-14 * fabs(folds->grip_indentation));
        assert_within(folds->zero_load_radius, maugis_fold_values[i].zero_load_radius, 1e-14);
        assert_within(folds->zero_load_indentation, maugis_fold_values[i].zero_load_indentation, 1e-14);
        assert_within(folds->touch_load, maugis_fold_values[i].touch_load, 1e-14 * fabs(folds->touch_load));
        assert_within(folds->touch_indentation, maugis_fold_values[i].touch_indentation,
                      1e-14 * fabs(folds->touch_indentation));
        assert_within(folds->onset_indentation, maugis_fold_values[i].onset_indentation,
                      1e-15 * fabs(folds->onset_indentation));
    }
}

/* delta(F(delta)) = delta to what the rounding of F allows. */
static void inversion_returns_the_indentation(void **state)
{
    (void)state;
    for (double lambda = 1e-9; lambda < 1e10; lambda *= 7.7) {
        const nt_maugis maugis = reduced(lambda);
        for (double d = maugis.folds.pull_off_indentation + 1e-3; d < 1e3; d += 0.01 + 0.3 * fabs(d)) {
            const nt_law_value value = eval(&maugis, d, NT_BRANCH_STABLE);
            double back;
            assert_int_equal(nt_maugis_indentation(&maugis, value.F, NT_BRANCH_STABLE, &back, NULL), NT_OK);
            const double rounding = fabs(d) + (2.0 + fabs(value.F)) / value.k;
            assert_within(back, d, 40.0 * DBL_EPSILON * (rounding + 1.0));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(states_agree_with_the_oracle),
        cmocka_unit_test(forces_are_right_to_1e_12_away_from_folds),
        cmocka_unit_test(indentations_agree_with_the_oracle),
        cmocka_unit_test(folds_agree_with_the_oracle),
        cmocka_unit_test(inversion_returns_the_indentation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
