/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/problem.h"
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
    const nt_problem problem = nt_problem_of("tip.radius", "m", 20.0, 1e-10, 1e-3);
    char text[100];
    assert_ptr_equal(nt_problem_print(&problem, text, sizeof text), text);
    assert_string_equal(text, "tip.radius = 20 m: valid is 1e-10 .. 0.001 m");
}

static void problem_without_unit(void **state)
{
    (void)state;
    const nt_problem problem = nt_problem_of("quality", "", -1.0, 0.05, 1e6), bare = {.value = 1.0, .maximum = 2.0};
    char text[100];
    assert_string_equal(nt_problem_print(&problem, text, sizeof text), "quality = -1: valid is 0.05 .. 1e+06");
    assert_string_equal(nt_problem_print(&bare, text, sizeof text), "? = 1: valid is 0 .. 2");
    const nt_problem choice = nt_problem_of("medium.kind", "air|vacuum|liquid", 3.0, 0.0, 2.0);
    assert_string_equal(nt_problem_print(&choice, text, sizeof text),
                        "medium.kind = 3: valid is 0 .. 2 (air|vacuum|liquid)");
}

/* The words of a code stand beside the value, with their cause; where there is no value they are all. */
static void problem_with_words(void **state)
{
    (void)state;
    char text[NT_PROBLEM_TEXT];
    nt_problem jump = nt_problem_of("range.minimum_gap", "m", 1e-9, 2e-9, 0.01);
    jump.code = NT_PROBLEM_JUMPS;
    jump.cause = "van der Waals";
    jump.remedy = (nt_remedy){"range.minimum_gap", "m", 2e-9};
    assert_string_equal(nt_problem_print(&jump, text, sizeof text),
                        "range.minimum_gap (nearer the sample jumps to the tip, pulled by van der Waals, and without "
                        "adhesion what follows is not planned) = 1e-09 m: valid is 2e-09 .. 0.01 m; range.minimum_gap "
                        "= 2e-09 m works");
    const nt_problem far = {.code = NT_PROBLEM_FORCE_TABLE_FAR};
    assert_string_equal(nt_problem_print(&far, text, sizeof text), "a force that is felt beyond 1 mm");
    const nt_problem none = nt_problem_of("demand.relative_accuracy", "", 0.01, HUGE_VAL, 0.5);
    assert_string_equal(nt_problem_print(&none, text, sizeof text),
                        "demand.relative_accuracy = 0.01: none is known to be valid");
}

/* Every row has room in NT_PROBLEM_TEXT, with the longest names there are. */
static void every_problem_fits(void **state)
{
    (void)state;
    char text[NT_PROBLEM_TEXT + 64];
    for (int code = 0; code < NT_PROBLEM_CODES; ++code) {
        const nt_problem problem = {"adhesion.equilibrium_distance",
                                    "J/m^2",
                                    -1.23456e-100,
                                    -1.23456e-100,
                                    1.23456e-100,
                                    (nt_problem_code)code,
                                    "the electrostatic force",
                                    {"adhesion.equilibrium_distance", "J/m^2", -1.23456e-100}};
        assert_true(strlen(nt_problem_print(&problem, text, sizeof text)) < NT_PROBLEM_TEXT);
        assert_null(strstr(text, "{}"));
    }
}

/* What is said to be valid is, though it is said with six digits. */
static void limits_are_printed_inwards(void **state)
{
    (void)state;
    char text[100];
    double low = 1.0, high = 1.0;
    for (int i = 0; i < 2000; i++) {
        const nt_problem problem =
            nt_problem_of("x", "", 0.0, 1e-12 * (1.0 + 1e-10) * (1.0 + 0.0047 * i), 1e3 / (7.0 + 0.0031 * i));
        nt_problem_print(&problem, text, sizeof text);
        assert_int_equal(sscanf(text, "x = 0: valid is %lg .. %lg", &low, &high), 2);
        assert_true(low >= problem.minimum && low < problem.minimum * (1.0 + 2e-5));
        assert_true(high <= problem.maximum && high > problem.maximum * (1.0 - 2e-5));
    }
    const nt_problem open = nt_problem_of("x", "", -1.0, 0.0, HUGE_VAL);
    assert_string_equal(nt_problem_print(&open, text, sizeof text), "x = -1: valid is 0 .. inf");
}

static void short_text_is_cut_and_ended(void **state)
{
    (void)state;
    const nt_problem problem = nt_problem_of("tip.radius", "m", 20.0, 1e-10, 1e-3);
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
        cmocka_unit_test(every_status_has_its_own_message),
        cmocka_unit_test(unknown_status_has_a_message),
        cmocka_unit_test(problem_reads_as_a_sentence),
        cmocka_unit_test(problem_without_unit),
        cmocka_unit_test(problem_with_words),
        cmocka_unit_test(every_problem_fits),
        cmocka_unit_test(limits_are_printed_inwards),
        cmocka_unit_test(short_text_is_cut_and_ended),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
