/* SPDX-License-Identifier: BSD-3-Clause
 * What a refused plan names: an accuracy of which there is a plan, near the smallest; a gap beyond which there is one;
 * the law that stands in the way. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "nanotouch/plan.h"

static nt_plan plan;

static nt_status ask(const nt_scene *scene, nt_demand demand, nt_problem *problem)
{
    const nt_plan_inputs inputs = {.scene = scene, .demand = &demand};
    return nt_plan_make(&plan, &inputs, problem);
}

static nt_status ask_force(const nt_scene *scene, double accuracy, nt_problem *problem)
{
    return ask(scene, (nt_demand){.relative_accuracy = accuracy}, problem);
}

/* A sample that deforms under the brush on it before the tip presses. */
static nt_scene brush(double youngs_modulus, double load)
{
    nt_scene scene = nt_scene_defaults();
    scene.medium.kind = NT_MEDIUM_LIQUID;
    scene.medium.brush_thickness = 30e-9;
    scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
    scene.sample.youngs_modulus = youngs_modulus;
    scene.range.maximum_load = load;
    return scene;
}

/* And one that is pulled by a tail, of an adhesion that is solved with it only so well. */
static nt_scene sticky(double youngs_modulus, double radius)
{
    nt_scene scene = nt_scene_defaults();
    scene.medium.kind = NT_MEDIUM_VACUUM;
    scene.adhesion.work_of_adhesion = 6.7e-3;
    scene.adhesion.hamaker_constant = 1e-21;
    scene.tip.radius = radius;
    scene.sample.youngs_modulus = youngs_modulus;
    scene.range.maximum_load = 28e-9;
    return scene;
}

/* 1.1 is what docs/plan.md says. */
static void assert_near_the_smallest(const nt_scene *scene, double demanded)
{
    nt_problem problem = {0}, other;
    assert_int_equal(ask_force(scene, demanded, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "demand.relative_accuracy");
    assert_int_equal(ask_force(scene, problem.minimum, &other), NT_OK);
    assert_true(plan.bound.force_error <= problem.minimum);
    assert_true(problem.minimum < 1.101 * demanded || ask_force(scene, problem.minimum / 1.101, &other) == NT_E_RANGE);
}

static void what_is_named_is_planned_and_little_less_is_not(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        const nt_scene pressed = brush(i < 2 ? 1e7 : 1e9, i % 2 ? 1e-9 : 3e-8);
        const nt_scene pulled = sticky(i < 2 ? 4.3e4 : 4.3e5, i % 2 ? 2.1e-7 : 4e-8);
        assert_near_the_smallest(&pressed, 1e-5);
        assert_near_the_smallest(&pulled, 1e-6);
    }
}

static void a_jump_names_a_gap(void **state)
{
    (void)state;
    nt_scene scene = brush(1e7, 1e-9);
    scene.medium.kind = NT_MEDIUM_VACUUM;
    scene.adhesion.contact_potential = 0.5;
    nt_problem problem = {0};
    assert_int_equal(ask_force(&scene, 0.01, &problem), NT_E_RANGE);
    assert_int_equal(problem.code, NT_PROBLEM_JUMPS);
    assert_string_equal(problem.field, "range.minimum_gap");
    assert_string_equal(problem.cause, "electrostatic");
    assert_string_equal(problem.remedy.field, "range.minimum_gap");
    assert_string_equal(problem.unit, "m");
    scene.range.minimum_gap = problem.minimum;
    assert_int_equal(ask_force(&scene, 0.01, NULL), NT_OK);
}

/* A budget is told in its own unit, though a looser demand would cost less, too. */
static void a_budget_names_a_cost(void **state)
{
    (void)state;
    const nt_scene scene = brush(1e13, 1e-9);
    nt_demand demand = {.relative_accuracy = 1e-3, .budget = 0.1};
    nt_problem problem = {0};
    assert_int_equal(ask(&scene, demand, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "demand.budget");
    demand.budget = problem.minimum;
    assert_int_equal(ask(&scene, demand, NULL), NT_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_named_is_planned_and_little_less_is_not),
        cmocka_unit_test(a_jump_names_a_gap),
        cmocka_unit_test(a_budget_names_a_cost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
