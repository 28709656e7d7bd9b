/* SPDX-License-Identifier: BSD-3-Clause
 * Pull-off force and minimum spring against a search of the whole plan without refinement, and against a law of one's
 * own whose strongest pull and steepest growth are known, wherever on the gaps they are. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "larger.h"
#include "nanotouch/interaction.h"
#include "nanotouch/plan.h"

static nt_plan plan, whole;

/* A well of attraction, F = -A sech^2((h - c)/s): the strongest pull is A at c, the steepest growth 4 A/(3 sqrt(3) s)
 * where tanh((h - c)/s) = 1/sqrt(3). */
typedef struct well {
    double force, centre, width; /* A [N], c [m], s [m] */
} well;

static nt_law_value well_law(const void *context, double gap)
{
    const well *w = context;
    const double t = tanh((gap - w->centre) / w->width), e = exp(-2.0 * fabs(gap - w->centre) / w->width);
    const double sech2 = 4.0 * e / ((1.0 + e) * (1.0 + e));
    return (nt_law_value){.U = -w->force * w->width * (gap > w->centre ? 2.0 * e / (1.0 + e) : 1.0 - t),
                          .F = -w->force * sech2,
                          .k = -2.0 * w->force / w->width * sech2 * t};
}

static double well_bound(const void *context, double gap)
{
    const well *w = context;
    return gap < w->centre ? w->force : -well_law(context, gap).F;
}

static void make(nt_plan *made, const nt_scene *scene, double accuracy)
{
    const nt_demand demand = {.relative_accuracy = accuracy, .bound = accuracy > 0.0 ? NT_BOUND_KEPT : NT_BOUND_EXACT};
    const nt_plan_inputs inputs = {.scene = scene, .demand = &demand};
    nt_problem problem = {0};
    if (nt_plan_make(made, &inputs, &problem) != NT_OK)
        fail_msg("%s = %g %s, range %g to %g", problem.field, problem.value, problem.unit, problem.minimum,
                 problem.maximum);
}

static nt_scene with_well(nt_scene scene, const well *w)
{
    scene.custom[NT_CUSTOM_TERMS - 1] =
        (nt_custom_term){.name = "well", .law = well_law, .bound = well_bound, .context = w};
    return scene;
}

/* The two plans let go at the same gap but for rounding. */
static double last_hold(void)
{
    return plan.release_gap - 1e-12 * fabs(plan.release_gap);
}

static nt_law_value everything(int attached, double gap)
{
    const nt_interaction_state history = {attached, 0.0, 0.0};
    return nt_interaction_eval_gap(&whole, &history, NULL, gap);
}

enum { GAPS = 1500 };

/* The largest of -F (in contact as far as the release gap) or of -k (apart as far as the capture gap) between two gaps,
 * in even steps or ratios. */
static double largest_between(int growth, double first, double last)
{
    const double fold = growth ? plan.capture_gap : last_hold();
    double most = 0.0;
    for (int i = 0; i <= GAPS; i++) {
        const double t = (double)i / GAPS, even = first + t * (last - first);
        const double gap = first * last > 0.0 ? first * pow(last / first, t) : even;
        const nt_law_value value = everything(gap <= fold, gap);
        most = larger(most, growth ? -value.k : -value.F);
    }
    return most;
}

/* ... of all gaps, just outside the folds, where terms are held and around a well included. */
static double largest_of_all(int growth, double hold, const well *w)
{
    const double fold = growth ? plan.capture_gap : last_hold(), near = larger(fold, 1e-13);
    double most = larger(growth ? 0.0 : -everything(1, fold).F,
                         largest_between(growth, -larger(plan.largest_indentation, near), fold));
    most = larger(most, largest_between(growth, -1e-18, -1e-9));
    most = larger(most, largest_between(growth, 1e-13, near));
    most = larger(most, largest_between(growth, near * (1.0 + 1e-11), 10.0 * near));
    most = larger(most, largest_between(growth, hold * (1.0 + 1e-11), 1.1 * hold));
    if (w)
        most = larger(most, largest_between(growth, w->centre - 3.0 * w->width, w->centre + 3.0 * w->width));
    return larger(most, largest_between(growth, near * (1.0 + 1e-11), 1e-2));
}

