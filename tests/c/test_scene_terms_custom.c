/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/interaction.h"
#include "nanotouch/plan.h"

static nt_plan plan;
static nt_problem problem;
static long calls;

/* Two exponentials of opposite sign and a power, as soft matter has. */
typedef struct mixture {
    double repulsion, attraction, tail; /* [N], [N], [N m^2] */
    double stated;                      /* share of the true bound that is stated */
    double force, stiffness;            /* what F and k are multiplied by: 1 is right */
} mixture;

static const mixture honest = {8e-9, 3e-9, 1e-28, 1.0, 1.0, 1.0};

static nt_law_value mixed(const void *context, double gap)
{
    const mixture *m = context;
    const double a = 0.7e-9, b = 4e-9, up = m->repulsion * exp(-gap / a), down = m->attraction * exp(-gap / b);
    const double tail = m->tail / (gap * gap);
    ++calls;
    return (nt_law_value){.U = up * a - down * b - tail * gap,
                          .F = m->force * (up - down - tail),
                          .k = m->stiffness * (up / a - down / b - 2.0 * tail / gap)};
}

static double bound_of_mixed(const void *context, double gap)
{
    const mixture *m = context;
    ++calls;
    return m->stated * (m->repulsion * exp(-gap / 0.7e-9) + m->attraction * exp(-gap / 4e-9) + m->tail / (gap * gap));
}

static nt_scene with(const mixture *m)
{
    nt_scene scene = nt_scene_defaults();
    scene.medium.relative_humidity = 0.0;
    scene.tip.youngs_modulus = scene.sample.youngs_modulus = 1e13; /* nothing that is looked at here deforms */
    scene.custom[1] = (nt_custom_term){.name = "gel", .law = mixed, .bound = bound_of_mixed, .context = m};
    return scene;
}

static nt_status make(const nt_scene *scene, double accuracy)
{
    const nt_demand demand = {.relative_accuracy = accuracy};
    const nt_plan_inputs inputs = {.scene = scene, .demand = &demand};
    return nt_plan_make(&plan, &inputs, &problem);
}

/* The table against the law at gaps that it has not seen, and what runs calls no function. */
static void a_plan_computes_it_within_the_error_it_states(void **state)
{
    (void)state;
    const nt_scene scene = with(&honest);
    nt_random random = nt_random_seed(5);
    assert_int_equal(make(&scene, 1e-4), NT_OK);
    const nt_plan_term *term = &plan.terms[NT_PLAN_CUSTOM_2];
    assert_string_equal(term->name, "gel");
    assert_string_equal(term->title, "gel");
    assert_int_equal(term->form, NT_FORM_TABLE);
    assert_true(term->bound > 0.0 && term->bound < 1e-6 && term->cost > 0.0);
    assert_true(term->force >= fabs(mixed(&honest, scene.adhesion.equilibrium_distance).F));
    const long before = calls;
    double worst = 0.0, worst_stiffness = 0.0;
    nt_law_value values[2000];
    double gaps[2000];
    for (int i = 0; i < 2000; i++) {
        gaps[i] = 0.2e-9 * pow(1e5, nt_random_uniform(&random));
        values[i] = nt_plan_term_eval(&plan, NT_PLAN_CUSTOM_2, gaps[i]);
    }
    assert_int_equal(calls, before);
    for (int i = 0; i < 2000; i++) {
        const nt_law_value truth = mixed(&honest, gaps[i]);
        worst = larger(worst, fabs(values[i].F - truth.F));
        worst_stiffness = larger(worst_stiffness, fabs(values[i].k - truth.k));
    }
    assert_true(worst <= term->bound * plan.scale);
    assert_true(worst > 0.0 && worst_stiffness <= plan.laws.custom_2.stiffness_error);
}

/* It adds to the rest, on any history, and U is its energy: around a way out and back nothing is won. */
static void it_is_one_term_of_the_sum(void **state)
{
    (void)state;
    const nt_scene scene = with(&honest);
    nt_scene bare = scene;
    static nt_plan without;
    const nt_interaction_state apart = {0};
    bare.custom[1].name[0] = '\0';
    const nt_plan_inputs inputs = {.scene = &bare};
    assert_int_equal(nt_plan_make(&without, &inputs, NULL), NT_OK);
    assert_int_equal(make(&scene, 0.01), NT_OK);
    assert_int_equal(without.terms[NT_PLAN_CUSTOM_2].form, NT_FORM_OFF);
    for (double gap = 0.5e-9; gap < 20e-9; gap *= 1.3) {
        const double sum = nt_interaction_eval_gap(&without, &apart, NULL, gap).F + mixed(&honest, gap).F;
        assert_true(fabs(nt_interaction_eval_gap(&plan, &apart, NULL, gap).F - sum) < 0.02 * plan.scale);
        const double step = 1e-4 * gap;
        const nt_law_value less = nt_plan_term_eval(&plan, NT_PLAN_CUSTOM_2, gap - step);
        const nt_law_value more = nt_plan_term_eval(&plan, NT_PLAN_CUSTOM_2, gap + step);
        const nt_law_value here = nt_plan_term_eval(&plan, NT_PLAN_CUSTOM_2, gap);
        assert_true(fabs((less.U - more.U) / (2.0 * step) - here.F) < 1e-6 * 8e-9);
        assert_true(fabs(here.F / nt_plan_term_pressure(&plan, NT_PLAN_CUSTOM_2, gap).energy / 6.283185307179586 /
                             scene.tip.radius -
                         1.0) < 1e-12);
    }
    assert_true(nt_plan_term_eval(&plan, NT_PLAN_CUSTOM_2, 0.0).F ==
                nt_plan_term_eval(&plan, NT_PLAN_CUSTOM_2, scene.adhesion.equilibrium_distance).F);
    assert_true(isnan(nt_plan_term_eval(&plan, NT_PLAN_CUSTOM_2, NAN).F));
    assert_true(nt_plan_term_eval(&plan, NT_PLAN_CUSTOM_2, INFINITY).U == 0.0);
    static nt_plan copy;
    nt_plan_copy(&copy, &plan);
    assert_ptr_equal(copy.terms[NT_PLAN_CUSTOM_2].name, copy.laws.custom_2.name);
    assert_string_equal(copy.terms[NT_PLAN_CUSTOM_2].name, "gel");
}

