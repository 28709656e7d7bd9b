/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "internal/field.h"
#include "nanotouch/advanced/field.h"

typedef struct pair {
    int other;
    double a, b;
} pair;

static const nt_field fields[] = {
    NT_FIELD_NAMED("pair.a", pair, a, "m", -1.0, 2.0, ""),
    NT_FIELD_NAMED("pair.b", pair, b, "N", 0.0, 5.0, ""),
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

typedef enum fruit { APPLE, PEAR, PLUM } fruit;
typedef struct basket {
    fruit kind;
    int ripe;
    double mass;
} basket;

/* An enum keeps the number that it is given, and what is none of its numbers is refused by the check. */
static void a_choice_is_an_enum(void **state)
{
    (void)state;
    static const nt_field kinds[] = {NT_FIELD(basket, kind, "apple|pear|plum", 0.0, 2.0, ""),
                                     NT_FIELD(basket, ripe, "no|yes", 0.0, 1.0, ""),
                                     NT_FIELD(basket, mass, "kg", 0.0, 1.0, "")};
    basket object = {PLUM, 1, 0.3};
    nt_field_set(&kinds[0], &object, PEAR);
    assert_true(object.kind == PEAR && object.ripe == 1 && object.mass == 0.3);
    assert_true(nt_field_get(&kinds[0], &object) == PEAR && nt_field_get(&kinds[1], &object) == 1.0);
    assert_int_equal(nt_field_check(kinds, 3, &object, NULL), NT_OK);
    const double none[] = {-1.0, 0.5, 3.0, 1e9, -1e300, (double)INFINITY, (double)NAN};
    for (int i = 0; i < 7; i++) {
        nt_problem problem = {0};
        nt_field_set(&kinds[0], &object, none[i]);
        assert_int_equal(nt_field_check(kinds, 3, &object, &problem), NT_E_RANGE);
        assert_string_equal(problem.field, "kind");
        assert_true(object.ripe == 1);
    }
}

/* Compilers for microcontrollers give an enum the least bytes that hold its values. */
static void an_enum_may_be_small(void **state)
{
    (void)state;
    struct bytes {
        signed char least;
        short small;
    } object = {7, 7};
    const nt_field small[] = {NT_FIELD(struct bytes, least, "a|b|c", 0.0, 2.0, ""),
                              NT_FIELD(struct bytes, small, "a|b|c", 0.0, 2.0, "")};
    for (int i = 0; i < 2; i++) {
        nt_field_set(&small[i], &object, 2.0);
        assert_true(nt_field_get(&small[i], &object) == 2.0);
        assert_int_equal(nt_field_check(&small[i], 1, &object, NULL), NT_OK);
        nt_field_set(&small[i], &object, 4711.0);
        assert_int_equal(nt_field_check(&small[i], 1, &object, NULL), NT_E_RANGE);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(accepts_the_ends_of_the_range), cmocka_unit_test(names_the_first_offender),
        cmocka_unit_test(reads_and_writes_by_table),     cmocka_unit_test(a_choice_is_an_enum),
        cmocka_unit_test(an_enum_may_be_small),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
