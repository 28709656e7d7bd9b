/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/plan.h"

#define PI 3.14159265358979323846

static nt_plan plan_of(const nt_scene *scene, const nt_demand *demand)
{
    nt_plan plan;
    assert_int_equal(nt_plan_make(&plan, scene, demand, NULL, NULL), NT_OK);
    return plan;
}

static nt_scene dry_silicon(void)
{
    nt_scene scene = nt_scene_defaults();
    scene.medium.relative_humidity = 0.0;
    return scene;
}

/* E = 0.6 MPa, R = 30 nm, w = 0.144 J/m^2 (erratum E13): lambda in the hundreds. */
static nt_scene rubber(void)
{
    nt_scene scene = dry_silicon();
    scene.tip.radius = 30e-9;
    scene.sample.youngs_modulus = 0.6e6;
    scene.sample.poisson_ratio = 0.49;
    scene.adhesion.work_of_adhesion = 0.144;
    return scene;
}

static void the_contact_law_follows_from_the_scene(void **state)
{
    (void)state;
    const nt_demand demand = nt_demand_defaults();
    const nt_scene silicon = nt_scene_defaults(), soft = rubber();
    nt_scene none = dry_silicon();
    none.adhesion.work_of_adhesion = 0.0;
    assert_int_equal(plan_of(&silicon, &demand).contact.model, NT_MAUGIS);
    assert_string_equal(plan_of(&silicon, &demand).terms[NT_PLAN_CONTACT].name, "maugis");
    assert_int_equal(plan_of(&soft, &demand).contact.model, NT_JKR);
    assert_int_equal(plan_of(&none, &demand).contact.model, NT_HERTZ);
    nt_demand coarse = demand;
    coarse.force_floor = 1e-6; /* no adhesion can be felt */
    assert_int_equal(plan_of(&silicon, &coarse).contact.model, NT_HERTZ);
}

/* Erratum E12, computed there: R = 30 nm, r1 = 1.06 nm gives lambda 0.0251 with the Laplace pressure. */
static void a_meniscus_has_the_laplace_pressure(void **state)
{
    (void)state;
    const nt_demand demand = nt_demand_defaults();
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = 30e-9;
    scene.medium.meniscus_radius = 1.06e-9;
    const nt_plan plan = plan_of(&scene, &demand);
    assert_true(fabs(plan.lambda - 0.0251) < 0.0001);
    assert_true(fabs(plan.capture_gap - 2.0 * scene.medium.film_thickness) < 1e-24);
    assert_true(plan.release_gap > 2.0 * 1.06e-9); /* retraction holds on beyond the range on approach, 2 r1 */
    scene.medium.film_thickness = 5e-9;            /* the paper's: thicker than the bridge is long (erratum E4) */
    assert_true(fabs(plan_of(&scene, &demand).capture_gap - 2.0 * 1.06e-9) < 1e-22);
}

/* JKR's F at the indentation d (reduced): a from d = a^2 - (2/3) sqrt(6 a) on the stable side, F = a^3 - sqrt(6 a^3).
 */
static double jkr_load(double d)
{
    double low = pow(1.0 / 6.0, 1.0 / 3.0), high = 100.0;
    for (int i = 0; i < 200; i++) {
        const double a = 0.5 * (low + high);
        *(a * a - 2.0 / 3.0 * sqrt(6.0 * a) < d ? &low : &high) = a;
    }
    return low * low * low - sqrt(6.0 * low * low * low);
}

/* Largest |F_JKR - F_MD| / max(|F|, P_c) over -0.95 P_c .. 10 P_c on the branch that a spring can hold. */
static double jkr_error(double lambda)
{
    nt_maugis_point point;
    double largest = 0.0, pull_off = 0.0, y = 1e-4;
    for (; y < 1e12; y *= 1.001) { /* the load fold: P falls, then rises */
        assert_int_equal(nt_maugis_at(lambda, y, &point), NT_OK);
        if (-point.P < pull_off)
            break;
        pull_off = -point.P;
    }
    for (; y < 1e12; y *= 1.001) {
        assert_int_equal(nt_maugis_at(lambda, y, &point), NT_OK);
        if (point.P < -0.95 * pull_off)
            continue;
        if (point.P > 10.0 * pull_off)
            break;
        largest = fmax(largest, fabs(jkr_load(point.d) - point.P) / fmax(fabs(point.P), pull_off));
    }
    return largest;
}

