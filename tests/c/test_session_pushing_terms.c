/* SPDX-License-Identifier: BSD-3-Clause
 * What lies on the surface of a session, by its numbers: what a session refuses, and what it adds to the promise. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "internal/manipulation.h"
#include "internal/margins.h"
#include "larger.h"
#include "nanotouch/margins.h"
#include "session/state.h"

static nt_terrain *terrain;

static int open_terrain(void **state)
{
    (void)state;
    const nt_terrain_setup setup = nt_terrain_defaults();
    return nt_terrain_make(&terrain, &setup, NULL) == NT_OK ? 0 : 1;
}

static int close_terrain(void **state)
{
    (void)state;
    nt_terrain_close(terrain);
    return 0;
}

/* A rod as wide as the tip is sharp, so stiff that nothing goes through it. */
static nt_rod rod_of(const nt_session_setup *setup)
{
    nt_rod rod = nt_rod_defaults();
    rod.tip_radius = setup->scene.tip.radius;
    rod.tip_half_angle = setup->scene.tip.half_angle;
    rod.tip_stiffness = 1e6;
    assert_int_equal(nt_rod_check(&rod, NULL), NT_OK);
    return rod;
}

static nt_composition composition_of(const nt_rod *rod)
{
    nt_composition made;
    memset(&made, 0, sizeof made);
    made.setup = nt_session_defaults();
    made.setup.rod = rod;
    made.terrain = terrain;
    return made;
}

static void what_a_rod_cannot_be_in(void **state)
{
    (void)state;
    const nt_session_setup setup = nt_session_defaults();
    for (int i = 0; i < 5; ++i) {
        nt_rod rod = rod_of(&setup);
        nt_composition made = composition_of(&rod);
        nt_problem problem = {.field = NULL};
        const double R = setup.scene.tip.radius, psi = setup.scene.tip.half_angle;
        if (i == 1)
            made.setup.mode = NT_MODE_TAPPING;
        if (i == 2)
            made.setup.probe_model = NT_PROBE_DYNAMIC;
        if (i == 3)
            rod.tip_radius = 1.01 * R;
        if (i == 4)
            rod.tip_half_angle = 1.01 * psi;
        assert_int_equal(nt_composition_take_pushed(&made, NULL, &problem), i ? NT_E_RANGE : NT_OK);
        assert_true(made.pushed.kind == NT_PUSHED_ROD && nt_composition_pushes(&made));
        const char *const fields[] = {NULL, "rod in a session that taps", "rod with a dynamic probe",
                                      "rod.tip_radius (that of the scene)", "rod.tip_half_angle (that of the scene)"};
        if (i == 0)
            continue;
        assert_string_equal(problem.field, fields[i]);
        const double values[] = {0.0, 1.0, 1.0, 1.01 * R, 1.01 * psi}, own[] = {0.0, 0.0, 0.0, R, psi};
        assert_true(problem.value == values[i] && problem.minimum == own[i] && problem.maximum == own[i]);
    }
}

static void a_rod_lies_on_a_flat(void **state)
{
    (void)state;
    static const double heights[][16] = {{0.0},
                                         {0.0, 0.0, 0.0, 1e-9},
                                         {0.0, -1e-9, 0.0, 0.0},
                                         {-1e-9, -1e-9, -1e-9, -1e-9, -1e-9, -1e-9, -1e-9, -1e-9, -1e-9, -1e-9, -1e-9,
                                          -1e-9, -1e-9, -1e-9, -1e-9, -1e-9}};
    for (int i = 0; i < 4; ++i) {
        const nt_session_setup setup = nt_session_defaults();
        const nt_rod rod = rod_of(&setup);
        nt_composition made = composition_of(&rod);
        nt_terrain_setup ground = nt_terrain_defaults();
        ground.map = (nt_height_map){.heights = heights[i], .nx = 4, .ny = 4, .dx = 1e-8, .dy = 1e-8};
        ground.dilated = 1;
        nt_terrain *own;
        nt_problem problem = {.field = NULL};
        assert_int_equal(nt_terrain_make(&own, &ground, &problem), NT_OK);
        made.terrain = own;
        assert_int_equal(nt_composition_take_pushed(&made, NULL, &problem), i ? NT_E_RANGE : NT_OK);
        if (i)
            assert_true(fabs(problem.value - (i == 3 ? 0.0 : 1e-9)) < 1e-24 && problem.maximum == 0.0);
        nt_terrain_close(own);
    }
}

