/* SPDX-License-Identifier: BSD-3-Clause
 * The contact with the radius of each place: one potential of x, y and z, what it dissipates, what others are told. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "internal/maugis.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/interaction.h"

enum { N = 24 };
static double coefficients[N * N], ratios[N * N];
static nt_surface surface;
static nt_radius_map radii;
static nt_maugis_bank bank;
static nt_maugis_bank_memory memory;
static nt_plan plan;

static nt_scene scene_of(int wet)
{
    nt_scene scene = nt_scene_defaults();
    scene.adhesion.hamaker_constant = 2e-20;
    if (!wet)
        scene.medium.relative_humidity = 0.0;
    return scene;
}

static int set_up(void **state)
{
    (void)state;
    double heights[N * N];
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            heights[j * N + i] = 1e-9 * sin(0.5 * i + 0.1 * j) + 0.7e-9 * cos(0.4 * j);
    const nt_height_map map = {heights, N, N, 6e-9, 6e-9};
    const nt_maugis_bank_options options = nt_maugis_bank_defaults();
    if (nt_surface_init(&surface, &map, coefficients) != NT_OK ||
        nt_radius_map_init(&radii, &surface, scene_of(0).tip.radius, NULL, ratios) != NT_OK ||
        nt_maugis_bank_size(&options, &memory) != NT_OK)
        return 1;
    memory.panels = calloc((size_t)memory.panel_capacity, sizeof *memory.panels);
    memory.cells = calloc((size_t)memory.cell_capacity, sizeof *memory.cells);
    return nt_maugis_bank_init(&bank, &options, &memory) != NT_OK;
}

static int tear_down(void **state)
{
    (void)state;
    free(memory.panels);
    free(memory.cells);
    return 0;
}

static nt_status make(const nt_scene *scene, const nt_radius_map *map)
{
    const nt_plan_inputs inputs = {.scene = scene, .surface = &surface, .radii = map, .bank = &bank};
    return nt_plan_make(&plan, &inputs, NULL);
}

static double energy_at(const nt_interaction_state *state, nt_pose pose)
{
    return nt_interaction_eval(&plan, state, &pose).U;
}

/* Central differences over h = 1e-13 m, as in test_scene_interaction.c; dU/dR R_x is a tenth of F z_x here. */
static void force_is_minus_the_gradient(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(3);
    const double h = 1e-13;
    for (int wet = 0; wet < 2; wet++) {
        const nt_scene scene = scene_of(wet);
        assert_int_equal(make(&scene, &radii), NT_OK);
        assert_int_equal(plan.terms[NT_PLAN_CONTACT].form, NT_FORM_LOCAL);
        double by_radius = 0.0;
        for (int n = 0; n < 1500; n++) {
            const nt_interaction_state held = {1, 0.0, 0.0};
            const double x = (10 + 110 * nt_random_uniform(&random)) * 1e-9,
                         y = (10 + 110 * nt_random_uniform(&random)) * 1e-9;
            const nt_place place = nt_interaction_place(&plan, x, y);
            const double gap = -1.2e-9 * nt_random_uniform(&random), z = place.surface.z + gap;
            const nt_interaction_value v = nt_interaction_eval(&plan, &held, &(nt_pose){x, y, z});
            const double dx = energy_at(&held, (nt_pose){x + h, y, z}) - energy_at(&held, (nt_pose){x - h, y, z});
            const double dy = energy_at(&held, (nt_pose){x, y + h, z}) - energy_at(&held, (nt_pose){x, y - h, z});
            const double dz = energy_at(&held, (nt_pose){x, y, z + h}) - energy_at(&held, (nt_pose){x, y, z - h});
            const double tolerance = 1e-12 + 1e-6 * fabs(v.Fz);
            assert_true(fabs(v.Fx + dx / (2 * h)) < tolerance);
            assert_true(fabs(v.Fy + dy / (2 * h)) < tolerance);
            assert_true(fabs(v.Fz + dz / (2 * h)) < tolerance);
            by_radius = larger(by_radius, fabs(v.Fx + v.Fz * place.surface.zx));
        }
        assert_true(by_radius > 1e-9); /* what a sum of F z_x alone would have missed */
    }
}

/* Over every place the energy on the held side of the fold is lost, although the fold is found to rounding only. */
static void letting_go_costs_the_energy_of_the_fold(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(4);
    const nt_scene scene = scene_of(1);
    assert_int_equal(make(&scene, &radii), NT_OK);
    for (int n = 0; n < 2000; n++) {
        const nt_place place = nt_interaction_place(&plan, 140e-9 * nt_random_uniform(&random), 70e-9);
        nt_contact contact = plan.contact;
        contact.radius = place.radius.radius;
        const double fold = -nt_maugis_bank_grip_indentation(&bank, &contact);
        nt_interaction_state history = {1, 0.0, 0.0};
        nt_bank_value held;
        nt_interaction_advance_gap(&plan, &history, &place, nextafter(fold, 1.0));
        assert_int_equal(history.attached, 0);
        assert_int_equal(nt_maugis_bank_eval_radius(&bank, &contact, -fold * (1.0 - 1e-9), NT_BRANCH_STABLE, &held),
                         NT_OK);
        assert_true(fabs(history.dissipated - larger(0.0, held.law.U)) < 1e-6 * plan.pull_off_force * fold);
    }
}

/* Stiffness, pull and jump-in are those of the bluntest place, contact beyond the cut-off gap nowhere. */
static void others_are_told_the_worst_of_the_surface(void **state)
{
    (void)state;
    nt_scene scene = scene_of(0);
    scene.adhesion.hamaker_constant = 0.0;
    assert_int_equal(make(&scene, &radii), NT_OK);
    const double cutoff = nt_plan_cutoff_gap(&plan, 0.0);
    nt_random random = nt_random_seed(5);
    for (int n = 0; n < 2000; n++) {
        const double x = 140e-9 * nt_random_uniform(&random), y = 140e-9 * nt_random_uniform(&random);
        const nt_place place = nt_interaction_place(&plan, x, y);
        const nt_interaction_state held = {1, 0.0, 0.0};
        const double gap = cutoff - 4e-9 * nt_random_uniform(&random);
        const nt_law_value v = nt_interaction_eval_gap(&plan, &held, &place, gap);
        assert_true(nt_interaction_eval_gap(&plan, &held, &place, cutoff * (1.0 + 1e-9)).F == 0.0);
        if (gap < 0.0 && v.F < scene.range.maximum_load)
            assert_true(v.k <= plan.maximum_stiffness * (1.0 + 1e-9));
        if (v.k > 0.0)
            assert_true(-v.F <= plan.largest_pull_off_force * (1.0 + 1e-9));
    }
}

static void a_map_of_another_surface_is_refused(void **state)
{
    (void)state;
    const nt_scene scene = scene_of(0);
    nt_radius_map other = radii;
    other.ratio.dx *= 2.0;
    assert_int_equal(make(&scene, &other), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(force_is_minus_the_gradient),
        cmocka_unit_test(letting_go_costs_the_energy_of_the_fold),
        cmocka_unit_test(others_are_told_the_worst_of_the_surface),
        cmocka_unit_test(a_map_of_another_surface_is_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
