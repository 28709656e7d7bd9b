/* SPDX-License-Identifier: BSD-3-Clause
 * Tables of Maugis-Dugdale against the exact branch: error, potential, joins, ends, refusals. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "contact/maugis_table.h"
#include "internal/contact.h"
#include "internal/maugis.h"
#include "larger.h"
#include "maugis_fixture.h"
#include "nanotouch/advanced/maugis.h"

enum { CAPACITY = 2000 };
static nt_maugis_cell cells[CAPACITY];

static nt_maugis_table table_of(double lambda, int cells_per_octave)
{
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
    const nt_maugis_table_options options = {cells_per_octave, 0.0};
    nt_maugis maugis;
    nt_maugis_table table;
    assert_int_equal(nt_maugis_init_lambda(&maugis, &contact, lambda), NT_OK);
    assert_int_equal(nt_maugis_table_init(&table, &maugis, &options, cells, CAPACITY), NT_OK);
    assert_int_equal(table.count, nt_maugis_table_cells(&maugis, &options));
    return table;
}

static nt_law_value at(const nt_maugis_table *table, nt_tier tier, double d)
{
    nt_law_value value;
    assert_int_equal(nt_maugis_table_eval(table, tier, d, NT_BRANCH_STABLE, &value), NT_OK);
    return value;
}

/* lambda from DMT to JKR, crowding at 0.9379 where fold and end of contact meet. */
static double lambda_of(int i)
{
    if (i < 40)
        return pow(10.0, -6.0 + 12.0 * i / 39.0);
    return 0.937947 + (i % 2 ? 1.0 : -1.0) * pow(10.0, -0.5 * (i - 39));
}

enum { LAMBDAS = 52 };

/* The accuracy a table claims is measured at 3 points per cell; here at others, dense. The bounds by cells per octave
 * are those of docs/evidence/contact.md; a polished force is at rounding level from 8 cells on. */
static void errors_are_what_the_table_says(void **state)
{
    (void)state;
    const struct {
        int cells_per_octave;
        double error, polished;
    } claims[] = {{1, 2e-2, 1e-5}, {4, 3e-5, 1e-11}, {8, 1.5e-6, 5e-14}, {16, 4e-7, 5e-14}};
    for (size_t c = 0; c < COUNT(claims); c++)
        for (int i = 0; i < LAMBDAS; i++) {
            const nt_maugis_table table = table_of(lambda_of(i), claims[c].cells_per_octave);
            const double pull_off = nt_maugis_pull_off_force(&table.maugis), rough = table.accuracy[0].force_error;
            const double fine = table.accuracy[1].force_error;
            assert_true(rough <= claims[c].error && fine <= claims[c].polished);
            for (double step = 1.3e-4; step < 900.0; step *= 1.0 + 0.31 / claims[c].cells_per_octave) {
                const double d = table.start + step, exact = eval(&table.maugis, d, NT_BRANCH_STABLE).F;
                const double scale = larger(fabs(exact), pull_off);
                assert_within(nt_maugis_table_force(&table, d), exact, (1.05 * rough + 1e-14) * scale);
                assert_within(nt_maugis_table_polish(&table, d), exact, (2.0 * fine + 2e-14) * scale);
            }
        }
}

/* The same of stiffness and radius, which are measured at 7 places per cell; from 1e-7 of the fold on, where
 * rounding does 1e-9 to k, at lambda = 0.9379 more. */
