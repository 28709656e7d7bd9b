/* SPDX-License-Identifier: BSD-3-Clause
 * What of a terrain can be reached, on surfaces of known height, slope and radius: a wave and a ball under the tip. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "internal/terrain.h"
#include "larger.h"
#include "nanotouch/advanced/terrain.h"
#include "session/terrain.h"

enum { N = 161 };
#define PIXEL 1e-9
#define WIDTH ((N - 1) * PIXEL)
#define X0 (0.5 * WIDTH)
#define R 20e-9
#define AMPLITUDE 4e-9
#define K (4.0 * 3.14159265358979323846 / WIDTH) /* two waves */
static double heights[N * N];

static double wave(double x, double y)
{
    (void)y;
    return AMPLITUDE * cos(K * x);
}

/* A ball of 60 nm: the apex of a tip of 20 nm goes over a ball of 80 nm, and 1/R_eff = 1/20 + 1/60. */
#define BALL 60e-9
static double ball(double x, double y)
{
    const double r2 = (x - X0) * (x - X0) + (y - X0) * (y - X0);
    return sqrt(larger(BALL * BALL - r2, 0.0)) - BALL;
}

static nt_terrain *terrain_of(double (*height)(double x, double y), int dilated)
{
    nt_terrain_setup setup = nt_terrain_defaults();
    nt_terrain *terrain = NULL;
    for (int j = 0; height && j < N; j++)
        for (int i = 0; i < N; i++)
            heights[j * N + i] = height(i * PIXEL, j * PIXEL);
    if (height)
        setup.map = (nt_height_map){heights, N, N, PIXEL, PIXEL};
    setup.dilated = dilated;
    assert_int_equal(nt_terrain_make(&terrain, &setup, NULL), NT_OK);
    return terrain;
}

static void over_a_wave(void **state)
{
    (void)state;
    nt_terrain *terrain = terrain_of(wave, 1);
    nt_reach reach;
    /* from the flank down into a trough and up the next crest */
    const double path[] = {1.5707963267948966 / K, 30e-9, 6.5 / K, 30e-9};
    assert_int_equal(nt_terrain_reach_path(terrain, path, 2, &reach, NULL), NT_OK);
    assert_within(reach.rise, AMPLITUDE, 1e-5 * AMPLITUDE);
    assert_within(reach.relief, 2.0 * AMPLITUDE, 1e-5 * AMPLITUDE);
    assert_within(reach.slope, AMPLITUDE * K, 1.2e-3 * AMPLITUDE * K);
    /* the whole, started in a trough: R_eff = R (1 - R k)^(1/2) with the curvature k = +-A K^2 of crest and trough */
    const nt_area whole = nt_terrain_whole(terrain, 3.14159265358979323846 / K, 30e-9);
    assert_int_equal(nt_terrain_reach_area(terrain, &whole, &reach, NULL), NT_OK);
    assert_within(reach.rise, 2.0 * AMPLITUDE, 1e-5 * AMPLITUDE);
    assert_within(reach.slope, AMPLITUDE * K, 1.2e-3 * AMPLITUDE * K);
    assert_within(reach.least_radius, R * sqrt(1.0 - R * AMPLITUDE * K * K), 1e-3 * R);
    assert_within(reach.largest_radius, R * sqrt(1.0 + R * AMPLITUDE * K * K), 1e-3 * R);
    assert_true(reach.least_radius == nt_terrain_radii(terrain)->minimum);
    assert_true(reach.largest_radius == nt_terrain_radii(terrain)->maximum);
    /* across the wave nothing changes */
    const double level[] = {40e-9, 10e-9, 40e-9, 150e-9};
    assert_int_equal(nt_terrain_reach_path(terrain, level, 2, &reach, NULL), NT_OK);
    assert_within(reach.relief, 0.0, 1e-5 * AMPLITUDE);
    assert_within(reach.slope, 0.0, 2e-9);
    nt_terrain_close(terrain);
}

