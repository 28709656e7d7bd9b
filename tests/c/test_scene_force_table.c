/* SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "larger.h"
#include "nanotouch/advanced/force_table.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/interaction.h"

static nt_plan plan;
static nt_force_piece pieces[NT_FORCE_PIECES];
static nt_force_table table;

static void make(const nt_scene *scene, const nt_demand *demand)
{
    const nt_plan_inputs inputs = {.scene = scene, .demand = demand};
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
    assert_int_equal(nt_force_table_make(&table, pieces, NT_FORCE_PIECES, &plan, NULL), NT_OK);
}

/* --- the table by itself: two pieces in contact, one apart --- */

static const nt_force_piece by_hand[] = {
    {-2.0f, 1.0f, {4.0f, -2.0f, 0.0f, 0.0f}},
    {-1.0f, 0.5f, {2.0f, -4.0f, 1.0f, 2.0f}},
    {0.5f, 0.5f, {-1.0f, 0.5f, 0.25f, 0.125f}},
};
static const nt_force_table small = {by_hand, 2, 1, 0.5f, 1.0f, 2.5f, 1.0f, 0.0f, 0.0f};

static void cubics_are_evaluated(void **state)
{
    (void)state;
    int attached = 0;
    nt_force_here here = nt_force_table_eval(&small, &attached, 1.5f); /* u = 0.5 */
    assert_int_equal(attached, 0);
    assert_true(here.force == -1.0f + 0.25f + 0.0625f + 0.015625f);
    assert_true(here.stiffness == -(0.5f + 0.25f + 0.09375f) * 0.5f);
    here = nt_force_table_eval(&small, &attached, -1.5f);
    assert_true(here.force == 3.0f && here.stiffness == 2.0f);
    here = nt_force_table_eval(&small, &attached, -1.0f);
    assert_true(here.force == 2.0f && here.stiffness == 2.0f);
}

static void history_is_kept(void **state)
{
    (void)state;
    int attached = 0;
    (void)nt_force_table_eval(&small, &attached, 0.75f);
    assert_int_equal(attached, 0); /* on the way in it is not captured here */
    (void)nt_force_table_eval(&small, &attached, 0.5f);
    assert_int_equal(attached, 1);
    const nt_force_here held = nt_force_table_eval(&small, &attached, 1.0f);
    assert_int_equal(attached, 1);
    assert_true(held.force == 2.0f - 4.0f + 1.0f + 2.0f);
    (void)nt_force_table_eval(&small, &attached, 1.0000001f);
    assert_int_equal(attached, 0);
}

static void beyond_its_ends(void **state)
{
    (void)state;
    int attached = 0;
    nt_force_here here = nt_force_table_eval(&small, &attached, 2.6f);
    assert_true(here.force == 0.0f && here.stiffness == 0.0f);
    here = nt_force_table_eval(&small, &attached, INFINITY);
    assert_true(here.force == 0.0f);
    here = nt_force_table_eval(&small, &attached, -5.0f); /* on with the first slope */
    assert_true(here.force == 10.0f && here.stiffness == 2.0f);
    here = nt_force_table_eval(&small, &attached, NAN);
    assert_true(isnan(here.force) && isnan(here.stiffness));
    assert_int_equal(attached, 1);
}

/* --- beside the plan --- */

static double to_bend(double gap)
{
    double near = smaller(fabs(gap), fabs(gap - plan.capture_gap));
    near = smaller(near, fabs(gap - plan.release_gap));
    return plan.deformation.count > 0 ? smaller(near, fabs(gap - plan.deformation.touch)) : near;
}

