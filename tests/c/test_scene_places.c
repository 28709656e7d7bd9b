/* SPDX-License-Identifier: BSD-3-Clause
 * A surface that is made of something else at each place: one potential of x, y and z, bounds and facts over all of it.
 * The truth is the exact solver for a contact whose E* and w were put together here. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "internal/contact.h"
#include "internal/maugis.h"
#include "internal/plan.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/interaction.h"
#include "scene/scene.h"

enum { N = 24, CASES = 4 };
static const double PIXEL = 6e-9;
static double coefficients[N * N], ratios[N * N], modulus[N * N], work[N * N];
static nt_surface surface;
static nt_radius_map radii;
static nt_properties properties;
static nt_maugis_bank bank;
static nt_maugis_bank_memory memory;
static nt_plan plan;

/* Dry and wet, with a tail; Hertz; a cone. */
static nt_scene scene_of(int which)
{
    nt_scene scene = nt_scene_defaults();
    scene.adhesion.hamaker_constant = which < 2 ? 1e-20 : 0.0;
    scene.range.maximum_load = 50e-9;
    if (which != 1)
        scene.medium.relative_humidity = 0.0;
    if (which == 3)
        scene.tip.shape = NT_SHAPE_CONE;
    return scene;
}

static int has_adhesion(int which)
{
    return which < 2;
}

static int set_up(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(1);
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++) {
            coefficients[j * N + i] = 1e-9 * sin(0.5 * i + 0.1 * j) + 0.7e-9 * cos(0.4 * j);
            modulus[j * N + i] = 2e9 * exp(3.0 * nt_random_uniform(&random));
            work[j * N + i] = 0.03 * exp(1.5 * nt_random_uniform(&random));
        }
    const nt_height_map map = {coefficients, N, N, PIXEL, PIXEL};
    return nt_surface_init(&surface, &map, coefficients) != NT_OK ||
           nt_radius_map_init(&radii, &surface, scene_of(0).tip.radius, NULL, ratios) != NT_OK;
}

static void clear_bank(void)
{
    free(memory.panels);
    free(memory.cells);
    memory = (nt_maugis_bank_memory){0};
    bank = (nt_maugis_bank){0};
}

static int tear_down(void **state)
{
    (void)state;
    clear_bank();
    return 0;
}

/* The plan with its bank, as a terrain makes it. */
static nt_status make(const nt_scene *scene, double accuracy, nt_quantity quantity, nt_problem *problem)
{
    nt_demand demand = nt_demand_defaults();
    demand.relative_accuracy = accuracy;
    demand.bound = accuracy > 0.0 ? NT_BOUND_KEPT : NT_BOUND_EXACT;
    demand.quantity = quantity;
    nt_plan_inputs inputs = {
        .scene = scene, .demand = &demand, .surface = &surface, .radii = &radii, .properties = &properties};
    nt_maugis_bank_options options;
    nt_status status = nt_plan_begin(&plan, &inputs, problem);
    clear_bank();
    if (status == NT_OK && nt_plan_wants_bank(&plan, &options)) {
        assert_int_equal(nt_maugis_bank_size(&options, &memory), NT_OK);
        memory.panels = calloc((size_t)memory.panel_capacity, sizeof *memory.panels);
        memory.cells = calloc((size_t)memory.cell_capacity, sizeof *memory.cells);
        assert_int_equal(nt_maugis_bank_init(&bank, &options, &memory), NT_OK);
        inputs.bank = &bank;
    }
    return status == NT_OK ? nt_plan_decide(&plan, &inputs, problem) : status;
}

static void give(int which)
{
    assert_int_equal(nt_properties_init(&properties, &surface, modulus, has_adhesion(which) ? work : NULL, NULL),
                     NT_OK);
    nt_scene scene = scene_of(which);
    if (!has_adhesion(which))
        scene.adhesion.work_of_adhesion = 0.0;
    nt_problem problem = {0};
    const nt_status status = make(&scene, 0.02, NT_QUANTITY_FORCE, &problem);
    if (status != NT_OK)
        fail_msg("%d: %s = %g, %g .. %g", which, problem.field, problem.value, problem.minimum, problem.maximum);
}

