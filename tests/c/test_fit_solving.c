/* SPDX-License-Identifier: BSD-3-Clause
 * fit/solving.cpp: what is known beforehand counts, and what contradicts it is said. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fit_curve.h"

static const double noise = 20e-12; /* N */

static nt_fit_known known_of(void)
{
    nt_fit_known known = {0};
    known.noise = noise;
    known.free.white = noise * noise;
    known.sensitivity_sigma = 0.03;
    return known;
}

static nt_fit_solution solve(const nt_fit_options *options, const nt_fit_known *known, const curve *made)
{
    const nt_fit_data data = data_of(made);
    nt_fit_solution found;
    assert_int_equal(nt_fit_solve(options, known, &data, &found, NULL), NT_OK);
    return found;
}

/* White noise of a right law: no doubt, and E* within 5 standard deviations. */
static void a_right_law_is_not_doubted(void **state)
{
    (void)state;
    const nt_fit_options options = options_of(NT_FIT_HERTZ, 0.5);
    const nt_fit_known known = known_of();
    curve made;
    synthesise(&options, noise, 1, &made);
    const nt_fit_solution found = solve(&options, &known, &made);
    const double off = found.fit.value[NT_FIT_EFFECTIVE_MODULUS] - truth[NT_FIT_EFFECTIVE_MODULUS];
    assert_true(fabs(off) < 5.0 * found.fit.sigma[NT_FIT_EFFECTIVE_MODULUS]);
    assert_true(found.fit.identifiable[NT_FIT_EFFECTIVE_MODULUS]);
    assert_int_equal(found.flags & (NT_FIT_CALIBRATION | NT_FIT_WRONG_MODEL | NT_FIT_MISFIT), 0);
    assert_int_equal(found.count, POINTS);
    assert_true(found.rating > 9.0);
    assert_true(isnan(found.any_rms));
    assert_false(found.exact);
}

/* Forces as a sensitivity that is 3 times too small makes them (0.03 are allowed): 37 standard deviations. */
static void a_false_sensitivity_is_told(void **state)
{
    (void)state;
    const nt_fit_options options = options_of(NT_FIT_HERTZ, 0.02);
    nt_fit_known known = known_of();
    known.noise = 1e-12;
    known.free.white = 1e-24;
    curve made;
    synthesise(&options, 0.0, 1, &made);
    for (int i = 0; i < POINTS; i++)
        made.force[i] /= 3.0;
    const nt_fit_solution found = solve(&options, &known, &made);
    assert_true(found.flags & NT_FIT_CALIBRATION);
    assert_false(found.fit.identifiable[NT_FIT_EFFECTIVE_MODULUS]);
}

/* A tear 30 nm from where the contact lets go, 15 standard deviations, is not used. */
static void a_false_tear_is_left(void **state)
{
    (void)state;
    const nt_fit_options options = options_of(NT_FIT_JKR, 0.5);
    nt_fit_known known = known_of();
    curve made;
    synthesise(&options, noise, 1, &made);
    known.tear_position = made.position[POINTS - 1] - 30e-9;
    known.tear_sigma = 2e-9;
    const nt_fit_solution found = solve(&options, &known, &made);
    assert_true(found.flags & NT_FIT_TORN_ELSEWHERE);
    assert_true(found.options.tear_sigma == 0.0);
}

static void nothing_is_refused(void **state)
{
    (void)state;
    const nt_fit_options options = options_of(NT_FIT_HERTZ, 0.5);
    const nt_fit_known known = known_of();
    nt_fit_solution found;
    assert_int_equal(nt_fit_solve(&options, &known, NULL, &found, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_fit_steep_width(&options, truth, NULL), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_right_law_is_not_doubted),
        cmocka_unit_test(a_false_sensitivity_is_told),
        cmocka_unit_test(a_false_tear_is_left),
        cmocka_unit_test(nothing_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
