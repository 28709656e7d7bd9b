/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "force_laws.h"
#include "larger.h"
#include "internal/forces.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

static const nt_lennard_jones silicon = {30e-9, 0.1, 0.2e-9, 0.1e-9};
FORCE_LAW(nt_lennard_jones, nt_lennard_jones_eval)
static const force_law law = {nt_lennard_jones_eval_at, nt_lennard_jones_eval_over, &silicon, 0.1e-9};

/* The 9-3 wall's traction on a ring of the paraboloid z = h + r^2/(2R), + repulsive. */
static double ring(double r, const void *context)
{
    const double z = *(const double *)context + r * r / (2.0 * silicon.radius);
    const double q = silicon.equilibrium_distance / z;
    return 2.0 * NT_PI * r * 8.0 * silicon.work_of_adhesion / (3.0 * silicon.equilibrium_distance) *
           (pow(q, 9.0) - pow(q, 3.0));
}

static void is_the_wall_over_the_paraboloid(void **state)
{
    (void)state;
    for (double h = 0.11e-9; h < 1e-6; h *= 1.4) {
        const double F = integral_to_infinity(ring, &h, sqrt(2.0 * silicon.radius * h));
        const double q = silicon.equilibrium_distance / h, term = 4.0 * NT_PI * 30e-9 * 0.1 * q * q;
        assert_within(nt_lennard_jones_eval(&silicon, h).F, F, 1e-10 * larger(term, fabs(F))); /* Simpson */
    }
}

/* Bradley 1932: the least force is -2 pi w R, where the walls rest; the force vanishes at 4^(-1/6) z0. */
static void pulls_off_as_bradley_says(void **state)
{
    (void)state;
    const double z0 = silicon.equilibrium_distance, pull_off = 2.0 * NT_PI * silicon.work_of_adhesion * silicon.radius;
    const nt_law_value at = nt_lennard_jones_eval(&silicon, z0);
    assert_within(at.F, -pull_off, 1e-14 * pull_off);
    assert_within(at.k, 0.0, 1e-14 * pull_off / z0);
    for (double h = 0.11e-9; h < 1e-8; h *= 1.01)
        assert_true(nt_lennard_jones_eval(&silicon, h).F >= -pull_off * (1.0 + 1e-15));
    assert_within(nt_lennard_jones_eval(&silicon, z0 * pow(4.0, -1.0 / 6.0)).F, 0.0, 1e-13 * pull_off);
}

/* k = 2 pi R sigma: the walls pull hardest at 3^(1/6) z0, with 16 w/(9 sqrt(3) z0) (erratum E9). */
static void steepest_where_the_walls_pull_hardest(void **state)
{
    (void)state;
    const double z0 = silicon.equilibrium_distance, stress = 16.0 * silicon.work_of_adhesion / (9.0 * sqrt(3.0) * z0);
    const double k = nt_lennard_jones_eval(&silicon, z0 * pow(3.0, 1.0 / 6.0)).k;
    assert_within(k, -2.0 * NT_PI * silicon.radius * stress, 1e-13 * -k);
}

/* The 1/h^2 tail is van der Waals with H = 16 pi w z0^2; what is missing falls as (z0/h)^6/4. */
static void tail_is_van_der_waals(void **state)
{
    (void)state;
    const double z0 = silicon.equilibrium_distance;
    const nt_vdw vdw = {silicon.radius, 16.0 * NT_PI * silicon.work_of_adhesion * z0 * z0, 0.0, 1e-12};
    for (double h = 1e-9; h < 1e-3; h *= 3.0) {
        const nt_law_value tail = nt_vdw_derjaguin_eval(&vdw, h), value = nt_lennard_jones_eval(&silicon, h);
        assert_within(value.F, tail.F, (pow(z0 / h, 6.0) / 4.0 + 1e-14) * -tail.F);
        assert_within(value.U, tail.U, (pow(z0 / h, 6.0) / 28.0 + 1e-14) * -tail.U);
    }
}

static void slopes(void **state)
{
    (void)state;
    assert_slopes(&law, (double[]){0.11e-9, 1e-5}, (nt_law_value){0});
}

static void rules(void **state)
{
    (void)state;
    assert_keeps_the_rules(&law);
    nt_problem problem;
    assert_int_equal(nt_lennard_jones_check(&silicon, NULL), NT_OK);
    assert_int_equal(nt_lennard_jones_check(&(nt_lennard_jones){30e-9, -0.1, 0.2e-9, 1e-10}, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "work_of_adhesion");
    assert_int_equal(nt_lennard_jones_check(&(nt_lennard_jones){30e-9, 0.1, NAN, 1e-10}, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "equilibrium_distance");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_the_wall_over_the_paraboloid),
        cmocka_unit_test(pulls_off_as_bradley_says),
        cmocka_unit_test(steepest_where_the_walls_pull_hardest),
        cmocka_unit_test(tail_is_van_der_waals),
        cmocka_unit_test(slopes),
        cmocka_unit_test(rules),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