static double energy_at(const nt_interaction_state *state, nt_pose pose)
{
    return nt_interaction_eval(&plan, state, &pose).U;
}

static nt_pose pose_at(nt_random *random, double deepest, double highest, nt_place *place)
{
    const double x = (10 + 110 * nt_random_uniform(random)) * 1e-9, y = (10 + 110 * nt_random_uniform(random)) * 1e-9;
    *place = nt_interaction_place(&plan, x, y);
    return (nt_pose){x, y, place->surface.z - deepest + (deepest + highest) * nt_random_uniform(random)};
}

static void force_is_minus_the_gradient(void **state)
{
    (void)state;
    const double h = 1e-13;
    for (int which = 0; which < CASES; which++) {
        nt_random random = nt_random_seed(3);
        give(which);
        double by_properties = 0.0;
        for (int n = 0; n < 1000; n++) {
            const nt_interaction_state held = {1, 0.0, 0.0};
            nt_place place;
            const nt_pose p = pose_at(&random, 1e-9, 0.0, &place);
            const nt_interaction_value v = nt_interaction_eval(&plan, &held, &p);
            const double x = p.x, y = p.y, z = p.z;
            const double dx = energy_at(&held, (nt_pose){x + h, y, z}) - energy_at(&held, (nt_pose){x - h, y, z});
            const double dy = energy_at(&held, (nt_pose){x, y + h, z}) - energy_at(&held, (nt_pose){x, y - h, z});
            const double dz = energy_at(&held, (nt_pose){x, y, z + h}) - energy_at(&held, (nt_pose){x, y, z - h});
            const double tolerance = 1e-13 + 1e-6 * fabs(v.Fz);
            assert_true(fabs(v.Fx + dx / (2 * h)) < tolerance);
            assert_true(fabs(v.Fy + dy / (2 * h)) < tolerance);
            assert_true(fabs(v.Fz + dz / (2 * h)) < tolerance);
            by_properties = larger(by_properties, fabs(v.Fx + v.Fz * place.surface.zx) / plan.scale);
        }
        assert_true(by_properties > 0.01); /* what F z_x alone would have missed */
    }
}

/* The contact at a place, from its own numbers. */
static nt_contact truth_of(const nt_scene *scene, const nt_place *place)
{
    const nt_material tip = {scene->tip.youngs_modulus, scene->tip.poisson_ratio};
    const nt_material sample = {place->youngs_modulus.value, scene->sample.poisson_ratio};
    nt_contact contact = {place->radius.radius, nt_effective_modulus(tip, sample), 0.0, 0.0};
    const double w = place->work_of_adhesion.value - plan.tail;
    const double range = plan.source == NT_ADHESION_MENISCUS
                             ? 2.0 * nt_scene_meniscus_radius(scene)
                             : 0.1 / nt_cohesive_stress_atomic(0.1, scene->adhesion.equilibrium_distance);
    if (place->work_of_adhesion.value > 0.0) {
        contact.work_of_adhesion = w;
        contact.cohesive_stress = w / range;
    }
    return contact;
}

/* Force and stiffness at a gap by the exact solver and the full laws. */
static nt_law_value exact_at(const nt_contact *contact, double gap)
{
    const nt_law_value beside = nt_plan_term_eval(&plan, NT_PLAN_VDW, gap);
    const double ratio = contact->radius / plan.contact.radius;
    nt_law_value law;
    nt_maugis maugis;
    if (plan.source == NT_ADHESION_NONE)
        return plan.shape.kind == NT_SHAPE_CONE ? nt_cone_eval(contact->effective_modulus, plan.shape.half_angle, -gap)
                                                : nt_hertz_eval(contact, -gap);
    assert_int_equal(nt_maugis_init(&maugis, contact), NT_OK);
    assert_int_equal(nt_maugis_eval(&maugis, -gap, NT_BRANCH_STABLE, &law, NULL), NT_OK);
    law.F += ratio * beside.F;
    law.k += ratio * beside.k;
    return law;
}

