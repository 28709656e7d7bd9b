/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/contact.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/interaction.h"
#include "nanotouch/plan.h"

#define PI 3.14159265358979323846

static nt_plan plan, full;

static nt_status make(nt_plan *made, const nt_scene *scene, const nt_demand *demand)
{
    const nt_plan_inputs inputs = {.scene = scene, .demand = demand};
    return nt_plan_make(made, &inputs, NULL);
}

static nt_scene dry_silicon(void)
{
    nt_scene scene = nt_scene_defaults();
    scene.medium.relative_humidity = 0.0;
    return scene;
}

static nt_form contact_form(const nt_scene *scene, const nt_demand *demand)
{
    assert_int_equal(make(&plan, scene, demand), NT_OK);
    return plan.terms[NT_PLAN_CONTACT].form;
}

static void the_contact_law_follows_from_the_scene(void **state)
{
    (void)state;
    nt_demand demand = nt_demand_defaults();
    const nt_scene silicon = nt_scene_defaults();
    nt_scene none = dry_silicon(), cone = dry_silicon(), far = dry_silicon(), tailless = silicon;
    none.adhesion.work_of_adhesion = none.adhesion.hamaker_constant = 0.0; /* under a pull the sample would deform */
    cone.tip.shape = NT_SHAPE_CONE;
    far.range.minimum_gap = 10e-9;
    tailless.adhesion.hamaker_constant = 0.0; /* with a tail the sample deforms, and its table has no such bound */
    assert_int_equal(contact_form(&silicon, &demand), NT_FORM_TABLE);
    assert_int_equal(contact_form(&none, &demand), NT_FORM_SHAPE);
    assert_int_equal(contact_form(&cone, &demand), NT_FORM_JKR);
    assert_int_equal(contact_form(&far, &demand), NT_FORM_OFF); /* never touches */
    demand.relative_accuracy = 1e-8;                            /* below the table's error */
    assert_int_equal(contact_form(&tailless, &demand), NT_FORM_POLISHED);
    demand.bound = NT_BOUND_EXACT; /* everything, exact */
    assert_int_equal(contact_form(&silicon, &demand), NT_FORM_POLISHED);
    demand.bound = NT_BOUND_KEPT;
    demand.relative_accuracy = 0.01;
    demand.force_floor = 1e-6; /* no adhesion can be felt */
    assert_int_equal(contact_form(&silicon, &demand), NT_FORM_SHAPE);
}

/* Erratum E12, computed there: R = 30 nm, r1 = 1.06 nm gives lambda 0.0251 with the Laplace pressure. */
static void a_meniscus_has_the_laplace_pressure(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = 30e-9;
    scene.medium.meniscus_radius = 1.06e-9;
    scene.adhesion.hamaker_constant = 0.0; /* nothing is taken out of w */
    assert_int_equal(make(&plan, &scene, NULL), NT_OK);
    assert_true(fabs(plan.lambda - 0.0251) < 0.0001);
    assert_true(fabs(plan.capture_gap - 2.0 * scene.medium.film_thickness) < 1e-24);
    assert_true(plan.release_gap > 2.0 * 1.06e-9); /* retraction holds on beyond the range on approach, 2 r1 */
    scene.medium.film_thickness = 5e-9;            /* the paper's: thicker than the bridge is long (erratum E4) */
    assert_int_equal(make(&plan, &scene, NULL), NT_OK);
    assert_true(fabs(plan.capture_gap - 2.0 * 1.06e-9) < 1e-22);
}

/* JKR is the limit of Maugis-Dugdale: 0.09/lambda^2 of max(|F|, P_c) between -0.95 and 10 P_c (measured with the
 * one-parameter form on 4687 states). */
