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

static const nt_electrostatic_tip tip = {20e-9, 0.3, 10e-6, 1.5, 0.2e-9};
static const nt_electrostatic_lever lever = {125e-6, 35e-6, 0.2, 12e-6, 1.5, 0.2e-9};
FORCE_LAW(nt_electrostatic_tip, nt_electrostatic_tip_eval)
FORCE_LAW(nt_electrostatic_lever, nt_electrostatic_lever_eval)
static const force_law laws[] = {
    {nt_electrostatic_tip_eval_at, nt_electrostatic_tip_eval_over, &tip, 0.2e-9},
    {nt_electrostatic_lever_eval_at, nt_electrostatic_lever_eval_over, &lever, 0.2e-9},
};

/* Between a cone of half-angle theta and the plane that its apex nearly touches the potential is
 * U ln(tan(t/2))/ln(tan(theta/2)) at polar angle t, for every distance r from the apex: Laplace's equation and both
 * boundaries hold exactly. Its field on the cone at r = 1, by differences. */
static double field_of_cone(double theta)
{
    const double step = 1e-5, scale = 1.0 / log(tan(0.5 * theta));
    return (log(tan(0.5 * (theta + step))) - log(tan(0.5 * (theta - step)))) / (2.0 * step) * scale;
}

/* So the force on the part of it between two distances is exact; in the law: what a longer cone pulls more, where apex
 * and gap are too small to matter. Pressure eps0 E^2/2, of which sin(theta) is vertical, on 2 pi r sin(theta) dr. */
static void long_cone_is_exact(void **state)
{
    (void)state;
    for (double theta = 0.1; theta < 1.4; theta += 0.15) {
        const nt_electrostatic_tip small = {1e-10, theta, 1e-6, 1.0, 1e-12}, large = {1e-10, theta, 1e-3, 1.0, 1e-12};
        const double E = field_of_cone(theta), sine = sin(theta);
        const double part = -NT_PI * NT_VACUUM_PERMITTIVITY * E * E * sine * sine * log(1e3);
        const double F = nt_electrostatic_tip_eval(&large, 1e-12).F - nt_electrostatic_tip_eval(&small, 1e-12).F;
        assert_within(F, part, 0.001 * -part); /* apex over length, 1e-10/(1e-6 theta) */
    }
}

/* The element integral of Hudlet's cone at a finite apex, by Simpson in ln x: 2 pi rho drho eps0 E^2/2,
 * E = U/(x tan(theta) ln(cot(theta/2))), rho = R cos(theta) + (x - x1) tan(theta). */
static double cone_by_numbers(double h)
{
    enum { N = 2000 };
    const double theta = tip.half_angle, x1 = h + tip.radius * (1.0 - sin(theta)), step = log1p(tip.height / x1) / N;
    double sum = 0.0;
    for (int i = 0; i <= N; i++) {
        const double x = x1 * exp(i * step), rho = tip.radius * cos(theta) + (x - x1) * tan(theta);
        const double E = tip.potential / (x * tan(theta) * log(1.0 / tan(0.5 * theta)));
        const double weight = (i == 0 || i == N ? 1.0 : i % 2 ? 4.0 : 2.0) * step / 3.0 * x;
        sum += weight * NT_PI * NT_VACUUM_PERMITTIVITY * rho * tan(theta) * E * E;
    }
    return -sum;
}

static void is_hudlets_tip(void **state)
{
    (void)state;
    const double R = tip.radius, theta = tip.half_angle, U = tip.potential, c = R * (1.0 - sin(theta));
    const double unit = NT_PI * NT_VACUUM_PERMITTIVITY * U * U, share = 1.0 / pow(log(tan(0.5 * theta)), 2.0);
    for (double h = 0.2e-9; h < 100e-6; h *= 1.5) {
        const double F = nt_electrostatic_tip_eval(&tip, h).F, sphere = -unit * R * c / (h * (h + c));
        assert_within(F, sphere + cone_by_numbers(h), 1e-10 * -F); /* Simpson */
        if (h > 300e-9)
            continue;
        const double flank = log(tip.height / (h + c)) - 1.0 + R * pow(cos(theta), 2.0) / sin(theta) / (h + c);
        assert_within(F, sphere - unit * share * flank, 0.07 * unit * share); /* the paper drops (h + R)/height */
    }
}