/* Heights to 0.05 nm, as dilation between the pixels has them; radii to 1 %, and their bounds, which are the least and
 * the largest of all pixels that reach the path, to 2 %. */
static void over_a_ball(void **state)
{
    (void)state;
    nt_terrain *terrain = terrain_of(ball, 0);
    nt_reach reach;
    const double path[] = {X0 - 30e-9, X0, X0 + 25e-9, X0}, sphere = BALL + R;
    const double start = sqrt(sphere * sphere - 30e-9 * 30e-9);
    assert_int_equal(nt_terrain_reach_path(terrain, path, 2, &reach, NULL), NT_OK);
    assert_within(reach.rise, sphere - start, 0.05e-9);
    assert_within(reach.slope, 30e-9 / start, 0.01);
    assert_within(reach.least_radius, 15e-9, 0.02 * 15e-9);
    assert_within(reach.largest_radius, 15e-9, 0.02 * 15e-9);
    const nt_area around = {X0, X0, X0 - 20e-9, X0 + 20e-9, X0 - 20e-9, X0 + 20e-9};
    const double corner = sqrt(sphere * sphere - 2.0 * 20e-9 * 20e-9);
    assert_int_equal(nt_terrain_reach_area(terrain, &around, &reach, NULL), NT_OK);
    assert_within(reach.rise, 0.0, 0.05e-9);
    assert_within(reach.relief, sphere - corner, 0.05e-9);
    assert_within(reach.slope, sqrt(2.0) * 20e-9 / corner, 0.01);
    nt_terrain_close(terrain);
}

static void a_flat_is_level_everywhere(void **state)
{
    (void)state;
    nt_terrain *terrain = terrain_of(NULL, 0);
    nt_reach reach;
    const double path[] = {-1.0, 2.0, 3.0, 4.0};
    assert_int_equal(nt_terrain_reach_path(terrain, path, 2, &reach, NULL), NT_OK);
    assert_true(reach.rise == 0.0 && reach.relief == 0.0 && reach.slope == 0.0);
    assert_true(reach.least_radius == R && reach.largest_radius == R);
    assert_true(reach.least_modulus == 0.0 && reach.largest_work == 0.0);
    const nt_area whole = nt_terrain_whole(terrain, 1.0, -1.0);
    assert_int_equal(nt_terrain_reach_area(terrain, &whole, &reach, NULL), NT_OK);
    assert_true(reach.rise == 0.0 && reach.slope == 0.0);
    nt_terrain_close(terrain);
}

/* Soft and sticky on the left, hard and less sticky on the right: what is reached is what lies on the way. */
static void properties_that_are_reached(void **state)
{
    (void)state;
    static double modulus[N * N], work[N * N];
    for (int k = 0; k < N * N; k++) {
        heights[k] = 0.0;
        modulus[k] = k % N < N / 2 ? 1e9 : 50e9;
        work[k] = k % N < N / 2 ? 0.08 : 0.02;
    }
    nt_terrain_setup setup = nt_terrain_defaults();
    setup.scene.medium.relative_humidity = 0.0;
    setup.scene.adhesion.hamaker_constant = 1e-20;
    setup.scene.range.maximum_load = 100e-9;
    setup.map = (nt_height_map){heights, N, N, PIXEL, PIXEL};
    const nt_surface grid = {heights, N, N, PIXEL, PIXEL, 0.0, 0.0};
    nt_properties properties;
    assert_int_equal(nt_properties_init(&properties, &grid, modulus, work, NULL), NT_OK);
    setup.properties = &properties;
    nt_terrain *terrain = NULL;
    nt_reach reach;
    assert_int_equal(nt_terrain_make(&terrain, &setup, NULL), NT_OK);
    const double middle = 0.5 * (N - 1) * PIXEL, left[] = {5.0 * PIXEL, middle, 20.0 * PIXEL, middle};
    assert_int_equal(nt_terrain_reach_path(terrain, left, 2, &reach, NULL), NT_OK);
    assert_true(reach.least_modulus == 1e9 && reach.largest_modulus == 1e9);
    assert_true(reach.least_work == 0.08 && reach.largest_work == 0.08);
    const nt_area whole = nt_terrain_whole(terrain, middle, middle);
    assert_int_equal(nt_terrain_reach_area(terrain, &whole, &reach, NULL), NT_OK);
    assert_true(reach.least_modulus == 1e9 && reach.largest_modulus == 50e9);
    assert_true(reach.least_work == 0.02 && reach.largest_work == 0.08);
    nt_terrain_close(terrain);
}

