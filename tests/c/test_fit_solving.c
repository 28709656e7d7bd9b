/* SPDX-License-Identifier: BSD-3-Clause
 * fit/solving.cpp: what is known beforehand counts, and what contradicts it is said. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fit_curve.h"
#include "internal/fit.h"

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

/* A fit that ends early from means of neighbours, against one to the last digits from the guess: within a twentieth of
 * sigma, which adds 0.1 % to a variance; sigma itself within 1 %. */
static void ends_where_the_exact_fit_does(void **state)
{
    (void)state;
    const nt_fit_model models[] = {NT_FIT_HERTZ, NT_FIT_CONE, NT_FIT_JKR, NT_FIT_MAUGIS};
    for (int i = 0; i < 4; i++)
        for (uint64_t seed = 1; seed <= 25; seed++) {
            const nt_fit_options options = options_of(models[i], 0.5);
            const nt_fit_known known = known_of();
            curve made;
            synthesise(&options, noise * (double)(1 + seed % 3), seed, &made); /* known, and up to 3 times of that */
            const nt_fit_solution found = solve(&options, &known, &made);
            nt_fit_data data = data_of(&made);
            data.count = found.count;
            nt_fit_result exact;
            assert_int_equal(nt_fit_run(&found.options, &data, &exact, NULL), NT_OK);
            for (int p = 0; p < NT_FIT_PARAMETERS; p++)
                if (exact.identifiable[p]) {
                    assert_true(fabs(found.fit.value[p] - exact.value[p]) < 0.05 * exact.sigma[p]);
                    if (!(found.flags & NT_FIT_UNEVEN)) /* that widens it */
                        assert_true(fabs(found.fit.sigma[p] / exact.sigma[p] - 1.0) < 0.01);
                }
        }
}

/* The model is held by its law from there on. */
static void steep_width_is_where_the_law_begins(void **state)
{
    (void)state;
    const double springs[] = {0.1, 0.5, 5.0};
    for (int i = 0; i < 3; i++)
        for (int model = NT_FIT_JKR; model <= NT_FIT_MAUGIS; model++) {
            const nt_fit_options options = options_of((nt_fit_model)model, springs[i]);
            double tear, width;
            assert_int_equal(nt_fit_tear_position(&options, truth, &tear), NT_OK);
            assert_int_equal(nt_fit_steep_width(&options, truth, &width), NT_OK);
            assert_true(width > 0.0);
            const double position[] = {tear + 0.999 * width, tear + 1.001 * width};
            const nt_fit_data data = {position, NULL, 2, 1, 1};
            nt_fit_point point[2];
            assert_int_equal(nt_fit_model_n(&options, truth, &data, point), NT_OK);
            assert_false(point[0].held);
            assert_true(point[1].held);
        }
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
        cmocka_unit_test(ends_where_the_exact_fit_does),
        cmocka_unit_test(steep_width_is_where_the_law_begins),
        cmocka_unit_test(nothing_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