/* Without cone and with no angle it is the sphere of nt_electrostatic_eval, whose apex loses sin(theta) = 0.01 of
 * itself. */
static void without_cone_is_the_sphere(void **state)
{
    (void)state;
    const nt_electrostatic_tip blunt = {20e-9, 0.01, 0.0, 1.5, 0.2e-9};
    const nt_electrostatic sphere = {20e-9, 1.5, 0.2e-9};
    for (double h = 0.2e-9; h < 1e-6; h *= 2.0) {
        const double F = nt_electrostatic_eval(&sphere, h).F;
        assert_within(nt_electrostatic_tip_eval(&blunt, h).F, F, 0.0101 * -F);
    }
}

/* Pressure eps0 E^2/2 with the wedge's field E = U/(beta r) on the plate from r1 = D/sin(beta), vertical part, by
 * Simpson in ln r; that E solves Laplace's equation, U phi/beta, and both boundaries. */
static void lever_is_a_plate_of_the_wedge(void **state)
{
    (void)state;
    enum { N = 2000 };
    for (double h = 0.2e-9; h < 1e-3; h *= 3.0) {
        const double beta = lever.tilt, r1 = (lever.tip_height + h) / sin(beta), step = log1p(lever.length / r1) / N;
        double F = 0.0;
        for (int i = 0; i <= N; i++) {
            const double r = r1 * exp(i * step), E = lever.potential / (beta * r);
            const double weight = (i == 0 || i == N ? 1.0 : i % 2 ? 4.0 : 2.0) * step / 3.0 * r;
            F -= weight * 0.5 * NT_VACUUM_PERMITTIVITY * E * E * lever.width * cos(beta);
        }
        assert_within(nt_electrostatic_lever_eval(&lever, h).F, F, 1e-10 * -F);
    }
}

static void flat_lever_is_a_plate(void **state)
{
    (void)state;
    const nt_electrostatic_lever flat = {125e-6, 35e-6, 0.0, 12e-6, 1.5, 0.2e-9};
    const nt_electrostatic_lever nearly = {125e-6, 35e-6, 1e-9, 12e-6, 1.5, 0.2e-9};
    const nt_electrostatic_plate plate = {125e-6 * 35e-6, 1.5, 1e-10};
    const nt_law_value one = nt_electrostatic_lever_eval(&flat, 1e-6), two = nt_electrostatic_plate_eval(&plate, 13e-6);
    assert_within(one.U, two.U, 1e-14 * -two.U);
    assert_within(one.F, two.F, 1e-14 * -two.F);
    assert_within(one.k, two.k, 1e-14 * -two.k);
    assert_within(nt_electrostatic_lever_eval(&nearly, 1e-6).U, two.U, 1e-7 * -two.U);
}

static void slopes(void **state)
{
    (void)state;
    assert_slopes(&laws[0], (double[]){0.21e-9, 1e-2}, (nt_law_value){0});
    const nt_law_value at_contact = nt_electrostatic_lever_eval(&lever, 0.0); /* 12 um away: does not change with h */
    assert_slopes(&laws[1], (double[]){1e-7, 1e-2}, (nt_law_value){-at_contact.U, -at_contact.F, -at_contact.k, 0.0});
}

static void rules(void **state)
{
    (void)state;
    nt_problem problem;
    assert_keeps_the_rules(&laws[0]);
    assert_keeps_the_rules(&laws[1]);
    assert_int_equal(nt_electrostatic_tip_check(&tip, NULL), NT_OK);
    assert_int_equal(nt_electrostatic_lever_check(&lever, NULL), NT_OK);
    assert_int_equal(nt_electrostatic_tip_check(&(nt_electrostatic_tip){20e-9, 0.0, 1e-5, 1.0, 1e-10}, &problem),
                     NT_E_RANGE);
    assert_string_equal(problem.field, "half_angle");
    const nt_electrostatic_lever no = {1e-4, NAN, 0.2, 1e-5, 1.0, 1e-10};
    assert_int_equal(nt_electrostatic_lever_check(&no, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "width");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(long_cone_is_exact),
        cmocka_unit_test(is_hudlets_tip),
        cmocka_unit_test(without_cone_is_the_sphere),
        cmocka_unit_test(lever_is_a_plate_of_the_wedge),
        cmocka_unit_test(flat_lever_is_a_plate),
        cmocka_unit_test(slopes),
        cmocka_unit_test(rules),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