/* The bound that the plan states for JKR is above the error against Maugis-Dugdale, and not by more than half. */
static void jkr_is_as_good_as_stated(void **state)
{
    (void)state;
    static const double lambdas[] = {1.0, 2.0, 5.8, 10.0, 30.0, 100.0};
    const nt_scene soft = rubber();
    nt_demand demand = {.relative_accuracy = 0.5, .maximum_load = 1e-7};
    for (size_t i = 0; i < sizeof lambdas / sizeof *lambdas; i++) {
        nt_scene scene = soft;
        scene.adhesion.hamaker_constant = 0.0;
        const nt_plan first = plan_of(&scene, &demand);
        scene.sample.youngs_modulus *= pow(first.lambda / lambdas[i], 1.5); /* lambda goes with K^(-2/3) */
        const nt_plan plan = plan_of(&scene, &demand);
        assert_true(fabs(plan.lambda / lambdas[i] - 1.0) < 0.1); /* the tip yields, too */
        assert_int_equal(plan.contact.model, NT_JKR);
        const double error = jkr_error(plan.lambda), stated = plan.terms[NT_PLAN_CONTACT].bound;
        print_message("lambda %6.2f: JKR errs by %.3e, stated %.3e\n", plan.lambda, error, stated);
        assert_true(error <= stated && error > (lambdas[i] < 1.5 ? 0.5 : 0.66) * stated);
    }
}

/* Left out: the force that the term would have added, at its worst gap. */
static void bounds_of_what_is_left_out_are_true_maxima(void **state)
{
    (void)state;
    for (int wet = 0; wet < 2; wet++) {
        nt_scene scene = wet ? nt_scene_defaults() : dry_silicon();
        scene.adhesion.contact_potential = 0.02;
        scene.adhesion.hamaker_constant = 1e-22;
        const nt_demand coarse = {.relative_accuracy = 0.2, .maximum_load = 1e-6};
        const nt_plan plan = plan_of(&scene, &coarse);
        double vdw = 0.0, electrostatic = 0.0;
        assert_false(plan.terms[NT_PLAN_VDW].included || plan.terms[NT_PLAN_ELECTROSTATIC].included);
        for (double gap = -5e-9; gap < 100e-9; gap += 1e-12) {
            vdw = fmax(vdw, fabs(nt_vdw_eval(&plan.vdw, gap).F));
            electrostatic = fmax(electrostatic, fabs(nt_electrostatic_eval(&plan.electrostatic, gap).F));
        }
        assert_true(fabs(plan.terms[NT_PLAN_VDW].bound / vdw - 1.0) < 1e-12 && vdw > 0.0);
        assert_true(fabs(plan.terms[NT_PLAN_ELECTROSTATIC].bound / electrostatic - 1.0) < 1e-12 && electrostatic > 0.0);
    }
}

/* A coarse plan against one that leaves nothing out: all that it costs is within the demand. The branch down to the
 * load fold, and before capture; between them the plans have their folds. */
static void a_plan_keeps_the_demand(void **state)
{
    (void)state;
    static const double demands[] = {0.003, 0.01, 0.03, 0.1, 0.3}, moduli[] = {135e9, 5e9, 500e6, 50e6};
    const nt_interaction_state apart = {0}, held = {1};
    for (int i = 0; i < 5 * 4 * 2; i++) {
        nt_scene scene = i % 2 ? nt_scene_defaults() : dry_silicon();
        scene.sample.youngs_modulus = moduli[i / 10];
        scene.adhesion.contact_potential = 0.05;
        scene.adhesion.hamaker_constant = 2e-21;
        const nt_demand demand = {.relative_accuracy = demands[i / 2 % 5], .maximum_load = 1e-6};
        const nt_demand strict = {.relative_accuracy = 1e-6, .maximum_load = 1e-6};
        const nt_plan coarse = plan_of(&scene, &demand), fine = plan_of(&scene, &strict);
        const double scale = fine.pull_off_force, reach = 10.0 * fine.contact.maugis.indentation_scale;
        assert_int_equal(fine.contact.model, NT_MAUGIS);
        const double far = fmax(fine.capture_gap, coarse.capture_gap) * (1.0 + 1e-12);
        for (double gap = -reach; gap < reach + far; gap += 1e-3 * reach) {
            const nt_interaction_state *history = gap > far ? &apart : &held;
            const double F = nt_interaction_eval_gap(&fine, history, gap).F;
            if (gap <= far && (F < -0.95 * scale || gap > -fine.contact.maugis.folds.pull_off_indentation *
                                                              fine.contact.maugis.indentation_scale))
                continue;
            const double error = fabs(nt_interaction_eval_gap(&coarse, history, gap).F - F) / fmax(fabs(F), scale);
            assert_true(error <= demand.relative_accuracy);
        }
    }
}

