/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "nanotouch/material.h"
#include "nanotouch/plan.h"

#define Y 7e9
#define R 20e-9

static nt_plan plan;

/* Silicon on silicon without adhesion: Hertz. */
static nt_scene bare_silicon(double load)
{
    nt_scene scene = nt_scene_defaults();
    scene.medium.relative_humidity = 0.0;
    scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
    scene.sample.yield_strength = Y;
    scene.range.maximum_load = load;
    return scene;
}

static nt_status make(const nt_scene *scene, nt_problem *problem)
{
    const nt_plan_inputs inputs = {.scene = scene};
    return nt_plan_make(&plan, &inputs, problem);
}

static const nt_plan_warning *warning_of(const char *words)
{
    for (int i = 0; i < plan.warning_count; ++i)
        if (strstr(plan.warnings[i].text, words))
            return &plan.warnings[i];
    return NULL;
}

/* The load of a peak pressure p0 (Johnson 1985, Eq. 6.11): P = pi^3 R^2 p0^3/(6 E*^2). */
static double load_of_peak(double p0)
{
    const double E = 135e9 / (2.0 * (1.0 - 0.35 * 0.35));
    return NT_PI * NT_PI * NT_PI * R * R * p0 * p0 * p0 / (6.0 * E * E);
}

static void the_onset_is_at_a_peak_of_1_6_yield_strengths(void **state)
{
    (void)state;
    nt_scene scene = bare_silicon(0.999 * load_of_peak(1.6 * Y));
    assert_int_equal(make(&scene, NULL), NT_OK);
    assert_null(warning_of("yield"));
    scene.range.maximum_load = 1.001 * load_of_peak(1.6 * Y);
    assert_int_equal(make(&scene, NULL), NT_OK);
    const nt_plan_warning *warning = warning_of("the sample begins to yield");
    assert_non_null(warning);
    assert_true(fabs(warning->value / (1.6 * Y) - 1.0) < 1e-3 && fabs(warning->limit / (1.6 * Y) - 1.0) < 1e-12);
    scene.sample.yield_strength = 0.0; /* not known */
    assert_int_equal(make(&scene, NULL), NT_OK);
    assert_null(warning_of("yield"));
    scene.tip.yield_strength = Y;
    scene.sample.yield_strength = 2.0 * Y; /* the weaker one is told */
    assert_int_equal(make(&scene, NULL), NT_OK);
    assert_non_null(warning_of("the tip begins to yield"));
    scene.range.minimum_gap = 10e-9; /* never touched */
    assert_int_equal(make(&scene, NULL), NT_OK);
    assert_null(warning_of("yield"));
}

/* Mean pressure of 3 Y: a peak of 4.5 Y under a round tip. */
static void plastic_contact_is_refused_with_the_load_that_would_do(void **state)
{
    (void)state;
    const double last = load_of_peak(4.5 * Y);
    nt_scene scene = bare_silicon(1.001 * last);
    nt_problem problem = {0};
    assert_int_equal(make(&scene, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "range.maximum_load");
    assert_int_equal(problem.code, NT_PROBLEM_PLASTIC_SAMPLE);
    assert_true(problem.value == scene.range.maximum_load && fabs(problem.maximum / last - 1.0) < 1e-9);
    scene.range.maximum_load = problem.maximum;
    assert_int_equal(make(&scene, &problem), NT_OK);
    scene.range.maximum_load = 2.0 * last;
    scene.tip.yield_strength = 0.5 * Y;
    assert_int_equal(make(&scene, &problem), NT_E_RANGE);
    assert_int_equal(problem.code, NT_PROBLEM_PLASTIC_TIP);
    scene.range.minimum_gap = 10e-9;
    assert_int_equal(make(&scene, &problem), NT_OK);
}

/* Under a cone the mean pressure is E* cot(psi)/2 at every load (Sneddon 1948). */
static void a_sharp_cone_is_refused_at_any_load(void **state)
{
    (void)state;
    const double E = 135e9 / (2.0 * (1.0 - 0.35 * 0.35));
    nt_scene scene = bare_silicon(1e-9);
    nt_problem problem = {0};
    scene.tip.shape = NT_SHAPE_CONE;
    scene.tip.half_angle = atan(E / (6.0 * Y)) * 1.001;
    assert_int_equal(make(&scene, &problem), NT_OK);
    scene.tip.half_angle = atan(E / (6.0 * Y)) * 0.999;
    assert_int_equal(make(&scene, &problem), NT_E_RANGE);
    assert_true(problem.maximum < 1e-14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_onset_is_at_a_peak_of_1_6_yield_strengths),
        cmocka_unit_test(plastic_contact_is_refused_with_the_load_that_would_do),
        cmocka_unit_test(a_sharp_cone_is_refused_at_any_load),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
