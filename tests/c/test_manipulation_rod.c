/* SPDX-License-Identifier: BSD-3-Clause
 * A rod that is pushed, beside even friction in closed form; its account of energy on random ways of the tip. */
#include <string.h>

#include "assertions.h"
#include "internal/manipulation.h"
#include "larger.h"
#include "nanotouch/advanced/manipulation.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/material.h"

#define BESIDE 70e-9 /* the tip touches here */

/* Pushed across at an arm: it turns about c, and the push is 2 q c. 8 nm of way turn it by 0.01. */
static void it_turns_about_the_point_of_even_friction(void **state)
{
    (void)state;
    const double arms[] = {0.99, 0.6, 0.2};
    nt_rod rod = nt_rod_defaults();
    rod.elements = 400.0;
    for (int i = 0; i < 3; ++i) {
        static nt_rod_state pushed, before;
        const double at = 0.5 * rod.length * arms[i], c = nt_rod_turning_point(rod.length, at);
        assert_int_equal(nt_rod_check(&rod, NULL), NT_OK);
        assert_int_equal(nt_rod_place(&rod, (double[3]){0.0, 0.0, 0.0}, (double[3]){at, -BESIDE, 0.0}, &pushed), NT_OK);
        assert_int_equal(nt_rod_advance(&rod, &pushed, (double[3]){at, -BESIDE + 6e-9, 0.0}), NT_OK);
        before = pushed;
        assert_int_equal(nt_rod_advance(&rod, &pushed, (double[3]){at, -BESIDE + 8e-9, 0.0}), NT_OK);
        const double turn = pushed.pose[2] - before.pose[2];
        assert_within((pushed.pose[1] - before.pose[1]) / turn, c, 0.01 * c);
        assert_within(-pushed.force[1], 2.0 * nt_rod_friction(&rod) * c, 4e-3 * nt_rod_friction(&rod) * c);
    }
}

/* On the middle: all of it slides, q L, and nothing turns. */
static void a_push_on_the_middle_does_not_turn_it(void **state)
{
    (void)state;
    static nt_rod_state pushed;
    const nt_rod rod = nt_rod_defaults();
    const double whole = nt_rod_friction(&rod) * rod.length;
    assert_int_equal(nt_rod_place(&rod, (double[3]){0.0, 0.0, 0.0}, (double[3]){0.0, -BESIDE, 0.0}, &pushed), NT_OK);
    assert_int_equal(nt_rod_advance(&rod, &pushed, (double[3]){0.0, 0.0, 0.0}), NT_OK);
    assert_within(pushed.force[1], -whole, 1e-6 * whole);
    assert_within(pushed.pose[2], 0.0, 1e-6);
    assert_true(pushed.dissipated > 0.8 * whole * BESIDE);
}

/* pi E* b^2/(4 R) = sqrt(2 pi E* b w) without load. */
static void its_contact_is_that_of_a_cylinder(void **state)
{
    (void)state;
    const nt_rod rod = nt_rod_defaults();
    const double b = nt_rod_half_width(&rod), E = rod.effective_modulus;
    const double pressed = NT_PI * E * b * b / (4.0 * rod.radius),
                 pulled = sqrt(2.0 * NT_PI * E * b * rod.work_of_adhesion);
    assert_within(pressed, pulled, 1e-12 * pulled);
}

static double of(nt_random *random)
{
    return 2.0 * nt_random_uniform(random) - 1.0;
}

/* Round it, against it, off its ends: stored + dissipated = work, heat never falls. */
static void energy_is_kept_on_random_ways(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(7);
    int pushed = 0;
    for (int wire = 0; wire < 5; ++wire) {
        static nt_rod_state now;
        nt_rod rod = nt_rod_defaults();
        rod.length = 2e-7 * pow(2.0, 1.0 + nt_random_uniform(&random));
        rod.shear_strength = pow(10.0, 6.0 + nt_random_uniform(&random));
        rod.elements = 24.0;
        rod.step = 2e-9;
        assert_int_equal(nt_rod_check(&rod, NULL), NT_OK);
        const double pose[3] = {0.0, 0.0, 6.0 * nt_random_uniform(&random)}, tip[3] = {rod.length, rod.length, 0.0};
        assert_int_equal(nt_rod_place(&rod, pose, tip, &now), NT_OK);
        double heat = 0.0, turnover = 0.0;
        for (int way = 0; way < 8; ++way) {
            const double work = now.work;
            const double to[3] = {now.pose[0] + 0.5 * rod.length * of(&random),
                                  now.pose[1] + 0.5 * rod.length * of(&random), 0.0};
            assert_int_equal(nt_rod_advance(&rod, &now, to), NT_OK);
            turnover += fabs(now.work - work);
            assert_true(now.dissipated >= heat && now.stored >= 0.0);
            assert_within(now.stored + now.dissipated, now.work, 1e-12 * turnover);
            heat = now.dissipated;
        }
        pushed += heat > 0.0;
    }
    assert_true(pushed >= 3);
}

static void what_is_no_rod_is_refused(void **state)
{
    (void)state;
    static nt_rod_state now, kept;
    nt_problem problem;
    nt_rod rod = nt_rod_defaults();
    rod.length = 3.0 * rod.radius;
    assert_int_equal(nt_rod_check(&rod, &problem), NT_E_RANGE);
    assert_within(problem.minimum, 4.0 * rod.radius, 0.0);
    rod = nt_rod_defaults();
    rod.tip_stiffness = 0.1;
    assert_int_equal(nt_rod_check(&rod, &problem), NT_E_RANGE);
    rod = nt_rod_defaults();
    rod.elements = 10.5;
    assert_int_equal(nt_rod_check(&rod, &problem), NT_E_RANGE);
    rod.elements = NAN;
    assert_int_equal(nt_rod_check(&rod, &problem), NT_E_NOT_FINITE);
    rod = nt_rod_defaults();
    const double pose[3] = {0.0, 0.0, 0.0};
    assert_int_equal(nt_rod_place(&rod, pose, (double[3]){0.0, 0.0, 0.0}, &now), NT_E_RANGE);
    assert_int_equal(nt_rod_place(&rod, pose, (double[3]){0.0, NAN, 0.0}, &now), NT_E_NOT_FINITE);
    assert_int_equal(nt_rod_place(&rod, pose, (double[3]){0.0, -BESIDE, 0.0}, &now), NT_OK);
    kept = now;
    assert_int_equal(nt_rod_advance(&rod, &now, (double[3]){NAN, 0.0, 0.0}), NT_E_NOT_FINITE);
    assert_int_equal(nt_rod_advance(&rod, &now, (double[3]){1.0, 0.0, 0.0}), NT_E_RANGE);
    assert_memory_equal(&now, &kept, sizeof now);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_turns_about_the_point_of_even_friction),
        cmocka_unit_test(a_push_on_the_middle_does_not_turn_it),
        cmocka_unit_test(its_contact_is_that_of_a_cylinder),
        cmocka_unit_test(energy_is_kept_on_random_ways),
        cmocka_unit_test(what_is_no_rod_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