/* At random places and gaps no error is above the bound, of force and of stiffness. */
static void bounds_hold_at_every_place(void **state)
{
    (void)state;
    static const nt_quantity quantities[] = {NT_QUANTITY_FORCE, NT_QUANTITY_STIFFNESS};
    static const double demands[] = {0.1, 1e-2, 1e-4};
    int made = 0;
    for (int which = 0; which < CASES; which++) {
        give(which);
        nt_scene scene = scene_of(which);
        if (!has_adhesion(which))
            scene.adhesion.work_of_adhesion = 0.0;
        for (int q = 0; q < 6; q++) {
            if (q >= 2) /* what a tail does to the soft places cannot be planned so well */
                scene.adhesion.hamaker_constant = 0.0;
            if (make(&scene, demands[q / 2], quantities[q % 2], NULL) != NT_OK)
                continue; /* so soft that it deforms under van der Waals before contact */
            made++;
            nt_random random = nt_random_seed((uint64_t)q);
            double worst = 0.0;
            for (int n = 0; n < 600; n++) {
                const nt_interaction_state held = {1, 0.0, 0.0};
                nt_place place;
                const nt_pose p = pose_at(&random, 2e-9, 0.5e-9, &place);
                const nt_contact contact = truth_of(&scene, &place);
                nt_maugis maugis;
                assert_int_equal(nt_maugis_init(&maugis, &contact), NT_OK);
                const double fold =
                    has_adhesion(which) ? -maugis.folds.grip_indentation * maugis.indentation_scale : 0.0;
                const double touch =
                    has_adhesion(which) ? -maugis.folds.touch_indentation * maugis.indentation_scale : 0.0;
                const double gap = p.z - place.surface.z;
                if (gap > fold - plan.fold_distance || fabs(gap - touch) < plan.fold_distance || fabs(gap) < 1e-15)
                    continue;
                const nt_law_value truth = exact_at(&contact, gap);
                const nt_law_value found = nt_interaction_eval_gap(&plan, &held, &place, gap);
                if (truth.F > scene.range.maximum_load)
                    continue;
                const int k = quantities[q % 2] == NT_QUANTITY_STIFFNESS;
                const double size = k ? truth.k : truth.F, off = (k ? found.k : found.F) - size;
                worst = larger(worst, fabs(off) / larger(fabs(size), plan.scale));
            }
            assert_true(worst <= plan.bound.force_error);
            assert_true(plan.bound.force_error <= demands[q / 2]);
        }
    }
    assert_true(made > 5 * CASES);
}

/* Stiffness, pull and reach of contact are nowhere worse than what others are told. */
static void others_are_told_the_worst_of_the_surface(void **state)
{
    (void)state;
    for (int which = 0; which < CASES; which++) {
        give(which);
        nt_random random = nt_random_seed(5);
        const double far = has_adhesion(which) ? nt_plan_cutoff_gap(&plan, 1e-3 * plan.scale) : 0.0;
        double stiffest = 0.0, strongest = 0.0;
        for (int n = 0; n < 20000; n++) {
            const nt_interaction_state held = {1, 0.0, 0.0};
            nt_place place;
            const nt_pose p = pose_at(&random, 3e-9, 2e-9, &place);
            const double gap = p.z - place.surface.z;
            const nt_law_value v = nt_interaction_eval_gap(&plan, &held, &place, gap);
            if (gap < 0.0 && v.F < scene_of(which).range.maximum_load)
                stiffest = larger(stiffest, v.k);
            strongest = larger(strongest, -v.F);
            if (gap > far)
                assert_true(fabs(v.F) <= 1e-3 * plan.scale);
        }
        assert_true(stiffest <= plan.maximum_stiffness && stiffest > 0.3 * plan.maximum_stiffness);
        assert_true(strongest <= plan.largest_pull_off_force);
        assert_true(!has_adhesion(which) || strongest > 0.5 * plan.largest_pull_off_force);
    }
}

