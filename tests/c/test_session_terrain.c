/* SPDX-License-Identifier: BSD-3-Clause
 * A terrain: surface, radii, bank and plan of a scene, each made once, and the same whichever way its surface is given;
 * inputs that are refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "assertions.h"
#include "internal/terrain.h"
#include "larger.h"
#include "nanotouch/advanced/terrain.h"
#include "session/terrain.h"

enum { MOST = 129 };
static double heights[MOST * MOST];

/* A built-in sample on pixels x pixels over a width [m], the last row and column once more, as in Python. */
static nt_height_map sample(double (*height)(const void *, double, double), const void *what, long pixels, double width)
{
    const double pixel = width / (double)pixels;
    const long n = pixels + 1;
    for (long j = 0; j < n; j++)
        for (long i = 0; i < n; i++)
            heights[j * n + i] = height(what, (double)(i < pixels ? i : pixels - 1) * pixel,
                                        (double)(j < pixels ? j : pixels - 1) * pixel);
    return (nt_height_map){heights, n, n, pixel, pixel};
}

static double dots_height(const void *what, double x, double y)
{
    return nt_dots_height(what, x, y);
}
static double grating_height(const void *what, double x, double y)
{
    return nt_grating_height(what, x, y);
}

static nt_height_map dots_map(void)
{
    nt_dots dots;
    assert_int_equal(nt_dots_scatter(&dots, 24, 500e-9, 1), NT_OK);
    return sample(dots_height, &dots, 96, 500e-9);
}

static nt_height_map grating_map(void)
{
    const nt_grating grating = nt_grating_defaults();
    return sample(grating_height, &grating, 128, 6e-6);
}

static nt_terrain *made(const nt_terrain_setup *setup)
{
    nt_terrain *terrain = NULL;
    nt_problem problem = {0};
    const nt_status status = nt_terrain_make(&terrain, setup, &problem);
    if (status != NT_OK)
        fail_msg("%d: %s = %g", status, problem.field ? problem.field : "?", problem.value);
    return terrain;
}

/* A rigid sample as it was composed; one that deforms has a table for each of some radii. */
static void assert_planned(const nt_plan *plan, double accuracy, double lambda, double bound)
{
    const double rigid = larger(plan->rigid_error, plan->around_error), found = plan->bound.force_error;
    if (plan->relief.count > 0) {
        assert_true(rigid > accuracy && found <= accuracy);
        assert_within(plan->lambda, lambda, rigid * lambda);
        return;
    }
    assert_within(plan->lambda, lambda, 1e-12 * lambda);
    assert_true(found >= bound * (1.0 - 1e-9) && found <= (bound + rigid) * (1.0 + 1e-9));
}

/* What Python's composition gave for these scenes before it was C, and since hollows are kept to 3 R: bounds of the
 * radii, pixels at their limits, range and fineness of the bank, and what the plan made of it. */
