/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/contact.h"

static void defaults_are_valid_silicon(void **state)
{
    (void)state;
    const nt_contact contact = nt_contact_defaults();
    assert_int_equal(nt_contact_check(&contact, NULL), NT_OK);
    assert_true(contact.radius == 20e-9 && contact.work_of_adhesion == 0.144);
    const double range = contact.work_of_adhesion / contact.cohesive_stress; /* of the 9-3 wall of z0 = 0.2 nm */
    assert_true(range > 0.19e-9 && range < 0.2e-9);
}

static void check_names_the_field(void **state)
{
    (void)state;
    nt_problem problem;
    nt_contact contact = nt_contact_defaults();
    contact.radius = 20.0; /* metres by mistake */
    assert_int_equal(nt_contact_check(&contact, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "radius");
    assert_string_equal(problem.unit, "m");
    assert_true(problem.value == 20.0 && problem.maximum < 20.0);
    contact = nt_contact_defaults();
    contact.work_of_adhesion = NAN;
    assert_int_equal(nt_contact_check(&contact, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "work_of_adhesion");
    contact = nt_contact_defaults();
    contact.effective_modulus = 0.0;
    assert_int_equal(nt_contact_check(&contact, NULL), NT_E_RANGE);
    assert_int_equal(nt_contact_check(NULL, NULL), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_valid_silicon),
        cmocka_unit_test(check_names_the_field),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
