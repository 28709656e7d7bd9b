/* SPDX-License-Identifier: BSD-3-Clause
 * What errors of a plan are measured by, and what contact bears of the terms beside it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "larger.h"
#include "nanotouch/plan.h"

static nt_plan plan;

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

/* Radii are measured by Hertz' contact radius at the largest load, (3 F R/(4 E*))^(1/3), where nothing adheres; lengths
 * of folds, forces and stiffnesses by their own. */
static void errors_have_the_scale_of_their_quantity(void **state)
{
    (void)state;
    for (double load = 1e-9; load < 2e-6; load *= 10.0) {
        nt_scene scene = dry_silicon();
        scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
        scene.tip.shape = NT_SHAPE_PARABOLOID;
        scene.tip.radius = 40e-9;
        scene.range.maximum_load = load;
        assert_int_equal(make(&plan, &scene, NULL), NT_OK);
        assert_true(fabs(plan.scale / (1e-3 * load) - 1.0) < 1e-12);
        const double E = plan.contact.effective_modulus, a = cbrt(0.75 * load * 40e-9 / E);
        const nt_demand radius = {.relative_accuracy = 0.01, .quantity = NT_QUANTITY_RADIUS};
        assert_int_equal(make(&plan, &scene, &radius), NT_OK);
        assert_true(fabs(plan.scale / a - 1.0) < 1e-9);
        const nt_demand stiff = {.relative_accuracy = 0.01, .quantity = NT_QUANTITY_STIFFNESS};
        assert_int_equal(make(&plan, &scene, &stiff), NT_OK);
        assert_true(fabs(plan.scale / (2.0 * E * a) - 1.0) < 1e-9);
    }
}

/* Contact without adhesion is off by 1e-12 of its force, of which the demanded whole is 1 + T/S: T the strongest pull
 * of all other terms, each of which is tried alone; sampled, with 5 % to spare. Under a hydration that pulls the sample
 * deforms, and contact has no form of its own. */
static void the_error_of_contact_knows_every_pull_beside_it(void **state)
{
    (void)state;
    static const int terms[] = {NT_PLAN_VDW, NT_PLAN_ELECTROSTATIC, NT_PLAN_CHARGE, NT_PLAN_DOUBLE_LAYER};
    for (int n = 0; n < 4; n++) {
        nt_scene scene = dry_silicon();
        const int liquid = terms[n] >= NT_PLAN_DOUBLE_LAYER;
        scene.tip.shape = NT_SHAPE_PARABOLOID;
        scene.adhesion.work_of_adhesion = 0.0;
        scene.adhesion.hamaker_constant = n == 0 ? 1e-19 : 0.0;
        scene.adhesion.contact_potential = n == 1 ? 1.0 : 0.0;
        scene.sample.charge = n == 2 ? 1e-18 : 0.0;
        scene.medium.kind = liquid ? NT_MEDIUM_LIQUID : scene.medium.kind;
        scene.medium.ionic_strength = n == 3 ? 1.0 : 0.0;
        scene.tip.surface_potential = n == 3 ? 0.05 : 0.0;
        scene.sample.surface_potential = n == 3 ? -0.05 : 0.0;
        if (n == 1)
            scene.tip.conducting = scene.sample.conducting = scene.sample.grounded = 1;
        const nt_demand exact = {.bound = NT_BOUND_EXACT};
        assert_int_equal(make(&plan, &scene, &exact), NT_OK);
        double pull = 0.0;
        for (double gap = 1e-13; gap < 1e-8; gap *= 1.01)
            pull = larger(pull, -nt_plan_term_eval(&plan, terms[n], gap).F);
        const double error = 1e-12 * (1.0 + pull / plan.scale);
        assert_true(pull > 0.0 && error > 1.5e-12);
        assert_true(plan.terms[NT_PLAN_CONTACT].bound > (1.0 - 1e-9) * error);
        assert_true(plan.terms[NT_PLAN_CONTACT].bound < 1.06 * error);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_have_the_scale_of_their_quantity),
        cmocka_unit_test(the_error_of_contact_knows_every_pull_beside_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