static void is_what_python_composed(void **state)
{
    (void)state;
    const struct {
        nt_height_map (*map)(void);
        double radius, accuracy, humidity;
        double least, largest;
        long limited;
        double lambda_min, lambda_max, deepest;
        int fineness;
        double lambda, bound, indentation;
    } cases[] = {
        {dots_map, 20e-9, 0.01, 0.4, 2e-09, 6e-08, 758, 1e-2, 1e-1, 1e3, 4, 0.040136064168705264, 0.0033168623827704289,
         2.8529276691665524e-09},
        {dots_map, 20e-9, 5e-5, 0.4, 2e-09, 6e-08, 758, 1e-2, 1e-1, 1e3, 8, 0.040136064168705264,
         3.5379319190890164e-05, 2.8529276691665524e-09},
        {dots_map, 50e-9, 0.01, 0.0, 5e-09, 1.5e-07, 1743, 1e-2, 1e0, 1e3, 4, 0.22442131802224558,
         0.0067778136629647974, 2.1043880340882543e-09},
        {grating_map, 20e-9, 0.01, 0.4, 1.3758156941318539e-08, 2.489627741156294e-08, 0, 1e-2, 1e-1, 1e2, 4,
         0.040136064168705264, 0.0013351091331703733, 2.8529276691665524e-09},
        {grating_map, 50e-9, 0.01, 0.0, 5e-09, 6.92091377188826e-08, 516, 1e-2, 1e0, 1e3, 4, 0.22442131802224558,
         0.0083414930317965378, 2.1043880340882543e-09},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        nt_terrain_setup setup = nt_terrain_defaults();
        setup.scene.tip.radius = cases[i].radius;
        setup.scene.medium.relative_humidity = cases[i].humidity;
        setup.scene.range.maximum_load = 2.2e-6;
        setup.demand.relative_accuracy = cases[i].accuracy;
        setup.map = cases[i].map();
        nt_terrain *terrain = made(&setup);
        const nt_radius_map *radii = nt_terrain_radii(terrain);
        const nt_maugis_bank_options *bank = &nt_terrain_bank(terrain)->options;
        const nt_plan *plan = nt_terrain_plan(terrain);
        assert_within(radii->minimum, cases[i].least, 1e-12 * cases[i].least);
        assert_within(radii->maximum, cases[i].largest, 1e-12 * cases[i].largest);
        assert_int_equal(radii->limited, cases[i].limited);
        assert_within(bank->lambda_min, cases[i].lambda_min, 1e-15);
        assert_within(bank->lambda_max, cases[i].lambda_max, 1e-15);
        assert_within(bank->largest_indentation, cases[i].deepest, 1e-12);
        assert_int_equal(bank->panels_per_octave, cases[i].fineness);
        assert_int_equal(bank->cells_per_octave, cases[i].fineness);
        assert_planned(plan, cases[i].accuracy, cases[i].lambda, cases[i].bound);
        if (plan->relief.count == 0)
            assert_within(plan->largest_indentation, cases[i].indentation, 1e-12 * cases[i].indentation);
        nt_terrain_close(terrain);
    }
}

/* Raw heights, heights of the apex, or a surface with its radii: one terrain. */
static void three_ways_to_one_terrain(void **state)
{
    (void)state;
    static double dilated[MOST * MOST], coefficients[MOST * MOST], ratios[MOST * MOST];
    nt_terrain_setup raw = nt_terrain_defaults(), apex = raw, borrowed = raw;
    raw.map = dots_map();
    const nt_tip_shape tip = {raw.scene.tip.radius, raw.scene.tip.half_angle};
    assert_int_equal(nt_surface_dilate(&raw.map, &tip, dilated), NT_OK);
    apex.map = raw.map;
    apex.map.heights = dilated;
    apex.dilated = 1;
    nt_surface surface;
    nt_radius_map radii;
    assert_int_equal(nt_surface_init(&surface, &apex.map, coefficients), NT_OK);
    assert_int_equal(nt_radius_map_init(&radii, &surface, tip.radius, NULL, ratios), NT_OK);
    borrowed.surface = &surface;
    borrowed.radii = &radii;
    nt_terrain *terrains[] = {made(&raw), made(&apex), made(&borrowed)};
    const size_t pixels = (size_t)(raw.map.nx * raw.map.ny);
    for (int k = 0; k < 3; k++) {
        const nt_terrain *t = terrains[k];
        const nt_plan *plan = nt_terrain_plan(t);
        assert_memory_equal(nt_terrain_surface(t)->coefficients, coefficients, pixels * sizeof(double));
        assert_memory_equal(nt_terrain_radii(t)->ratio.coefficients, ratios, pixels * sizeof(double));
        assert_true(plan->surface == nt_terrain_surface(t) && plan->radii == nt_terrain_radii(t));
        assert_true(plan->bank == nt_terrain_bank(t) && plan->terms[NT_PLAN_CONTACT].form == NT_FORM_LOCAL);
        assert_true(plan->bound.force_error == nt_terrain_plan(terrains[0])->bound.force_error);
    }
    assert_true(nt_terrain_surface(terrains[2]) == &surface);
    for (int k = 0; k < 3; k++)
        nt_terrain_close(terrains[k]);
}

