/* SPDX-License-Identifier: BSD-3-Clause
 * A bank of tables over lambda against the exact law: error, potential, joins, gap and ends, refusals. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "maugis_fixture.h"
#include "nanotouch/contact_bank.h"

enum { PANELS = 240, CELLS = 26000 };
static nt_maugis_panel panels[PANELS];
static nt_maugis_bank_cell cells[CELLS];

static nt_maugis_bank bank_of(int panels_per_octave, int cells_per_octave)
{
    nt_maugis_bank_options options = nt_maugis_bank_defaults();
    options.panels_per_octave = panels_per_octave;
    options.cells_per_octave = cells_per_octave;
    const nt_maugis_bank_memory memory = {panels, cells, PANELS, CELLS};
    nt_maugis_bank bank;
    assert_int_equal(nt_maugis_bank_init(&bank, &options, &memory), NT_OK);
    return bank;
}

static nt_law_value at(const nt_maugis_bank *bank, double lambda, double d)
{
    nt_law_value value;
    assert_int_equal(nt_maugis_bank_eval(bank, lambda, d, NT_BRANCH_STABLE, &value), NT_OK);
    return value;
}

static nt_maugis prepared(double lambda)
{
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
    nt_maugis maugis;
    assert_int_equal(nt_maugis_init_lambda(&maugis, &contact, lambda), NT_OK);
    return maugis;
}

/* At 400 lambdas that no panel was made from, dense in d: within what the bank measured of itself. */
static void errors_are_what_the_bank_says(void **state)
{
    (void)state;
    const struct {
        int panels, cells;
        double error;
    } claims[] = {{4, 4, 3e-5}, {8, 8, 3e-6}};
    for (size_t c = 0; c < COUNT(claims); c++) {
        const nt_maugis_bank bank = bank_of(claims[c].panels, claims[c].cells);
        assert_true(bank.accuracy.force_error < claims[c].error && bank.accuracy.fold_shift < 1e-8);
        for (double lambda = 0.01001; lambda < 100.0; lambda *= 1.02327) {
            const nt_maugis maugis = prepared(lambda);
            const nt_maugis_folds *folds = &maugis.folds;
            const double start = folds->grip_in_contact ? folds->grip_indentation : folds->touch_indentation;
            for (double step = 1.1e-4; start + step < 99.0; step *= 1.17) {
                const double d = start + step;
                const nt_law_value exact = eval(&maugis, d, NT_BRANCH_STABLE), value = at(&bank, lambda, d);
                const double scale = fmax(fabs(exact.F), nt_maugis_pull_off_force(&maugis));
                assert_within(value.F, exact.F, bank.accuracy.force_error * scale);
                assert_within(value.a, exact.a, 50.0 * bank.accuracy.force_error);
                assert_within(value.U, exact.U, 2.0 * bank.accuracy.force_error * (fabs(exact.U) + scale));
            }
        }
    }
}

/* The attracted state is closed-form; apart is 0. */
static void other_states(void **state)
{
    (void)state;
    const nt_maugis_bank bank = bank_of(4, 4);
    for (double lambda = 0.0101; lambda < 99.0; lambda *= 1.27) {
        const nt_maugis maugis = prepared(lambda);
        const double grip = maugis.folds.grip_indentation, touch = maugis.folds.touch_indentation;
        assert_true(at(&bank, lambda, grip - 1e-6).F == 0.0);
        nt_law_value value;
        assert_int_equal(
            nt_maugis_bank_eval(&bank, lambda, maugis.folds.onset_indentation - 1e-3, NT_BRANCH_APPROACH, &value),
            NT_OK);
        assert_true(value.F == 0.0);
        if (maugis.folds.grip_in_contact)
            continue;
        const double d = 0.5 * (grip + touch);
        const nt_law_value exact = eval(&maugis, d, NT_BRANCH_STABLE);
        value = at(&bank, lambda, d);
        assert_within(value.F, exact.F, 1e-13);
        assert_within(value.k, exact.k, 1e-11 * fabs(exact.k));
        assert_within(at(&bank, lambda, touch - 1e-7).F, at(&bank, lambda, touch + 1e-7).F,
                      2.0 * bank.accuracy.force_error);
    }
}

/* At constant lambda: work by Simpson's rule over short steps, across cells; k by differences. */
static void a_potential_at_constant_lambda(void **state)
{
    (void)state;
    const nt_maugis_bank bank = bank_of(4, 4);
    for (double lambda = 0.0123; lambda < 99.0; lambda *= 2.7) {
        const double start = prepared(lambda).folds.zero_load_indentation;
        double work = 0.0;
        const double h = 1e-3;
        const nt_law_value first = at(&bank, lambda, start);
        for (int i = 0; i < 3000; i++) {
            const double d = start + i * h;
            work += h / 6.0 *
                    (at(&bank, lambda, d).F + 4.0 * at(&bank, lambda, d + 0.5 * h).F + at(&bank, lambda, d + h).F);
        }
        const double end = start + 3000 * h;
        assert_within(at(&bank, lambda, end).U - first.U, work, 1e-10 * work);
        const double slope = (at(&bank, lambda, end + 1e-5).F - at(&bank, lambda, end - 1e-5).F) / 2e-5;
        assert_within(at(&bank, lambda, end).k, slope, 1e-6 * slope);
    }
}