static void the_error_of_jkr_is_told(void **state)
{
    (void)state;
    nt_scene scene = dry_silicon();
    scene.tip.radius = 30e-9;
    scene.adhesion.hamaker_constant = 0.0;
    scene.sample.poisson_ratio = 0.49;
    for (double E = 0.6e6; E < 1e8; E *= 3.0) {
        scene.sample.youngs_modulus = E;
        assert_int_equal(make(&plan, &scene, NULL), NT_OK);
        scene.range.maximum_load = 10.0 * plan.pull_off_force;
        assert_int_equal(make(&plan, &scene, NULL), NT_OK);
        const double stated = 0.09 / (plan.lambda * plan.lambda);
        print_message("lambda %6.2f: JKR errs by %.3e, 0.09/lambda^2 = %.3e\n", plan.lambda, plan.rivals.jkr, stated);
        assert_true(plan.rivals.jkr < 1.5 * stated && plan.rivals.jkr > 0.3 * stated);
        assert_true(plan.rivals.hertz > 0.5 && plan.rivals.dmt > 0.1);
    }
}

/* Left out: the largest force that the term would have added. */
static void bounds_of_what_is_left_out_are_true_maxima(void **state)
{
    (void)state;
    const nt_demand coarse = {.relative_accuracy = 0.3};
    for (int wet = 0; wet < 2; wet++) {
        nt_scene scene = wet ? nt_scene_defaults() : dry_silicon();
        scene.adhesion.contact_potential = 0.02;
        scene.adhesion.hamaker_constant = 1e-22;
        scene.sample.charge = 1e-20;
        assert_int_equal(make(&plan, &scene, &coarse), NT_OK);
        for (int term = NT_PLAN_VDW; term <= NT_PLAN_CHARGE; term++) {
            double largest = 0.0;
            assert_int_equal(plan.terms[term].form, NT_FORM_OFF);
            for (double gap = -5e-9; gap < 100e-9; gap += 1e-12) {
                const double F = term == NT_PLAN_VDW ? nt_vdw_eval(&plan.laws.vdw.sphere, gap).F
                                 : term == NT_PLAN_ELECTROSTATIC
                                     ? nt_electrostatic_eval(&plan.laws.electrostatic.sphere, gap).F
                                     : nt_point_charge_eval(&plan.laws.charge, gap).F;
                largest = larger(largest, fabs(F));
            }
            assert_true(largest > 0.0 && fabs(plan.terms[term].force / largest - 1.0) < 1e-9);
            assert_true(fabs(plan.terms[term].bound * plan.scale / largest - 1.0) < 1e-9);
        }
    }
}

/* Any scene near the defaults, any demand: the planned force against everything-on, on both histories. The bound is
 * that of the plan, not the demand. */
static void a_plan_keeps_its_bound(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(5);
    int made = 0;
    for (int n = 0; n < 200; n++) {
        nt_scene scene = n % 2 ? nt_scene_defaults() : dry_silicon();
        const nt_demand demand = {.relative_accuracy = pow(10.0, -6.0 + 5.4 * nt_random_uniform(&random))};
        const nt_demand exact = {.bound = NT_BOUND_EXACT};
        scene.sample.youngs_modulus = pow(10.0, 9.0 + 3.0 * nt_random_uniform(&random));
        scene.adhesion.contact_potential = nt_random_uniform(&random);
        scene.adhesion.hamaker_constant = pow(10.0, -22.0 + 3.0 * nt_random_uniform(&random));
        scene.tip.height = n % 3 ? 0.0 : 1e-5;
        if (make(&plan, &scene, &demand) != NT_OK)
            continue;
        assert_int_equal(make(&full, &scene, &exact), NT_OK);
        if ((plan.deformation.count > 0) != (full.deformation.count > 0))
            continue; /* of a sample that deforms the truth is nanotouch.reference's */
        made++;
        const double bound = plan.bound.force_error + full.bound.force_error;
        for (double gap = -3.0 * full.release_gap; gap < 100e-9; gap += 0.01 * full.release_gap + 0.01 * fabs(gap))
            for (int attached = 0; attached < 2; attached++) {
                const nt_interaction_state history = {attached, 0.0, 0.0};
                const double F = nt_interaction_eval_gap(&full, &history, NULL, gap).F;
                const double error = fabs(nt_interaction_eval_gap(&plan, &history, NULL, gap).F - F);
                if (fabs(gap - full.release_gap) > 1e-6 * full.release_gap)
                    assert_true(error <= bound * larger(fabs(F), full.pull_off_force));
            }
        const double rigid = plan.deformation.count > 0 ? 0.0 : larger(plan.rigid_error, plan.around_error);
        const double beyond = rigid >= demand.relative_accuracy ? rigid * (1.0 + 1e-12) : 0.0; /* which is warned of */
        assert_true(plan.bound.force_error <= demand.relative_accuracy + beyond && plan.cost <= full.cost);
    }
    assert_true(made > 100);
}

