/* SPDX-License-Identifier: BSD-3-Clause
 * A bank of tables over lambda against the exact law: error, potential, joins, gap and ends, refusals. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "contact/maugis_bank.h"
#include "internal/contact.h"
#include "internal/maugis.h"
#include "larger.h"
#include "maugis_fixture.h"
#include "nanotouch/advanced/maugis.h"

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

static nt_law_value at_contact(const nt_maugis_bank *bank, const nt_contact *contact, double d)
{
    nt_law_value value;
    assert_int_equal(nt_maugis_bank_eval_contact(bank, contact, d, NT_BRANCH_STABLE, &value), NT_OK);
    return value;
}

static nt_maugis prepared(double lambda)
{
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
    nt_maugis maugis;
    assert_int_equal(nt_maugis_init_lambda(&maugis, &contact, lambda), NT_OK);
    return maugis;
}

/* At 400 lambdas that no panel was made from, dense in d: within what the bank measured of itself, there. */
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
            const nt_bank_error error = nt_maugis_bank_error(&bank, lambda, lambda);
            assert_true(error.force <= bank.accuracy.force_error && error.fold_shift <= bank.accuracy.fold_shift);
            const double start = folds->grip_in_contact ? folds->grip_indentation : folds->touch_indentation;
            for (double step = 1.1e-4; start + step < 99.0; step *= 1.17) {
                const double d = start + step;
                const nt_law_value exact = eval(&maugis, d, NT_BRANCH_STABLE), value = at(&bank, lambda, d);
                const double scale = larger(fabs(exact.F), nt_maugis_pull_off_force(&maugis));
                /* rounding of the exact law: 1e-13 */
                assert_within(value.F, exact.F, (error.force + 1e-13) * scale);
                assert_within(value.k, exact.k, (error.stiffness + 1e-11) * larger(fabs(exact.k), 1.0));
                assert_within(value.a, exact.a, (error.radius + 1e-13) * larger(exact.a, 1.0));
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
                      3e-5 * larger(value.F, nt_maugis_pull_off_force(&maugis)));
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

/* dU/dlambda by central differences of the bank's own U, across panels, both blends and the exact window, on the
 * attracted state too; F and k alike. Truncation h^2 and, at joins, the jump of the second derivative times h. */
static void one_potential_of_indentation_and_radius(void **state)
{
    (void)state;
    const nt_maugis_bank bank = bank_of(4, 4);
    const nt_contact base = {1.0, 0.75, 1.0 / NT_PI, 0.0};
    for (double lambda = 0.0045; lambda < 230.0; lambda *= lambda > 0.85 && lambda < 1.05 ? 1.0017 : 1.037) {
        nt_contact contact = base;
        contact.cohesive_stress = 0.5 * lambda; /* R = 1: the units are 1 */
        const double grip = nt_maugis_bank_grip_indentation(&bank, &contact);
        for (double above = 3e-3; above < 130.0; above *= 1.9) {
            const double d = grip + above, h = 1e-6;
            nt_bank_value at, up, down;
            assert_int_equal(nt_maugis_bank_eval_radius(&bank, &contact, d, NT_BRANCH_STABLE, &at), NT_OK);
            nt_contact blunter = contact, sharper = contact;
            blunter.radius += h;
            sharper.radius -= h;
            assert_int_equal(nt_maugis_bank_eval_radius(&bank, &blunter, d, NT_BRANCH_STABLE, &up), NT_OK);
            assert_int_equal(nt_maugis_bank_eval_radius(&bank, &sharper, d, NT_BRANCH_STABLE, &down), NT_OK);
            const double scale = 1.0 + fabs(at.law.U);
            assert_within((up.law.U - down.law.U) / (2.0 * h), at.dU_dR, 1e-6 * scale);
            const double step = 1e-6 * smaller(above, 1.0);
            const nt_law_value more = at_contact(&bank, &contact, d + step);
            const nt_law_value less = at_contact(&bank, &contact, d - step);
            assert_within((more.U - less.U) / (2.0 * step), at.law.F, 1e-5 * scale);
            assert_within((more.F - less.F) / (2.0 * step), at.law.k, 1e-4 * (1.0 + fabs(at.law.k)));
        }
    }
}

