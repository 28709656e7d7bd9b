/* SPDX-License-Identifier: BSD-3-Clause
 * The parts of the force curve: each is the law, they end at the folds, and the unstable part joins them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "nanotouch/advanced/view.h"

enum { N = 101 };
static nt_plan plan;
static nt_view_point points[N];
static const double nearest = -20e-9, farthest = 60e-9;

static long curve(nt_view_part part, nt_view_point out[])
{
    const nt_view_range range = {part, nearest, farthest};
    return nt_view_curve(&plan, NULL, &range, out, N);
}

static void make(const nt_scene *scene)
{
    const nt_plan_inputs inputs = {.scene = scene};
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
}

/* A rubber ball, like JKR: its folds are those of closed form. */
static nt_scene sticky(void)
{
    nt_scene scene = nt_scene_defaults();
    scene.medium.surface_tension = 0.0;
    scene.medium.film_thickness = 0.0;
    scene.adhesion.hamaker_constant = 0.0;
    scene.adhesion.work_of_adhesion = 0.04;
    scene.tip.radius = 1e-6;
    scene.sample.youngs_modulus = 10e6;
    scene.sample.poisson_ratio = 0.5;
    return scene;
}

static void parts_are_the_law(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    make(&scene);
    for (int attached = 0; attached <= 1; ++attached) {
        const nt_interaction_state history = {attached, 0.0, 0.0};
        const nt_view_part part = attached ? NT_VIEW_ATTACHED : NT_VIEW_APART;
        assert_int_equal(curve(part, points), N);
        for (int i = 0; i < N; ++i) {
            const double force = nt_interaction_eval_gap(&plan, &history, NULL, points[i].gap).F;
            assert_true(points[i].force == force);
            if (i > 0)
                assert_true(attached ? points[i].gap > points[i - 1].gap : points[i].gap < points[i - 1].gap);
        }
    }
    assert_within(points[N - 1].gap, plan.release_gap, 1e-18);
    assert_true(points[0].gap == nearest);
}

/* Of JKR the fold under grips lies at delta = -(3/4) (pi^2 w^2 R/E*^2)^(1/3), F = -(5/9) of the pull-off; between it
 * and first touch the unstable part comes back to nothing. */
static void the_unstable_part_joins_the_folds(void **state)
{
    (void)state;
    const nt_scene scene = sticky();
    make(&scene);
    const double w = 0.04, R = 1e-6, E = plan.contact.effective_modulus;
    const double fold = 0.75 * cbrt(NT_PI * NT_PI * w * w * R / (E * E)), pull_off = 1.5 * NT_PI * R * w;
    const long made = curve(NT_VIEW_UNSTABLE, points);
    assert_true(made > N / 2);
    assert_within(points[made - 1].gap, fold, 0.01 * fold);
    assert_within(points[made - 1].force, -5.0 / 9.0 * pull_off, 0.02 * pull_off);
    assert_true(points[0].gap < 0.05 * fold);
    for (long i = 1; i < made; ++i)
        assert_true(points[i].gap > points[i - 1].gap && points[i].force < points[i - 1].force + 0.01 * pull_off);
    nt_view_point out[N];
    assert_int_equal(curve(NT_VIEW_ATTACHED, out), N);
    assert_within(out[N - 1].force, points[made - 1].force, 0.02 * pull_off);
}

static void without_adhesion_nothing_is_unstable(void **state)
{
    (void)state;
    nt_scene scene = sticky();
    scene.adhesion.work_of_adhesion = 0.0;
    make(&scene);
    assert_int_equal(curve(NT_VIEW_UNSTABLE, points), 0);
    assert_int_equal(curve(NT_VIEW_APART, points), N);
    assert_true(points[N - 1].gap > 0.0 && points[N - 1].gap < 1e-300);
}

static void nonsense_draws_nothing(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    make(&scene);
    const nt_view_range empty = {NT_VIEW_APART, 1e-9, 1e-9}, unknown = {NT_VIEW_APART, NAN, 1e-9};
    assert_int_equal(nt_view_curve(&plan, NULL, &empty, points, N), 0);
    assert_int_equal(nt_view_curve(&plan, NULL, &unknown, points, N), 0);
    const nt_view_range good = {NT_VIEW_APART, nearest, farthest};
    assert_int_equal(nt_view_curve(&plan, NULL, &good, points, 1), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_are_the_law),
        cmocka_unit_test(the_unstable_part_joins_the_folds),
        cmocka_unit_test(without_adhesion_nothing_is_unstable),
        cmocka_unit_test(nonsense_draws_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
