/* SPDX-License-Identifier: BSD-3-Clause
 * Contact laws over arrays: the bits of the scalar law for every model, branch, length and stride, at ordinary and at
 * extreme indentations. The scalar laws have references of their own (test_contact_hertz and its neighbors). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "contact/maugis_table.h"
#include "internal/contact.h"
#include "nanotouch/contact.h"
#include "nanotouch/material.h"

enum { MOST = 200 };

static unsigned long long random_state = 1;

static double uniform(double low, double high)
{
    random_state = random_state * 6364136223846793005ULL + 1442695040888963407ULL;
    return low + (high - low) * (double)(random_state >> 11) / 9007199254740992.0;
}

/* From glass on glass to gels, one in eight without adhesion; some indentations extreme. */
static nt_contact_law drawn_law(nt_model model)
{
    const double w = uniform(0.0, 8.0) < 1.0 ? 0.0 : pow(10.0, uniform(-4.0, 0.0));
    const nt_contact contact = {
        .radius = pow(10.0, uniform(-9.0, -5.0)),
        .effective_modulus = pow(10.0, uniform(3.0, 11.5)),
        .work_of_adhesion = w,
        .cohesive_stress = (w + 1e-4) / pow(10.0, uniform(-10.0, -8.0)),
    };
    nt_contact_law law;
    assert_int_equal(nt_contact_law_init(&law, model, &contact), NT_OK);
    return law;
}

static double drawn_indentation(const nt_contact_law *law)
{
    static const double extreme[] = {0.0, -0.0, NAN, INFINITY, -INFINITY, 1e300, -1e300, 5e-324, 1e-200, -1e-12};
    const double kind = uniform(0.0, 12.0);
    const double unit =
        law->maugis.contact.work_of_adhesion > 0.0 ? fabs(nt_jkr_pull_off_indentation(&law->maugis.contact)) : 1e-9;
    if (kind < 0.2)
        return extreme[(int)uniform(0.0, 10.0)];
    if (kind < 1.0) /* at the fold of JKR and a rounding beside it */
        return nt_jkr_pull_off_indentation(&law->maugis.contact) * (1.0 + (floor(uniform(0.0, 5.0)) - 2.0) * 0x1p-52);
    return unit * (kind < 6.0 ? uniform(-1.5, 10.0) : pow(10.0, uniform(-6.0, 6.0)));
}

static int same_bits(double x, double y)
{
    return memcmp(&x, &y, sizeof x) == 0 || (isnan(x) && isnan(y));
}

/* One array of this length and these strides; returns how many elements were not the scalar law's. */
static int differences(const nt_contact_law *law, nt_branch branch, long count, const long strides[2])
{
    static double in[3 * MOST], out[4][3 * MOST];
    for (long i = 0; i < count; i++)
        in[i * strides[0]] = drawn_indentation(law);
    for (int j = 0; j < 4; j++)
        for (long i = 0; i < 3 * MOST; i++)
            out[j][i] = 7.0;
    const int force_alone = uniform(0.0, 2.0) < 1.0;
    const nt_strided arrays = {in,
                               force_alone ? NULL : out[0],
                               out[1],
                               force_alone ? NULL : out[2],
                               force_alone ? NULL : out[3],
                               count,
                               strides[0],
                               strides[1]};
    const nt_status status = nt_contact_law_eval_n(law, branch, &arrays);
    nt_status first = NT_OK;
    int wrong = 0;
    for (long i = 0; i < count; i++) {
        nt_law_value value = {NAN, NAN, NAN, NAN};
        const nt_status one = nt_contact_law_eval(law, in[i * strides[0]], branch, &value);
        first = first == NT_OK ? one : first;
        const long j = i * strides[1];
        wrong += !same_bits(out[1][j], value.F);
        if (!force_alone)
            wrong += !same_bits(out[0][j], value.U) + !same_bits(out[2][j], value.k) + !same_bits(out[3][j], value.a);
    }
    for (long i = 0; strides[1] > 1 && i < count; i++) /* nothing between the elements */
        wrong += out[1][i * strides[1] + 1] != 7.0;
    return wrong + (status != first);
}