/* 5-point Gauss-Legendre on [0, 1]. */
static const double gauss_x[] = {0.046910077030668004, 0.23076534494715845, 0.5, 0.76923465505284155,
                                 0.95308992296933200};
static const double gauss_w[] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324,
                                 0.11846344252809454};

/* The work over an edge of a lap in (R, delta): the integral of dU/dR dR + F d(delta). */
static double work_of(const nt_maugis_bank *bank, const double from[2], const double to[2])
{
    double sum = 0.0;
    for (int i = 0; i < 5; i++) {
        const nt_contact contact = {from[0] + gauss_x[i] * (to[0] - from[0]), 0.75, 1.0 / NT_PI, 0.5};
        nt_bank_value at;
        assert_int_equal(
            nt_maugis_bank_eval_radius(bank, &contact, from[1] + gauss_x[i] * (to[1] - from[1]), NT_BRANCH_STABLE, &at),
            NT_OK);
        sum += gauss_w[i] * (at.dU_dR * (to[0] - from[0]) + at.law.F * (to[1] - from[1]));
    }
    return sum;
}

/* Closed laps over radius and indentation in contact, from below lambda = 0.9379 to above it and far beyond the tables:
 * what is got out is the error of the quadrature; the energy itself returns bit by bit, being a function. A lap by
 * steps of a 4000th: the kinks of the third derivative at joins leave 1e-9 of the energy that is turned over. */
static void closed_laps_give_nothing(void **state)
{
    (void)state;
    const nt_maugis_bank bank = bank_of(4, 4);
    const struct {
        double R, R_reach, d, d_reach;
    } laps[] = {{0.9, 0.5, 0.8, 1.2},       /* lambda = R^(1/3): 0.74 .. 1.12 */
                {0.825, 0.03, 0.5, 1.0},    /* within the exact window and its blends */
                {40.0, 30.0, 200.0, 180.0}, /* through the largest indentation, d ~ R^(-1/3) */
                {1e-4, 9e-5, 1.0, 0.5}};
    for (size_t l = 0; l < COUNT(laps); l++) {
        double sum = 0.0, turned = 0.0;
        const int count = 4000;
        double from[2] = {laps[l].R + laps[l].R_reach, laps[l].d};
        for (int i = 1; i <= count; i++) {
            const double phase = 2.0 * NT_PI * (i % count) / count;
            const double to[2] = {laps[l].R + laps[l].R_reach * cos(phase), laps[l].d + laps[l].d_reach * sin(phase)};
            const double work = work_of(&bank, from, to);
            sum += work;
            turned += fabs(work);
            from[0] = to[0];
            from[1] = to[1];
        }
        assert_within(sum, 0.0, 1e-9 * turned);
    }
}

/* U, F and dU/dR do not jump where a panel meets the next, the exact law, or the attracted state: 1e-9 of lambda on
 * either side of every panel's border and of a = 0. */
static void nothing_jumps_at_joins(void **state)
{
    (void)state;
    const nt_maugis_bank bank = bank_of(4, 4);
    for (int i = 0; i < bank.panel_count[0] + bank.panel_count[1]; i++) {
        const double v = bank.panels[i].low * 0.93794745721071221163;
        const double lambda =
            i < bank.panel_count[0] ? 0.93794745721071221163 / (1.0 + bank.panels[i].low) : 0.93794745721071221163 + v;
        nt_contact low = {1.0, 0.75, 1.0 / NT_PI, 0.5 * lambda * (1.0 - 1e-9)}, high = low;
        high.cohesive_stress = 0.5 * lambda * (1.0 + 1e-9);
        const double grip = nt_maugis_bank_grip_indentation(&bank, &low);
        for (double above = 1e-2; above < 120.0; above *= 1.7) {
            nt_bank_value a, b;
            assert_int_equal(nt_maugis_bank_eval_radius(&bank, &low, grip + above, NT_BRANCH_STABLE, &a), NT_OK);
            assert_int_equal(nt_maugis_bank_eval_radius(&bank, &high, grip + above, NT_BRANCH_STABLE, &b), NT_OK);
            const double scale = 1.0 + fabs(a.law.U);
            assert_within(a.law.U, b.law.U, 1e-7 * scale);
            assert_within(a.law.F, b.law.F, 1e-7 * scale);
            assert_within(a.dU_dR, b.dU_dR, 1e-6 * scale);
        }
    }
    for (double lambda = 0.0123; lambda < 0.93; lambda *= 1.07) {
        const double touch = prepared(lambda).folds.touch_indentation;
        const nt_law_value attracted = at(&bank, lambda, touch - 1e-12), contact = at(&bank, lambda, touch + 1e-12);
        assert_within(attracted.F, contact.F, 1e-5 * sqrt(1e-12 / (0.94 - lambda)) + 1e-9);
        assert_within(attracted.U, contact.U, 1e-11);
    }
}