/* A fact is no less than what the search finds, and no more than what lies between its gaps. */
static void expect(double fact, double found)
{
    if (!(fact >= found * (1.0 - 2e-9) && fact <= found * (1.0 + 1e-3)))
        fail_msg("%.9g, but the search finds %.9g", fact, found);
}

/* Of laws that add on the undeformed gap; of a sample that deforms under them the facts are those of its table. */
static int make_both(const nt_scene *scene, double accuracy)
{
    const nt_demand demand = {.relative_accuracy = accuracy, .bound = accuracy > 0.0 ? NT_BOUND_KEPT : NT_BOUND_EXACT};
    const nt_plan_inputs inputs = {.scene = scene, .demand = &demand};
    const int made = nt_plan_make(&plan, &inputs, NULL) == NT_OK;
    make(&whole, scene, 0.0);
    return made && plan.deformation.count == 0 && whole.deformation.count == 0;
}

/* z0, or the distance at which van der Waals alone is all of w; of a cone and a punch it is no part of w. */
static double atoms_apart(const nt_scene *scene)
{
    const nt_adhesion *adhesion = &scene->adhesion;
    const double all = sqrt(adhesion->hamaker_constant / (12.0 * NT_PI * adhesion->work_of_adhesion));
    const int round = scene->tip.shape != NT_SHAPE_CONE && scene->tip.shape != NT_SHAPE_PUNCH;
    return plan.source == NT_ADHESION_SOLID && round ? larger(adhesion->equilibrium_distance, all)
                                                     : adhesion->equilibrium_distance;
}

static void compare_pull(const nt_scene *scene)
{
    expect(plan.pull_off_force, largest_of_all(0, atoms_apart(scene), scene->custom[NT_CUSTOM_TERMS - 1].context));
}

static void compare_growth(const nt_scene *scene, double accuracy)
{
    const double capture = plan.capture_gap, jump = everything(1, capture).F - everything(0, capture * (1.0 + 1e-12)).F;
    assert_int_equal(isinf(plan.minimum_spring), fabs(jump) > accuracy * plan.pull_off_force);
    if (isfinite(plan.minimum_spring))
        expect(plan.minimum_spring, largest_of_all(1, atoms_apart(scene), scene->custom[NT_CUSTOM_TERMS - 1].context));
}

static int compared;

static void compare(const nt_scene *scene)
{
    for (double accuracy = 0.5; accuracy > 1e-4; accuracy *= 0.04) {
        if (!make_both(scene, accuracy))
            continue;
        compare_growth(scene, accuracy);
        compare_pull(scene);
        compared++;
    }
}

static nt_scene dry(double radius, double modulus, double w)
{
    nt_scene scene = nt_scene_defaults();
    scene.medium.relative_humidity = 0.0;
    scene.tip.radius = radius;
    scene.sample.youngs_modulus = modulus;
    scene.adhesion.work_of_adhesion = w;
    scene.adhesion.hamaker_constant = 0.0;
    return scene;
}

/* From JKR's end of contact to DMT's, where even the rigid limit is pulled most a little inside first touch. */
static void scenes_of_every_kind(void **state)
{
    (void)state;
    const double modulus[] = {1e4, 1e6, 1e8, 1e11};
    const int step = getenv("NANOTOUCH_ALL_DRAWS") ? 1 : 3;
    for (int i = 0; i < 8; i += step) {
        nt_scene scene = i < 4 ? dry(50e-9, modulus[i], 0.02) : dry(2e-9, modulus[i - 4], 1e-4);
        compare(&scene);
        scene.adhesion.hamaker_constant = i < 4 ? 2e-20 : 2e-22;
        scene.adhesion.contact_potential = 0.5;
        compare(&scene);
        scene.sample.charge = 2e-17;
        compare(&scene);
        scene.tip.shape = i % 2 ? NT_SHAPE_CONE : NT_SHAPE_PUNCH;
        compare(&scene);
        scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
        compare(&scene);
    }
    assert_true(compared > 30 / step);
}