/* In the gap around 0.9379, outside the range and far in, the exact law. */
static void elsewhere_the_exact_law(void **state)
{
    (void)state;
    const nt_maugis_bank bank = bank_of(4, 4);
    const struct {
        double lambda, d;
    } points[] = {{0.94, 0.3}, {0.936, 0.3}, {1e-4, 0.5}, {1e4, 0.5}, {2.0, 111.0}, {2.0, 1e9}};
    for (size_t i = 0; i < COUNT(points); i++) {
        const nt_maugis maugis = prepared(points[i].lambda);
        const nt_law_value exact = eval(&maugis, points[i].d, NT_BRANCH_STABLE);
        assert_true(at(&bank, points[i].lambda, points[i].d).F == exact.F);
    }
    const nt_maugis maugis = prepared(3.0);
    nt_law_value value;
    assert_int_equal(nt_maugis_bank_eval(&bank, 3.0, -0.8, NT_BRANCH_UNSTABLE, &value), NT_OK);
    assert_true(value.F == eval(&maugis, -0.8, NT_BRANCH_UNSTABLE).F);
}

static void arrays_and_si(void **state)
{
    (void)state;
    const nt_maugis_bank bank = bank_of(4, 4);
    double lambda[50], d[50], load[50];
    for (int i = 0; i < 50; i++) {
        lambda[i] = 0.02 * pow(1.1, i);
        d[i] = 0.1 * i - 1.0;
        nt_contact contact = nt_contact_defaults();
        contact.radius *= 1.0 + i; /* a curved surface under one tip */
        nt_maugis maugis;
        nt_law_value value;
        assert_int_equal(nt_maugis_init(&maugis, &contact), NT_OK);
        assert_int_equal(nt_maugis_bank_eval_contact(&bank, &contact, 1e-9, NT_BRANCH_STABLE, &value), NT_OK);
        assert_within(value.F, eval(&maugis, 1e-9, NT_BRANCH_STABLE).F,
                      3e-5 * fmax(value.F, nt_maugis_pull_off_force(&maugis)));
    }
    d[7] = NAN;
    assert_int_equal(nt_maugis_bank_load_n(&bank, lambda, d, load, 50), NT_E_NOT_FINITE);
    for (int i = 0; i < 50; i++)
        assert_true(i == 7 ? isnan(load[i]) : load[i] == at(&bank, lambda[i], d[i]).F);
    nt_contact contact = nt_contact_defaults();
    contact.work_of_adhesion = 0.0;
    nt_law_value value;
    assert_int_equal(nt_maugis_bank_eval_contact(&bank, &contact, 1e-9, NT_BRANCH_STABLE, &value), NT_OK);
    assert_true(value.F == nt_hertz_force(&contact, 1e-9));
}

static void refuses_bad_input(void **state)
{
    (void)state;
    const nt_maugis_bank bank = bank_of(4, 4);
    nt_law_value value = {.F = 7.0};
    assert_int_equal(nt_maugis_bank_eval(&bank, NAN, 0.0, NT_BRANCH_STABLE, &value), NT_E_NOT_FINITE);
    assert_int_equal(nt_maugis_bank_eval(&bank, 1.0, INFINITY, NT_BRANCH_STABLE, &value), NT_E_NOT_FINITE);
    assert_int_equal(nt_maugis_bank_eval(&bank, -1.0, 0.0, NT_BRANCH_STABLE, &value), NT_E_RANGE);
    assert_int_equal(nt_maugis_bank_eval(&bank, 1.0, 0.0, (nt_branch)9, &value), NT_E_ARGUMENT);
    assert_true(value.F == 7.0);
    nt_maugis_bank_memory memory = {panels, cells, 3, CELLS};
    nt_maugis_bank_options options = nt_maugis_bank_defaults();
    nt_maugis_bank made;
    assert_int_equal(nt_maugis_bank_init(&made, &options, &memory), NT_E_CAPACITY);
    const nt_maugis_bank_options wrong[] = {{1.0, 0.5, 10.0, 2, 4},  {0.1, 10.0, 0.0, 2, 4},
                                            {0.1, 10.0, 10.0, 3, 4}, {0.1, 10.0, 10.0, 2, 0},
                                            {NAN, 10.0, 10.0, 2, 4}, {0.1, INFINITY, 10.0, 2, 4}};
    for (size_t i = 0; i < COUNT(wrong); i++)
        assert_int_equal(nt_maugis_bank_size(&wrong[i], &memory), NT_E_RANGE);
    options.lambda_min = 2.0; /* one side only */
    assert_int_equal(nt_maugis_bank_size(&options, &memory), NT_OK);
    memory.panels = panels;
    memory.cells = cells;
    assert_int_equal(nt_maugis_bank_init(&made, &options, &memory), NT_OK);
    assert_true(made.panel_count[0] == 0 && made.panel_count[1] == memory.panel_capacity);
    assert_within(at(&made, 5.8, 1.0).F, at(&bank, 5.8, 1.0).F, 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_what_the_bank_says),
        cmocka_unit_test(other_states),
        cmocka_unit_test(a_potential_at_constant_lambda),
        cmocka_unit_test(elsewhere_the_exact_law),
        cmocka_unit_test(arrays_and_si),
        cmocka_unit_test(refuses_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
