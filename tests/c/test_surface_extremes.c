/* SPDX-License-Identifier: BSD-3-Clause
 * Bounds of a surface against closed forms (waves, a ball) and, on noise, against dense sampling: never below it, and
 * above it by no more than they promise. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assertions.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "surface/extremes.h"

enum { NX = 129, NY = 97 };
#define DX 1e-9
#define DY 1.3e-9
#define WIDTH ((NX - 1) * DX)
#define HEIGHT ((NY - 1) * DY)
#define PI 3.14159265358979323846

static double coefficients[NX * NY];
static const nt_fields NONE = {{NULL, NULL, NULL}};

static nt_surface surface_of(double (*height)(double x, double y), long nx, long ny)
{
    static double heights[NX * NY];
    const nt_height_map map = {heights, nx, ny, DX, DY};
    nt_surface surface;
    for (long j = 0; j < ny; j++)
        for (long i = 0; i < nx; i++)
            heights[j * nx + i] = height((double)i * DX, (double)j * DY);
    assert_int_equal(nt_surface_init(&surface, &map, coefficients), NT_OK);
    return surface;
}

/* Waves that fit the map, so that its mirrored borders do not bend them; the spline is off by (k h)^4/384 or so. */
#define A 5e-9
#define B 2e-9
#define KX (2.0 * PI * 3.0 / WIDTH)
#define KY (2.0 * PI * 2.0 / HEIGHT)
static double waves(double x, double y)
{
    return A * cos(KX * x) + B * cos(KY * y);
}

static void waves_in_an_area(void **state)
{
    (void)state;
    const nt_surface surface = surface_of(waves, NX, NY);
    const double x[2] = {0.0, WIDTH}, y[2] = {0.0, HEIGHT};
    const nt_extremes all = nt_extremes_in_area(&surface, &NONE, x, y);
    assert_within(all.highest, A + B, 1e-5 * (A + B));
    assert_within(all.lowest, -(A + B), 1e-5 * (A + B));
    assert_within(all.steepest, hypot(A * KX, B * KY), 1.2e-3 * hypot(A * KX, B * KY));
    for (int field = 0; field < NT_FIELDS; field++)
        assert_true(all.least[field] == 0.0 && all.most[field] == 0.0);
    /* a part without crest and trough: heights at its corners, slope along x alone */
    const double part_x[2] = {0.30 / KX, 1.20 / KX}, part_y[2] = {0.1 / KY, 0.2 / KY};
    const nt_extremes part = nt_extremes_in_area(&surface, &NONE, part_x, part_y);
    assert_within(part.highest, A * cos(0.30) + B * cos(0.1), 1e-5 * A);
    assert_within(part.lowest, A * cos(1.20) + B * cos(0.2), 1e-5 * A);
    assert_within(part.steepest, hypot(A * KX * sin(1.20), B * KY * sin(0.2)), 1.2e-3 * A * KX);
}

static void waves_along_a_path(void **state)
{
    (void)state;
    const nt_surface surface = surface_of(waves, NX, NY);
    const double along_x[] = {0.5 / KX, 0.4 / KY, 5.0 / KX, 0.4 / KY};
    const nt_extremes row = nt_extremes_on_path(&surface, &NONE, along_x, 2);
    assert_within(row.highest, A * cos(0.5) + B * cos(0.4), 1e-5 * A);
    assert_within(row.lowest, -A + B * cos(0.4), 1e-5 * A);
    assert_within(row.steepest, A * KX, 1.2e-3 * A * KX); /* not what the surface rises by across the path */
    /* down and back up a corner: z = A cos(KX x) + B cos(KY y) with KX x = KY y = t on the way */
    const double corner[] = {0.0, 0.0, 2.0 / KX, 2.0 / KY, 0.1 / KX, 2.0 / KY};
    const nt_extremes turned = nt_extremes_on_path(&surface, &NONE, corner, 3);
    const double leg = hypot(1.0 / KX, 1.0 / KY);
    assert_within(turned.highest, A + B, 1e-5 * A);
    assert_within(turned.lowest, (A + B) * cos(2.0), 1e-5 * A);
    assert_within(turned.steepest, larger((A + B) / leg, A * KX), 1.2e-3 * A * KX);
}

/* A trough in the middle of a piece, where the slope is 0: what its ends rise by is the remainder alone. */
static void a_trough_in_the_middle(void **state)
{
    (void)state;
    const nt_surface surface = surface_of(waves, NX, NY);
    const double x[2] = {PI / KX - 0.3e-9, PI / KX + 0.3e-9}, y[2] = {PI / KY, PI / KY};
    const double path[] = {x[0], y[0], x[1], y[1]};
    const nt_extremes found[] = {nt_extremes_in_area(&surface, &NONE, x, y),
                                 nt_extremes_on_path(&surface, &NONE, path, 2)};
    for (int k = 0; k < 2; k++) {
        assert_within(found[k].highest, -B - A * cos(KX * 0.3e-9), 1e-4 * A);
        assert_within(found[k].lowest, -B - A, 1e-4 * A);
        assert_within(found[k].steepest, A * KX * sin(KX * 0.3e-9), 2e-3 * A * KX * sin(KX * 0.3e-9));
    }
}