/* Within a nanometre under a contact that holds over micrometres; near the release gap; just beyond it; far out. */
static void the_strongest_pull_is_found_wherever_it_is(void **state)
{
    (void)state;
    const nt_scene soft = dry(1e-4, 1e4, 1e-3);
    make(&plan, &soft, 0.0);
    const double release = plan.release_gap, pull = plan.contact_pull;
    assert_true(release > 1e-6);
    const double place[][2] = {
        {1e-9, 0.1},           {20e-9, 0.2},           {0.5 * release, 0.03}, {0.55 * release, 0.03},
        {0.6 * release, 0.03}, {0.97 * release, 0.02}, {1.5 * release, 0.3},  {30.0 * release, 0.3}};
    for (int i = 0; i < (int)(sizeof place / sizeof *place); i++) {
        const well w = {10.0 * pull, place[i][0], place[i][0] * place[i][1]};
        const nt_scene scene = with_well(soft, &w);
        if (!make_both(&scene, 0.0)) { /* the first deforms: its well is inside the jump of the surface */
            assert_true(i == 0 && plan.deformation.count > 0);
            continue;
        }
        compare_pull(&scene);
        assert_true(plan.pull_off_force > (w.centre > release ? 0.999 : 1.0) * w.force);
        assert_true((plan.contact_pull >= w.force) == (w.centre < release));
    }
}

/* Scenes with a bridge so weak that it takes hold without a jump; it reaches over `capture`. */
static nt_scene bridged(double humidity)
{
    nt_scene scene = dry(20e-9, 135e9, 0.1);
    scene.medium.relative_humidity = humidity;
    scene.medium.film_thickness = 90e-9;
    make(&plan, &scene, 0.5);
    assert_true(isfinite(plan.minimum_spring));
    return scene;
}

static void compare_with_well(const nt_scene *bare, double centre, double width)
{
    make(&plan, bare, 0.5);
    const well w = {20.0 * plan.minimum_spring * width, centre, width};
    const nt_scene scene = with_well(*bare, &w);
    if (!make_both(&scene, 0.5))
        return;
    compare_growth(&scene, 0.5);
    compared++;
    if (centre > scene.adhesion.equilibrium_distance) /* its peak is not held */
        assert_true(plan.minimum_spring > 0.98 * 4.0 / (3.0 * sqrt(3.0)) * w.force / width);
}

/* Apart, far out and just beyond capture; inside the range of a bridge; where a term is held. */
static void the_steepest_growth_is_found_wherever_it_is(void **state)
{
    (void)state;
    nt_scene wet = bridged(0.7);
    compared = 0;
    const double capture = plan.capture_gap;
    assert_true(capture > 4.0 * wet.adhesion.equilibrium_distance);
    const double place[][2] = {{0.3, 0.2}, {1.5, 0.1}, {30.0, 0.2}, {500.0, 0.3}};
    for (int i = 0; i < (int)(sizeof place / sizeof *place); i++)
        compare_with_well(&wet, place[i][0] * capture, place[i][0] * place[i][1] * capture);
    const double hold = wet.adhesion.equilibrium_distance, narrow = 0.02 * hold;
    compare_with_well(&wet, hold - 0.66 * narrow, narrow); /* as steep as it gets at the hold */
    wet.sample.charge = 5e-17;
    compare(&wet);
    const nt_scene wetter = bridged(0.99);
    const double wide = plan.capture_gap;
    assert_true(wide > 50e-9);
    compare_with_well(&wetter, 1e-9, 0.2e-9);
    for (double centre = 0.4 * wide; centre < 0.8 * wide; centre *= 1.1)
        compare_with_well(&wetter, centre, 0.03 * centre);
    assert_true(compared > 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_of_every_kind),
        cmocka_unit_test(the_strongest_pull_is_found_wherever_it_is),
        cmocka_unit_test(the_steepest_growth_is_found_wherever_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
