/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/surface.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/surface.h"

enum { NX = 90, NY = 70 };
#define DX 2e-9
#define DY 3e-9
static double heights[NX * NY], coefficients[NX * NY];

static nt_surface surface_of(double (*height)(double x, double y))
{
    for (int j = 0; j < NY; j++)
        for (int i = 0; i < NX; i++)
            heights[j * NX + i] = height(i * DX, j * DY);
    const nt_height_map map = {heights, NX, NY, DX, DY};
    nt_surface surface;
    assert_int_equal(nt_surface_init(&surface, &map, coefficients), NT_OK);
    return surface;
}

static double bumps(double x, double y)
{
    return 10e-9 * sin(x / 17e-9 + 0.3) * cos(y / 23e-9) + 3e-9 * exp(-pow((x - 60e-9) / 9e-9, 2));
}

static double noise(double x, double y)
{
    nt_random random = nt_random_seed((uint64_t)lround(x / DX) * 1000 + (uint64_t)lround(y / DY));
    return 100e-9 * nt_random_uniform(&random);
}

/* The worst case for the filter is noise; 1e-12 of the height range of 100 nm. */
static void passes_through_every_pixel(void **state)
{
    (void)state;
    const nt_surface surface = surface_of(noise);
    assert_true(surface.height_maximum > 99e-9 && surface.height_minimum < 1e-9);
    for (int j = 0; j < NY; j++)
        for (int i = 0; i < NX; i++)
            assert_true(fabs(nt_surface_eval(&surface, i * DX, j * DY).z - heights[j * NX + i]) < 1e-19);
}

static void smallest_maps_work_too(void **state)
{
    (void)state;
    for (long nx = 4; nx < 9; nx++)
        for (long ny = 4; ny < 9; ny++) {
            double small[64], c[64];
            nt_random random = nt_random_seed((uint64_t)(nx * 100 + ny));
            for (long p = 0; p < nx * ny; p++)
                small[p] = c[p] = nt_random_uniform(&random) * 1e-9;
            const nt_height_map map = {c, nx, ny, 1e-9, 1e-9};
            nt_surface surface;
            assert_int_equal(nt_surface_init(&surface, &map, c), NT_OK); /* in place */
            for (long p = 0; p < nx * ny; p++) {
                const double x = (double)(p % nx) * 1e-9, y = (double)(p / nx) * 1e-9;
                assert_true(fabs(nt_surface_eval(&surface, x, y).z - small[p]) < 1e-21);
            }
        }
}

static double cubic(double x, double y)
{
    const double u = x / 100e-9 - 0.8, v = y / 100e-9 - 1.1;
    return 1e-9 * (1.0 + 2.0 * u - v + u * v - u * u + 0.5 * v * v * v + 2.0 * u * u * u + u * u * v - u * v * v * u);
}

/* Cubic splines reproduce cubics; the mirrored border is forgotten by |sqrt(3) - 2|^n = 1e-14 within n = 24 pixels.
 * Curvatures: 50 roundings of the heights over a pixel's area. */
static void cubics_are_exact_away_from_borders(void **state)
{
    (void)state;
    const nt_surface surface = surface_of(cubic);
    nt_random random = nt_random_seed(1);
    for (int k = 0; k < 2000; k++) {
        const double x = (28 + 34 * nt_random_uniform(&random)) * DX, y = (28 + 14 * nt_random_uniform(&random)) * DY;
        const double u = x / 100e-9 - 0.8, v = y / 100e-9 - 1.1;
        const nt_surface_value s = nt_surface_eval(&surface, x, y);
        assert_true(fabs(s.z - cubic(x, y)) < 1e-12 * 1e-9 * 4.0);
        assert_true(fabs(s.zx - 1e-2 * (2.0 + v - 2.0 * u + 6.0 * u * u + 2.0 * u * v - 2.0 * u * v * v)) < 1e-12);
        assert_true(fabs(s.zy - 1e-2 * (-1.0 + u + 1.5 * v * v + u * u - 2.0 * u * u * v)) < 1e-12);
        assert_true(fabs(s.zxx - 1e5 * (-2.0 + 12.0 * u + 2.0 * v - 2.0 * v * v)) < 50 * 1.1e-16 * 4e-9 / (DX * DX));
        assert_true(fabs(s.zxy - 1e5 * (1.0 + 2.0 * u - 4.0 * u * v)) < 50 * 1.1e-16 * 4e-9 / (DX * DX));
        assert_true(fabs(s.zyy - 1e5 * (3.0 * v - 2.0 * u * u)) < 50 * 1.1e-16 * 4e-9 / (DX * DX));
    }
}