/* Left out where it cannot be felt, by the bound that was stated. */
static void what_is_left_out_counts_by_its_bound(void **state)
{
    (void)state;
    const mixture faint = {1e-14, 1e-14, 0.0, 3.0, 1.0, 1.0};
    const nt_scene scene = with(&faint);
    assert_int_equal(make(&scene, 0.01), NT_OK);
    const nt_plan_term *term = &plan.terms[NT_PLAN_CUSTOM_2];
    const double stated = bound_of_mixed(&faint, scene.adhesion.equilibrium_distance);
    assert_int_equal(term->form, NT_FORM_OFF);
    assert_true(fabs(term->bound * plan.scale / stated - 1.0) < 1e-9);
    assert_true(plan.bound.force_error <= 0.01);
}

static double endless(const void *context, double gap)
{
    (void)context;
    (void)gap;
    return INFINITY;
}

static nt_law_value broken(const void *context, double gap)
{
    (void)context;
    return (nt_law_value){.U = 0.0, .F = gap > 5e-9 ? (double)NAN : 0.0};
}

/* What a law states of itself is compared with samples. */
static void what_is_stated_wrongly_is_refused(void **state)
{
    (void)state;
    const mixture short_bound = {8e-9, 3e-9, 1e-28, 0.5, 1.0, 1.0}, other_force = {8e-9, 3e-9, 1e-28, 1.1, 1.05, 1.0};
    const mixture other_stiffness = {8e-9, 3e-9, 1e-28, 1.0, 1.0, 1.5};
    nt_scene scene = with(&short_bound);
    assert_int_equal(make(&scene, 0.01), NT_E_RANGE);
    assert_string_equal(problem.field, "custom[1].bound");
    assert_true(problem.value < problem.minimum && strcmp(problem.unit, "N") == 0);
    scene = with(&other_force);
    assert_int_equal(make(&scene, 0.01), NT_E_RANGE);
    assert_string_equal(problem.field, "custom[1].law");
    scene = with(&other_stiffness);
    assert_int_equal(make(&scene, 0.01), NT_E_RANGE);
    assert_string_equal(problem.field, "custom[1].law");
    scene = with(&honest);
    scene.custom[1].bound = endless;
    assert_int_equal(make(&scene, 0.01), NT_E_RANGE);
    assert_string_equal(problem.field, "custom[1].bound");
    scene = with(&honest);
    scene.custom[1].law = broken;
    assert_int_equal(make(&scene, 0.01), NT_E_NOT_FINITE);
    assert_true(problem.value > 5e-9);
    scene.custom[1].law = NULL;
    assert_int_equal(make(&scene, 0.01), NT_E_ARGUMENT);
}

/* A brush has an edge, where k has a kink: refined there, not refused. */
static nt_law_value edged(const void *context, double gap)
{
    const double reach = *(const double *)context, rest = gap < reach ? reach - gap : 0.0;
    return (nt_law_value){.U = 0.005 * rest * rest, .F = 0.01 * rest, .k = rest > 0.0 ? 0.01 : 0.0};
}

static double bound_of_edged(const void *context, double gap)
{
    return edged(context, gap).F;
}

static void a_kink_is_no_error(void **state)
{
    (void)state;
    static const double reaches[] = {0.1e-9, 0.2001e-9, 7.3e-9, 1e-6}; /* also inside z0, and just beyond it */
    for (int i = 0; i < 4; i++) {
        nt_scene scene = with(&honest);
        scene.custom[0] = (nt_custom_term){"wall", edged, bound_of_edged, &reaches[i]};
        assert_int_equal(make(&scene, 1e-3), NT_OK);
        const double error = plan.laws.custom_1.force_error, z0 = scene.adhesion.equilibrium_distance;
        for (double gap = z0; gap < 2e-6; gap *= 1.01)
            assert_true(fabs(nt_plan_term_eval(&plan, NT_PLAN_CUSTOM_1, gap).F - edged(&reaches[i], gap).F) <= error);
        assert_true(error <= 1e-3 * edged(&reaches[i], z0).F);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plan_computes_it_within_the_error_it_states),
        cmocka_unit_test(it_is_one_term_of_the_sum),
        cmocka_unit_test(what_is_left_out_counts_by_its_bound),
        cmocka_unit_test(what_is_stated_wrongly_is_refused),
        cmocka_unit_test(a_kink_is_no_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