/* Without adhesion: k = 2 E* a = (6 E*^2 R F)^(1/3), a = (3 F R/(4 E*))^(1/3). */
static void stiffness_is_that_of_the_largest_load(void **state)
{
    (void)state;
    nt_scene scene = dry_silicon();
    scene.adhesion.work_of_adhesion = 0.0;
    const nt_demand demand = nt_demand_defaults();
    const nt_plan plan = plan_of(&scene, &demand);
    const double E = 135e9 / (2.0 * (1.0 - 0.35 * 0.35)), R = 20e-9, F = demand.maximum_load;
    assert_true(fabs(plan.maximum_stiffness / cbrt(6.0 * E * E * R * F) - 1.0) < 1e-9);
    assert_true(fabs(plan.contact_strain / (cbrt(0.75 * F * R / E) / R) - 1.0) < 1e-9);
    /* with adhesion: the slope of the law where it carries the load */
    const nt_scene wet = nt_scene_defaults();
    const nt_plan sticky = plan_of(&wet, &demand);
    double indentation;
    nt_law_value value;
    assert_int_equal(nt_maugis_indentation(&sticky.contact.maugis, F, NT_BRANCH_STABLE, &indentation, NULL), NT_OK);
    assert_int_equal(nt_maugis_eval(&sticky.contact.maugis, indentation, NT_BRANCH_STABLE, &value, NULL), NT_OK);
    assert_true(fabs(sticky.maximum_stiffness / value.k - 1.0) < 1e-9);
}

/* Tail and contact share w (erratum E5b): the rigid limit pulls 2 pi R w, not more; with a meniscus 4 pi R gamma_L. */
static void adhesion_is_not_counted_twice(void **state)
{
    (void)state;
    const nt_demand demand = {.relative_accuracy = 1e-6, .maximum_load = 1e-6};
    nt_scene scene = dry_silicon();
    scene.tip.youngs_modulus = scene.sample.youngs_modulus = 1e13;
    scene.tip.radius = 1e-9; /* lambda = 0.0087: P_c = -2 + 1.72 lambda^1.5 */
    nt_plan plan = plan_of(&scene, &demand);
    assert_true(plan.terms[NT_PLAN_VDW].included && plan.terms[NT_PLAN_VDW].bound > 0.05 * plan.pull_off_force);
    assert_true(fabs(plan.pull_off_force / (2.0 * PI * scene.tip.radius * scene.adhesion.work_of_adhesion) - 1.0) <
                1e-3);
    scene.medium.relative_humidity = 0.4;
    plan = plan_of(&scene, &demand);
    assert_true(fabs(plan.pull_off_force / (4.0 * PI * scene.tip.radius * 0.072) - 1.0) < 1e-3);
}

static void what_cannot_be_is_refused_by_name(void **state)
{
    (void)state;
    const nt_demand demand = nt_demand_defaults();
    nt_plan plan = {.capture_gap = 42.0};
    nt_problem problem = {0};
    nt_scene scene = dry_silicon();
    scene.adhesion.hamaker_constant = 1e-17; /* pulls more than w = 0.1 J/m^2 does */
    assert_int_equal(nt_plan_make(&plan, &scene, &demand, NULL, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "adhesion.hamaker_constant");
    assert_true(problem.maximum < 1e-17 && problem.maximum > 1e-19);
    scene.adhesion.hamaker_constant = 0.999 * problem.maximum; /* the stated end of the range is the true one */
    nt_plan allowed;
    assert_int_equal(nt_plan_make(&allowed, &scene, &demand, NULL, &problem), NT_OK);
    scene = nt_scene_defaults();
    scene.tip.radius = -1.0;
    assert_int_equal(nt_plan_make(&plan, &scene, &demand, NULL, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "tip.radius");
    scene = nt_scene_defaults();
    nt_demand wrong = demand;
    wrong.relative_accuracy = 0.0;
    assert_int_equal(nt_plan_make(&plan, &scene, &wrong, NULL, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "demand.relative_accuracy");
    wrong = demand;
    wrong.maximum_load = NAN;
    assert_int_equal(nt_plan_make(&plan, &scene, &wrong, NULL, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "demand.maximum_load");
    assert_true(plan.capture_gap == 42.0); /* untouched */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_contact_law_follows_from_the_scene),
        cmocka_unit_test(a_meniscus_has_the_laplace_pressure),
        cmocka_unit_test(jkr_is_as_good_as_stated),
        cmocka_unit_test(bounds_of_what_is_left_out_are_true_maxima),
        cmocka_unit_test(a_plan_keeps_the_demand),
        cmocka_unit_test(stiffness_is_that_of_the_largest_load),
        cmocka_unit_test(adhesion_is_not_counted_twice),
        cmocka_unit_test(what_cannot_be_is_refused_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