static void slopes_are_what_the_table_says(void **state)
{
    (void)state;
    for (int cells_per_octave = 4; cells_per_octave <= 16; cells_per_octave *= 2)
        for (int i = 0; i < LAMBDAS; i++) {
            const nt_maugis_table table = table_of(lambda_of(i), cells_per_octave);
            const nt_table_error error = nt_maugis_table_error(&table);
            double k_worst = 0.0, a_worst = 0.0;
            for (double step = 1e-7 * larger(1.0, fabs(table.start)); step < 900.0; step *= 1.031) {
                const double d = table.start + step, least_a = table.maugis.folds.zero_load_radius;
                const nt_law_value exact = eval(&table.maugis, d, NT_BRANCH_STABLE),
                                   value = at(&table, NT_TIER_TABLE, d);
                k_worst = larger(k_worst, fabs(value.k - exact.k) / larger(fabs(exact.k), 1.0));
                a_worst = larger(a_worst, fabs(value.a - exact.a) / larger(exact.a, least_a));
            }
            assert_true(k_worst <= error.stiffness + 3e-8 && a_worst <= error.radius + 1e-11);
            assert_true(error.stiffness <= 5.0 * k_worst + 3e-8 && error.radius <= 2.0 * a_worst + 1e-11);
        }
}

/* At the fold the table has its value and slope from the second derivative of the branch: no floor there. */
static void the_fold_is_no_exception(void **state)
{
    (void)state;
    const double lambdas[] = {1.2, 5.8, 100.0, 1e6, NT_MAUGIS_LAMBDA_MAX};
    for (size_t i = 0; i < COUNT(lambdas); i++) {
        const nt_maugis_table table = table_of(lambdas[i], 8);
        assert_within(nt_maugis_table_force(&table, table.start), table.maugis.folds.grip_load, 1e-14);
        for (double step = 1e-14; step < 1e-4; step *= 7.0) {
            const double d = table.start + step, exact = eval(&table.maugis, d, NT_BRANCH_STABLE).F;
            /* what the roundings of d do there; and of a cubic that is right at Z = 0 the error is 16 (Z/h)^2 of the
             * largest one in its cell, of width h */
            const double rounding = 4.0 * DBL_EPSILON / sqrt(step) + 2e-14, h = 0.125 / table.rate;
            const double cubic = 20.0 * table.accuracy[0].force_error * smaller(1.0, step / (h * h));
            assert_within(nt_maugis_table_force(&table, d), exact, rounding + cubic);
            assert_within(nt_maugis_table_polish(&table, d), exact, rounding);
        }
    }
}

/* U(d2) - U(d1) = integral of F: by Gauss-Legendre with 5 points in Z, in which F is a cubic and d(delta) = 2 Z dZ, so
 * exact inside a cell; k by differences. Steps over borders of cells are the test of the sums. */
static void the_table_is_a_potential(void **state)
{
    (void)state;
    static const double node[5] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                   0.9061798459386640};
    static const double weight[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                     0.2369268850561891};
    for (int i = 0; i < LAMBDAS; i += 3) {
        const nt_maugis_table table = table_of(lambda_of(i), 4);
        for (int j = NT_BRANCH_STABLE; j + 4 < table.count; j++) {
            const double u = cells[j + 2].u, next = cells[j + 3].u, a = (u - 1.0) / table.rate;
            const double half = 0.5 * (next - u) / table.rate, middle = a + half;
            double work = 0.0;
            for (int n = 0; n < 5; n++) {
                const double Z = middle + half * node[n];
                work += weight[n] * half * 2.0 * Z * nt_maugis_table_force(&table, table.start + Z * Z);
            }
            const double low = table.start + a * a, high = table.start + pow(middle + half, 2.0);
            if (high > table.largest_indentation)
                break;
            const nt_law_value from = at(&table, NT_TIER_TABLE, low), to = at(&table, NT_TIER_TABLE, high);
            const double scale = fabs(to.U) + fabs(to.F * high) + 1.0;
            assert_within(to.U - from.U, work, 1e-13 * scale); /* at d, and F near the fold, rounded: 1e-8 of Z */
            const double d = table.start + middle * middle, h = 1e-4 * middle * half;
            const double slope =
                (nt_maugis_table_force(&table, d + h) - nt_maugis_table_force(&table, d - h)) / (2.0 * h);
            if (half > 1e-3) /* else the difference is rounding */
                assert_within(at(&table, NT_TIER_TABLE, d).k, slope, 1e-5 * (fabs(slope) + 1.0));
        }
    }
}