/* The exact slope, in closed form, against the differences of the exact energy (tests of the branch have its energy
 * against 50 digits): 1e-8 by truncation. */
static void exact_slope_of_the_energy(void **state)
{
    (void)state;
    nt_maugis_bank bank = bank_of(4, 4);
    bank.panel_count[0] = bank.panel_count[1] = 0; /* exact everywhere */
    for (double lambda = 1e-3; lambda < 1e3; lambda *= 1.43)
        for (double above = 0.02; above < 1e3; above *= 2.3) {
            const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.5 * lambda};
            const double d = nt_maugis_bank_grip_indentation(&bank, &contact) + above;
            nt_bank_value value;
            double U[4];
            for (int i = 0; i < 4; i++) {
                static const double steps[] = {-2e-4, -1e-4, 1e-4, 2e-4};
                const nt_contact near = {1.0 + steps[i], 0.75, 1.0 / NT_PI, 0.5 * lambda};
                U[i] = at_contact(&bank, &near, d).U;
            }
            assert_int_equal(nt_maugis_bank_eval_radius(&bank, &contact, d, NT_BRANCH_STABLE, &value), NT_OK);
            assert_within((8.0 * (U[2] - U[1]) - (U[3] - U[0])) / 12e-4, value.dU_dR, 1e-8 * (1.0 + fabs(value.law.U)));
        }
}

/* Pairs, strided, in two parts, are the single calls; a contact that is none is NaN and sets the status. */
static void pairs_are_the_single_calls(void **state)
{
    (void)state;
    const nt_maugis_bank bank = bank_of(4, 4);
    nt_contact contacts[40];
    double depth[80], U[120], F[120], slope[120];
    for (int i = 0; i < 40; i++) {
        contacts[i] = nt_contact_defaults();
        contacts[i].radius *= 0.1 * (1.0 + i);
        contacts[i].work_of_adhesion *= i % 5 == 4 ? 0.0 : 1.0;
        depth[2 * i] = 0.1e-9 * (i - 10);
    }
    contacts[33].radius = (double)NAN;
    nt_bank_pairs pairs = {contacts, depth, U, F, NULL, NULL, slope, 20, 1, 2, 3};
    assert_int_equal(nt_maugis_bank_pairs_n(&bank, NT_BRANCH_STABLE, &pairs), NT_OK);
    pairs.contacts += 20;
    pairs.indentation += 40;
    pairs.U += 60;
    pairs.F += 60;
    pairs.dU_dR += 60;
    assert_int_equal(nt_maugis_bank_pairs_n(&bank, NT_BRANCH_STABLE, &pairs), NT_E_NOT_FINITE);
    for (int i = 0; i < 40; i++) {
        nt_bank_value one = {{NAN, NAN, NAN, NAN}, NAN};
        (void)nt_maugis_bank_eval_radius(&bank, &contacts[i], depth[2 * i], NT_BRANCH_STABLE, &one);
        if (i == 33)
            assert_true(isnan(U[3 * i]) && isnan(F[3 * i]) && isnan(slope[3 * i]));
        else
            assert_true(U[3 * i] == one.law.U && F[3 * i] == one.law.F && slope[3 * i] == one.dU_dR);
    }
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
        cmocka_unit_test(one_potential_of_indentation_and_radius),
        cmocka_unit_test(closed_laps_give_nothing),
        cmocka_unit_test(nothing_jumps_at_joins),
        cmocka_unit_test(exact_slope_of_the_energy),
        cmocka_unit_test(pairs_are_the_single_calls),
        cmocka_unit_test(refuses_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
