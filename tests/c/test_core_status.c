/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "nanotouch/status.h"

static void every_status_has_its_own_message(void **state)
{
    (void)state;
    for (int i = NT_OK; i <= NT_E_UNSUPPORTED; i++)
        for (int j = NT_OK; j < i; j++)
            assert_string_not_equal(nt_status_message((nt_status)i), nt_status_message((nt_status)j));
    assert_string_equal(nt_status_message(NT_OK), "no error");
}

static void unknown_status_has_a_message(void **state)
{
    (void)state;
    assert_string_equal(nt_status_message((nt_status)(NT_E_UNSUPPORTED + 1)), "unknown status");
    assert_string_equal(nt_status_message((nt_status)(-1)), "unknown status");
}

static void problem_reads_as_a_sentence(void **state)
{
    (void)state;
    const nt_problem problem = {"tip.radius", "m", 20.0, 1e-10, 1e-3};
    char text[100];
    assert_ptr_equal(nt_problem_print(&problem, text, sizeof text), text);
    assert_string_equal(text, "tip.radius = 20 m: valid is 1e-10 .. 0.001 m");
}

static void problem_without_unit(void **state)
{
    (void)state;
    const nt_problem problem = {"quality", "", -1.0, 0.05, 1e6}, bare = {.value = 1.0, .maximum = 2.0};
    char text[100];
    assert_string_equal(nt_problem_print(&problem, text, sizeof text), "quality = -1: valid is 0.05 .. 1e+06");
    assert_string_equal(nt_problem_print(&bare, text, sizeof text), "? = 1: valid is 0 .. 2");
    const nt_problem choice = {"medium.kind", "air|vacuum|liquid", 3.0, 0.0, 2.0};
    assert_string_equal(nt_problem_print(&choice, text, sizeof text),
                        "medium.kind = 3: valid is 0 .. 2 (air|vacuum|liquid)");
}

/* A reason is a sentence with the error that there would be, and no range. */
static void problem_that_is_a_reason(void **state)
{
    (void)state;
    char text[100];
    const nt_problem known = {"sample: too soft", NT_UNIT_ERROR, 0.3, 0.0, 0.01};
    const nt_problem unknown = {"sample: too soft", NT_UNIT_ERROR, HUGE_VAL, 0.0, 0.01};
    assert_string_equal(nt_problem_print(&known, text, sizeof text),
                        "sample: too soft: error 0.3 where 0.01 is demanded");
    assert_string_equal(nt_problem_print(&unknown, text, sizeof text),
                        "sample: too soft: no bound of the error is known");
}

/* What is said to be valid is, though it is said with six digits. */
static void limits_are_printed_inwards(void **state)
{
    (void)state;
    char text[100];
    double low = 1.0, high = 1.0;
    for (int i = 0; i < 2000; i++) {
        const nt_problem problem = {"x", "", 0.0, 1e-12 * (1.0 + 1e-10) * (1.0 + 0.0047 * i), 1e3 / (7.0 + 0.0031 * i)};
        nt_problem_print(&problem, text, sizeof text);
        assert_int_equal(sscanf(text, "x = 0: valid is %lg .. %lg", &low, &high), 2);
        assert_true(low >= problem.minimum && low < problem.minimum * (1.0 + 2e-5));
        assert_true(high <= problem.maximum && high > problem.maximum * (1.0 - 2e-5));
    }
    const nt_problem open = {"x", "", -1.0, 0.0, HUGE_VAL};
    assert_string_equal(nt_problem_print(&open, text, sizeof text), "x = -1: valid is 0 .. inf");
}

static void short_text_is_cut_and_ended(void **state)
{
    (void)state;
    const nt_problem problem = {"tip.radius", "m", 20.0, 1e-10, 1e-3};
    char text[12];
    memset(text, 'x', sizeof text);
    nt_problem_print(&problem, text, 6);
    assert_string_equal(text, "tip.r");
    assert_int_equal(text[6], 'x'); /* nothing beyond the size */
    nt_problem_print(&problem, text, 0);
    assert_string_equal(text, "tip.r");
    assert_null(nt_problem_print(&problem, NULL, 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_status_has_its_own_message), cmocka_unit_test(unknown_status_has_a_message),
        cmocka_unit_test(problem_reads_as_a_sentence),      cmocka_unit_test(problem_without_unit),
        cmocka_unit_test(problem_that_is_a_reason),         cmocka_unit_test(limits_are_printed_inwards),
        cmocka_unit_test(short_text_is_cut_and_ended),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
