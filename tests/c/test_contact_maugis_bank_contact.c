/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/maugis.h"
#include "maugis_fixture.h"
#include "nanotouch/advanced/maugis.h"

static nt_bank_value eval_radius(const nt_maugis_bank *bank, double lambda, double radius, double d)
{
    const nt_contact contact = {radius, 0.75, 1.0 / NT_PI, 0.5 * lambda}; /* units of 1 at R = 1 */
    nt_bank_value value;
    assert_int_equal(nt_maugis_bank_eval_radius(bank, &contact, d, NT_BRANCH_STABLE, &value), NT_OK);
    return value;
}

/* Without panels the exact solver answers; its slope over the radius by differences, h^2 and 1e-14/h; its fold. */
static void a_bank_of_zeros_is_exact(void **state)
{
    (void)state;
    const nt_maugis_bank none = {.panels = NULL};
    const double h = 1e-5;
    assert_true(nt_maugis_bank_error(&none, 0.01, 100.0).force == 0.0);
    for (double lambda = 0.02; lambda < 90.0; lambda *= 1.7) {
        const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.5 * lambda};
        const nt_maugis maugis = reduced(lambda);
        assert_within(nt_maugis_bank_grip_indentation(&none, &contact), maugis.folds.grip_indentation, 1e-14);
        for (double step = 0.1; step < 20.0; step *= 1.4) {
            const double d = maugis.folds.grip_indentation + step;
            const nt_bank_value value = eval_radius(&none, lambda, 1.0, d);
            const nt_law_value direct = eval(&maugis, d, NT_BRANCH_STABLE);
            const double change =
                eval_radius(&none, lambda, 1.0 + h, d).law.U - eval_radius(&none, lambda, 1.0 - h, d).law.U;
            assert_within(value.law.F, direct.F, 1e-12 * (fabs(direct.F) + 1.0));
            assert_within(value.law.U, direct.U, 1e-12 * (fabs(direct.U) + 1.0));
            assert_within(value.dU_dR, change / (2.0 * h), 1e-8 * (fabs(direct.U) + 1.0));
        }
    }
}

enum { PAIRS = 1500 };

static double drawn(unsigned *random)
{
    *random = *random * 1664525u + 1013904223u;
    return (double)(*random >> 8) / 16777216.0;
}

/* Contacts and indentations: lambda 1e-3 .. 1e3, around the folds and far from them; at a fold, apart, without
 * adhesion, and one that is so deep that it is Hertz. */
static void draw(nt_contact *contacts, double *indentations)
{
    unsigned random = 45;
    for (int i = 0; i < PAIRS; i++) {
        const double lambda = pow(10.0, 6.0 * drawn(&random) - 3.0), R = 5e-9 + 50e-9 * drawn(&random);
        contacts[i] = (nt_contact){R, 1e9, i % 401 == 7 ? 0.0 : 0.02 + drawn(&random), 1e9};
        contacts[i].cohesive_stress *= lambda / nt_maugis_lambda(&contacts[i]);
        if (i % 401 == 7)
            contacts[i].cohesive_stress = 1e8;
        nt_maugis maugis;
        assert_int_equal(nt_maugis_init(&maugis, &contacts[i]), NT_OK);
        const double grip = maugis.folds.grip_indentation, step = i % 11 == 0 ? 0.0 : drawn(&random);
        const double reach = i % 3 == 0 ? 10.0 : i % 3 == 1 ? 0.02 : 2.5 * fabs(maugis.folds.onset_indentation);
        indentations[i] = (i % 13 == 0 ? 1.1 * grip : grip + step * reach) * maugis.indentation_scale;
    }
    contacts[300].work_of_adhesion = 1e-290;
    contacts[300].cohesive_stress = 0.5 / nt_maugis_lambda(&(nt_contact){contacts[300].radius, 1e9, 1e-290, 1.0});
    indentations[300] = 1e-9;
}

/* Each pair, in a block or not, is the law of its contact to the bit. */
static void pairs_have_the_bits_of_the_law(void **state)
{
    (void)state;
    static nt_contact contacts[PAIRS];
    static double in[PAIRS], out[4][PAIRS], alone[PAIRS];
    const nt_maugis_bank none = {.panels = NULL};
    draw(contacts, in);
    for (int approach = 0; approach < 2; approach++) {
        const nt_branch branch = approach ? NT_BRANCH_APPROACH : NT_BRANCH_STABLE;
        const nt_bank_pairs all = {contacts, in, out[0], out[1], out[2], out[3], NULL, PAIRS, 1, 1, 1};
        const nt_bank_pairs force = {contacts, in, NULL, alone, NULL, NULL, NULL, PAIRS, 1, 1, 1};
        assert_int_equal(nt_maugis_bank_pairs_n(&none, branch, &all), NT_OK);
        assert_int_equal(nt_maugis_bank_pairs_n(&none, branch, &force), NT_OK);
        for (int i = 0; i < PAIRS; i++) {
            nt_maugis maugis;
            nt_law_value value;
            assert_int_equal(nt_maugis_init(&maugis, &contacts[i]), NT_OK);
            assert_int_equal(nt_maugis_eval(&maugis, in[i], branch, &value, NULL), NT_OK);
            assert_true(out[0][i] == value.U && out[1][i] == value.F && out[2][i] == value.k && out[3][i] == value.a);
            assert_true(alone[i] == value.F);
        }
    }
}

/* What is wrong in a block is NaN, and leaves the others alone. */
static void a_wrong_pair_is_alone(void **state)
{
    (void)state;
    nt_contact contacts[100];
    double in[100], out[100];
    const nt_maugis_bank none = {.panels = NULL};
    for (int i = 0; i < 100; i++) {
        contacts[i] = (nt_contact){20e-9, 1e9, 0.05, 1e8};
        in[i] = 1e-9;
    }
    contacts[10].radius = -1.0;
    in[80] = NAN;
    const nt_bank_pairs pairs = {contacts, in, NULL, out, NULL, NULL, NULL, 100, 1, 1, 1};
    assert_int_equal(nt_maugis_bank_pairs_n(&none, NT_BRANCH_STABLE, &pairs), NT_E_RANGE);
    for (int i = 0; i < 100; i++)
        assert_true(i == 10 || i == 80 ? isnan(out[i]) : out[i] == out[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bank_of_zeros_is_exact),
        cmocka_unit_test(pairs_have_the_bits_of_the_law),
        cmocka_unit_test(a_wrong_pair_is_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
