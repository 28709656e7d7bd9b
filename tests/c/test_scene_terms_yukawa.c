/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "nanotouch/interaction.h"
#include "nanotouch/plan.h"

#define PI 3.14159265358979323846

static nt_plan plan;

static nt_scene with(double radius, double energy, double length)
{
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = radius;
    scene.medium.relative_humidity = 0.0;
    scene.tip.youngs_modulus = scene.sample.youngs_modulus = 1e13; /* nothing that is looked at here deforms */
    scene.medium.yukawa_energy = energy;
    scene.medium.yukawa_length = length;
    return scene;
}

static void make(const nt_scene *scene, double accuracy)
{
    const nt_demand demand = {.relative_accuracy = accuracy};
    const nt_plan_inputs inputs = {.scene = scene, .demand = &demand};
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
}

/* The slices of the sphere in the field of a half-space, by Simpson's rule, which ends where nothing is left. A slice
 * of thickness l over the half-space alone would have W exp(-z/l) per area, so that matter has W/l per volume. */
static double slices(double radius, double energy, double length, double gap)
{
    enum { STEPS = 20000 };
    const double depth = 2.0 * radius < 60.0 * length ? 2.0 * radius : 60.0 * length, step = depth / STEPS;
    double sum = 0.0;
    for (int i = 0; i <= STEPS; i++) {
        const double t = i * step, weight = i == 0 || i == STEPS ? 1.0 : i % 2 ? 4.0 : 2.0;
        sum += weight * PI * (2.0 * radius * t - t * t) * exp(-(gap + t) / length);
    }
    return energy / length / length * sum * step / 3.0;
}

static void the_force_is_that_of_all_slices(void **state)
{
    (void)state;
    const double radii[] = {2e-10, 5e-9, 20e-9, 21e-9, 1e-6}, lengths[] = {1e-10, 5e-9, 20e-9, 1e-6};
    for (int r = 0; r < 5; r++)
        for (int l = 0; l < 4; l++) {
            const nt_scene scene = with(radii[r], -2e-4, lengths[l]);
            make(&scene, 0.01);
            for (double gap = 0.3e-9; gap < 30e-9; gap *= 2.0) {
                const double truth = slices(radii[r], -2e-4, lengths[l], gap);
                assert_true(fabs(nt_plan_term_eval(&plan, NT_PLAN_YUKAWA, gap).F - truth) < 1e-9 * fabs(truth));
            }
        }
}

/* l << R: Derjaguin; l >> R: every element of the sphere feels the same field. */
static void its_limits_are_those_of_the_paper(void **state)
{
    (void)state;
    nt_scene scene = with(1e-3, 1e-3, 1e-10);
    make(&scene, 0.01);
    assert_true(fabs(nt_plan_term_eval(&plan, NT_PLAN_YUKAWA, 1e-9).F / (2.0 * PI * 1e-6 * exp(-10.0)) - 1.0) < 2e-7);
    scene = with(2e-10, 1e-3, 1e-6);
    make(&scene, 0.01);
    const double volume = 4.0 / 3.0 * PI * 8e-30, F = 1e-3 / 1e-12 * volume * exp(-1.2e-3);
    assert_true(fabs(nt_plan_term_eval(&plan, NT_PLAN_YUKAWA, 1e-9).F / F - 1.0) < 1e-7);
}

/* Where it is felt it is on and adds to the rest; where it is not it is left out, and the bound holds what it has. */
static void a_plan_takes_it_where_it_is_felt(void **state)
{
    (void)state;
    nt_scene scene = with(20e-9, 1e-2, 5e-9);
    const nt_interaction_state apart = {0};
    make(&scene, 1e-3);
    assert_int_equal(plan.terms[NT_PLAN_YUKAWA].form, NT_FORM_ON);
    const double all = nt_interaction_eval_gap(&plan, &apart, NULL, 3e-9).F;
    scene.medium.yukawa_energy = 1e-7;
    make(&scene, 1e-3);
    assert_int_equal(plan.terms[NT_PLAN_YUKAWA].form, NT_FORM_OFF);
    const double rest = nt_interaction_eval_gap(&plan, &apart, NULL, 3e-9).F;
    assert_true(fabs((all - rest) / slices(20e-9, 1e-2, 5e-9, 3e-9) - 1.0) < 1e-3);
    const double largest = slices(20e-9, 1e-7, 5e-9, scene.adhesion.equilibrium_distance); /* held inside */
    assert_true(fabs(plan.terms[NT_PLAN_YUKAWA].force / largest - 1.0) < 1e-9);
    assert_true(fabs(plan.terms[NT_PLAN_YUKAWA].bound * plan.scale / largest - 1.0) < 1e-9);
}

/* An energy without a length is no force, and told. */
static void without_a_length_there_is_none(void **state)
{
    (void)state;
    const nt_scene scene = with(20e-9, 1e-2, 0.0);
    make(&scene, 1e-3);
    assert_true(nt_plan_term_eval(&plan, NT_PLAN_YUKAWA, 1e-9).F == 0.0);
    int told = 0;
    for (int i = 0; i < plan.warning_count; i++)
        told += strstr(plan.warnings[i].text, "Yukawa") != NULL;
    assert_int_equal(told, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_force_is_that_of_all_slices),
        cmocka_unit_test(its_limits_are_those_of_the_paper),
        cmocka_unit_test(a_plan_takes_it_where_it_is_felt),
        cmocka_unit_test(without_a_length_there_is_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
