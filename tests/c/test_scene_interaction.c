/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/surface.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/interaction.h"
#include "nanotouch/scene.h"
#include "nanotouch/surface.h"

#define PI 3.14159265358979323846
enum { N = 16 };
static double coefficients[N * N];

/* Waves of 6 nm over a grid of 10 nm, unlike in x and y. */
static nt_surface bumpy_surface(void)
{
    double heights[N * N];
    nt_surface surface;
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            heights[j * N + i] = 3e-9 * sin(0.9 * i + 0.2 * j) + 2e-9 * cos(0.7 * j);
    const nt_height_map map = {heights, N, N, 10e-9, 10e-9};
    assert_int_equal(nt_surface_init(&surface, &map, coefficients), NT_OK);
    return surface;
}

static nt_plan plan;

static void make_plan_within(const nt_scene *scene, const nt_surface *surface, double accuracy)
{
    const nt_demand demand = {.relative_accuracy = accuracy};
    const nt_plan_inputs inputs = {.scene = scene, .demand = &demand, .surface = surface};
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
}

static void make_plan(const nt_scene *scene, const nt_surface *surface)
{
    make_plan_within(scene, surface, 1e-4);
}

static nt_scene scene_of(int wet)
{
    nt_scene scene = nt_scene_defaults();
    scene.adhesion.contact_potential = 0.3;
    scene.adhesion.hamaker_constant = 2e-20;
    if (!wet)
        scene.medium.relative_humidity = 0.0;
    return scene;
}

static double energy_at(const nt_interaction_state *state, nt_pose pose)
{
    return nt_interaction_eval(&plan, state, &pose).U;
}

/* Central differences, h = 1e-13 m. The slope of the force jumps at first touch by some N/m: error h dk = 1e-12 N there
 * and less elsewhere; rounding is 1e-16 U/h < 1e-19 N. Forces are 1e-9 .. 1e-8 N. */
static void force_is_minus_the_gradient(void **state)
{
    (void)state;
    const nt_surface surface = bumpy_surface();
    nt_random random = nt_random_seed(3);
    int compared = 0;
    for (int wet = 0; wet < 2; wet++) {
        const nt_scene scene = scene_of(wet);
        make_plan(&scene, &surface);
        for (int n = 0; n < 2000; n++) {
            const nt_interaction_state history = {n % 2, 0.0, 0.0};
            const double h = 1e-13, x = (20 + 110 * nt_random_uniform(&random)) * 1e-9,
                         y = (20 + 110 * nt_random_uniform(&random)) * 1e-9;
            const double gap = (-1.5 + 5.0 * nt_random_uniform(&random)) * 1e-9;
            const double joins[] = {plan.capture_gap, plan.release_gap, scene.adhesion.equilibrium_distance};
            int near = 0; /* a jump or kink inside the difference */
            for (int i = 0; i < 3; i++)
                near |= fabs(gap - joins[i]) < 1e-11;
            if (near)
                continue;
            const nt_pose p = {x, y, nt_surface_eval(&surface, x, y).z + gap};
            const nt_interaction_value v = nt_interaction_eval(&plan, &history, &p);
            const double dx =
                energy_at(&history, (nt_pose){x + h, y, p.z}) - energy_at(&history, (nt_pose){x - h, y, p.z});
            const double dy =
                energy_at(&history, (nt_pose){x, y + h, p.z}) - energy_at(&history, (nt_pose){x, y - h, p.z});
            const double dz =
                energy_at(&history, (nt_pose){x, y, p.z + h}) - energy_at(&history, (nt_pose){x, y, p.z - h});
            const double tolerance = 1e-12 + 1e-6 * fabs(v.Fz);
            assert_true(fabs(v.Fx + dx / (2 * h)) < tolerance);
            assert_true(fabs(v.Fy + dy / (2 * h)) < tolerance);
            assert_true(fabs(v.Fz + dz / (2 * h)) < tolerance);
            assert_true(fabs(v.gap - gap) < 1e-20);
            compared++;
        }
    }
    assert_true(compared > 3500);
}

static void stiffness_is_the_slope_of_the_force(void **state)
{
    (void)state;
    for (int wet = 0; wet < 2; wet++) {
        const nt_scene scene = scene_of(wet);
        make_plan(&scene, NULL);
        for (double gap = -2e-9; gap < 5e-9; gap += 7.3e-12)
            for (int attached = 0; attached < 2; attached++) {
                const nt_interaction_state history = {attached, 0.0, 0.0};
                const double h = 1e-14;
                const nt_law_value v = nt_interaction_eval_gap(&plan, &history, NULL, gap);
                const nt_law_value a = nt_interaction_eval_gap(&plan, &history, NULL, gap - h);
                const nt_law_value b = nt_interaction_eval_gap(&plan, &history, NULL, gap + h);
                const int jump = fabs(gap - plan.capture_gap) < 1e-12 || fabs(gap - plan.release_gap) < 5e-12 ||
                                 fabs(gap - scene.adhesion.equilibrium_distance) < 1e-12;
                if (!jump)
                    assert_true(fabs((a.F - b.F) / (2 * h) - v.k) < 1e-4 * fabs(v.k) + 1e-3);
            }
    }
}

