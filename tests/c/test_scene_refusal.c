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

#include "nanotouch/interaction.h"
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
    assert_string_equal(problem.cause, "the electrostatic force");
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

/* A dry silicon tip on a polymer, whose van der Waals force takes most of a small work of adhesion. */
static nt_scene polymer(double youngs_modulus)
{
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = 10e-9;
    scene.sample.youngs_modulus = youngs_modulus;
    scene.sample.poisson_ratio = 0.35;
    scene.medium.relative_humidity = 0.0;
    scene.adhesion.work_of_adhesion = 0.05;
    scene.adhesion.hamaker_constant = 1e-19;
    return scene;
}

/* A repulsive hydration presses most, but van der Waals is what pulls. */
static nt_scene film(void)
{
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = 20e-9;
    scene.sample = (nt_specimen){.youngs_modulus = 2e7, .poisson_ratio = 0.45, .thickness = 4e-9};
    scene.medium.kind = NT_MEDIUM_LIQUID;
    scene.medium.ionic_strength = 150.0;
    scene.medium.hydration_energy = 0.01;
    scene.adhesion.work_of_adhesion = 0.0;
    scene.adhesion.hamaker_constant = 5e-21;
    scene.range.maximum_load = 2e-9;
    return scene;
}

static void set(nt_scene *scene, const nt_remedy *remedy)
{
    int count = 0;
    const nt_field *fields = nt_scene_fields(&count);
    for (int i = 0; i < count; i++)
        if (strcmp(fields[i].name, remedy->field) == 0)
            nt_field_set(&fields[i], scene, remedy->value);
}

static void one_change_that_is_named_works(void **state)
{
    (void)state;
    const nt_scene scenes[] = {polymer(3e9), polymer(3.5e9), film()};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        nt_problem problem = {0};
        nt_scene changed = scenes[i];
        if (ask_force(&scenes[i], 0.1, &problem) == NT_OK)
            continue;
        assert_non_null(problem.remedy.field);
        assert_string_equal(problem.cause, "van der Waals");
        set(&changed, &problem.remedy);
        assert_int_equal(ask_force(&changed, 0.1, NULL), NT_OK);
        assert_true(plan.bound.force_error <= 0.1);
    }
}

/* Nothing keeps it, and it says what can be kept. */
static void an_error_of_zero_is_refused_as_any_other(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    nt_problem problem = {0};
    assert_int_equal(ask_force(&scene, 0.0, &problem), NT_E_RANGE);
    assert_int_equal(problem.code, NT_PROBLEM_ACCURACY);
    assert_true(problem.value == 0.0 && problem.minimum > 1e-13 && problem.minimum < 1e-11);
    assert_int_equal(ask_force(&scene, problem.minimum, NULL), NT_OK);
    const nt_demand exact = {.bound = NT_BOUND_EXACT};
    assert_int_equal(ask(&scene, exact, NULL), NT_OK);
    assert_true(plan.bound.force_error < 1e-3 && plan.accuracy == 0.0);
}

/* Where nothing is known there is a force, and the bound says so; where the demand can be kept, it is. */
static void any_bound_will_do(void **state)
{
    (void)state;
    nt_scene strong = nt_scene_defaults();
    strong.adhesion.hamaker_constant = 1e-17; /* alone it pulls more than all of w */
    strong.medium.relative_humidity = 0.0;
    const nt_scene scenes[] = {polymer(3.5e9), film(), strong}, kept = nt_scene_defaults();
    const nt_demand any = {.relative_accuracy = 0.01, .bound = NT_BOUND_ANY};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        assert_int_equal(ask(&scenes[i], any, NULL), NT_OK);
        int warned = 0;
        for (int w = 0; w < plan.warning_count; w++)
            warned |= strstr(plan.warnings[w].text, "no bound is known") != NULL;
        assert_int_equal(warned, isinf(plan.bound.force_error) != 0);
        assert_true(isfinite(plan.pull_off_force));
    }
    assert_true(isinf(plan.bound.force_error)); /* the last */
    assert_int_equal(ask(&kept, any, NULL), NT_OK);
    assert_true(plan.bound.force_error <= 0.01);
}

