/* SPDX-License-Identifier: BSD-3-Clause
 * fit.h: arguments, and a curve of the library's own law given back (independent references are in
 * tests/python/test_fit_ting.py). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "nanotouch/fit.h"

enum { BRANCH = 300, POINTS = 2 * BRANCH };

static double times[POINTS], positions[POINTS], forces[POINTS], workspace[20000];
static const long starts[2] = {0, BRANCH};

static nt_fit_path_options options_of(void)
{
    nt_fit_path_options options = nt_fit_path_defaults();
    options.contact.spring_constant = 0.05;
    options.noise = 1e-13;
    return options;
}

static nt_fit_path path_of(void)
{
    return (nt_fit_path){times, positions, forces, NULL, POINTS, starts, 2};
}

/* Level, tilt and drag beside the contact's force. */
static void make(const nt_viscoelastic *contact, double first_touch)
{
    for (int i = 0; i < POINTS; i++) {
        times[i] = 0.005 * i;
        positions[i] = 1e-6 - 1e-8 * fabs((double)(i - BRANCH));
    }
    assert_true(nt_viscoelastic_workspace(contact, POINTS, 0) <= 20000);
    const nt_viscoelastic_path path = {times, positions, first_touch, POINTS, workspace};
    nt_viscoelastic_result result = {.forces = forces};
    assert_int_equal(nt_viscoelastic_run(contact, &path, &result, NULL), NT_OK);
    for (int i = 0; i < POINTS; i++)
        forces[i] += 2e-11 + 1e-6 * positions[i] + 1e-6 * (i < BRANCH ? 2e-6 : -2e-6);
}

static void test_gives_its_own_law_back(void **state)
{
    (void)state;
    nt_fit_path_options options = options_of();
    nt_viscoelastic truth = options.contact;
    truth.rheology.modulus = 3e3;
    truth.rheology.exponent = 0.15;
    make(&truth, -2e-8);
    const nt_fit_path path = path_of();
    nt_fit_path_result found;
    assert_int_equal(nt_fit_path_run(&options, &path, &found, NULL), NT_OK);
    assert_int_equal(found.converged, 1);
    assert_true(fabs(found.value[0] / 3e3 - 1.0) < 1e-5); /* binning */
    assert_true(fabs(found.value[1] - 0.15) < 1e-5);
    assert_true(fabs(found.value[NT_FIT_PATH_CONTACT] + 2e-8) < 1e-11);
    assert_true(fabs(found.value[NT_FIT_PATH_LEVEL] - 2e-11) < 1e-13);
    assert_true(fabs(found.value[NT_FIT_PATH_DRAG] - 1e-6) < 1e-8);
    assert_true(isnan(found.value[2]));
    assert_true(found.free_exponent == found.value[1]);
    double fitted[POINTS];
    assert_int_equal(nt_fit_path_model(&options, &found, &path, fitted, NULL), NT_OK);
    for (int i = 0; i < POINTS; i++)
        assert_true(i == BRANCH || fabs(fitted[i] - forces[i]) < 1e-5 * found.peak); /* the turn has no speed */
}

/* Drag that falls with the height h over first touch as 1/(1 + h/h_d). */
static void test_drag_depends_on_the_height(void **state)
{
    (void)state;
    nt_fit_path_options options = options_of();
    make(&options.contact, 0.0);
    options.drag_height = 5e-7;
    for (int i = 0; i < POINTS; i++) {
        const double speed = i < BRANCH ? 2e-6 : -2e-6, height = positions[i] < 0.0 ? -positions[i] : 0.0;
        forces[i] += 4e-6 * speed / (1.0 + height / 5e-7);
    }
    for (int i = 0; i < POINTS; i++) /* without what make() put in */
        forces[i] -= 1e-6 * (i < BRANCH ? 2e-6 : -2e-6);
    const nt_fit_path path = path_of();
    nt_fit_path_result found;
    assert_int_equal(nt_fit_path_run(&options, &path, &found, NULL), NT_OK);
    assert_true(fabs(found.value[NT_FIT_PATH_DRAG] / 4e-6 - 1.0) < 1e-3);
    assert_true(fabs(found.value[1] - options.contact.rheology.exponent) < 1e-5);
}

static void test_an_elastic_sample_stays_at_the_floor(void **state)
{
    (void)state;
    nt_fit_path_options options = options_of();
    nt_viscoelastic truth = options.contact;
    truth.rheology.exponent = 0.0;
    make(&truth, 0.0);
    for (int i = 0; i < POINTS; i++) /* what a gel with a negative exponent would show */
        forces[i] *= 1.0 + 1e-4 * times[i];
    const nt_fit_path path = path_of();
    nt_fit_path_result found;
    assert_int_equal(nt_fit_path_run(&options, &path, &found, NULL), NT_OK);
    assert_true(found.value[1] == 0.0);
    assert_true(found.free_exponent < 0.0);
    assert_true(found.sigma[1] > 0.0 && found.covariance[0][1] == 0.0);
}

static void test_arguments(void **state)
{
    (void)state;
    nt_fit_path_options options = options_of();
    make(&options.contact, 0.0);
    nt_fit_path path = path_of();
    nt_fit_path_result found;
    nt_problem problem;
    options.noise = 0.0;
    assert_int_equal(nt_fit_path_run(&options, &path, &found, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "noise");
    options.noise = 1e-12;
    times[7] = times[6];
    assert_int_equal(nt_fit_path_run(&options, &path, &found, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "times");
    make(&options.contact, 0.0);
    forces[9] = (double)NAN;
    assert_int_equal(nt_fit_path_run(&options, &path, &found, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "forces");
    make(&options.contact, 0.0);
    path.count = 8;
    assert_int_equal(nt_fit_path_run(&options, &path, &found, &problem), NT_E_RANGE);
    path.count = POINTS;
    memset(forces, 0, sizeof forces);
    assert_int_equal(nt_fit_path_run(&options, &path, &found, &problem), NT_E_NO_CONVERGENCE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gives_its_own_law_back),
        cmocka_unit_test(test_drag_depends_on_the_height),
        cmocka_unit_test(test_an_elastic_sample_stays_at_the_floor),
        cmocka_unit_test(test_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
