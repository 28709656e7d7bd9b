/* SPDX-License-Identifier: BSD-3-Clause
 * JKR's contact with a rate-dependent edge: its slow limit is JKR, its fast one E_0/E_inf times that, and the work done
 * on a closed path is what the edge loses. */
#include <stdlib.h>

#include "assertions.h"
#include "larger.h"
#include "nanotouch/rheology.h"

enum { POINTS = 1500 };
#define PI 3.14159265358979323846
#define WORK 1e-3 /* [J/m^2] */
#define PUSH 2e-6

static double pull = 6e-6; /* [m] */
static double times[POINTS], positions[POINTS], forces[POINTS], indentations[POINTS];

static nt_viscoelastic sample(double relaxation_time)
{
    nt_viscoelastic made = nt_viscoelastic_defaults();
    made.spring_constant = 0.1;
    made.rheology.kind = NT_RHEOLOGY_STANDARD_LINEAR_SOLID;
    made.rheology.equilibrium_modulus = 1e4;
    made.rheology.arm_moduli[0] = 9e4;
    made.rheology.relaxation_times[0] = relaxation_time;
    return made;
}

/* From 100 nm above the surface down and back until it is free, at one speed. */
static nt_status touch(const nt_viscoelastic *contact, double speed, double crack_length,
                       nt_viscoelastic_result *result)
{
    const nt_viscoelastic_path path = {times, positions, 0.0, POINTS, NULL};
    const nt_viscoelastic_adhesion adhesion = {WORK, crack_length};
    nt_problem problem;
    for (int i = 0; i < POINTS; i++) {
        const double way = (1e-7 + PUSH + pull) * i / (POINTS - 1);
        positions[i] = way < 1e-7 + PUSH ? way - 1e-7 : 1e-7 + 2.0 * PUSH - way;
        times[i] = way / speed;
    }
    *result = (nt_viscoelastic_result){.forces = forces, .indentations = indentations};
    return nt_viscoelastic_run_adhesive(contact, &adhesion, &path, result, &problem);
}

/* Over JKR's, 3/2 pi w R. */
static double pull_off(void)
{
    double least = 0.0;
    for (int i = 0; i < POINTS; i++)
        least = smaller(least, forces[i]);
    return -least / (1.5 * PI * WORK * 5e-6);
}

static void a_slow_contact_is_jkr(void **unused)
{
    (void)unused;
    const nt_viscoelastic contact = sample(0.01);
    nt_viscoelastic_result result;
    assert_int_equal(touch(&contact, 1e-12, 1e-9, &result), NT_OK);
    assert_within(pull_off(), 1.0, 5e-3);
    for (int i = 0; i < POINTS; i++) { /* JKR at the load found: delta by a */
        const double K = 4.0 / 3.0 * 1e4 / 0.75, R = 5e-6, w = WORK, six = 3.0 * PI * w * R;
        if (i > 450 || forces[i] <= 0.0)
            continue;
        const double a = cbrt(R / K * (forces[i] + six + sqrt(2.0 * six * forces[i] + six * six)));
        const double delta = a * a / R - sqrt(8.0 * PI * w * a / (3.0 * K));
        assert_within(indentations[i], delta, 5e-3 * 1e-6);
    }
}

static void a_faster_edge_holds_more_and_never_more_than_at_once(void **unused)
{
    (void)unused;
    const nt_viscoelastic contact = sample(1e-4);
    double before = 1.0;
    for (double speed = 1e-8; speed < 2e-5; speed *= 10.0) {
        nt_viscoelastic_result result;
        assert_int_equal(touch(&contact, speed, 1e-10, &result), NT_OK);
        assert_true(pull_off() > before && pull_off() < 10.0);
        before = pull_off();
    }
    assert_true(before > 5.0);
}

/* Levers from rigid to one that holds most of the energy at pull-off. */
static void the_work_is_what_the_edge_loses(void **unused)
{
    (void)unused;
    const double levers[] = {0.0, 0.1, 1e-3};
    for (int i = 0; i < 6; i++) {
        nt_viscoelastic contact = sample(0.01);
        nt_viscoelastic_result result;
        double work = 0.0;
        contact.spring_constant = levers[i % 3];
        pull = i % 3 == 2 ? 8e-5 : 6e-6;
        assert_int_equal(touch(&contact, i < 3 ? 1e-9 : 1e-8, 1e-9, &result), NT_OK);
        for (int j = 1; j < POINTS; j++)
            work += 0.5 * (forces[j] + forces[j - 1]) * (positions[j] - positions[j - 1]);
        assert_true(forces[POINTS - 1] == 0.0);
        assert_within(result.dissipated, work, 0.01 * work); /* the trapezoid of snap-in and pull-off */
    }
    pull = 6e-6;
}

static void what_lies_outside_is_refused(void **unused)
{
    (void)unused;
    nt_viscoelastic contact = sample(0.01);
    nt_viscoelastic_result result;
    assert_int_equal(touch(&contact, 1e-5, 1e-9, &result), NT_E_RANGE); /* the bulk has no time to relax */
    assert_true(result.bulk_error > 0.05);
    assert_int_equal(touch(&contact, 1e-8, 1e-6, &result), NT_E_RANGE); /* the edge as wide as the contact */
    contact.rheology.equilibrium_modulus = 0.0;
    assert_int_equal(touch(&contact, 1e-8, 1e-9, &result), NT_E_RANGE);
    contact.rheology.kind = NT_RHEOLOGY_POWER_LAW;
    assert_int_equal(touch(&contact, 1e-8, 1e-9, &result), NT_E_RANGE);
    contact = sample(0.01);
    contact.shape.kind = NT_SHAPE_CONE;
    assert_int_equal(touch(&contact, 1e-8, 1e-9, &result), NT_E_RANGE);
    contact = sample(0.01);
    assert_int_equal(touch(&contact, 1e-8, (double)NAN, &result), NT_E_NOT_FINITE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slow_contact_is_jkr),
        cmocka_unit_test(a_faster_edge_holds_more_and_never_more_than_at_once),
        cmocka_unit_test(the_work_is_what_the_edge_loses),
        cmocka_unit_test(what_lies_outside_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