/* Central differences over 1e-3 pixel: truncation (1e-3)^2 / 6 of the range, rounding 1e-16 / 1e-3; of a noisy map. */
static void slopes_are_the_derivatives(void **state)
{
    (void)state;
    const nt_surface s = surface_of(noise);
    nt_random random = nt_random_seed(2);
    const double hx = 1e-3 * DX, hy = 1e-3 * DY, range = 100e-9;
    for (int k = 0; k < 2000; k++) { /* off the pixel borders, where the third derivative jumps */
        const double x = (floor(1 + 87 * nt_random_uniform(&random)) + 0.1 + 0.8 * nt_random_uniform(&random)) * DX;
        const double y = (floor(1 + 67 * nt_random_uniform(&random)) + 0.1 + 0.8 * nt_random_uniform(&random)) * DY;
        const nt_surface_value v = nt_surface_eval(&s, x, y);
        const nt_surface_value e = nt_surface_eval(&s, x + hx, y), w = nt_surface_eval(&s, x - hx, y);
        const nt_surface_value n = nt_surface_eval(&s, x, y + hy), o = nt_surface_eval(&s, x, y - hy);
        assert_true(fabs((e.z - w.z) / (2 * hx) - v.zx) < 1e-5 * range / DX);
        assert_true(fabs((n.z - o.z) / (2 * hy) - v.zy) < 1e-5 * range / DY);
        assert_true(fabs((e.zx - w.zx) / (2 * hx) - v.zxx) < 1e-5 * range / (DX * DX));
        assert_true(fabs((n.zy - o.zy) / (2 * hy) - v.zyy) < 1e-5 * range / (DY * DY));
        assert_true(fabs((e.zy - w.zy) / (2 * hx) - v.zxy) < 1e-5 * range / (DX * DY));
        assert_true(fabs((n.zx - o.zx) / (2 * hy) - v.zxy) < 1e-5 * range / (DX * DY));
    }
}

/* On both sides of every pixel border (1e-9 pixel away), the curvature is the same: C2. */
static void curvature_is_continuous(void **state)
{
    (void)state;
    const nt_surface s = surface_of(noise);
    const double e = 1e-9, curvature = 100e-9 / (DX * DX);
    for (int j = 1; j < NY - 1; j++)
        for (int i = 1; i < NX - 1; i++) {
            const nt_surface_value a = nt_surface_eval(&s, (i - e) * DX, (j - e) * DY);
            const nt_surface_value b = nt_surface_eval(&s, (i + e) * DX, (j + e) * DY);
            assert_true(fabs(a.zxx - b.zxx) < 1e-6 * curvature);
            assert_true(fabs(a.zyy - b.zyy) < 1e-6 * curvature);
            assert_true(fabs(a.zxy - b.zxy) < 1e-6 * curvature);
        }
}

static double ramp(double x, double y)
{
    return 0.1 * x + 0.01 * y;
}

/* Row 0 lies at y = 0, x is the fast index: an asymmetric map comes out the right way round. */
static void orientation_is_as_documented(void **state)
{
    (void)state;
    const nt_surface s = surface_of(ramp);
    const nt_surface_value v = nt_surface_eval(&s, 40 * DX, 30 * DY);
    assert_true(fabs(v.zx - 0.1) < 1e-12 && fabs(v.zy - 0.01) < 1e-12); /* borders are 30 pixels away */
    for (int p = 0; p < NX * NY; p++)
        heights[p] = 0.0;
    heights[7 * NX + 50] = 5e-9; /* row 7, column 50 */
    const nt_height_map map = {heights, NX, NY, DX, DY};
    nt_surface spot;
    assert_int_equal(nt_surface_init(&spot, &map, coefficients), NT_OK);
    assert_true(fabs(nt_surface_eval(&spot, 50 * DX, 7 * DY).z - 5e-9) < 1e-20);
    assert_true(fabs(nt_surface_eval(&spot, 50 * DX, (NY - 1 - 7) * DY).z) < 1e-20);
    assert_true(fabs(nt_surface_eval(&spot, 7 * DX, 50 * DY).z) < 1e-20);
}

