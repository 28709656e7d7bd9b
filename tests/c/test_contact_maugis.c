/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale as a law in SI: branches, joins, energy, extremes, refusals. Accuracy: test_contact_maugis_solve.c. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/contact.h"
#include "larger.h"
#include "maugis_fixture.h"

static void no_work_of_adhesion_is_hertz_exactly(void **state)
{
    (void)state;
    nt_contact contact = nt_contact_defaults();
    contact.work_of_adhesion = 0.0;
    contact.cohesive_stress = 0.0;
    nt_maugis maugis;
    assert_int_equal(nt_maugis_init(&maugis, &contact), NT_OK);
    assert_true(isinf(maugis.lambda) && nt_maugis_pull_off_force(&maugis) == 0.0);
    assert_true(nt_maugis_onset_gap(&maugis) == 0.0);
    for (double d = -1e-9; d < 1e-8; d += 1e-10) {
        const nt_law_value hertz = nt_hertz_eval(&contact, d);
        for (int branch = NT_BRANCH_STABLE; branch <= NT_BRANCH_APPROACH; branch++) {
            const nt_law_value value = eval(&maugis, d, (nt_branch)branch);
            assert_true(value.F == hertz.F && value.U == hertz.U && value.k == hertz.k && value.a == hertz.a);
        }
        nt_law_value value;
        assert_int_equal(nt_maugis_eval(&maugis, d, NT_BRANCH_UNSTABLE, &value, NULL), NT_E_NO_SOLUTION);
    }
    double d;
    assert_int_equal(nt_maugis_indentation(&maugis, 1e-9, NT_BRANCH_STABLE, &d, NULL), NT_OK);
    assert_true(d == nt_hertz_indentation(&contact, 1e-9));
    assert_int_equal(nt_maugis_indentation(&maugis, -1e-30, NT_BRANCH_STABLE, &d, NULL), NT_E_NO_SOLUTION);
}

/* F = dU/dd and k = dF/dd by five-point differences along each branch, h small beside the distance from the folds:
 * truncation h^4, rounding U u/h. */
static void assert_potential(const nt_maugis *maugis, double d, nt_branch branch, double h)
{
    nt_law_value at[5];
    for (int i = 0; i < 5; i++)
        at[i] = eval(maugis, d + (i - 2) * h, branch);
    const double F = (8.0 * (at[3].U - at[1].U) - (at[4].U - at[0].U)) / (12.0 * h);
    const double k = (8.0 * (at[3].F - at[1].F) - (at[4].F - at[0].F)) / (12.0 * h);
    assert_within(at[2].F, F, 1e-8 * (1.0 + fabs(F)));
    assert_within(at[2].k, k, 1e-7 * (1.0 + fabs(k)));
}

static void force_is_the_slope_of_the_energy(void **state)
{
    (void)state;
    for (double lambda = 1e-3; lambda < 1e4; lambda *= 2.3) {
        const nt_maugis maugis = reduced(lambda);
        const nt_maugis_folds *folds = &maugis.folds;
        const double start = folds->grip_in_contact ? folds->grip_indentation : folds->touch_indentation;
        for (double step = 0.1; step < 20.0; step *= 1.4)
            assert_potential(&maugis, start + step, NT_BRANCH_STABLE, 2e-4);
        const double low = folds->grip_indentation, high = folds->onset_indentation, width = high - low;
        if (!folds->grip_in_contact) {
            assert_potential(&maugis, low + 0.5 * (folds->touch_indentation - low), NT_BRANCH_STABLE,
                             1e-4 * (folds->touch_indentation - low));
            assert_potential(&maugis, low + 0.5 * width, NT_BRANCH_UNSTABLE, 1e-3 * width);
        } else {
            const double middle = 0.5 * (folds->touch_indentation + low);
            assert_potential(&maugis, middle, NT_BRANCH_UNSTABLE, 1e-3 * (middle - low));
            assert_potential(&maugis, 0.5 * (folds->touch_indentation + high), NT_BRANCH_UNSTABLE,
                             1e-3 * (high - folds->touch_indentation));
        }
    }
}

/* Across a = 0 energy, force and stiffness join. Next to it k is its end value plus sqrt(distance), as the radius
 * is, so that its jump over 1e-10 is bounded by 1e-4 of its range. */
static void contact_joins_the_attracted_state(void **state)
{
    (void)state;
    for (double lambda = 0.01; lambda < 20.0; lambda *= 1.3) {
        const nt_maugis maugis = reduced(lambda);
        const double touch = maugis.folds.touch_indentation;
        const nt_branch branch = branch_of(maugis.folds.grip_in_contact);
        if (maugis.folds.grip_in_contact && touch - maugis.folds.grip_indentation < 1e-3)
            continue; /* the fold itself is at the join */
        const nt_law_value below = eval(&maugis, touch - 1e-10, branch), above = eval(&maugis, touch + 1e-10, branch);
        const double k = fabs(below.k) + fabs(above.k);
        assert_true((below.a == 0.0) != (above.a == 0.0));
        assert_within(above.F, below.F, 2e-10 * k + 1e-13);
        assert_within(above.U, below.U, 2e-10 * fabs(below.F) + 1e-13);
        assert_within(above.k, below.k, 1e-4 * (1.0 + k * k));
    }
}

