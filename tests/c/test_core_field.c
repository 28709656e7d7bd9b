/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "nanotouch/field.h"

typedef struct pair {
    int other;
    double a, b;
} pair;

static const nt_field fields[] = {
    {"pair.a", "m", -1.0, 2.0, offsetof(pair, a), ""},
    {"pair.b", "N", 0.0, 5.0, offsetof(pair, b), ""},
};

static void accepts_the_ends_of_the_range(void **state)
{
    (void)state;
    assert_int_equal(nt_field_check(fields, 2, &(pair){0, -1.0, 0.0}, NULL), NT_OK);
    assert_int_equal(nt_field_check(fields, 2, &(pair){0, 2.0, 5.0}, NULL), NT_OK);
}

static void names_the_first_offender(void **state)
{
    (void)state;
    nt_problem problem = {0};
    assert_int_equal(nt_field_check(fields, 2, &(pair){0, 0.0, 5.5}, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "pair.b");
    assert_string_equal(problem.unit, "N");
    assert_true(problem.value == 5.5 && problem.minimum == 0.0 && problem.maximum == 5.0);
    assert_int_equal(nt_field_check(fields, 2, &(pair){0, (double)NAN, 9.0}, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "pair.a");
    assert_true(isnan(problem.value));
    assert_int_equal(nt_field_check(fields, 2, &(pair){0, 0.0, -(double)INFINITY}, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "pair.b");
    assert_int_equal(nt_field_check(fields, 2, &(pair){0, 0.0, -1.0}, NULL), NT_E_RANGE);
    assert_int_equal(nt_field_check(NULL, 2, &(pair){0}, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_field_check(fields, 2, NULL, NULL), NT_E_ARGUMENT);
}

static void reads_and_writes_by_table(void **state)
{
    (void)state;
    pair object = {7, 1.0, 2.0};
    nt_field_set(&fields[1], &object, 3.5);
    assert_true(object.other == 7 && object.a == 1.0 && object.b == 3.5);
    assert_true(nt_field_get(&fields[0], &object) == 1.0 && nt_field_get(&fields[1], &object) == 3.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(accepts_the_ends_of_the_range),
        cmocka_unit_test(names_the_first_offender),
        cmocka_unit_test(reads_and_writes_by_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