/* All of {U, F, k, a} against the exact solver; the polished tier at rounding level. */
static void values_agree_with_the_exact_law(void **state)
{
    (void)state;
    for (int i = 0; i < LAMBDAS; i++) {
        const nt_maugis_table table = table_of(lambda_of(i), 8);
        const double low = table.maugis.folds.grip_in_contact ? table.start + 1e-3 : table.start - 0.5;
        for (double step = 0.0; step < 900.0; step += 0.013 + 0.11 * step) {
            const double d = low + step;
            if (d < table.maugis.folds.grip_indentation)
                continue;
            const nt_law_value exact = at(&table, NT_TIER_EXACT, d), rough = at(&table, NT_TIER_TABLE, d);
            const nt_law_value fine = at(&table, NT_TIER_POLISHED, d);
            const double F = fabs(exact.F) + 1.5, U = fabs(exact.U) + F * (1.0 + fabs(d));
            assert_within(rough.F, exact.F, 2e-6 * F);
            assert_within(rough.U, exact.U, 2e-6 * U);
            assert_within(rough.k, exact.k, 2e-4 * (fabs(exact.k) + 1.0));
            assert_within(rough.a, exact.a, 3e-5 * (exact.a + 0.1));
            assert_within(fine.F, exact.F, 1e-13 * (F + fabs(exact.k * d)));
            assert_within(fine.U, exact.U, 1e-13 * U);
            assert_within(fine.k, exact.k, 1e-10 * (fabs(exact.k) + 1.0));
            assert_within(fine.a, exact.a, 1e-12 * (exact.a + 0.1));
        }
    }
}

static void beyond_the_table_is_the_exact_law(void **state)
{
    (void)state;
    const nt_maugis_table table = table_of(0.3, 8);
    const double outside[] = {nextafter(table.largest_indentation, 1e9), 1e5, 1e30};
    for (size_t i = 0; i < COUNT(outside); i++)
        for (int tier = NT_TIER_TABLE; tier <= NT_TIER_EXACT; tier++) {
            const nt_law_value exact = eval(&table.maugis, outside[i], NT_BRANCH_STABLE);
            const nt_law_value value = at(&table, (nt_tier)tier, outside[i]);
            assert_true(value.F == exact.F && value.U == exact.U && value.k == exact.k && value.a == exact.a);
            assert_true(nt_maugis_table_force(&table, outside[i]) == exact.F);
        }
    const double apart = table.maugis.folds.grip_indentation;
    assert_true(at(&table, NT_TIER_TABLE, nextafter(apart, -9e9)).F == 0.0 &&
                at(&table, NT_TIER_POLISHED, -1e9).U == 0.0);
    nt_law_value value = {.F = 7.0}, exact;
    assert_int_equal(nt_maugis_table_eval(&table, NT_TIER_TABLE, table.maugis.folds.onset_indentation - 0.1,
                                          NT_BRANCH_APPROACH, &value),
                     NT_OK);
    assert_true(value.F == 0.0);
    assert_int_equal(nt_maugis_table_eval(&table, NT_TIER_TABLE, apart + 0.01, NT_BRANCH_UNSTABLE, &value), NT_OK);
    assert_int_equal(nt_maugis_eval(&table.maugis, apart + 0.01, NT_BRANCH_UNSTABLE, &exact, NULL), NT_OK);
    assert_true(value.F == exact.F);
}