/* Pressed with the limit while friction holds it, a tip does not go through: 4 times both over the sharper radius. */
static void a_tip_does_not_go_through(void **state)
{
    (void)state;
    const nt_session_setup setup = nt_session_defaults();
    for (int sharp = 0; sharp < 2; ++sharp)
        for (int side = 0; side < 2; ++side) {
            nt_rod rod = rod_of(&setup);
            rod.radius = sharp ? 0.5 * rod.tip_radius : 2.0 * rod.tip_radius;
            nt_composition made = composition_of(&rod);
            const double slides = nt_rod_friction(&rod) * rod.length, F = made.setup.settings.limits.force;
            const double least = 4.0 * hypot(slides, F) / (sharp ? rod.radius : rod.tip_radius);
            rod.tip_stiffness = least * (side ? 1.0 - 1e-12 : 1.0 + 1e-12);
            nt_problem problem = {.field = NULL};
            const nt_status status = nt_composition_take_pushed(&made, NULL, &problem);
            if (side) {
                assert_int_equal(status, NT_E_RANGE);
                assert_true(fabs(problem.minimum / least - 1.0) < 1e-12 && problem.value == rod.tip_stiffness);
            } else {
                assert_int_equal(status, NT_OK);
            }
        }
}

static void what_it_adds_to_the_promise(void **state)
{
    (void)state;
    const nt_session_setup setup = nt_session_defaults();
    nt_rod rod = rod_of(&setup);
    nt_composition made = composition_of(&rod);
    assert_true(nt_composition_resistance(&made, 1e-6) == 0.0 && nt_composition_slope(&made) == 0.0); /* none yet */
    assert_int_equal(nt_composition_take_pushed(&made, NULL, NULL), NT_OK);
    const double F = made.setup.settings.limits.force, of_plan = nt_terrain_plan(terrain)->maximum_stiffness;
    const nt_pushed_bound bound = nt_pushed_bound_of(&made.pushed, F);
    assert_true(bound.resistance > 0.0 && bound.stiffness > of_plan);
    assert_true(nt_composition_stiffness(&made) == bound.stiffness);
    made.reach.slope = 0.5 * bound.resistance / F;
    assert_true(nt_composition_slope(&made) == bound.resistance / F);
    made.reach.slope = 2.0 * bound.resistance / F;
    assert_true(nt_composition_slope(&made) == made.reach.slope);
    const nt_pushed_bound light = nt_pushed_bound_of(&made.pushed, 0.5 * F);
    assert_true(nt_composition_resistance(&made, 0.5 * F) == light.resistance + light.pull_off);
    for (int i = 0; i < 4; ++i) {
        nt_hazard hazard = {.stiffness = i & 1 ? 1e9 : 1.0, .pull_off_force = 3e-9, .stick = i & 1 ? 1e9 : 0.0};
        const nt_hazard before = hazard;
        hazard.failing[NT_FAILURE_SLIP] = 1e10;
        made.setup.rig.probe.lateral_stiffness = i & 2 ? 50.0 : 0.0;
        nt_composition_add_pushed(&made, &hazard);
        assert_true(hazard.stiffness == larger(before.stiffness, bound.stiffness));
        assert_true(hazard.failing[NT_FAILURE_STAGE] == bound.stiffness && hazard.failing[NT_FAILURE_SLIP] == 1e10);
        assert_true(hazard.pull_off_force == 3e-9 + bound.pull_off);
        const double series = bound.stiffness * 50.0 / (bound.stiffness + 50.0);
        assert_true(fabs(hazard.stick - (i & 1 ? 1e9 : i & 2 ? series : 0.0)) < 1e-9 * series);
    }
    nt_composition bare = composition_of(NULL);
    assert_int_equal(nt_composition_take_pushed(&bare, NULL, NULL), NT_OK);
    nt_hazard same = {.stiffness = 1.0};
    nt_composition_add_pushed(&bare, &same);
    assert_true(same.stiffness == 1.0 && same.failing[0] == 0.0 && nt_composition_stiffness(&bare) == of_plan);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_a_rod_cannot_be_in),
        cmocka_unit_test(a_rod_lies_on_a_flat),
        cmocka_unit_test(a_tip_does_not_go_through),
        cmocka_unit_test(what_it_adds_to_the_promise),
    };
    return cmocka_run_group_tests(tests, open_terrain, close_terrain);
}