static void continues_level_outside(void **state)
{
    (void)state;
    const nt_surface s = surface_of(bumps);
    const double right = (NX - 1) * DX, top = (NY - 1) * DY, y = 31.4e-9;
    const nt_surface_value edge = nt_surface_eval(&s, right, y);
    assert_true(fabs(edge.zx) < 1e-12);
    const nt_surface_value far = nt_surface_eval(&s, right + 1.0, y);
    assert_true(far.z == edge.z && far.zx == 0.0 && far.zxx == 0.0 && far.zxy == 0.0);
    assert_true(far.zy == edge.zy && far.zyy == edge.zyy);
    const nt_surface_value corner = nt_surface_eval(&s, -1e300, top + 1e300);
    assert_true(fabs(corner.z - heights[(NY - 1) * NX]) < 1e-20 && corner.zy == 0.0 && corner.zyy == 0.0);
    assert_true(nt_surface_eval(&s, (double)INFINITY, y).z == edge.z);
    assert_int_equal(nt_surface_contains(&s, 0.0, 0.0), 1);
    assert_int_equal(nt_surface_contains(&s, right, top), 1);
    assert_int_equal(nt_surface_contains(&s, right * 1.0001, y), 0);
    assert_int_equal(nt_surface_contains(&s, 1e-9, -1e-15), 0);
    assert_int_equal(nt_surface_contains(&s, (double)NAN, y), 0);
}

static void flat_is_flat_everywhere(void **state)
{
    (void)state;
    const nt_surface flat = nt_surface_flat();
    const nt_surface_value v = nt_surface_eval(&flat, 1e3, -1e9);
    assert_true(v.z == 0.0 && v.zx == 0.0 && v.zy == 0.0 && v.zxx == 0.0 && v.zxy == 0.0 && v.zyy == 0.0);
    assert_int_equal(nt_surface_contains(&flat, 1e3, -1e9), 1);
}

static void nan_in_nan_out(void **state)
{
    (void)state;
    const nt_surface s = surface_of(bumps), flat = nt_surface_flat();
    for (int k = 0; k < 4; k++) {
        const double x = k % 2 ? (double)NAN : 1e-9, y = k % 2 ? 1e-9 : (double)NAN;
        const nt_surface_value v = nt_surface_eval(k < 2 ? &s : &flat, x, y);
        assert_true(isnan(v.z) && isnan(v.zx) && isnan(v.zy) && isnan(v.zxx) && isnan(v.zxy) && isnan(v.zyy));
    }
}

static void assert_refused(nt_height_map map, nt_status expected, const char *field)
{
    nt_problem problem = {0};
    nt_surface surface = {.nx = 12345};
    assert_int_equal(nt_height_map_check(&map, &problem), expected);
    assert_string_equal(problem.field, field);
    assert_int_equal(nt_surface_init(&surface, &map, coefficients), expected);
    assert_int_equal(surface.nx, 12345);
}

static void refuses_bad_maps_by_name(void **state)
{
    (void)state;
    surface_of(bumps);
    const nt_height_map good = {heights, NX, NY, DX, DY};
    nt_height_map map = good;
    map.heights = NULL;
    assert_refused(map, NT_E_ARGUMENT, "map.heights");
    map = good;
    map.nx = 3;
    assert_refused(map, NT_E_RANGE, "map.nx");
    map = good;
    map.ny = 32769;
    assert_refused(map, NT_E_RANGE, "map.ny");
    map = good;
    map.dx = 0.0;
    assert_refused(map, NT_E_RANGE, "map.dx");
    map = good;
    map.dy = (double)NAN;
    assert_refused(map, NT_E_NOT_FINITE, "map.dy");
    heights[NX * NY - 1] = (double)NAN;
    assert_refused(good, NT_E_NOT_FINITE, "map.heights");
    heights[NX * NY - 1] = 480.0; /* nanometres taken for metres */
    assert_refused(good, NT_E_RANGE, "map.heights");
    nt_surface surface;
    heights[NX * NY - 1] = 0.0;
    assert_int_equal(nt_surface_init(&surface, &good, NULL), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passes_through_every_pixel),
        cmocka_unit_test(smallest_maps_work_too),
        cmocka_unit_test(cubics_are_exact_away_from_borders),
        cmocka_unit_test(slopes_are_the_derivatives),
        cmocka_unit_test(curvature_is_continuous),
        cmocka_unit_test(orientation_is_as_documented),
        cmocka_unit_test(continues_level_outside),
        cmocka_unit_test(flat_is_flat_everywhere),
        cmocka_unit_test(nan_in_nan_out),
        cmocka_unit_test(refuses_bad_maps_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
