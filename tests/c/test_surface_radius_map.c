/* SPDX-License-Identifier: BSD-3-Clause
 * The effective radius on surfaces of known curvature: sphere on sphere, sphere in a bowl, on a cylinder, on an edge.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/surface.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/surface.h"

enum { NX = 120, NY = 100 };
#define DX 1e-9
#define DY 1.2e-9
#define R 20e-9
static double heights[NX * NY], dilated[NX * NY], coefficients[NX * NY], ratios[NX * NY];

/* Heights, their dilation by a sphere of radius R (a steep flank), the spline and the radius map. */
static nt_radius_map map_of(double (*height)(double x, double y), nt_surface *surface)
{
    const nt_tip_shape tip = {R, 0.05};
    for (int j = 0; j < NY; j++)
        for (int i = 0; i < NX; i++)
            heights[j * NX + i] = height(i * DX, j * DY);
    const nt_height_map map = {heights, NX, NY, DX, DY}, touched = {dilated, NX, NY, DX, DY};
    nt_radius_map radius;
    assert_int_equal(nt_surface_dilate(&map, &tip, dilated), NT_OK);
    assert_int_equal(nt_surface_init(surface, &touched, coefficients), NT_OK);
    assert_int_equal(nt_radius_map_init(&radius, surface, R, NULL, ratios), NT_OK);
    return radius;
}

#define X0 (60 * DX)
#define Y0 (50 * DY)

/* A ball of 60 nm: 1/R_eff = 1/R + 1/60 nm. */
static double ball(double x, double y)
{
    const double r2 = (x - X0) * (x - X0) + (y - Y0) * (y - Y0);
    return sqrt(larger(60e-9 * 60e-9 - r2, 40e-9 * 40e-9));
}

/* A bowl of 80 nm: 1/R_eff = 1/R - 1/80 nm. */
static double bowl(double x, double y)
{
    const double r2 = (x - X0) * (x - X0) + (y - Y0) * (y - Y0);
    return -sqrt(larger(80e-9 * 80e-9 - r2, 30e-9 * 30e-9));
}

/* A cylinder of 50 nm along y: R_eff = R sqrt(50/(50 + 20)). */
static double cylinder(double x, double y)
{
    (void)y;
    return sqrt(larger(50e-9 * 50e-9 - (x - X0) * (x - X0), 20e-9 * 20e-9));
}

/* Where the body is analytic under the tip: 1 %, left by the parabola between the pixels, at every place; without it
 * 50 %. */
static void spheres_on_spheres(void **state)
{
    (void)state;
    const struct {
        double (*height)(double x, double y);
        double expected;
    } bodies[] = {{ball, R / (1.0 + R / 60e-9)}, {bowl, R / (1.0 - R / 80e-9)}, {cylinder, R / sqrt(1.0 + R / 50e-9)}};
    for (size_t b = 0; b < sizeof bodies / sizeof bodies[0]; b++) {
        nt_surface surface;
        const nt_radius_map map = map_of(bodies[b].height, &surface);
        double worst = 0.0;
        for (double x = -15e-9; x <= 15e-9; x += 0.37e-9)
            for (double y = -15e-9; y <= 15e-9; y += 0.41e-9)
                worst = larger(worst, fabs(nt_radius_map_eval(&map, X0 + x, Y0 + y).radius / bodies[b].expected - 1.0));
        if (!(worst < 0.01))
            fail_msg("body %d: %g", (int)b, worst);
    }
}

static double step(double x, double y)
{
    return (x > X0 ? 30e-9 : 0.0) + 0.0 * y;
}

static double noise(double x, double y)
{
    nt_random random = nt_random_seed((uint64_t)lround(x / DX) * 1000 + (uint64_t)lround(y / DY));
    return 3e-9 * nt_random_uniform(&random);
}

/* The radius stays in its bounds everywhere, they are inside the limits, and the pixels that needed them are counted:
 * none on a ball, the columns over which the tip turns round the edge of a step. */
static void bounds_are_kept_and_counted(void **state)
{
    (void)state;
    double (*bodies[])(double, double) = {ball, step, noise};
    nt_random random = nt_random_seed(7);
    for (int b = 0; b < 3; b++) {
        nt_surface surface;
        const nt_radius_map map = map_of(bodies[b], &surface);
        assert_true(map.minimum >= 0.1 * R && map.maximum <= 3.0 * R);
        for (int k = 0; k < 20000; k++) {
            const double x = (1.2 * nt_random_uniform(&random) - 0.1) * NX * DX;
            const nt_radius_value at = nt_radius_map_eval(&map, x, NY * DY * nt_random_uniform(&random));
            assert_true(at.radius >= map.minimum * (1.0 - 1e-15) && at.radius <= map.maximum * (1.0 + 1e-15));
        }
        const long columns = map.limited / NY;
        assert_true(b == 0 || map.limited > 0);
        if (b == 1) /* over the edge the centre of the tip goes a quarter of a circle, 20 pixels wide at most */
            assert_true(map.limited == columns * NY && columns >= 5 && columns <= 25);
    }
    nt_surface surface;
    const nt_radius_map round = map_of(ball, &surface);
    const nt_radius_limits narrow = {0.9, 1.0};
    nt_radius_map limited;
    assert_int_equal(nt_radius_map_init(&limited, &surface, R, &narrow, ratios), NT_OK);
    assert_true(limited.limited > round.limited && limited.minimum == 0.9 * R && limited.maximum == R);
}

