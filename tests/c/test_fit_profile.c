/* SPDX-License-Identifier: BSD-3-Clause
 * fit/profile.cpp: how a result moves with the calibration, and how far it can go. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fit_curve.h"
#include "internal/fit.h"

static const double noise = 20e-12; /* N */

static nt_fit_solution solve(double spring_constant, curve *made)
{
    const nt_fit_options options = options_of(NT_FIT_HERTZ, spring_constant);
    const nt_fit_known known = {.noise = noise, .free = {noise * noise, 0.0}, .sensitivity_sigma = 0.03};
    synthesise(&options, noise, 1, made);
    const nt_fit_data data = data_of(made);
    nt_fit_solution found;
    assert_int_equal(nt_fit_solve(&options, &known, &data, &found, NULL), NT_OK);
    return found;
}

/* Of Hertz only E sqrt(R) shows: d ln E by d ln R is -1/2. The difference of 0.1 % has an error of second order, 4e-4.
 */
static void modulus_goes_as_one_over_root_of_radius(void **state)
{
    (void)state;
    curve made;
    const nt_fit_solution found = solve(0.5, &made);
    const nt_fit_data data = data_of(&made);
    double shift[NT_FIT_PARAMETERS];
    assert_int_equal(nt_fit_shift(&found, &data, NT_FIT_RADIUS, shift), NT_OK);
    assert_true(fabs(shift[NT_FIT_EFFECTIVE_MODULUS] / found.fit.value[NT_FIT_EFFECTIVE_MODULUS] + 0.5) < 1e-3);
    /* force and spring constant together: delta stays, E* goes with them */
    assert_int_equal(nt_fit_shift(&found, &data, NT_FIT_SPRING_CONSTANT, shift), NT_OK);
    assert_true(fabs(shift[NT_FIT_EFFECTIVE_MODULUS] / found.fit.value[NT_FIT_EFFECTIVE_MODULUS] - 1.0) < 1e-3);
}

/* Where the modulus is determined, chi^2 is a parabola of its logarithm: its ends are 1.96 sigma away, within the 1 %
 * of a halved decade and the 10 % by which it is none. */
static void bounds_are_those_of_a_parabola(void **state)
{
    (void)state;
    curve made;
    const nt_fit_solution found = solve(0.5, &made);
    const nt_fit_data data = data_of(&made);
    const double E = found.fit.value[NT_FIT_EFFECTIVE_MODULUS], sigma = found.fit.sigma[NT_FIT_EFFECTIVE_MODULUS];
    double bounds[2];
    assert_int_equal(nt_fit_bounds(&found, &data, NT_FIT_EFFECTIVE_MODULUS, bounds), NT_OK);
    assert_true(fabs(log(bounds[1] / E) - 1.96 * sigma / E) < 0.011 + 0.1 * 1.96 * sigma / E);
    assert_true(fabs(log(E / bounds[0]) - 1.96 * sigma / E) < 0.011 + 0.1 * 1.96 * sigma / E);
    assert_int_equal(nt_fit_bounds(&found, &data, NT_FIT_CONTACT_POINT, bounds), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(modulus_goes_as_one_over_root_of_radius),
        cmocka_unit_test(bounds_are_those_of_a_parabola),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