/* Contact radius and energy balance on the stable branch: a grows with d, F grows with d beyond the load fold. */
static void stable_branch_is_monotonic(void **state)
{
    (void)state;
    for (double lambda = 1e-6; lambda < 1e7; lambda *= 3.1) {
        const nt_maugis maugis = reduced(lambda);
        const double pull_off = maugis.folds.pull_off_indentation, grip = maugis.folds.grip_indentation;
        const double start = maugis.folds.grip_in_contact ? grip : maugis.folds.touch_indentation;
        nt_law_value last = eval(&maugis, start, NT_BRANCH_STABLE);
        for (double step = 1e-6; step < 1e4; step *= 1.2) {
            const nt_law_value next = eval(&maugis, start + step, NT_BRANCH_STABLE);
            assert_true(next.a > last.a);
            assert_true(start + step < pull_off + 1e-6 || next.k > 0.0);
            last = next;
        }
    }
}

/* Approach: apart until the onset of attraction; lands attracted for lambda < (9/32)^(1/3) = 0.655, else in contact. */
static void approach_is_apart_until_the_onset(void **state)
{
    (void)state;
    for (double lambda = 0.05; lambda < 50.0; lambda *= 1.17) {
        const nt_maugis maugis = reduced(lambda);
        const double onset = maugis.folds.onset_indentation;
        assert_within(-onset, nt_maugis_onset_gap(&maugis), 0.0);
        assert_within(-onset, maugis.contact.work_of_adhesion / maugis.contact.cohesive_stress, 1e-15 * -onset);
        const nt_law_value apart = eval(&maugis, nextafter(onset, -1e9), NT_BRANCH_APPROACH);
        assert_true(apart.F == 0.0 && apart.U == 0.0 && apart.k == 0.0 && apart.a == 0.0);
        const nt_law_value landed = eval(&maugis, onset, NT_BRANCH_APPROACH);
        const nt_law_value stable = eval(&maugis, onset, NT_BRANCH_STABLE);
        assert_true(landed.F == stable.F && landed.F < 0.0 && landed.U < 0.0);
        assert_true((landed.a > 0.0) == (lambda > cbrt(9.0 / 32.0)));
    }
}

static void grips_let_go_at_the_fold(void **state)
{
    (void)state;
    for (double lambda = 1e-3; lambda < 1e4; lambda *= 2.9) {
        const nt_maugis maugis = reduced(lambda);
        const double grip = maugis.folds.grip_indentation;
        nt_law_value held = eval(&maugis, grip, NT_BRANCH_STABLE), value;
        assert_within(held.F, maugis.folds.grip_load, 1e-6); /* square-root conditioned */
        assert_true(held.k < 0.0 && isfinite(held.k));
        assert_true(eval(&maugis, nextafter(grip, -1e9), NT_BRANCH_STABLE).F == 0.0);
        held = eval(&maugis, grip, NT_BRANCH_UNSTABLE);
        assert_within(held.F, maugis.folds.grip_load, 1e-6);
        assert_true(held.k > 0.0 && isfinite(held.k));
        value.F = 7.0;
        assert_int_equal(nt_maugis_eval(&maugis, nextafter(grip, -1e9), NT_BRANCH_UNSTABLE, &value, NULL),
                         NT_E_NO_SOLUTION);
        assert_int_equal(nt_maugis_eval(&maugis, maugis.folds.onset_indentation, NT_BRANCH_UNSTABLE, &value, NULL),
                         NT_E_NO_SOLUTION);
        assert_true(value.F == 7.0);
    }
}

static void pull_off_is_the_lowest_force(void **state)
{
    (void)state;
    for (double lambda = 1e-6; lambda < 1e7; lambda *= 3.3) {
        const nt_maugis maugis = reduced(lambda);
        const double pull_off = nt_maugis_pull_off_force(&maugis);
        double stable, unstable;
        assert_int_equal(nt_maugis_indentation(&maugis, -pull_off, NT_BRANCH_STABLE, &stable, NULL), NT_OK);
        assert_int_equal(nt_maugis_indentation(&maugis, -pull_off, NT_BRANCH_UNSTABLE, &unstable, NULL), NT_OK);
        assert_within(stable, maugis.folds.pull_off_indentation, 1e-15);
        assert_within(unstable, stable, 1e-15);
        assert_int_equal(nt_maugis_indentation(&maugis, nextafter(-pull_off, -9.0), NT_BRANCH_STABLE, &stable, NULL),
                         NT_E_NO_SOLUTION);
        assert_int_equal(nt_maugis_indentation(&maugis, 0.0, NT_BRANCH_UNSTABLE, &stable, NULL), NT_E_NO_SOLUTION);
        for (double d = maugis.folds.touch_indentation; d < 2.0; d += 0.01)
            assert_true(d < maugis.folds.grip_indentation ||
                        eval(&maugis, d, NT_BRANCH_STABLE).F >= -pull_off * (1.0 + 1e-15));
    }
}