/* Without adhesion: k = 2 E* a = (6 E*^2 R F)^(1/3), a = (3 F R/(4 E*))^(1/3). */
static void stiffness_is_that_of_the_largest_load(void **state)
{
    (void)state;
    nt_scene scene = dry_silicon();
    scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
    assert_int_equal(make(&plan, &scene, NULL), NT_OK);
    const double E = 135e9 / (2.0 * (1.0 - 0.35 * 0.35)), R = 20e-9, F = scene.range.maximum_load;
    assert_true(fabs(plan.maximum_stiffness / cbrt(6.0 * E * E * R * F) - 1.0) < 1e-9);
    assert_true(fabs(plan.validity.radius_ratio / (cbrt(0.75 * F * R / E) / R) - 1.0) < 1e-9);
    /* with adhesion: the slope of the law where it carries the load */
    const nt_scene wet = nt_scene_defaults();
    assert_int_equal(make(&plan, &wet, NULL), NT_OK);
    double indentation;
    nt_law_value value;
    assert_int_equal(nt_maugis_indentation(&plan.maugis, F, NT_BRANCH_STABLE, &indentation, NULL), NT_OK);
    assert_int_equal(nt_maugis_eval(&plan.maugis, indentation, NT_BRANCH_STABLE, &value, NULL), NT_OK);
    assert_true(fabs(plan.maximum_stiffness / value.k - 1.0) < 1e-9);
}

/* Tail and contact share w (erratum E5b): the rigid limit pulls 2 pi R w, not more; with a meniscus 4 pi R gamma_L. */
static void adhesion_is_not_counted_twice(void **state)
{
    (void)state;
    const nt_demand demand = {.relative_accuracy = 1e-6};
    nt_scene scene = dry_silicon();
    scene.tip.youngs_modulus = scene.sample.youngs_modulus = 1e13;
    scene.tip.radius = 1e-9; /* lambda = 0.0087: P_c = -2 + 1.72 lambda^1.5 */
    scene.range.maximum_load = 1e-8;
    assert_int_equal(make(&plan, &scene, &demand), NT_OK);
    assert_true(plan.terms[NT_PLAN_VDW].form != NT_FORM_OFF);
    assert_true(plan.terms[NT_PLAN_VDW].force > 0.05 * plan.pull_off_force);
    assert_true(fabs(plan.pull_off_force / (2.0 * PI * scene.tip.radius * scene.adhesion.work_of_adhesion) - 1.0) <
                1e-3);
    scene.medium.relative_humidity = 0.4;
    assert_int_equal(make(&plan, &scene, &demand), NT_OK);
    assert_true(fabs(plan.pull_off_force / (4.0 * PI * scene.tip.radius * 0.072) - 1.0) < 1e-3);
}

/* Tails of a vanishing gap: at the cut-off the bound of the force is met, and a little closer it is not. */
static void numbers_for_integrators_are_bounds(void **state)
{
    (void)state;
    const nt_scene scene = dry_silicon();
    const nt_interaction_state apart = {0, 0.0, 0.0};
    assert_int_equal(make(&plan, &scene, NULL), NT_OK);
    const double cutoff = nt_plan_cutoff_gap(&plan, 1e-12);
    assert_true(fabs(nt_interaction_eval_gap(&plan, &apart, NULL, cutoff).F) <= 1e-12);
    assert_true(fabs(nt_interaction_eval_gap(&plan, &apart, NULL, 0.999 * cutoff).F) > 1e-12);
    assert_true(isinf(nt_plan_cutoff_gap(&plan, 0.0)));
    nt_scene bare = scene;
    bare.adhesion.hamaker_constant = 0.0; /* Dugdale's stress has a range: beyond it there is nothing */
    assert_int_equal(make(&plan, &bare, NULL), NT_OK);
    assert_true(nt_plan_cutoff_gap(&plan, 0.0) == larger(plan.release_gap, plan.capture_gap));
    const double mass = 1e-12;
    assert_true(fabs(nt_plan_stable_step(&plan, mass) / (2.0 * sqrt(mass / plan.maximum_stiffness)) - 1.0) < 1e-12);
}

