/* SPDX-License-Identifier: BSD-3-Clause
 * Friction as part of a scene: energy along random paths, the vertical force left as it was, its bound. */
#include <stdlib.h>
#include <string.h>

#include "assertions.h"
#include "internal/interaction.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/interaction.h"
#include "scene/interaction.h"

enum { N = 16, STEPS = 60 };
static double coefficients[N * N];
static nt_plan plan, other;

static double between(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

static nt_surface bumpy_surface(void)
{
    double heights[N * N];
    nt_surface surface;
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            heights[j * N + i] = 2e-9 * sin(0.9 * i + 0.2 * j) + 1e-9 * cos(0.7 * j);
    const nt_height_map map = {heights, N, N, 10e-9, 10e-9};
    assert_int_equal(nt_surface_init(&surface, &map, coefficients), NT_OK);
    return surface;
}

static nt_scene rubbed(nt_random *random)
{
    nt_scene scene = nt_scene_defaults();
    const double kind = nt_random_uniform(random);
    scene.medium.relative_humidity = kind < 0.5 ? 0.4 : 0.0;
    if (kind > 0.75)
        scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
    scene.tip.radius = between(random, 5e-9, 1e-6);
    scene.sample.youngs_modulus = between(random, 2e9, 1e12);
    scene.range.maximum_load = between(random, 1e-9, 1e-8) * scene.tip.radius / 5e-9;
    scene.friction = (nt_scene_friction){between(random, 1e5, 1e9), between(random, 1e-3, 1.0),
                                         nt_random_uniform(random) < 0.5 ? 0.0 : between(random, 1e-3, 1.0)};
    return scene;
}

static nt_status make(nt_plan *to, const nt_scene *scene, const nt_surface *surface, const nt_probe *probe)
{
    const nt_demand demand = {.relative_accuracy = 1e-3};
    const nt_plan_inputs inputs = {.scene = scene, .demand = &demand, .surface = surface, .probe = probe};
    return nt_plan_make(to, &inputs, NULL);
}

/* A walk of the tip through and out of contact. Friction only takes; what is vertical has the same bits as in the plan
 * without friction. Returns how far the account is off, over the work to and fro. */
static double walk(nt_random *random, const nt_plan *smooth)
{
    nt_interaction_state state = {0}, bare = {0};
    nt_slide slide = {0};
    nt_pose pose = {20e-9, 20e-9, 0.0};
    double turnover = 0.0;
    for (int i = 0; i < STEPS; ++i) {
        const double work = slide.friction.work, heat = slide.friction.dissipated;
        const double depth = plan.largest_indentation, gap = depth * (0.6 - 1.6 * nt_random_uniform(random));
        pose.x += 2e-9 * (nt_random_uniform(random) - 0.5);
        pose.y += 2e-9 * (nt_random_uniform(random) - 0.5);
        pose.z = gap + nt_interaction_place(&plan, pose.x, pose.y).surface.z;
        const nt_interaction_arrays arrays = {&pose, &(nt_interaction_value){0}, 1, 1, 1};
        nt_interaction_slide_n(&plan, &state, &slide, &arrays);
        nt_interaction_advance(smooth, &bare, &pose);
        nt_interaction_value without = nt_interaction_eval(smooth, &bare, &pose);
        without.Fx += slide.friction.force[0];
        without.Fy += slide.friction.force[1];
        assert_memory_equal(&without, arrays.values, sizeof without);
        assert_true(slide.friction.dissipated >= heat);
        turnover += fabs(slide.friction.work - work);
    }
    assert_memory_equal(&state, &bare, sizeof state);
    const double account = slide.friction.stored + slide.friction.dissipated - slide.friction.work;
    return turnover > 0.0 ? fabs(account) / turnover : 0.0;
}

/* 1e-12 of the energy to and fro: 60 steps of a handful of roundings. NANOTOUCH_FRICTION_PATHS=100000: the heavy run.
 * A plan is refused where a scene at random is (a load that is plastic, a sample that jumps): some must not be. */
static void never_gives_more_than_it_took(void **unused)
{
    (void)unused;
    const char *more = getenv("NANOTOUCH_FRICTION_PATHS");
    const long paths = more ? atol(more) : 200;
    const nt_surface surface = bumpy_surface();
    double worst = 0.0;
    long walked = 0;
    for (long seed = 0; seed < paths; ++seed) {
        nt_random random = nt_random_seed((uint64_t)seed);
        nt_scene scene = rubbed(&random);
        const nt_surface *over = seed % 2 ? &surface : NULL;
        if (make(&plan, &scene, over, NULL) != NT_OK || plan.friction.term.form == NT_FORM_OFF)
            continue;
        scene.friction = (nt_scene_friction){0};
        assert_int_equal(make(&other, &scene, over, NULL), NT_OK);
        worst = larger(worst, walk(&random, &other));
        ++walked;
    }
    print_message("worst energy balance of %ld scenes: %.2g\n", walked, worst);
    assert_true(walked > paths / 2);
    assert_true(worst <= 1e-12);
}

/* Closed forms without adhesion: on a flat under Hertz a^2 = R d, N_c = 4/3 E* sqrt(R d^3); stiffness 8 a G*. */
static void slips_and_sticks_as_said(void **unused)
{
    (void)unused;
    nt_scene scene = nt_scene_defaults();
    scene.medium.relative_humidity = scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
    scene.friction = (nt_scene_friction){30e6, 0.2, 0.01};
    nt_rig rig = nt_rig_defaults();
    rig.probe.lateral_stiffness = 50.0; /* 0.02 m/N */
    assert_int_equal(make(&plan, &scene, NULL, &rig.probe), NT_OK);
    const double d = 0.1e-9, R = scene.tip.radius, a = sqrt(R * d);
    const double E = 135e9 / (2.0 * (1.0 - 0.35 * 0.35)), limit = 30e6 * NT_PI * R * d + 0.2 * 4.0 / 3.0 * E * a * d;
    const double G = 135e9 / (2.0 * 1.35) / (2.0 * 1.65); /* 1/G* = 2 (2 - nu)/G */
    const double stiffness = 1.0 / (1.0 / (8.0 * a * G) + 0.03);
    nt_interaction_state state = {0};
    nt_slide slide = {0};
    nt_pose poses[3] = {{0.0, 0.0, -d}, {0.0, 1e-13, -d}, {0.0, 5e-9, -d}};
    for (int i = 0; i < 2; ++i) {
        nt_interaction_advance(&plan, &state, &poses[i]);
        nt_interaction_slide(&plan, &state, &slide, &poses[i]);
    }
    assert_within(slide.friction.force[1], -stiffness * 1e-13, 1e-12 * stiffness * 1e-13);
    nt_interaction_slide(&plan, &state, &slide, &poses[2]);
    assert_within(slide.friction.force[1], -limit, 1e-12 * limit);
    assert_true(slide.friction.force[0] == 0.0);
    const nt_pose away = {0.0, 5e-9, 1e-9};
    nt_interaction_advance(&plan, &state, &away);
    nt_interaction_slide(&plan, &state, &slide, &away);
    assert_true(slide.friction.force[1] == 0.0 && slide.friction.stored == 0.0);
}

/* Planned friction beside that of a plan that computes everything, on random scenes and ways: within its bound. */
static void keeps_its_bound(void **unused)
{
    (void)unused;
    long on = 0, off = 0;
    for (long seed = 0; seed < 120; ++seed) {
        nt_random random = nt_random_seed((uint64_t)seed + 7000u);
        nt_scene scene = rubbed(&random);
        scene.friction.shear_strength = between(&random, 1e2, 1e9);
        scene.friction.coefficient = between(&random, 1e-6, 1.0);
        const nt_demand demand = {.relative_accuracy = between(&random, 1e-6, 0.3)}, exact = {.bound = NT_BOUND_EXACT};
        nt_plan_inputs inputs = {.scene = &scene, .demand = &demand};
        if (nt_plan_make(&plan, &inputs, NULL) != NT_OK)
            continue;
        inputs.demand = &exact;
        if (nt_plan_make(&other, &inputs, NULL) != NT_OK || plan.deformation.count + other.deformation.count > 0)
            continue;
        const int is_on = plan.friction.term.form == NT_FORM_ON;
        *(is_on ? &on : &off) += 1;
        for (int i = 0; i < 100; ++i) {
            const double gap = -plan.largest_indentation * nt_random_uniform(&random);
            const nt_interaction_state held = {1, 0.0, 0.0};
            const nt_friction_contact there = nt_interaction_friction_contact(&plan, &held, NULL, gap);
            const nt_friction_contact truth = nt_interaction_friction_contact(&other, &held, NULL, gap);
            const double limit = nt_friction_limit(&other.friction.law, &truth);
            const double found = is_on ? nt_friction_limit(&plan.friction.law, &there) : 0.0;
            const double size = larger(fabs(nt_interaction_eval_gap(&other, &held, NULL, gap).F), plan.scale);
            assert_true(fabs(found - limit) <= plan.friction.term.bound * size);
        }
    }
    print_message("on %ld, left out %ld\n", on, off);
    assert_true(on > 10 && off > 10);
}

/* A cone that adheres: its shear strength will do, a coefficient is refused by name; and a budget counts friction. */
static void refuses_by_name(void **unused)
{
    (void)unused;
    nt_scene scene = nt_scene_defaults();
    nt_problem problem = {0};
    scene.friction = (nt_scene_friction){30e6, 0.2, 0.0};
    const nt_demand cheap = {.relative_accuracy = 0.01, .budget = 5.0};
    nt_plan_inputs inputs = {.scene = &scene, .demand = &cheap};
    assert_int_equal(nt_plan_make(&plan, &inputs, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "demand.budget");
    scene.tip.shape = NT_SHAPE_CONE;
    scene.tip.half_angle = 1.2;
    scene.range.maximum_load = 1e-9;
    inputs.demand = NULL;
    assert_int_equal(nt_plan_make(&plan, &inputs, &problem), NT_E_RANGE);
    assert_true(strncmp(problem.field, "friction.coefficient", 20) == 0);
    scene.friction.coefficient = 0.0;
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
    assert_int_equal(plan.friction.term.form, NT_FORM_ON);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(never_gives_more_than_it_took),
        cmocka_unit_test(slips_and_sticks_as_said),
        cmocka_unit_test(keeps_its_bound),
        cmocka_unit_test(refuses_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