/* The work that the surface does on a tip led through random walks of the gap and back to where it began: never
 * positive beyond what the quadrature misses. Steps of 0.5 pm; a jump happens at one gap, where no work is done. */
static void hysteresis_only_dissipates(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(11);
    double most_dissipated = 0.0;
    int jumped = 0;
    for (int n = 0; n < 40; n++) {
        nt_scene scene = scene_of(n % 2);
        scene.tip.radius = pow(10.0, -8.5 + 1.5 * nt_random_uniform(&random));
        scene.sample.youngs_modulus = pow(10.0, 7.0 + 4.0 * nt_random_uniform(&random));
        scene.medium.film_thickness = 1e-9 * nt_random_uniform(&random);
        scene.medium.relative_humidity *= 0.5 + nt_random_uniform(&random);
        make_plan_within(&scene, NULL, 0.2); /* some of the samples deform */
        jumped += plan.deformation.count > 0 && plan.deformation.jumps;
        const double far = 1.5 * plan.release_gap, scale = plan.pull_off_force * plan.release_gap;
        nt_interaction_state history = {0};
        double gap = far, work = 0.0;
        for (int leg = 0; leg < 6; leg++) {
            const double target = leg == 5 ? far : far - (far + 0.5e-9) * nt_random_uniform(&random);
            const long steps = 1 + lround(fabs(target - gap) / 0.5e-12);
            for (long i = 0; i < steps; i++) {
                const double next = i + 1 == steps ? target : gap + (target - gap) / (double)(steps - i);
                const nt_interaction_state before = history;
                nt_interaction_advance_gap(&plan, &history, NULL, next);
                /* a jump of history happens at `next`: up to it the old branch holds, if it is still there */
                const double F0 = nt_interaction_eval_gap(&plan, &before, NULL, gap).F;
                const double F1 =
                    before.attached == history.attached ? nt_interaction_eval_gap(&plan, &before, NULL, next).F : F0;
                work += 0.5 * (F0 + F1) * (next - gap);
                gap = next;
            }
        }
        assert_int_equal(history.attached, 0);
        assert_true(work < 2e-3 * scale); /* a jump may be off by one step: 0.5 pm of some 100 pm of range */
        most_dissipated = larger(most_dissipated, -work / scale);
    }
    assert_true(most_dissipated > 0.05); /* and dissipate it does */
    assert_true(jumped > 3);
}

static void capture_and_release_have_their_gaps(void **state)
{
    (void)state;
    for (int wet = 0; wet < 2; wet++) {
        const nt_scene scene = scene_of(wet);
        make_plan(&scene, NULL);
        nt_interaction_state history = {0};
        assert_true(plan.release_gap > plan.capture_gap && plan.capture_gap > 0.0);
        nt_interaction_advance_gap(&plan, &history, NULL, nextafter(plan.capture_gap, 1.0));
        assert_int_equal(history.attached, 0);
        nt_interaction_advance_gap(&plan, &history, NULL, plan.capture_gap);
        assert_int_equal(history.attached, 1);
        nt_interaction_advance_gap(&plan, &history, NULL, plan.release_gap);
        assert_int_equal(history.attached, 1);
        nt_interaction_advance_gap(&plan, &history, NULL, nextafter(plan.release_gap, 1.0));
        assert_int_equal(history.attached, 0);
    }
}

/* At the same gap between capture and release the bridge pulls on retraction and is not there on approach. */
static void the_meniscus_is_there_on_retraction_only(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    scene.adhesion.hamaker_constant = 0.0;
    make_plan(&scene, NULL);
    const nt_interaction_state approach = {0, 0.0, 0.0}, retraction = {1, 0.0, 0.0};
    for (double gap = 1.001 * plan.capture_gap; gap < plan.release_gap; gap *= 1.01) {
        assert_true(nt_interaction_eval_gap(&plan, &approach, NULL, gap).F == 0.0);
        assert_true(nt_interaction_eval_gap(&plan, &retraction, NULL, gap).F < 0.0);
    }
    /* inside the capture gap history makes no difference */
    assert_true(nt_interaction_eval_gap(&plan, &approach, NULL, 0.5 * plan.capture_gap).F ==
                nt_interaction_eval_gap(&plan, &retraction, NULL, 0.5 * plan.capture_gap).F);
}

