/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "internal/geometry.h"
#include "nanotouch/advanced/geometry.h"

static const nt_shape sphere = {NT_SHAPE_PARABOLOID, 0, 30e-9, 0.0, 0.0};
static const nt_lever lever = {8.0, 0.2};

static nt_stage_displacement solve(nt_shape shape, double modulus, nt_lever on, double displacement)
{
    nt_stage_displacement solved;
    assert_int_equal(nt_stage_displacement_solve(&shape, modulus, &on, displacement, &solved), NT_OK);
    return solved;
}

/* Eq. 5 with P = k_c zeta, for every shape, from a lever that does all to one that does nothing. */
static void balances_for_every_shape(void **state)
{
    (void)state;
    const nt_shape shapes[] = {
        sphere,
        {NT_SHAPE_SPHERE, 0, 30e-9, 0.0, 0.0},
        {NT_SHAPE_CONE, 0, 0.0, 0.4, 0.0},
        {NT_SHAPE_CONE, 4, 0.0, 0.4, 0.0},
        {NT_SHAPE_PUNCH, 0, 30e-9, 0.0, 0.0},
        {NT_SHAPE_BLUNTED, 0, 30e-9, 0.4, 0.0},
        {NT_SHAPE_TRUNCATED, 3, 30e-9, 0.4, 0.0},
    };
    for (size_t i = 0; i < sizeof shapes / sizeof shapes[0]; i++)
        for (double E = 1e2; E <= 1e13; E *= 1e3)
            for (double k_c = 1e-3; k_c <= 1e3; k_c *= 1e2)
                for (double D = 1e-15; D < 1e-5; D *= 1e3) {
                    const nt_stage_displacement s = solve(shapes[i], E, (nt_lever){k_c, 0.2}, D);
                    assert_within(s.indentation + s.deflection * cos(0.2), D, 1e-14 * D);
                    assert_within(k_c * s.deflection, s.value.F, 1e-15 * s.value.F);
                    const double F = nt_shape_eval(&shapes[i], E, s.indentation).F;
                    assert_true(s.value.F == F && s.indentation > 0.0);
                }
}

/* Eq. 6 literally: Delta = delta + K sqrt(R) cos(alpha) delta^1.5/k_c. */
static void sphere_is_equation_6(void **state)
{
    (void)state;
    for (double D = 1e-12; D < 1e-6; D *= 3.0) {
        const double d = solve(sphere, 76.923e9, lever, D).indentation;
        const double K = 4.0 / 3.0 * 76.923e9;
        assert_within(d + K * sqrt(30e-9) * cos(0.2) * pow(d, 1.5) / 8.0, D, 1e-14 * D);
    }
}

/* Errata E6 and E7: Eq. 7 corrected is a quadratic, whose root is known. The printed term pi tan(psi) delta^2/(2 K k_c)
 * is no length: the ratio of it to the right one carries 1/K^2. */
static void cone_is_equation_7_corrected(void **state)
{
    (void)state;
    const double E = 1e9, psi = 0.3;
    for (double D = 1e-12; D < 1e-6; D *= 3.0) {
        const double q = cos(0.2) * 2.0 / NT_PI * E * tan(psi) / 8.0;
        const double expected = 2.0 * D / (1.0 + sqrt(1.0 + 4.0 * q * D));
        assert_within(solve((nt_shape){NT_SHAPE_CONE, 0, 0.0, psi, 0.0}, E, lever, D).indentation, expected,
                      1e-14 * expected);
    }
    const double soft = NT_PI * tan(psi) / (2.0 * E * 8.0), softer = NT_PI * tan(psi) / (2.0 * 0.5 * E * 8.0);
    assert_true(softer > soft); /* as printed a softer sample would bend the lever more */
    const nt_shape cone = {NT_SHAPE_CONE, 0, 0.0, psi, 0.0};
    assert_true(solve(cone, 0.5 * E, lever, 1e-8).deflection < solve(cone, E, lever, 1e-8).deflection);
}

/* Erratum E8: for silicon, k_c = 8 N/m, alpha = 0, Delta = 1..20 nm, Eq. 8 gives 0.18..0.10 of the indentation. */
static void equation_8_is_wrong_as_stated(void **state)
{
    (void)state;
    const nt_contact silicon = {.radius = 30e-9, .effective_modulus = 76.923e9};
    const nt_lever flat = {8.0, 0.0};
    const double near =
        nt_stage_displacement_approximate(&silicon, &flat, 1e-9) / solve(sphere, 76.923e9, flat, 1e-9).indentation;
    const double far =
        nt_stage_displacement_approximate(&silicon, &flat, 20e-9) / solve(sphere, 76.923e9, flat, 20e-9).indentation;
    assert_within(near, 0.18, 0.01);
    assert_within(far, 0.10, 0.01);
    /* where the sample gives way first the lever does not matter, and it is right: to K cos(alpha) a/k_c */
    const nt_contact soft = {.radius = 30e-9, .effective_modulus = 1e3};
    assert_within(nt_stage_displacement_approximate(&soft, &flat, 1e-9), 1e-9, 1e-14);
    assert_true(nt_stage_displacement_approximate(&soft, &flat, -1e-9) == 0.0);
    assert_true(isnan(nt_stage_displacement_approximate(&soft, &flat, NAN)));
}

static void refuses_what_is_no_lever(void **state)
{
    (void)state;
    nt_stage_displacement solved = {.indentation = 7.0};
    const nt_lever limp = {0.0, 0.0}, upright = {1.0, 1.6}, none = {NAN, 0.0};
    assert_int_equal(nt_stage_displacement_solve(&sphere, 1e9, &limp, 1e-9, &solved), NT_E_RANGE);
    assert_int_equal(nt_stage_displacement_solve(&sphere, 1e9, &upright, 1e-9, &solved), NT_E_RANGE);
    assert_int_equal(nt_stage_displacement_solve(&sphere, 0.0, &lever, 1e-9, &solved), NT_E_RANGE);
    assert_int_equal(nt_stage_displacement_solve(&sphere, 1e9, &none, 1e-9, &solved), NT_E_NOT_FINITE);
    assert_int_equal(nt_stage_displacement_solve(&sphere, 1e9, &lever, NAN, &solved), NT_E_NOT_FINITE);
    assert_int_equal(nt_stage_displacement_solve(&sphere, 1e9, &lever, 1e-310, &solved), NT_E_RANGE);
    assert_true(solved.indentation == 7.0);
    assert_true(solve(sphere, 1e9, lever, -1e-9).indentation == 0.0 &&
                solve(sphere, 1e9, lever, 0.0).deflection == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balances_for_every_shape),     cmocka_unit_test(sphere_is_equation_6),
        cmocka_unit_test(cone_is_equation_7_corrected), cmocka_unit_test(equation_8_is_wrong_as_stated),
        cmocka_unit_test(refuses_what_is_no_lever),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