/* In two steps with a bank between them, a plan is what it is in one. */
static void plan_is_that_of_the_parts(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_terrain_setup setup = nt_terrain_defaults();
    setup.map = dots_map();
    setup.probe = &rig.probe;
    setup.demand.relative_accuracy = 1e-3;
    nt_terrain *terrain = made(&setup);
    const nt_plan *plan = nt_terrain_plan(terrain);
    static nt_plan whole;
    const nt_plan_inputs inputs = {.scene = &setup.scene,
                                   .demand = &setup.demand,
                                   .probe = setup.probe,
                                   .surface = nt_terrain_surface(terrain),
                                   .radii = plan->radii,
                                   .bank = plan->bank};
    assert_int_equal(nt_plan_make(&whole, &inputs, NULL), NT_OK);
    assert_memory_equal(whole.terms, plan->terms, sizeof whole.terms);
    assert_memory_equal(&whole.bound, &plan->bound, sizeof whole.bound);
    assert_true(whole.demand.force_floor == 0.0 && plan->demand.force_floor == 0.0);
    assert_true(whole.probe_noise == plan->probe_noise && plan->probe_noise > 0.0);
    assert_true(whole.pull_off_force == plan->pull_off_force && whole.cost == plan->cost);
    nt_terrain_close(terrain);
}

/* No bank where none could serve: on a flat, on a level map, without adhesion, without radii. */
static void no_bank_without_a_use(void **state)
{
    (void)state;
    nt_terrain_setup flat = nt_terrain_defaults(), level = flat, hard = flat, uncurved = flat;
    nt_terrain *terrain = made(&flat);
    assert_true(!nt_terrain_surface(terrain) && !nt_terrain_radii(terrain) && !nt_terrain_bank(terrain));
    assert_true(nt_terrain_plan(terrain)->cost > 0.0);
    nt_terrain_close(terrain);
    memset(heights, 0, sizeof heights);
    level.map = (nt_height_map){heights, 16, 16, 1e-9, 1e-9};
    terrain = made(&level);
    assert_true(nt_terrain_radii(terrain) && !nt_terrain_bank(terrain));
    nt_terrain_close(terrain);
    hard.map = dots_map();
    hard.scene.medium.relative_humidity = hard.scene.adhesion.work_of_adhesion = 0.0;
    hard.scene.adhesion.hamaker_constant = 0.0;
    terrain = made(&hard);
    assert_true(!nt_terrain_bank(terrain));
    assert_int_equal(nt_terrain_plan(terrain)->terms[NT_PLAN_CONTACT].form, NT_FORM_LOCAL); /* Hertz */
    uncurved.surface = nt_terrain_surface(terrain);
    nt_terrain *without = made(&uncurved);
    assert_true(!nt_terrain_radii(without) && !nt_terrain_bank(without));
    nt_terrain_close(without);
    nt_terrain_close(terrain);
    nt_terrain_close(NULL);
}

static void assert_refused(const nt_terrain_setup *setup, nt_status status, const char *field)
{
    nt_terrain *const before = (nt_terrain *)&heights, *terrain = before;
    nt_problem problem = {.field = ""};
    assert_int_equal(nt_terrain_make(&terrain, setup, &problem), status);
    assert_string_equal(problem.field, field);
    assert_int_equal(nt_terrain_make(&terrain, setup, NULL), status);
    assert_true(terrain == before);
}