/* The same everywhere as in the scene: the same law as without. */
static void properties_of_the_scene_change_nothing(void **state)
{
    (void)state;
    static double E[N * N], w[N * N];
    static nt_plan with;
    const nt_scene scene = scene_of(0);
    for (int p = 0; p < N * N; p++) {
        E[p] = scene.sample.youngs_modulus;
        w[p] = scene.adhesion.work_of_adhesion;
    }
    assert_int_equal(nt_properties_init(&properties, &surface, E, w, NULL), NT_OK);
    assert_int_equal(make(&scene, 1e-3, NT_QUANTITY_FORCE, NULL), NT_OK);
    nt_plan_copy(&with, &plan);
    const nt_plan_inputs inputs = {
        .scene = &scene, .demand = &plan.demand, .surface = &surface, .radii = &radii, .bank = &bank};
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
    nt_random random = nt_random_seed(6);
    for (int n = 0; n < 3000; n++) {
        const nt_interaction_state held = {1, 0.0, 0.0};
        nt_place place;
        const nt_pose p = pose_at(&random, 1e-9, 0.5e-9, &place);
        const nt_interaction_value a = nt_interaction_eval(&plan, &held, &p), b = nt_interaction_eval(&with, &held, &p);
        const double small = 1e-6 * plan.pull_off_force;
        assert_true(fabs(a.Fz - b.Fz) < small && fabs(a.Fx - b.Fx) < small && fabs(a.Fy - b.Fy) < small);
    }
    assert_true(fabs(with.largest_pull_off_force / plan.largest_pull_off_force - 1.0) < 1e-9);
    assert_true(fabs(with.maximum_stiffness / plan.maximum_stiffness - 1.0) < 1e-4);
}

static void assert_not_made(const nt_scene *scene, const char *words)
{
    nt_problem problem = {0};
    assert_int_equal(make(scene, 0.01, NT_QUANTITY_FORCE, &problem), NT_E_RANGE);
    assert_non_null(strstr(problem.field, words));
}

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    nt_scene scene = scene_of(0);
    assert_int_equal(nt_properties_init(&properties, &surface, modulus, work, NULL), NT_OK);
    scene.tip.shape = NT_SHAPE_CONE; /* JKR's */
    assert_not_made(&scene, "tip.shape");
    scene = scene_of(0);
    scene.adhesion.hamaker_constant = 1e-17; /* at a nanometre, too, pulls more than the least w */
    assert_not_made(&scene, "adhesion.hamaker_constant");
    nt_surface other = surface;
    other.nx--;
    assert_int_equal(nt_properties_init(&properties, &other, modulus, work, NULL), NT_OK);
    scene = scene_of(0);
    assert_int_equal(make(&scene, 0.01, NT_QUANTITY_FORCE, NULL), NT_E_ARGUMENT);
}

/* Beyond it nobody knows the error of rigid bodies: the plan gives the elastic number, and no infinite error. */
static void a_jump_of_the_sample_is_told(void **state)
{
    (void)state;
    static double E[N * N];
    for (int p = 0; p < N * N; p++)
        E[p] = 1e8;
    nt_scene scene = scene_of(0);
    scene.sample.youngs_modulus = 1e8;
    assert_int_equal(nt_properties_init(&properties, &surface, E, work, NULL), NT_OK);
    assert_int_equal(make(&scene, 0.0, NT_QUANTITY_FORCE, NULL), NT_OK);
    int found = 0;
    for (int i = 0; i < plan.warning_count; i++) {
        assert_true(plan.warnings[i].value < (double)INFINITY);
        if (strstr(plan.warnings[i].text, "sample jumps")) {
            found++;
            assert_true(plan.warnings[i].value == plan.elastic_number && plan.elastic_number > 0.55);
        }
    }
    assert_int_equal(found, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(force_is_minus_the_gradient),
        cmocka_unit_test(bounds_hold_at_every_place),
        cmocka_unit_test(others_are_told_the_worst_of_the_surface),
        cmocka_unit_test(properties_of_the_scene_change_nothing),
        cmocka_unit_test(what_cannot_be_is_refused),
        cmocka_unit_test(a_jump_of_the_sample_is_told),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