/* Solid, nearly rigid: Dugdale and tail together pull 2 pi R w at contact, and where the tail meets the range of the
 * contact law the force steps by no more than the Dugdale jump-in, (pi/2) lambda (16 lambda/(3 pi))^2 pi w R. */
static void tail_and_contact_join(void **state)
{
    (void)state;
    nt_scene scene = scene_of(0);
    scene.adhesion.contact_potential = 0.0;
    scene.adhesion.hamaker_constant = 1e-19;
    scene.tip.youngs_modulus = scene.sample.youngs_modulus = 1e13;
    scene.tip.radius = 1e-9;
    make_plan(&scene, NULL);
    const nt_interaction_state apart = {0, 0.0, 0.0};
    const double pull = 2.0 * PI * scene.tip.radius * scene.adhesion.work_of_adhesion, lambda = plan.lambda;
    assert_true(plan.terms[NT_PLAN_VDW].form != NT_FORM_OFF);
    double strongest = 0.0;
    for (double gap = -0.1e-9; gap < plan.release_gap; gap += 1e-14)
        strongest = smaller(strongest, nt_interaction_eval_gap(&plan, &apart, NULL, gap).F);
    /* under displacement control the rigid sphere pulls its most at a = 0: P0 = -2 + O(lambda^1.5) of pi w R */
    assert_true(fabs(-strongest / pull - 1.0) < 2.0 * pow(lambda, 1.5));
    const double outside = nt_interaction_eval_gap(&plan, &apart, NULL, nextafter(plan.capture_gap, 1.0)).F;
    const double inside = nt_interaction_eval_gap(&plan, &apart, NULL, plan.capture_gap).F;
    const double jump = 0.5 * PI * lambda * pow(16.0 * lambda / (3.0 * PI), 2.0) * 0.5 * pull;
    assert_true(outside < 0.0 && outside - inside > 0.0 && outside - inside < 1.001 * jump);
    assert_true(jump < 1e-4 * pull);
}

static void what_is_not_a_number_stays_so(void **state)
{
    (void)state;
    const nt_surface surface = bumpy_surface();
    for (int kind = 0; kind < 4; kind++) {
        const int wet = kind & 1;
        const nt_scene scene = scene_of(wet);
        make_plan(&scene, kind & 2 ? NULL : &surface);
        for (int attached = 0; attached < 2; attached++) {
            nt_interaction_state history = {attached, 0.0, 0.0};
            const nt_law_value law = nt_interaction_eval_gap(&plan, &history, NULL, (double)NAN);
            assert_true(isnan(law.U) && isnan(law.F) && isnan(law.k));
            assert_true(isnan(nt_interaction_eval_gap(&plan, &history, NULL, -HUGE_VAL).F)); /* the law refuses it */
            const nt_pose poses[] = {{NAN, 50e-9, 0.0}, {50e-9, NAN, 0.0}, {50e-9, 50e-9, NAN}};
            for (int i = 0; i < 3; i++)
                assert_true(isnan(nt_interaction_eval(&plan, &history, &poses[i]).Fz));
            for (int i = 0; i < 3; i++)
                nt_interaction_advance(&plan, &history, &poses[i]);
            for (int i = 0; i < 3; i++)
                nt_interaction_change(&plan, &plan, &history, &poses[i]);
            assert_true(history.port == 0.0);
            assert_true(history.attached == attached && history.dissipated == 0.0);
        }
        assert_true(nt_interaction_eval_gap(&plan, &(nt_interaction_state){0, 0.0, 0.0}, NULL, HUGE_VAL).F == 0.0);
    }
}

static void evaluation_leaves_history_alone(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    make_plan(&scene, NULL);
    const nt_interaction_state apart = {0, 0.0, 0.0};
    const double before = nt_interaction_eval_gap(&plan, &apart, NULL, 1e-9).F;
    assert_true(nt_interaction_eval_gap(&plan, &apart, NULL, -1e-9).F != before); /* a trial deep in contact */
    assert_int_equal(apart.attached, 0);
    assert_true(nt_interaction_eval_gap(&plan, &apart, NULL, 1e-9).F == before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(force_is_minus_the_gradient),
        cmocka_unit_test(stiffness_is_the_slope_of_the_force),
        cmocka_unit_test(hysteresis_only_dissipates),
        cmocka_unit_test(capture_and_release_have_their_gaps),
        cmocka_unit_test(the_meniscus_is_there_on_retraction_only),
        cmocka_unit_test(tail_and_contact_join),
        cmocka_unit_test(what_is_not_a_number_stays_so),
        cmocka_unit_test(evaluation_leaves_history_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