/* All combinations of tips from atoms to a metre, of rubber to diamond, of 1e-9 to 10 J/m^2: nothing overflows, and the
 * dimensional law is the reduced one times its units (each a product of rounded cube roots: a few ulp, times k d). */
static void scales_from_atoms_to_metres(void **state)
{
    (void)state;
    for (double R = 1e-10; R < 2.0; R *= 1e2)
        for (double E = 1e2; E < 2e13; E *= 1e2)
            for (double w = 1e-9; w < 20.0; w *= 10.0)
                for (double range = 1e-11; range < 1e-6; range *= 1e2) {
                    const nt_contact contact = {R, E, w, w / range};
                    nt_maugis maugis;
                    assert_int_equal(nt_maugis_init(&maugis, &contact), NT_OK);
                    const nt_maugis unit = reduced(maugis.lambda);
                    assert_within(nt_maugis_onset_gap(&maugis), range, 8.0 * DBL_EPSILON * range);
                    for (double d = unit.folds.zero_load_indentation; d < 1e4; d *= 30.0) {
                        const nt_law_value value = eval(&maugis, d * maugis.indentation_scale, NT_BRANCH_STABLE);
                        const nt_law_value expected = eval(&unit, d, NT_BRANCH_STABLE);
                        assert_within(value.F / maugis.load_scale, expected.F, 1e-14 * (3.0 + expected.k * d));
                        assert_within(value.a / maugis.radius_scale, expected.a, 1e-14 * (1.0 + expected.a));
                        assert_true(isfinite(value.U) && isfinite(value.k));
                    }
                }
}

static void lambda_from_1e_15_to_1e15(void **state)
{
    (void)state;
    for (double lambda = 1e-15; lambda < 1.0000001e15; lambda *= 10.0) {
        const nt_maugis maugis = reduced(smaller(lambda, NT_MAUGIS_LAMBDA_MAX));
        for (double step = 1e-14; step < 1e30; step *= 10.0)
            for (int branch = NT_BRANCH_STABLE; branch <= NT_BRANCH_UNSTABLE; branch++) {
                const double d = maugis.folds.grip_indentation + step;
                if (branch == NT_BRANCH_UNSTABLE && d >= maugis.folds.onset_indentation)
                    continue;
                const nt_law_value value = eval(&maugis, d, (nt_branch)branch);
                assert_true(isfinite(value.U) && isfinite(value.F) && isfinite(value.k) && isfinite(value.a));
            }
    }
}

static void refuses_bad_input(void **state)
{
    (void)state;
    const nt_maugis good = reduced(1.0);
    nt_law_value value = {.F = 7.0};
    double d = 7.0;
    const double bad[] = {NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < COUNT(bad); i++) {
        for (int branch = NT_BRANCH_STABLE; branch <= NT_BRANCH_UNSTABLE; branch++) {
            assert_int_equal(nt_maugis_eval(&good, bad[i], (nt_branch)branch, &value, NULL), NT_E_NOT_FINITE);
            assert_int_equal(nt_maugis_indentation(&good, bad[i], (nt_branch)branch, &d, NULL), NT_E_NOT_FINITE);
        }
        nt_maugis maugis = good;
        const nt_contact contact = {20e-9, bad[i], 0.1, 1e8};
        assert_int_equal(nt_maugis_init(&maugis, &contact), NT_E_NOT_FINITE);
        assert_true(maugis.lambda == 1.0);
        nt_maugis_point point;
        assert_int_equal(nt_maugis_at(bad[i], 1.0, &point), NT_E_NOT_FINITE);
        assert_int_equal(nt_maugis_at(1.0, bad[i], &point), NT_E_NOT_FINITE);
    }
    assert_true(value.F == 7.0 && d == 7.0);
    nt_maugis maugis;
    const nt_contact no_stress = {20e-9, 1e9, 0.1, 0.0}, negative = {20e-9, 1e9, -0.1, 1e8};
    assert_int_equal(nt_maugis_init(&maugis, &no_stress), NT_E_RANGE);
    assert_int_equal(nt_maugis_init(&maugis, &negative), NT_E_RANGE);
    assert_true(isnan(nt_maugis_lambda(&(nt_contact){NAN, 1e9, 0.1, 1e8})));
    assert_int_equal(nt_maugis_eval(&good, 0.0, (nt_branch)9, &value, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_maugis_indentation(&good, 0.0, (nt_branch)9, &d, NULL), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_work_of_adhesion_is_hertz_exactly),
        cmocka_unit_test(force_is_the_slope_of_the_energy),
        cmocka_unit_test(contact_joins_the_attracted_state),
        cmocka_unit_test(stable_branch_is_monotonic),
        cmocka_unit_test(approach_is_apart_until_the_onset),
        cmocka_unit_test(grips_let_go_at_the_fold),
        cmocka_unit_test(pull_off_is_the_lowest_force),
        cmocka_unit_test(scales_from_atoms_to_metres),
        cmocka_unit_test(lambda_from_1e_15_to_1e15),
        cmocka_unit_test(refuses_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