/* Random gaps: over the whole range, and ever nearer to where it bends; both histories. Returns how many. */
static long keeps_its_bound(uint64_t seed)
{
    nt_random random = nt_random_seed(seed);
    const double bends[] = {0.0, plan.capture_gap, plan.release_gap, -plan.largest_indentation, table.farthest};
    long compared = 0;
    for (int i = 0; i < 4000; ++i) {
        const double span = plan.largest_indentation + smaller((double)table.farthest, 50e-9);
        double gap = -plan.largest_indentation + span * nt_random_uniform(&random);
        if (i % 2)
            gap = bends[i / 2 % 5] + (i % 4 < 2 ? 1.0 : -1.0) * span * pow(2.0, -40.0 * nt_random_uniform(&random));
        const float h = (float)gap;
        if ((double)h < -plan.largest_indentation || to_bend(h) < (double)table.fold_distance)
            continue;
        nt_interaction_state history = {.attached = i / 4 % 2};
        int attached = history.attached;
        const nt_law_value truth = nt_interaction_eval_gap(&plan, &history, NULL, h);
        const double found = (double)nt_force_table_eval(&table, &attached, h).force;
        const double error = fabs(found - truth.F) / larger(fabs(truth.F), (double)table.scale);
        if (!(error <= (double)table.bound))
            fail_msg("h = %.9g, attached %d: %.9g and %.9g N, error %.3g of %.3g", (double)h, history.attached, found,
                     truth.F, error, (double)table.bound);
        ++compared;
    }
    return compared;
}

static void scenes_keep_their_bound(void **state)
{
    (void)state;
    const double demands[] = {0.1, 0.01, 1e-3, 1e-4, 0.0};
    nt_scene scenes[7];
    for (int i = 0; i < 7; ++i)
        scenes[i] = nt_scene_defaults();
    for (int i = 1; i < 7; ++i)
        scenes[i].medium.relative_humidity = 0.0;
    scenes[2].adhesion.work_of_adhesion = scenes[2].adhesion.hamaker_constant = 0.0;
    scenes[3].tip.shape = NT_SHAPE_CONE;
    scenes[4].sample.youngs_modulus = 1e6;
    scenes[5].adhesion.hamaker_constant = 0.0;
    scenes[6].range.minimum_gap = 5e-9; /* never touches */
    for (size_t d = 0; d < sizeof demands / sizeof *demands; ++d)
        for (int i = 0; i < 7; ++i) {
            nt_demand demand = nt_demand_defaults();
            demand.relative_accuracy = demands[d];
            const nt_plan_inputs inputs = {.scene = &scenes[i], .demand = &demand};
            if (nt_plan_make(&plan, &inputs, NULL) != NT_OK)
                continue; /* not so accurate */
            make(&scenes[i], &demand);
            assert_true((double)table.bound <= 1.06 * larger(0.1 * demands[d], 4e-6) + 2.1e-5);
            assert_true(table.fold_distance < 1e-12f);
            assert_true(keeps_its_bound(d * 7 + (uint64_t)i) > 1000);
        }
}

static void what_has_no_table_is_refused(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    nt_problem problem;
    char text[200];
    make(&scene, NULL);
    const nt_force_table before = table;
    assert_int_equal(nt_force_table_make(&table, pieces, 3, &plan, &problem), NT_E_CAPACITY);
    assert_string_equal(nt_problem_print(&problem, text, sizeof text), "it needs more pieces than there is place for");
    static nt_plan over;
    static const nt_surface surface;
    nt_plan_copy(&over, &plan);
    over.surface = &surface; /* nothing of it is looked at */
    assert_int_equal(nt_force_table_make(&table, pieces, NT_FORCE_PIECES, &over, &problem), NT_E_RANGE);
    assert_int_equal(problem.code, NT_PROBLEM_FORCE_TABLE_SURFACE);
    over.surface = NULL;
    over.history = NT_HISTORY_DENTS;
    assert_int_equal(nt_force_table_make(&table, pieces, NT_FORCE_PIECES, &over, &problem), NT_E_RANGE);
    assert_int_equal(problem.code, NT_PROBLEM_FORCE_TABLE_DENTS);
    assert_int_equal(nt_force_table_make(&table, pieces, 0, &plan, &problem), NT_E_ARGUMENT);
    assert_int_equal(nt_force_table_make(NULL, pieces, 9, &plan, &problem), NT_E_ARGUMENT);
    assert_memory_equal(&before, &table, sizeof table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cubics_are_evaluated),
        cmocka_unit_test(history_is_kept),
        cmocka_unit_test(beyond_its_ends),
        cmocka_unit_test(scenes_keep_their_bound),
        cmocka_unit_test(what_has_no_table_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