static void expect_refusal(const nt_scene *scene, const nt_demand *demand, nt_status status, const char *field)
{
    const nt_plan_inputs inputs = {.scene = scene, .demand = demand};
    nt_problem problem = {0};
    assert_int_equal(nt_plan_make(&plan, &inputs, &problem), status);
    assert_string_equal(problem.field, field);
}

static void what_cannot_be_is_refused_by_name(void **state)
{
    (void)state;
    nt_demand demand = {.bound = NT_BOUND_EXACT};
    nt_problem problem = {0};
    nt_scene scene = dry_silicon();
    scene.adhesion.hamaker_constant = 1e-17; /* pulls more than w = 0.1 J/m^2 does */
    const nt_plan_inputs inputs = {.scene = &scene, .demand = &demand};
    assert_int_equal(nt_plan_make(&plan, &inputs, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "adhesion.hamaker_constant");
    assert_true(problem.maximum < 1e-17 && problem.maximum > 1e-19);
    scene.adhesion.hamaker_constant = 0.999 * problem.maximum; /* the stated end of the range is the true one */
    assert_int_equal(nt_plan_make(&plan, &inputs, &problem), NT_OK);
    scene = nt_scene_defaults();
    scene.tip.radius = -1.0;
    expect_refusal(&scene, &demand, NT_E_RANGE, "tip.radius");
    scene = nt_scene_defaults();
    scene.range.maximum_load = NAN;
    expect_refusal(&scene, &demand, NT_E_NOT_FINITE, "range.maximum_load");
    scene = nt_scene_defaults();
    demand = (nt_demand){.relative_accuracy = 0.0}; /* is kept by nothing, as any other below rounding */
    expect_refusal(&scene, &demand, NT_E_RANGE, "demand.relative_accuracy");
    demand.relative_accuracy = 1e-14; /* below rounding */
    expect_refusal(&scene, &demand, NT_E_RANGE, "demand.relative_accuracy");
    nt_probe probe = nt_rig_defaults().probe;
    probe.noise = NAN; /* must not pass for no noise */
    const nt_plan_inputs noisy = {.scene = &scene, .probe = &probe};
    assert_int_equal(nt_plan_make(&plan, &noisy, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "probe.noise");
    probe.noise = 0.0;
    probe.spring_constant = 0.0;
    assert_int_equal(nt_plan_make(&plan, &noisy, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "probe.spring_constant");
    demand.relative_accuracy = 1e-9;
    demand.budget = 5.0;
    expect_refusal(&scene, &demand, NT_E_RANGE, "demand.budget");
}

/* What other models err by is told of the force, whatever is demanded. */
static void rivals_are_those_of_the_force(void **state)
{
    (void)state;
    const nt_scene scene = dry_silicon();
    nt_demand demand = nt_demand_defaults();
    assert_int_equal(make(&full, &scene, &demand), NT_OK);
    for (int quantity = NT_QUANTITY_STIFFNESS; quantity <= NT_QUANTITY_FOLDS; ++quantity) {
        demand.quantity = quantity;
        demand.relative_accuracy = 0.1;
        assert_int_equal(make(&plan, &scene, &demand), NT_OK);
        assert_true(fabs(plan.rivals.hertz / full.rivals.hertz - 1.0) < 1e-12);
        assert_true(fabs(plan.rivals.jkr / full.rivals.jkr - 1.0) < 1e-12);
    }
}

/* Without adhesion no fold can be missed: the cheapest form will do, however sharp the demand. */
static void without_adhesion_there_are_no_folds(void **state)
{
    (void)state;
    nt_scene scene = dry_silicon();
    scene.tip.shape = NT_SHAPE_SPHERE;
    scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
    nt_demand demand = nt_demand_defaults();
    demand.quantity = NT_QUANTITY_FOLDS;
    demand.relative_accuracy = 1e-9;
    assert_int_equal(contact_form(&scene, &demand), NT_FORM_PARABOLOID);
    assert_true(plan.bound.force_error <= 1e-11);
}

/* With tail and potential, of contacts from JKR's to DMT's end; what no w makes is refused with what can be. */
static void measured_pull_off_is_that_of_the_whole(void **state)
{
    (void)state;
    nt_scene scene = dry_silicon();
    nt_problem problem = {0};
    const nt_demand within = {.relative_accuracy = 0.1}, exact = {.bound = NT_BOUND_EXACT};
    int deformed = 0;
    scene.adhesion.given = NT_ADHESION_GIVEN_PULL_OFF;
    scene.adhesion.contact_potential = 0.5;
    for (double modulus = 1e5; modulus < 1e12; modulus *= 100.0)
        for (int shape = 0; shape < 4; ++shape) {
            static const nt_shape_kind kinds[] = {NT_SHAPE_PARABOLOID, NT_SHAPE_SPHERE, NT_SHAPE_CONE, NT_SHAPE_PUNCH};
            scene.tip.shape = kinds[shape];
            scene.sample.youngs_modulus = modulus;
            scene.adhesion.pull_off_force = 12e-9;
            assert_int_equal(make(&plan, &scene, shape < 2 ? &within : &exact), NT_OK);
            assert_true(fabs(plan.pull_off_force / 12e-9 - 1.0) < 1e-9);
            deformed += plan.deformation.count > 0;
        }
    assert_true(deformed >= 2);
    scene.tip.shape = NT_SHAPE_PARABOLOID;
    scene.adhesion.pull_off_force = 0.1e-9; /* the potential alone pulls more */
    const nt_plan_inputs inputs = {.scene = &scene};
    assert_int_equal(nt_plan_make(&plan, &inputs, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "adhesion.pull_off_force");
    const double ends[] = {problem.minimum, problem.maximum};
    scene.adhesion.pull_off_force = ends[0];
    assert_int_equal(make(&plan, &scene, &exact), NT_OK);
    scene.adhesion.pull_off_force = ends[1];
    assert_int_equal(make(&plan, &scene, &exact), NT_OK);
    scene.adhesion.pull_off_force = 0.9; /* w beyond any solid's */
    assert_int_equal(nt_plan_make(&plan, &inputs, &problem), NT_E_RANGE);
    assert_true(fabs(problem.minimum / ends[0] - 1.0) < 1e-6 && fabs(problem.maximum / ends[1] - 1.0) < 1e-6);
    scene.adhesion.pull_off_force = problem.maximum;
    assert_int_equal(make(&plan, &scene, NULL), NT_OK);
    for (int tail = 0; tail < 2; ++tail) { /* a bridge always pulls: none was measured is no answer */
        scene = nt_scene_defaults();
        scene.adhesion.given = NT_ADHESION_GIVEN_PULL_OFF;
        scene.adhesion.hamaker_constant *= tail;
        assert_int_equal(nt_plan_make(&plan, &inputs, &problem), NT_E_RANGE);
        assert_string_equal(problem.field, "adhesion.pull_off_force");
        assert_true(problem.minimum > 0.0);
        scene.adhesion.pull_off_force = problem.minimum;
        assert_int_equal(make(&plan, &scene, NULL), NT_OK);
        assert_true(plan.maximum_stiffness > 0.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_contact_law_follows_from_the_scene),
        cmocka_unit_test(a_meniscus_has_the_laplace_pressure),
        cmocka_unit_test(the_error_of_jkr_is_told),
        cmocka_unit_test(bounds_of_what_is_left_out_are_true_maxima),
        cmocka_unit_test(a_plan_keeps_its_bound),
        cmocka_unit_test(stiffness_is_that_of_the_largest_load),
        cmocka_unit_test(adhesion_is_not_counted_twice),
        cmocka_unit_test(numbers_for_integrators_are_bounds),
        cmocka_unit_test(what_cannot_be_is_refused_by_name),
        cmocka_unit_test(rivals_are_those_of_the_force),
        cmocka_unit_test(without_adhesion_there_are_no_folds),
        cmocka_unit_test(measured_pull_off_is_that_of_the_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
