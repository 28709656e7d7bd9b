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

/* Silica and gold in 1 mM salt. */
static const nt_double_layer water = {30e-9, 9.6e-9, 78.5, -0.020, -0.012, 0.2e-9};
FORCE_LAW(nt_double_layer, nt_double_layer_potential_eval)
FORCE_LAW(nt_double_layer, nt_double_layer_charge_eval)
static const force_law laws[] = {
    {nt_double_layer_potential_eval_at, nt_double_layer_potential_eval_over, &water, 0.2e-9},
    {nt_double_layer_charge_eval_at, nt_double_layer_charge_eval_over, &water, 0.2e-9},
};

/* The pressure between plates at x = h/debye_length [Pa]: psi'' = kappa^2 psi by finite differences of second order on
 * N cells, with the potentials held, or their slopes (the charges); then P = eps kappa^2/2 (psi^2 - psi'^2) in the
 * middle of the first cell, the same everywhere. Richardson takes out the error of second order. */
static double pressure_on_grid(int charge, double x, int N)
{
    enum { MOST = 1601 };
    double diagonal[MOST], right[MOST];
    const double step = x / N, psi_1 = water.tip_potential, psi_2 = water.sample_potential;
    const double inner = 2.0 + step * step, outer = charge ? 1.0 + 0.5 * step * step : 1.0, wing = charge ? -1.0 : 0.0;
    for (int i = 0; i <= N; i++) {
        const int end = i == 0 || i == N;
        diagonal[i] = end ? outer : inner;
        right[i] = end ? (i == 0 ? psi_1 : psi_2) * (charge ? step : 1.0) : 0.0;
    }
    for (int i = 1; i <= N; i++) { /* Gauss: the lower wing of the last row is `wing`, the upper of the first as well */
        const double upper = i == 1 ? wing : -1.0, lower = i == N ? wing : -1.0;
        diagonal[i] -= lower / diagonal[i - 1] * upper;
        right[i] -= lower / diagonal[i - 1] * right[i - 1];
    }
    double next = right[N] / diagonal[N], here = next;
    for (int i = N - 1; i >= 0; i--) {
        next = here;
        here = (right[i] - (i == 0 ? wing : -1.0) * next) / diagonal[i];
    }
    const double middle = 0.5 * (here + next), slope = (next - here) / step;
    const double permittivity = NT_VACUUM_PERMITTIVITY * water.relative_permittivity, kappa = 1.0 / water.debye_length;
    return 0.5 * permittivity * kappa * kappa * (middle * middle - slope * slope);
}

/* k = 2 pi R P: the curvature of the sphere's energy is the pressure of the plates. Finite differences leave 1e-6. */
static void is_the_linear_poisson_boltzmann_equation(void **state)
{
    (void)state;
    for (int charge = 0; charge < 2; charge++)
        for (double x = 0.05; x < 6.0; x *= 1.5) {
            const double coarse = pressure_on_grid(charge, x, 800), fine = pressure_on_grid(charge, x, 1600);
            const double P = fine + (fine - coarse) / 3.0, R = water.radius;
            const double k = laws[charge].at(&water, x * water.debye_length).k / (2.0 * NT_PI * R);
            assert_within(k, P, 2e-6 * fabs(P));
        }
}

/* Both boundary conditions have one far field: two undisturbed layers, F = 4 pi eps R kappa psi_1 psi_2 exp(-x). */
static void far_field(void **state)
{
    (void)state;
    const double x = 12.0, h = x * water.debye_length;
    const double C = 4.0 * NT_PI * NT_VACUUM_PERMITTIVITY * 78.5 * 30e-9 * 0.020 * 0.012;
    for (int i = 0; i < 2; i++) {
        const nt_law_value value = laws[i].at(&water, h);
        assert_within(value.U, C * exp(-x), 2.0 * exp(-x) * C * exp(-x));
        assert_within(value.F, C * exp(-x) / water.debye_length, 4.0 * exp(-x) * C * exp(-x) / water.debye_length);
    }
}

/* Close up: at constant potential unlike plates are capacitors, P = -eps (psi_1 - psi_2)^2/(2 h^2); at constant charge
 * ions are squeezed, P = +eps kappa^2 (psi_1 + psi_2)^2/(2 x^2). Equal potentials leave a finite force, 2 pi eps kappa
 * R psi^2. */
