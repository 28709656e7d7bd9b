/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "force_laws.h"
#include "internal/forces.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

/* Mica in salt water: hydration before a hydrophobic tail. */
static const nt_hydration mica = {30e-9, 0.020, 0.9e-9, -0.004, 3e-9, 0.0};
FORCE_LAW(nt_hydration, nt_hydration_eval)
static const force_law law = {nt_hydration_eval_at, nt_hydration_eval_over, &mica, 0.0};

static double plates(double h) /* energy per area */
{
    return 0.020 * exp(-h / 0.9e-9) - 0.004 * exp(-h / 3e-9);
}

static double plates_beyond(double depth, const void *gap)
{
    return plates(*(const double *)gap + depth);
}

/* The disjoining pressure of plates on the rings of the paraboloid, by numbers: -W'(h + r^2/(2R)). */
static double ring(double r, const void *gap)
{
    const double z = *(const double *)gap + r * r / (2.0 * mica.radius);
    return 2.0 * NT_PI * r * (0.020 / 0.9e-9 * exp(-z / 0.9e-9) - 0.004 / 3e-9 * exp(-z / 3e-9));
}

static void is_the_pressure_over_the_paraboloid(void **state)
{
    (void)state;
    const double whole = 2.0 * NT_PI * mica.radius * 0.020;
    for (double h = 1e-11; h < 20e-9; h *= 2.0) {
        const nt_law_value value = nt_hydration_eval(&mica, h);
        assert_within(value.F, integral_to_infinity(ring, &h, 1e-8), 1e-10 * whole); /* Simpson */
        assert_within(value.U, 2.0 * NT_PI * mica.radius * integral_to_infinity(plates_beyond, &h, 1e-9),
                      1e-10 * whole * 1e-9);
    }
}

/* Israelachvili: hydrophobic plates, W = -2 gamma, so that a sphere in contact is held with 4 pi gamma R, as by DMT. */
static void hydrophobic_contact_is_the_dmt_pull_off(void **state)
{
    (void)state;
    const nt_hydration hydrophobic = {30e-9, -0.1, 1e-9, 0.0, 1e-9, 0.0};
    assert_within(nt_hydration_eval(&hydrophobic, 0.0).F, -4.0 * NT_PI * 0.05 * 30e-9, 1e-14 * 2e-8);
    assert_within(nt_hydration_eval(&hydrophobic, 1e-9).F, -4.0 * NT_PI * 0.05 * 30e-9 / exp(1.0), 1e-14 * 2e-8);
}

static void slopes(void **state)
{
    (void)state;
    const nt_law_value at_contact = {.U = 3e-18, .F = 4e-9, .k = 4.0};
    assert_slopes(&law, (double[]){1e-11, 40e-9}, at_contact);
}

static void rules(void **state)
{
    (void)state;
    assert_keeps_the_rules(&law);
    nt_problem problem;
    assert_int_equal(nt_hydration_check(&mica, NULL), NT_OK);
    assert_int_equal(nt_hydration_check(&(nt_hydration){30e-9, 0.02, 1e-9, 0.0, 0.0, 0.0}, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "second_decay_length");
    assert_int_equal(nt_hydration_check(&(nt_hydration){30e-9, INFINITY, 1e-9, 0.0, 1e-9, 0.0}, &problem),
                     NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "amplitude");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_the_pressure_over_the_paraboloid),
        cmocka_unit_test(hydrophobic_contact_is_the_dmt_pull_off),
        cmocka_unit_test(slopes),
        cmocka_unit_test(rules),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