/* Central differences over 1e-4 pixel; the radius of noise. */
static void slopes_are_the_derivatives(void **state)
{
    (void)state;
    nt_surface surface;
    const nt_radius_map map = map_of(noise, &surface);
    nt_random random = nt_random_seed(5);
    const double h = 1e-4 * DX;
    for (int k = 0; k < 5000; k++) {
        const double x = NX * DX * nt_random_uniform(&random), y = NY * DY * nt_random_uniform(&random);
        const nt_radius_value at = nt_radius_map_eval(&map, x, y);
        const double east = nt_radius_map_eval(&map, x + h, y).radius, west = nt_radius_map_eval(&map, x - h, y).radius;
        const double north = nt_radius_map_eval(&map, x, y + h).radius;
        const double south = nt_radius_map_eval(&map, x, y - h).radius;
        if (x - h < 0.0 || x + h > (NX - 1) * DX || y - h < 0.0 || y + h > (NY - 1) * DY)
            continue; /* level outside */
        assert_true(fabs((east - west) / (2.0 * h) - at.dx) < 1e-3 * R / DX);
        assert_true(fabs((north - south) / (2.0 * h) - at.dy) < 1e-3 * R / DX);
    }
}

static void flat_is_the_tip_and_bad_input_is_refused(void **state)
{
    (void)state;
    const nt_surface flat = nt_surface_flat();
    nt_radius_map map;
    assert_int_equal(nt_radius_map_init(&map, &flat, R, NULL, NULL), NT_OK);
    const nt_radius_value at = nt_radius_map_eval(&map, 1.0, -3.0);
    assert_true(at.radius == R && at.dx == 0.0 && at.dy == 0.0 && map.minimum == R && map.maximum == R);
    assert_true(isnan(nt_radius_map_eval(&map, (double)NAN, 0.0).radius));
    nt_surface surface;
    const nt_radius_map good = map_of(ball, &surface);
    assert_true(isnan(nt_radius_map_eval(&good, 0.0, (double)NAN).dx));
    const nt_radius_limits wrong[] = {{0.0, 10.0}, {0.1, 0.5}, {2.0, 10.0}, {0.1, (double)INFINITY}};
    for (size_t i = 0; i < 4; i++)
        assert_true(nt_radius_map_init(&map, &surface, R, &wrong[i], ratios) != NT_OK);
    assert_int_equal(nt_radius_map_init(&map, &surface, 0.0, NULL, ratios), NT_E_RANGE);
    assert_int_equal(nt_radius_map_init(&map, &surface, (double)NAN, NULL, ratios), NT_E_NOT_FINITE);
    assert_int_equal(nt_radius_map_init(&map, &surface, R, NULL, NULL), NT_E_ARGUMENT);
    assert_true(map.tip_radius == R);
}

/* Height and radius of a place are the same as one by one, and the same as with all derivatives to rounding: 16
 * products of 1e-16 of the range of the coefficients; inside, at the borders, beyond them, at NaN. */
static void a_place_has_both(void **state)
{
    (void)state;
    nt_surface surface;
    const nt_radius_map map = map_of(ball, &surface);
    nt_random random = nt_random_seed(5);
    for (int n = 0; n < 20000; n++) {
        const double x = (1.2 * nt_random_uniform(&random) - 0.1) * NX * DX;
        const double y = (1.2 * nt_random_uniform(&random) - 0.1) * NY * DY;
        const nt_place place = nt_surface_place(&surface, &map, NULL, x, y);
        const nt_height_value height = nt_surface_height(&surface, x, y);
        const nt_radius_value radius = nt_radius_map_eval(&map, x, y);
        const nt_surface_value all = nt_surface_eval(&surface, x, y);
        assert_true(place.surface.z == height.z && place.surface.zx == height.zx && place.surface.zy == height.zy);
        assert_true(place.radius.radius == radius.radius && place.radius.dx == radius.dx);
        assert_true(place.radius.dy == radius.dy);
        assert_true(fabs(height.z - all.z) < 16 * 1.2e-16 * 80e-9);
        assert_true(fabs(height.zx - all.zx) < 32 * 1.2e-16 * 80e-9 / DX);
        assert_true(fabs(height.zy - all.zy) < 32 * 1.2e-16 * 80e-9 / DX);
    }
    assert_true(isnan(nt_surface_place(&surface, &map, NULL, NAN, Y0).surface.z));
    const nt_surface flat = nt_surface_flat();
    const nt_radius_map same = {.tip_radius = R};
    const nt_place place = nt_surface_place(&flat, &same, NULL, 1.0, -1.0);
    assert_true(place.surface.z == 0.0 && place.radius.radius == R && place.radius.dx == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_on_spheres),         cmocka_unit_test(bounds_are_kept_and_counted),
        cmocka_unit_test(slopes_are_the_derivatives), cmocka_unit_test(flat_is_the_tip_and_bad_input_is_refused),
        cmocka_unit_test(a_place_has_both),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