static void places_elsewhere_are_refused(void **state)
{
    (void)state;
    nt_terrain *terrain = terrain_of(wave, 1);
    const nt_reach before = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0};
    nt_reach reach = before;
    nt_problem problem;
    const struct {
        double xy[4];
        nt_status status;
        const char *field;
    } paths[] = {
        {{0.0, 0.0, -1e-12, 0.0}, NT_E_RANGE, "path.x"},
        {{0.0, 0.0, 1e-9, 1.001 * WIDTH}, NT_E_RANGE, "path.y"},
        {{(double)NAN, 0.0, 0.0, 0.0}, NT_E_NOT_FINITE, "path.x"},
        {{0.0, (double)INFINITY, 0.0, 0.0}, NT_E_NOT_FINITE, "path.y"},
    };
    for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++) {
        assert_int_equal(nt_terrain_reach_path(terrain, paths[i].xy, 2, &reach, &problem), paths[i].status);
        assert_string_equal(problem.field, paths[i].field);
        assert_true(problem.minimum == 0.0 && problem.maximum == WIDTH);
        assert_int_equal(nt_terrain_reach_path(terrain, paths[i].xy, 2, &reach, NULL), paths[i].status);
    }
    assert_int_equal(nt_terrain_reach_path(terrain, paths[0].xy, 0, &reach, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "path.count");
    assert_int_equal(nt_terrain_reach_path(terrain, NULL, 1, &reach, NULL), NT_E_ARGUMENT);
    const struct {
        nt_area area;
        nt_status status;
        const char *field;
    } areas[] = {
        {{1e-9, 1e-9, -1e-9, 2e-9, 0.0, 2e-9}, NT_E_RANGE, "area.x_min"},
        {{1e-9, 1e-9, 3e-9, 2e-9, 0.0, 2e-9}, NT_E_RANGE, "area.x_max"},
        {{1e-9, 1e-9, 0.0, 2e-9, (double)NAN, 2e-9}, NT_E_NOT_FINITE, "area.y_min"},
        {{1e-9, 1e-9, 0.0, 2e-9, 0.0, 2.0 * WIDTH}, NT_E_RANGE, "area.y_max"},
        {{3e-9, 1e-9, 0.0, 2e-9, 0.0, 2e-9}, NT_E_RANGE, "area.x"},
        {{1e-9, (double)NAN, 0.0, 2e-9, 0.0, 2e-9}, NT_E_NOT_FINITE, "area.y"},
    };
    for (size_t i = 0; i < sizeof areas / sizeof areas[0]; i++) {
        assert_int_equal(nt_terrain_reach_area(terrain, &areas[i].area, &reach, &problem), areas[i].status);
        assert_string_equal(problem.field, areas[i].field);
    }
    assert_int_equal(nt_terrain_reach_area(terrain, NULL, &reach, NULL), NT_E_ARGUMENT);
    assert_memory_equal(&reach, &before, sizeof reach);
    nt_terrain_close(terrain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(over_a_wave),
        cmocka_unit_test(over_a_ball),
        cmocka_unit_test(a_flat_is_level_everywhere),
        cmocka_unit_test(properties_that_are_reached),
        cmocka_unit_test(places_elsewhere_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