#define BALL 90e-9
static double ball(double x, double y)
{
    const double u = x - 0.5 * WIDTH, v = y - 0.5 * HEIGHT;
    return sqrt(larger(BALL * BALL - u * u - v * v, 0.01 * BALL * BALL));
}

/* Of a ball: z = (R^2 - r^2)^(1/2), slope r/z; a square about its middle is steepest in its corners. */
static void a_ball(void **state)
{
    (void)state;
    const nt_surface surface = surface_of(ball, NX, NY);
    const double a = 20e-9, x0 = 0.5 * WIDTH, y0 = 0.5 * HEIGHT;
    const double x[2] = {x0 - a, x0 + a}, y[2] = {y0 - a, y0 + a};
    const nt_extremes found = nt_extremes_in_area(&surface, &NONE, x, y);
    const double low = sqrt(BALL * BALL - 2.0 * a * a);
    assert_within(found.highest, BALL, 1e-5 * BALL);
    assert_within(found.lowest, low, 1e-5 * BALL);
    assert_within(found.steepest, sqrt(2.0) * a / low, 1.2e-3 * a / low);
}

static double noise(double x, double y)
{
    nt_random random = nt_random_seed((uint64_t)lround(x / DX) * 1000 + (uint64_t)lround(y / DY));
    return 3e-9 * nt_random_uniform(&random);
}

enum { SMALL_X = 13, SMALL_Y = 9, DENSE = 64 };

/* The worst surface there is: 64 x 64 samples a pixel are short of the truth by (1/64)^2/8 of the second difference,
 * and a slope by 1/128 of it. */
static void noise_is_never_above_its_bounds(void **state)
{
    (void)state;
    const nt_surface surface = surface_of(noise, SMALL_X, SMALL_Y);
    const double x[2] = {0.3 * DX, (SMALL_X - 1) * DX}, y[2] = {0.0, (SMALL_Y - 1.6) * DY};
    const nt_extremes found = nt_extremes_in_area(&surface, &NONE, x, y);
    double highest = -1.0, lowest = 1.0, steepest = 0.0;
    for (int j = 0; j <= DENSE * (SMALL_Y - 1); j++)
        for (int i = 0; i <= DENSE * (SMALL_X - 1); i++) {
            const double t = x[0] + (x[1] - x[0]) * i / (DENSE * (SMALL_X - 1.0));
            const nt_height_value at =
                nt_surface_height(&surface, t, y[0] + (y[1] - y[0]) * j / (DENSE * (SMALL_Y - 1.0)));
            highest = larger(highest, at.z);
            lowest = smaller(lowest, at.z);
            steepest = larger(steepest, hypot(at.zx, at.zy));
        }
    assert_true(found.highest >= highest && found.highest <= highest + 1e-3 * 3e-9);
    assert_true(found.lowest <= lowest && found.lowest >= lowest - 1e-3 * 3e-9);
    assert_true(found.steepest >= steepest && found.steepest <= 1.01 * steepest);
}

/* Of one cell: never below what is there, and close to it where that is asked; where less is enough no more than that.
 */
static void cells_of_noise(void **state)
{
    (void)state;
    const nt_surface surface = surface_of(noise, SMALL_X, SMALL_Y);
    for (long j = 0; j + 1 < SMALL_Y; j++)
        for (long i = 0; i + 1 < SMALL_X; i++) {
            double steepest = 0.0, lowest = 1.0;
            for (int k = 0; k < DENSE * DENSE; k++) {
                const double x = ((double)i + k % DENSE / (DENSE - 1.0)) * DX;
                const double y = ((double)j + (double)(k / DENSE) / (DENSE - 1.0)) * DY;
                const nt_height_value at = nt_surface_height(&surface, x, y);
                steepest = larger(steepest, hypot(at.zx, at.zy));
                lowest = smaller(lowest, at.z);
            }
            const double low = nt_extremes_lowest_in_cell(&surface, i, j, 3e-11);
            assert_true(low <= lowest + 1e-21 && low >= lowest - 4e-11);
            const double found = nt_extremes_in_cell(&surface, i, j, 0.0);
            assert_true(found >= steepest * (1.0 - 1e-12) && found <= 1.02 * steepest);
            const double enough = 2.0 * steepest;
            assert_in_range((long)(1e6 * nt_extremes_in_cell(&surface, i, j, enough) / steepest), 1000000, 2002001);
        }
}