static void close_up(void **state)
{
    (void)state;
    const nt_double_layer close = {30e-9, 9.6e-9, 78.5, -0.020, -0.012, 1e-12};
    const double h = 2e-12, R = close.radius;
    const double P = NT_VACUUM_PERMITTIVITY * 78.5 / (2.0 * h * h);
    const double potential = nt_double_layer_potential_eval(&close, h).k / (2.0 * NT_PI * R);
    const double charge = nt_double_layer_charge_eval(&close, h).k / (2.0 * NT_PI * R);
    assert_within(potential, -P * 0.008 * 0.008, 1e-7 * P * 0.032 * 0.032);
    assert_within(charge, P * 0.032 * 0.032, 1e-7 * P * 0.032 * 0.032);
    const nt_double_layer equal = {30e-9, 9.6e-9, 78.5, 0.020, 0.020, 1e-12};
    const double F = 2.0 * NT_PI * NT_VACUUM_PERMITTIVITY * 78.5 / equal.debye_length * R * 0.020 * 0.020;
    assert_within(nt_double_layer_potential_eval(&equal, 1e-12).F, F, 1e-4 * F); /* first order in x */
}

/* Opposite potentials attract at constant charge as well, until the layers are squeezed; swapping the bodies is no
 * change. */
static void signs(void **state)
{
    (void)state;
    const nt_double_layer opposite = {30e-9, 9.6e-9, 78.5, 0.020, -0.012, 0.2e-9};
    const nt_double_layer swapped = {30e-9, 9.6e-9, 78.5, -0.012, 0.020, 0.2e-9};
    for (double h = 0.2e-9; h < 1e-7; h *= 1.5) {
        assert_true(nt_double_layer_potential_eval(&opposite, h).F < 0.0);
        assert_true(nt_double_layer_charge_eval(&water, h).F > nt_double_layer_potential_eval(&water, h).F);
        assert_true(nt_double_layer_charge_eval(&opposite, h).F == nt_double_layer_charge_eval(&swapped, h).F);
    }
    assert_true(nt_double_layer_charge_eval(&opposite, 20e-9).F < 0.0);
    assert_true(nt_double_layer_charge_eval(&opposite, 0.2e-9).F > 0.0);
}

/* Israelachvili: 0.304/sqrt(c) nm for a 1:1 salt of c mol/l in water at 25 C; 2:2 has four times the ionic strength.
 * The 0.304 has three digits. */
static void debye_lengths_of_water(void **state)
{
    (void)state;
    assert_within(nt_debye_length(1.0, 78.54, 298.15), 9.61e-9, 0.003 * 9.61e-9);
    assert_within(nt_debye_length(100.0, 78.54, 298.15), 0.961e-9, 0.003 * 0.961e-9);
    assert_within(nt_debye_length(4.0, 78.54, 298.15), 4.81e-9, 0.003 * 4.81e-9);
    assert_within(nt_debye_length(1e-4, 78.54, 298.15), 961e-9, 0.003 * 961e-9); /* pure water at pH 7 */
    const double no[] = {0.0, -1.0, NAN};
    for (size_t i = 0; i < sizeof no / sizeof *no; i++)
        assert_true(isnan(nt_debye_length(no[i], 78.5, 298.0)) && isnan(nt_debye_length(1.0, no[i], 298.0)) &&
                    isnan(nt_debye_length(1.0, 78.5, no[i])));
}

static void slopes(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++)
        assert_slopes(&laws[i], (double[]){0.21e-9, 60e-9}, (nt_law_value){0});
}

static void rules(void **state)
{
    (void)state;
    nt_problem problem;
    assert_keeps_the_rules(&laws[0]);
    assert_keeps_the_rules(&laws[1]);
    assert_int_equal(nt_double_layer_check(&water, NULL), NT_OK);
    assert_int_equal(nt_double_layer_check(&(nt_double_layer){30e-9, 9.6e-9, 0.5, 0.0, 0.0, 1e-10}, &problem),
                     NT_E_RANGE);
    assert_string_equal(problem.field, "relative_permittivity");
    assert_int_equal(nt_double_layer_check(&(nt_double_layer){30e-9, NAN, 78.5, 0.0, 0.0, 1e-10}, &problem),
                     NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "debye_length");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_the_linear_poisson_boltzmann_equation),
        cmocka_unit_test(far_field),
        cmocka_unit_test(close_up),
        cmocka_unit_test(signs),
        cmocka_unit_test(debye_lengths_of_water),
        cmocka_unit_test(slopes),
        cmocka_unit_test(rules),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