static void arrays_have_the_bits_of_the_scalar_law(void **state)
{
    (void)state;
    static const nt_model models[] = {NT_HERTZ, NT_DMT, NT_JKR, NT_MAUGIS};
    static const nt_branch branches[] = {NT_BRANCH_STABLE, NT_BRANCH_APPROACH, NT_BRANCH_UNSTABLE, (nt_branch)9};
    for (int m = 0; m < 4; m++)
        for (int b = 0; b < 4; b++)
            for (int n = 0; n < 40; n++) {
                const nt_contact_law law = drawn_law(models[m]);
                const long strides[2] = {1 + (long)uniform(0.0, 2.0), 1 + (long)uniform(0.0, 3.0)};
                const long count = (long)uniform(0.0, MOST);
                const int wrong = differences(&law, branches[b], count, strides);
                if (wrong)
                    print_error("%s, branch %d, %ld elements: %d differ\n", nt_model_name(models[m]), b, count, wrong);
                assert_int_equal(wrong, 0);
            }
}

static void in_and_out_may_be_one_array(void **state)
{
    (void)state;
    static const nt_model models[] = {NT_HERTZ, NT_DMT, NT_JKR, NT_MAUGIS};
    for (int m = 0; m < 4; m++) {
        const nt_contact_law law = drawn_law(models[m]);
        double in[MOST], place[MOST];
        for (int i = 0; i < MOST; i++)
            in[i] = place[i] = drawn_indentation(&law);
        const nt_strided arrays = {.in = place, .F = place, .count = MOST, .in_stride = 1, .out_stride = 1};
        (void)nt_contact_law_eval_n(&law, NT_BRANCH_STABLE, &arrays);
        for (int i = 0; i < MOST; i++) {
            nt_law_value value = {.F = NAN};
            (void)nt_contact_law_eval(&law, in[i], NT_BRANCH_STABLE, &value);
            assert_true(same_bits(place[i], value.F));
        }
    }
}

/* {U, F, k, a} from a table: blocks of 256 and what is left of them, in all four states of the bodies. */
static void tables_have_the_bits_of_one_element(void **state)
{
    (void)state;
    enum { LONG = 700, CELLS = 400 };
    static nt_maugis_cell cells[CELLS];
    static double in[LONG], out[4][2 * LONG];
    for (int n = 0; n < 24; n++) {
        const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.5 * pow(10.0, uniform(-2.0, 3.0))};
        nt_maugis maugis;
        nt_maugis_table table;
        assert_int_equal(nt_maugis_init(&maugis, &contact), NT_OK);
        assert_int_equal(nt_maugis_table_init(&table, &maugis, NULL, cells, CELLS), NT_OK);
        const double low = n % 2 ? 1.2 * maugis.folds.grip_indentation : -1.5;
        for (int i = 0; i < LONG; i++)
            in[i] = uniform(0.0, 1.0) < 0.1 ? low * uniform(0.5, 1.0) : uniform(low, 10.0);
        if (n > 18)
            in[(int)uniform(0.0, LONG)] = n % 3 ? INFINITY : NAN;
        in[3] = maugis.folds.grip_indentation;
        const nt_branch branch = n % 3 ? NT_BRANCH_STABLE : NT_BRANCH_APPROACH;
        const nt_tier tier = n % 4 ? NT_TIER_TABLE : NT_TIER_POLISHED;
        const nt_strided arrays = {in, out[0], out[1], out[2], out[3], LONG, 1, 2};
        (void)nt_maugis_table_eval_n(&table, tier, branch, &arrays);
        for (int i = 0; i < LONG; i++) {
            nt_law_value value = {NAN, NAN, NAN, NAN};
            (void)nt_maugis_table_eval(&table, tier, in[i], branch, &value);
            assert_true(same_bits(out[0][2 * i], value.U) && same_bits(out[1][2 * i], value.F) &&
                        same_bits(out[2][2 * i], value.k) && same_bits(out[3][2 * i], value.a));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_have_the_bits_of_the_scalar_law),
        cmocka_unit_test(in_and_out_may_be_one_array),
        cmocka_unit_test(tables_have_the_bits_of_one_element),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
