/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale over arrays gives what the scalar functions give, bit for bit. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "contact/maugis_table.h"
#include "internal/contact.h"
#include "internal/maugis.h"
#include "maugis_fixture.h"
#include "nanotouch/advanced/maugis.h"

enum { CAPACITY = 300, COUNT_MAX = 1500 };
static nt_maugis_cell cells[CAPACITY];
static double in[COUNT_MAX], out[COUNT_MAX];

static nt_maugis_table table_of(double lambda)
{
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
    nt_maugis maugis;
    nt_maugis_table table;
    assert_int_equal(nt_maugis_init_lambda(&maugis, &contact, lambda), NT_OK);
    assert_int_equal(nt_maugis_table_init(&table, &maugis, NULL, cells, CAPACITY), NT_OK);
    return table;
}

/* Over all three states and both joins, out of order. */
static void fill(const nt_maugis_table *table, long count)
{
    const double low = table->maugis.folds.grip_indentation;
    for (long i = 0; i < count; i++)
        in[i] = low + (table->start - low) * ((double)(i * 37 % 101) / 50.0 - 0.3) + 1e-3 * (double)(i * i % 5003);
}

static int same(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static void arrays_are_the_scalars(void **state)
{
    (void)state;
    const double lambdas[] = {0.01, 0.5, 0.95, 5.8, 1e9};
    const long counts[] = {0, 1, 3, 255, 256, 257, 1500}; /* around whole blocks */
    for (size_t i = 0; i < COUNT(lambdas); i++)
        for (size_t j = 0; j < COUNT(counts); j++) {
            const nt_maugis_table table = table_of(lambdas[i]);
            fill(&table, counts[j]);
            assert_int_equal(nt_maugis_table_force_n(&table, NT_BRANCH_STABLE, in, out, counts[j]), NT_OK);
            for (long n = 0; n < counts[j]; n++)
                assert_true(same(out[n], nt_maugis_table_force(&table, in[n])));
            assert_int_equal(nt_maugis_table_polish_n(&table, NT_BRANCH_STABLE, in, out, counts[j]), NT_OK);
            for (long n = 0; n < counts[j]; n++)
                assert_true(same(out[n], nt_maugis_table_polish(&table, in[n])));
            memcpy(out, in, sizeof in);
            assert_int_equal(nt_maugis_table_force_n(&table, NT_BRANCH_APPROACH, out, out, counts[j]), NT_OK);
            for (long n = 0; n < counts[j]; n++) {
                nt_law_value value;
                assert_int_equal(nt_maugis_table_eval(&table, NT_TIER_TABLE, in[n], NT_BRANCH_APPROACH, &value), NT_OK);
                assert_true(same(out[n], value.F));
            }
        }
}

/* One bad element among good ones: NaN there and the status, nothing else changes; far elements are the exact law. */
static void bad_and_far_elements(void **state)
{
    (void)state;
    const nt_maugis_table table = table_of(1.3);
    const double odd[] = {NAN, -NAN, INFINITY, -INFINITY, 1e7};
    for (size_t i = 0; i < COUNT(odd); i++) {
        fill(&table, 600);
        in[300] = odd[i];
        const nt_status expected = odd[i] < 1e30 ? NT_OK : NT_E_NOT_FINITE;
        assert_int_equal(nt_maugis_table_force_n(&table, NT_BRANCH_STABLE, in, out, 600), expected);
        for (long n = 0; n < 600; n++)
            assert_true(same(out[n], nt_maugis_table_force(&table, in[n])));
        if (isfinite(odd[i]))
            assert_true(out[300] == eval(&table.maugis, odd[i], NT_BRANCH_STABLE).F);
        else
            assert_true(odd[i] < 0.0 ? out[300] == 0.0 : isnan(out[300]));
        assert_int_equal(nt_maugis_table_polish_n(&table, NT_BRANCH_STABLE, in, out, 600), expected);
        assert_true(same(out[300], nt_maugis_table_polish(&table, odd[i])));
    }
}

static void strided_arrays_and_the_unstable_branch(void **state)
{
    (void)state;
    const nt_maugis_table table = table_of(0.2);
    fill(&table, 100);
    double U[50], k[50];
    for (int tier = NT_TIER_TABLE; tier <= NT_TIER_EXACT; tier++) {
        const nt_strided arrays = {in, U, out, k, NULL, 50, 2, 1};
        assert_int_equal(nt_maugis_table_eval_n(&table, (nt_tier)tier, NT_BRANCH_STABLE, &arrays), NT_OK);
        for (int n = 0; n < 50; n++) {
            nt_law_value value;
            assert_int_equal(nt_maugis_table_eval(&table, (nt_tier)tier, in[2 * n], NT_BRANCH_STABLE, &value), NT_OK);
            assert_true(same(value.F, out[n]) && same(value.U, U[n]) && same(value.k, k[n]));
        }
    }
    const double low = table.maugis.folds.grip_indentation;
    in[0] = low + 0.01;
    in[1] = 5.0; /* no unstable state there */
    assert_int_equal(nt_maugis_table_force_n(&table, NT_BRANCH_UNSTABLE, in, out, 2), NT_E_NO_SOLUTION);
    assert_true(out[0] == eval(&table.maugis, low + 0.01, NT_BRANCH_UNSTABLE).F && isnan(out[1]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_are_the_scalars),
        cmocka_unit_test(bad_and_far_elements),
        cmocka_unit_test(strided_arrays_and_the_unstable_branch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