/* Random paths of three legs over noise, across pixels and borders of pixels. */
static void paths_over_noise(void **state)
{
    (void)state;
    const nt_surface surface = surface_of(noise, SMALL_X, SMALL_Y);
    nt_random random = nt_random_seed(11);
    for (int n = 0; n < 200; n++) {
        double xy[8], highest = -1.0, lowest = 1.0, steepest = 0.0;
        for (int i = 0; i < 8; i++)
            xy[i] = nt_random_uniform(&random) * (i % 2 ? (SMALL_Y - 1) * DY : (SMALL_X - 1) * DX);
        for (int i = 0; i < 3000; i++) {
            const double *p = xy + 2 * (i / 1000), t = (i % 1000) / 999.0;
            const double u = p[2] - p[0], v = p[3] - p[1];
            const nt_height_value at = nt_surface_height(&surface, p[0] + t * u, p[1] + t * v);
            const double slope = fabs(at.zx * u + at.zy * v) / hypot(u, v);
            highest = larger(highest, at.z);
            lowest = smaller(lowest, at.z);
            steepest = larger(steepest, slope);
        }
        const nt_extremes found = nt_extremes_on_path(&surface, &NONE, xy, 4);
        assert_true(found.highest >= highest - 1e-24 && found.highest <= highest + 1e-3 * 3e-9);
        assert_true(found.lowest <= lowest + 1e-24 && found.lowest >= lowest - 1e-3 * 3e-9);
        assert_true(found.steepest >= steepest * (1.0 - 1e-12) && found.steepest <= 1.01 * steepest);
    }
}

static double level(double x, double y)
{
    (void)x;
    (void)y;
    return 7e-7;
}

/* Standing on a point: its height, no slope; a level surface: rounding alone. */
static void points_and_levels(void **state)
{
    (void)state;
    const double point[] = {41.3e-9, 22.2e-9}, x[2] = {0.0, WIDTH}, y[2] = {3e-9, 3e-9};
    nt_surface surface = surface_of(noise, NX, NY);
    const nt_extremes there = nt_extremes_on_path(&surface, &NONE, point, 1);
    const double z = nt_surface_height(&surface, point[0], point[1]).z;
    assert_true(there.highest == z && there.lowest == z && there.steepest == 0.0);
    surface = surface_of(level, NX, NY);
    const nt_extremes found = nt_extremes_in_area(&surface, &NONE, x, y);
    assert_within(found.highest, 7e-7, 1e-14 * 7e-7);
    assert_within(found.lowest, 7e-7, 1e-14 * 7e-7);
    assert_within(found.steepest, 0.0, 2e-9);
}

/* Ratios of a radius map, modulus and w are coefficients of a spline, which never leaves their range: of those that
 * reach the path. */
static void fields_that_reach(void **state)
{
    (void)state;
    static double ratios[NX * NY];
    const nt_surface surface = surface_of(waves, NX, NY);
    for (int k = 0; k < NX * NY; k++)
        ratios[k] = 1.0;
    ratios[30 * NX + 50] = 0.4;
    ratios[34 * NX + 50] = 3.0;
    nt_surface of = surface;
    of.coefficients = ratios;
    for (int field = 0; field < NT_FIELDS; field++) {
        nt_fields fields = NONE;
        fields.of[field] = &of;
        const double over[] = {10e-9, 30.4 * DY, 90e-9, 30.4 * DY}, far[] = {10e-9, 60e-9, 90e-9, 60e-9};
        const nt_extremes near = nt_extremes_on_path(&surface, &fields, over, 2);
        assert_true(near.least[field] == 0.4 && near.most[field] == 1.0);
        const nt_extremes beside = nt_extremes_on_path(&surface, &fields, far, 2);
        assert_true(beside.least[field] == 1.0 && beside.most[field] == 1.0);
        const double x[2] = {0.0, WIDTH}, y[2] = {0.0, HEIGHT};
        const nt_extremes all = nt_extremes_in_area(&surface, &fields, x, y);
        assert_true(all.least[field] == 0.4 && all.most[field] == 3.0);
        for (int other = 0; other < NT_FIELDS; other++)
            assert_true(other == field || (all.least[other] == 0.0 && all.most[other] == 0.0));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves_in_an_area),
        cmocka_unit_test(waves_along_a_path),
        cmocka_unit_test(a_trough_in_the_middle),
        cmocka_unit_test(a_ball),
        cmocka_unit_test(noise_is_never_above_its_bounds),
        cmocka_unit_test(cells_of_noise),
        cmocka_unit_test(paths_over_noise),
        cmocka_unit_test(points_and_levels),
        cmocka_unit_test(fields_that_reach),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