/* Double layers of unlike surfaces, without adhesion. */
static nt_scene unlike(double radius, double modulus, double poisson_ratio, double salt, const double potentials[2])
{
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = radius;
    scene.tip.surface_potential = potentials[0];
    scene.sample.surface_potential = potentials[1];
    scene.sample.youngs_modulus = modulus;
    scene.sample.poisson_ratio = poisson_ratio;
    scene.medium.kind = NT_MEDIUM_LIQUID;
    scene.medium.ionic_strength = salt;
    scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
    return scene;
}

/* Whether it is planned, with forces {gap, F} within the bound and what the digits of the truth leave. */
static void assert_within(const nt_scene *scene, double demand, const double (*truth)[2], int count)
{
    nt_problem problem = {0};
    const nt_interaction_state apart = {0};
    assert_int_equal(ask_force(scene, demand, &problem), NT_OK);
    assert_true(plan.bound.force_error <= demand);
    for (int i = 0; i < count; ++i) {
        const double F = nt_interaction_eval_gap(&plan, &apart, NULL, truth[i][0]).F;
        const double size = fabs(truth[i][1]) > plan.scale ? fabs(truth[i][1]) : plan.scale;
        assert_true(fabs(F - truth[i][1]) <= (plan.bound.force_error + 3e-5) * size);
    }
}

/* The surface would jump 30 pm inside the gap where the bodies touch. The forces, as those of the next test, are of
 * nanotouch.reference.deformed, which shares no code with plans. */
static void a_surface_that_touches_before_it_jumps_is_planned(void **state)
{
    (void)state;
    static const double truth[][2] = {{1e-9, -1.5049e-8}, {4e-10, -5.2585e-8},      {1.2e-10, -8.4573e-8},
                                      {0.0, -8.1375e-8},  {-2.5090e-10, 4.1632e-8}, {-8.3633e-10, 6.0087e-7}};
    const double demands[] = {0.1, 0.03, 0.01, 0.003, 0.001};
    nt_scene scene = unlike(7.75747758466504e-06, 7423713634.411866, 0.2111910147487924, 2.3337125885373227,
                            (double[]){-0.013598718397653767, -0.049181819148044474});
    scene.tip.youngs_modulus = 130e9;
    scene.tip.poisson_ratio = 0.28;
    scene.range.maximum_load = 7.146714203136005e-07;
    for (int i = 0; i < 5; ++i)
        assert_within(&scene, demands[i], truth, 6);
}

/* The pressure is larger around the contact than at its edge, where repulsion and attraction cancel: the sum on the
 * undeformed gap was off by 1.16 times its bound. */
static void a_pressure_that_cancels_at_contact_counts_around_it(void **state)
{
    (void)state;
    static const double truth[][2] = {{1e-9, 4.35960e-11},    {2.4e-10, 5.66637e-11},  {0.0, 5.71178e-11},
                                      {-7e-13, 5.80816e-11},  {-3.4e-12, 7.26906e-11}, {-1e-11, 1.40516e-10},
                                      {-3.4e-11, 5.91020e-10}};
    nt_scene scene = unlike(11.36e-9, 2.2e10, 0.392, 36.0, (double[]){-0.0431, -0.0471});
    scene.tip.youngs_modulus = 7e10;
    scene.tip.poisson_ratio = 0.17;
    scene.range.maximum_load = 6.95e-10;
    for (double demand = 0.1; demand > 1e-3; demand *= 0.3)
        assert_within(&scene, demand, truth, 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_named_is_planned_and_little_less_is_not),
        cmocka_unit_test(a_jump_names_a_gap),
        cmocka_unit_test(a_budget_names_a_cost),
        cmocka_unit_test(one_change_that_is_named_works),
        cmocka_unit_test(an_error_of_zero_is_refused_as_any_other),
        cmocka_unit_test(any_bound_will_do),
        cmocka_unit_test(a_surface_that_touches_before_it_jumps_is_planned),
        cmocka_unit_test(a_pressure_that_cancels_at_contact_counts_around_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