/* The whole domain in SI: a table of any contact is that of its lambda, in its units. */
static void scales_from_atoms_to_metres(void **state)
{
    (void)state;
    for (double R = 1e-10; R < 2.0; R *= 1e5)
        for (double E = 1e2; E < 2e13; E *= 1e5)
            for (double w = 1e-9; w < 20.0; w *= 1e3) {
                const nt_contact contact = {R, E, w, w / 2e-10};
                nt_maugis maugis;
                nt_maugis_table table;
                assert_int_equal(nt_maugis_init(&maugis, &contact), NT_OK);
                assert_int_equal(nt_maugis_table_init(&table, &maugis, NULL, cells, CAPACITY), NT_OK);
                assert_true(table.accuracy[0].force_error < 1.5e-6 && table.accuracy[1].force_error < 1e-13);
                const double d = maugis.folds.zero_load_indentation * maugis.indentation_scale;
                assert_within(nt_maugis_table_polish(&table, 3.0 * d), eval(&maugis, 3.0 * d, NT_BRANCH_STABLE).F,
                              1e-13 * eval(&maugis, 3.0 * d, NT_BRANCH_STABLE).F);
            }
}

static void no_work_of_adhesion_is_hertz(void **state)
{
    (void)state;
    nt_contact contact = nt_contact_defaults();
    contact.work_of_adhesion = 0.0;
    nt_maugis maugis;
    nt_maugis_table table;
    assert_int_equal(nt_maugis_init(&maugis, &contact), NT_OK);
    assert_int_equal(nt_maugis_table_init(&table, &maugis, NULL, NULL, 0), NT_OK);
    for (int tier = NT_TIER_TABLE; tier <= NT_TIER_EXACT; tier++)
        assert_true(at(&table, (nt_tier)tier, 1e-9).F == nt_hertz_force(&contact, 1e-9));
    assert_true(nt_maugis_table_force(&table, 1e-9) == nt_hertz_force(&contact, 1e-9));
}

static void refuses_bad_input(void **state)
{
    (void)state;
    nt_maugis_table table = table_of(1.0, 8);
    const nt_maugis maugis = table.maugis;
    nt_law_value value = {.F = 7.0};
    const double bad[] = {NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < COUNT(bad); i++) {
        assert_int_equal(nt_maugis_table_eval(&table, NT_TIER_TABLE, bad[i], NT_BRANCH_STABLE, &value),
                         NT_E_NOT_FINITE);
        if (bad[i] < 0.0) /* as Hertz and DMT: infinitely far is apart */
            assert_true(nt_maugis_table_force(&table, bad[i]) == 0.0 && nt_maugis_table_polish(&table, bad[i]) == 0.0);
        else
            assert_true(isnan(nt_maugis_table_force(&table, bad[i])) && isnan(nt_maugis_table_polish(&table, bad[i])));
    }
    assert_int_equal(nt_maugis_table_eval(&table, (nt_tier)9, 0.0, NT_BRANCH_STABLE, &value), NT_E_ARGUMENT);
    assert_int_equal(nt_maugis_table_eval(&table, NT_TIER_TABLE, 0.0, (nt_branch)9, &value), NT_E_ARGUMENT);
    assert_true(value.F == 7.0);
    const nt_maugis_table_options wrong[] = {{0, 0.0}, {3, 0.0}, {128, 0.0}, {8, -1.0}, {8, NAN}, {8, INFINITY}};
    for (size_t i = 0; i < COUNT(wrong); i++)
        assert_int_equal(nt_maugis_table_init(&table, &maugis, &wrong[i], cells, CAPACITY), NT_E_RANGE);
    assert_int_equal(nt_maugis_table_init(&table, &maugis, NULL, cells, 5), NT_E_CAPACITY);
    assert_true(table.count > 5); /* untouched */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_what_the_table_says),
        cmocka_unit_test(slopes_are_what_the_table_says),
        cmocka_unit_test(the_fold_is_no_exception),
        cmocka_unit_test(the_table_is_a_potential),
        cmocka_unit_test(values_agree_with_the_exact_law),
        cmocka_unit_test(beyond_the_table_is_the_exact_law),
        cmocka_unit_test(scales_from_atoms_to_metres),
        cmocka_unit_test(no_work_of_adhesion_is_hertz),
        cmocka_unit_test(refuses_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