static void bad_inputs_are_named(void **state)
{
    (void)state;
    nt_terrain_setup good = nt_terrain_defaults();
    good.map = (nt_height_map){heights, 8, 8, 1e-9, 1e-9};
    memset(heights, 0, sizeof heights);
    nt_terrain *terrain = NULL;
    assert_int_equal(nt_terrain_make(NULL, &good, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_terrain_make(&terrain, NULL, NULL), NT_E_ARGUMENT);
    nt_terrain_setup bad = good;
    bad.scene.tip.radius = -1.0;
    assert_refused(&bad, NT_E_RANGE, "tip.radius");
    bad = good;
    bad.scene.tip.half_angle = (double)NAN;
    assert_refused(&bad, NT_E_NOT_FINITE, "tip.half_angle");
    bad = good;
    bad.demand.relative_accuracy = 0.9;
    assert_refused(&bad, NT_E_RANGE, "demand.relative_accuracy");
    bad = good;
    bad.demand.budget = 0.5;
    assert_refused(&bad, NT_E_RANGE, "demand.budget");
    bad = good;
    nt_rig rig = nt_rig_defaults();
    rig.probe.spring_constant = 0.0;
    bad.probe = &rig.probe;
    assert_refused(&bad, NT_E_RANGE, "probe.spring_constant");
    bad = good;
    bad.map.nx = 3;
    assert_refused(&bad, NT_E_RANGE, "map.nx");
    bad = good;
    bad.map.dy = (double)NAN;
    assert_refused(&bad, NT_E_NOT_FINITE, "map.dy");
    bad = good;
    bad.map.heights = NULL;
    assert_refused(&bad, NT_E_ARGUMENT, "map.heights");
    bad = good;
    bad.dilated = 2;
    assert_refused(&bad, NT_E_RANGE, "dilated");
    heights[5] = (double)INFINITY;
    assert_refused(&good, NT_E_NOT_FINITE, "map.heights");
    heights[5] = 2.0;
    assert_refused(&good, NT_E_RANGE, "map.heights");
    heights[5] = 0.0;
}

/* A surface with radii that are not its own, or of another tip. */
static void radii_of_something_else_are_refused(void **state)
{
    (void)state;
    nt_terrain_setup setup = nt_terrain_defaults(), bad;
    setup.map = dots_map();
    nt_terrain *terrain = made(&setup);
    nt_radius_map radii = *nt_terrain_radii(terrain);
    nt_terrain_setup good = nt_terrain_defaults();
    good.surface = nt_terrain_surface(terrain);
    good.radii = &radii;
    bad = good;
    bad.map = setup.map;
    assert_refused(&bad, NT_E_ARGUMENT, "surface beside a map");
    bad = good;
    bad.surface = NULL;
    assert_refused(&bad, NT_E_ARGUMENT, "radii without a surface");
    bad = good;
    bad.scene.tip.radius = 40e-9;
    assert_refused(&bad, NT_E_RANGE, "tip.radius");
    radii.ratio.nx--;
    assert_refused(&good, NT_E_RANGE, "radii.nx");
    radii.ratio.nx++;
    radii.ratio.dy *= 2.0;
    assert_refused(&good, NT_E_RANGE, "radii.dy");
    nt_terrain_close(terrain);
}

/* Properties that are on another grid, or on none. */
static void properties_of_something_else_are_refused(void **state)
{
    (void)state;
    nt_terrain_setup setup = nt_terrain_defaults();
    setup.map = dots_map();
    const nt_surface grid = {setup.map.heights, setup.map.nx, setup.map.ny, setup.map.dx, setup.map.dy, 0.0, 0.0};
    const size_t pixels = (size_t)setup.map.nx * (size_t)setup.map.ny;
    double *modulus = malloc(pixels * sizeof *modulus);
    assert_non_null(modulus);
    for (size_t p = 0; p < pixels; p++)
        modulus[p] = p % 7 ? 1e9 : 3e9;
    nt_properties properties;
    assert_int_equal(nt_properties_init(&properties, &grid, modulus, NULL, NULL), NT_OK);
    setup.properties = &properties;
    nt_terrain *terrain = made(&setup);
    assert_true(nt_terrain_plan(terrain)->properties == &properties && nt_terrain_bank(terrain));
    nt_terrain_close(terrain);
    properties.youngs_modulus.nx--;
    assert_refused(&setup, NT_E_RANGE, "properties.nx");
    properties.youngs_modulus.nx++;
    properties.youngs_modulus.dx *= 2.0;
    assert_refused(&setup, NT_E_RANGE, "properties.dx");
    setup.map = (nt_height_map){0};
    assert_refused(&setup, NT_E_ARGUMENT, "properties without a surface");
    free(modulus);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_what_python_composed),
        cmocka_unit_test(three_ways_to_one_terrain),
        cmocka_unit_test(plan_is_that_of_the_parts),
        cmocka_unit_test(no_bank_without_a_use),
        cmocka_unit_test(bad_inputs_are_named),
        cmocka_unit_test(radii_of_something_else_are_refused),
        cmocka_unit_test(properties_of_something_else_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
