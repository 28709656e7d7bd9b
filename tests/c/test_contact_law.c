/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/contact.h"
#include "nanotouch/contact.h"
#include "nanotouch/material.h"

static const nt_model models[] = {NT_HERTZ, NT_DMT, NT_JKR, NT_MAUGIS};
enum { MODELS = (int)(sizeof models / sizeof models[0]) };

static nt_contact_law law_of(nt_model model)
{
    const nt_contact contact = nt_contact_defaults();
    nt_contact_law law;
    assert_int_equal(nt_contact_law_init(&law, model, &contact), NT_OK);
    return law;
}

/* The law chosen at run time is the law called by name. */
static void law_is_the_model(void **state)
{
    (void)state;
    const nt_contact contact = nt_contact_defaults();
    nt_contact_law laws[MODELS];
    for (int i = 0; i < MODELS; i++)
        laws[i] = law_of(models[i]);
    for (double d = -2e-9; d < 5e-9; d += 0.03e-9) {
        nt_law_value value, expected;
        assert_int_equal(nt_contact_law_eval(&laws[0], d, NT_BRANCH_STABLE, &value), NT_OK);
        assert_true(value.F == nt_hertz_force(&contact, d));
        assert_int_equal(nt_contact_law_eval(&laws[1], d, NT_BRANCH_APPROACH, &value), NT_OK);
        assert_true(value.F == nt_dmt_force(&contact, d));
        assert_int_equal(nt_contact_law_eval(&laws[2], d, NT_BRANCH_STABLE, &value), NT_OK);
        assert_int_equal(nt_jkr_eval(&contact, d, NT_BRANCH_STABLE, &expected), NT_OK);
        assert_true(value.F == expected.F);
        assert_int_equal(nt_contact_law_eval(&laws[3], d, NT_BRANCH_APPROACH, &value), NT_OK);
        assert_int_equal(nt_maugis_eval(&laws[3].maugis, d, NT_BRANCH_APPROACH, &expected, NULL), NT_OK);
        assert_true(value.F == expected.F && value.k == expected.k);
    }
}

static void pull_off_and_grips(void **state)
{
    (void)state;
    const double unit = NT_PI * 20e-9 * 0.144;
    const double pull_off[MODELS] = {0.0, 2.0, 1.5, -1.0};
    for (int i = 0; i < MODELS; i++) {
        const nt_contact_law law = law_of(models[i]);
        const double force = nt_contact_law_pull_off_force(&law), grip = nt_contact_law_grip_indentation(&law);
        if (pull_off[i] >= 0.0)
            assert_true(fabs(force - pull_off[i] * unit) <= 1e-14 * unit);
        else
            assert_true(force > 1.5 * unit && force < 2.0 * unit);
        nt_law_value held, free;
        assert_int_equal(nt_contact_law_eval(&law, grip, NT_BRANCH_STABLE, &held), NT_OK);
        assert_int_equal(nt_contact_law_eval(&law, nextafter(grip, -1.0), NT_BRANCH_STABLE, &free), NT_OK);
        assert_true(free.F == 0.0 && free.U == 0.0);
        assert_true(models[i] == NT_HERTZ || held.F < 0.0);
    }
}

static void unstable_branch_is_jkrs_and_maugis_only(void **state)
{
    (void)state;
    for (int i = 0; i < MODELS; i++) {
        const nt_contact_law law = law_of(models[i]);
        const double inside = 0.999 * nt_contact_law_grip_indentation(&law);
        nt_law_value value = {.F = 7.0};
        const nt_status status = nt_contact_law_eval(&law, inside, NT_BRANCH_UNSTABLE, &value);
        assert_int_equal(status, models[i] == NT_HERTZ || models[i] == NT_DMT ? NT_E_NO_SOLUTION : NT_OK);
        assert_true((value.F == 7.0) == (status != NT_OK));
    }
}

static void arrays_are_scalars_in_a_row(void **state)
{
    (void)state;
    enum { N = 50 };
    double in[2 * N], F[3 * N], a[3 * N];
    for (int i = 0; i < MODELS; i++) {
        const nt_contact_law law = law_of(models[i]);
        for (int j = 0; j < N; j++)
            in[2 * j] = -1e-9 + 0.1e-9 * j;
        for (int j = 0; j < 3 * N; j++)
            F[j] = a[j] = 7.0;
        const nt_strided arrays = {.in = in, .F = F, .a = a, .count = N, .in_stride = 2, .out_stride = 3};
        assert_int_equal(nt_contact_law_eval_n(&law, NT_BRANCH_STABLE, &arrays), NT_OK);
        for (int j = 0; j < N; j++) {
            nt_law_value value;
            assert_int_equal(nt_contact_law_eval(&law, in[2 * j], NT_BRANCH_STABLE, &value), NT_OK);
            assert_true(F[3 * j] == value.F && a[3 * j] == value.a && F[3 * j + 1] == 7.0 && a[3 * j + 2] == 7.0);
        }
    }
}

static void arrays_mark_what_failed(void **state)
{
    (void)state;
    const nt_contact_law law = law_of(NT_MAUGIS);
    double in[] = {1e-9, NAN, 2e-9, INFINITY};
    const nt_strided arrays = {.in = in, .k = in, .count = 4, .in_stride = 1, .out_stride = 1}; /* in place */
    assert_int_equal(nt_contact_law_eval_n(&law, NT_BRANCH_STABLE, &arrays), NT_E_NOT_FINITE);
    assert_true(in[0] > 0.0 && isnan(in[1]) && in[2] > in[0] && isnan(in[3]));
}

static void refuses_bad_arguments(void **state)
{
    (void)state;
    const nt_contact contact = nt_contact_defaults();
    nt_contact_law law = law_of(NT_JKR);
    assert_int_equal(nt_contact_law_init(&law, (nt_model)9, &contact), NT_E_ARGUMENT);
    assert_int_equal(law.model, NT_JKR);
    nt_law_value value = {.F = 7.0};
    for (int i = 0; i < MODELS; i++) {
        law = law_of(models[i]);
        assert_int_equal(nt_contact_law_eval(&law, NAN, NT_BRANCH_STABLE, &value), NT_E_NOT_FINITE);
        assert_int_equal(nt_contact_law_eval(&law, INFINITY, NT_BRANCH_STABLE, &value), NT_E_NOT_FINITE);
        assert_int_equal(nt_contact_law_eval(&law, 0.0, (nt_branch)9, &value), NT_E_ARGUMENT);
        const nt_contact bad = {-1.0, 1e9, 0.1, 1e8};
        assert_int_equal(nt_contact_law_init(&law, models[i], &bad), NT_E_RANGE);
    }
    assert_true(value.F == 7.0);
}

static void models_have_names(void **state)
{
    (void)state;
    assert_string_equal(nt_model_name(NT_HERTZ), "hertz");
    assert_string_equal(nt_model_name(NT_DMT), "dmt");
    assert_string_equal(nt_model_name(NT_JKR), "jkr");
    assert_string_equal(nt_model_name(NT_MAUGIS), "maugis");
    assert_string_equal(nt_model_name((nt_model)9), "unknown");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(law_is_the_model),
        cmocka_unit_test(pull_off_and_grips),
        cmocka_unit_test(unstable_branch_is_jkrs_and_maugis_only),
        cmocka_unit_test(arrays_are_scalars_in_a_row),
        cmocka_unit_test(arrays_mark_what_failed),
        cmocka_unit_test(refuses_bad_arguments),
        cmocka_unit_test(models_have_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
