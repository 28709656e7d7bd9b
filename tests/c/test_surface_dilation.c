/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <time.h>

#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/surface.h"
#include "surface/surface.h"

enum { NX = 150, NY = 61 };
#define DX 2e-9
#define DY 3e-9
static double heights[NX * NY], dilated[NX * NY], again[NX * NY];
static const nt_tip_shape tip = {20e-9, 0.35};

static void dilate(const double *from, const nt_tip_shape *shape, double *to)
{
    const nt_height_map map = {from, NX, NY, DX, DY};
    assert_int_equal(nt_surface_dilate(&map, shape, to), NT_OK);
}

/* The tip as a set of points: on the sphere up to the tangent, on the cone beyond. Written apart from the library. */
static double shape_height(const nt_tip_shape *shape, double r)
{
    const double contact = shape->radius * cos(shape->half_angle);
    if (r <= contact)
        return shape->radius - sqrt(shape->radius * shape->radius - r * r);
    return shape->radius * (1.0 - 1.0 / sin(shape->half_angle)) + r / tan(shape->half_angle); /* apex of the cone */
}

static void tip_is_a_sphere_that_runs_into_a_cone(void **state)
{
    (void)state;
    for (double psi = 0.05; psi < 1.5; psi += 0.1) {
        const nt_tip_shape shape = {20e-9, psi};
        for (double r = 0.0; r < 100e-9; r += 0.7e-9)
            assert_true(fabs(nt_tip_shape_height(&shape, r) - shape_height(&shape, r)) < 1e-15 * 100e-9 / tan(psi));
        const double tangent = 20e-9 * cos(psi), h = 1e-14; /* value and slope agree at the tangent */
        const double below = nt_tip_shape_height(&shape, tangent) - nt_tip_shape_height(&shape, tangent - h);
        const double above = nt_tip_shape_height(&shape, tangent + h) - nt_tip_shape_height(&shape, tangent);
        assert_true(fabs(above / below - 1.0) < 1e-3);
    }
    const nt_tip_shape rod = {20e-9, 0.0};
    assert_true(nt_tip_shape_height(&rod, 20e-9) == 20e-9 && isinf(nt_tip_shape_height(&rod, 20.1e-9)));
    assert_true(isnan(nt_tip_shape_height(&tip, (double)NAN)));
    assert_true(fabs(nt_tip_shape_height(&tip, 1e-15) / 2.5e-23 - 1.0) < 1e-12); /* r^2/2R, no cancellation */
}

/* Second difference of body less tip at a pixel, along one axis: what a parabola there can add. */
static double bend_of(const nt_tip_shape *shape, const long apex[2], const long touching[2], int along_x)
{
    double g[3];
    for (int k = -1; k <= 1; k++) {
        const long p = touching[0] + (along_x ? k : 0), q = touching[1] + (along_x ? 0 : k);
        if (p < 0 || p >= NX || q < 0 || q >= NY)
            return 0.0;
        const double away = hypot((double)(p - apex[0]) * DX, (double)(q - apex[1]) * DY);
        g[k + 1] = heights[q * NX + p] - nt_tip_shape_height(shape, away);
    }
    const double bend = 2.0 * g[1] - g[0] - g[2];
    return isfinite(bend) ? bend : 0.0;
}

#define ROUNDING 1e-20 /* of a distance, 2^-53 of a micrometre, on a flank of slope 10, a few times [m] */

/* The definition, without any pruning; above it at most the peak of a parabola: an eighth of the second differences, on
 * a diagonal twice that. */
static void agrees_with_brute_force(void **state)
{
    (void)state;
    static const nt_tip_shape shapes[] = {{20e-9, 0.35}, {2e-9, 0.1}, {100e-9, 0.8}, {20e-9, 0.0}, {10e-9, 1.4}};
    nt_random random = nt_random_seed(4);
    for (int n = 0; n < 5; n++) {
        for (int p = 0; p < NX * NY; p++) /* spikes, a step, and a rough floor */
            heights[p] = (p % NX > 70 ? 60e-9 : 0.0) + 2e-9 * nt_random_uniform(&random) +
                         (nt_random_uniform(&random) < 0.002 ? 200e-9 * nt_random_uniform(&random) : 0.0);
        dilate(heights, &shapes[n], dilated);
        for (int j = 0; j < NY; j += 10)
            for (int i = j % 3; i < NX; i += 3) {
                double apex = -1.0;
                long touching[2] = {0, 0};
                for (int q = 0; q < NY; q++)
                    for (int p = 0; p < NX; p++) {
                        const double away = hypot((p - i) * DX, (q - j) * DY);
                        const double lift = heights[q * NX + p] - nt_tip_shape_height(&shapes[n], away);
                        if (lift > apex) {
                            touching[0] = p;
                            touching[1] = q;
                        }
                        apex = larger(apex, lift);
                    }
                const long at[2] = {i, j};
                const double peak =
                    0.25 * (bend_of(&shapes[n], at, touching, 1) + bend_of(&shapes[n], at, touching, 0));
                const double above = dilated[j * NX + i] - apex;
                assert_true(above >= -ROUNDING && above <= peak + ROUNDING);
            }
    }
}

static double hills(double x, double y)
{
    return 5e-9 * sin(x / 15e-9) * cos(y / 19e-9); /* radii above 45 nm */
}

/* Where the body is smooth the pixels do not show: against the dilation of a grid ten times as fine. The pixels alone
 * stand up to h^2/8 (1/R + kappa) = 30 pm along x and 80 along y too low; a cubic term of the body is left, 6 pm. */
static void smooth_bodies_are_touched_between_the_pixels(void **state)
{
    (void)state;
    for (int p = 0; p < NX * NY; p++)
        heights[p] = hills(p % NX * DX, p / NX * DY);
    dilate(heights, &tip, dilated);
    double worst = 0.0;
    for (int j = 15; j < NY - 15; j += 3)
        for (int i = 20; i < NX - 20; i += 7) {
            double apex = -1.0;
            for (int q = -100; q <= 100; q++)
                for (int p = -100; p <= 100; p++) {
                    const double x = 0.1 * p * DX, y = 0.1 * q * DY;
                    apex = larger(apex, hills(i * DX + x, j * DY + y) - shape_height(&tip, hypot(x, y)));
                }
            worst = larger(worst, fabs(dilated[j * NX + i] - apex));
        }
    assert_true(worst < 10e-12);
}

/* A spike on the floor shows the tip, upside down. */
static void spike_gives_the_reflected_tip(void **state)
{
    (void)state;
    for (int p = 0; p < NX * NY; p++)
        heights[p] = 0.0;
    heights[20 * NX + 100] = 90e-9;
    dilate(heights, &tip, dilated);
    int seen = 0;
    for (int j = 0; j < NY; j++)
        for (int i = 0; i < NX; i++) {
            const double expected = 90e-9 - shape_height(&tip, hypot((i - 100) * DX, (j - 20) * DY));
            seen += expected > 0.0;
            assert_true(fabs(dilated[j * NX + i] - (expected > 0.0 ? expected : 0.0)) < 1e-21);
        }
    assert_true(seen > 400);
}

/* Over a step the apex follows the tip's profile down to the floor, where the flank lets go of the edge. */
static void step_gives_the_profile_of_the_tip(void **state)
{
    (void)state;
    for (int p = 0; p < NX * NY; p++)
        heights[p] = p % NX >= 80 ? 40e-9 : 0.0;
    dilate(heights, &tip, dilated);
    for (int j = 0; j < NY; j++)
        for (int i = 0; i < NX; i++) {
            const double profile = i >= 80 ? 40e-9 : larger(0.0, 40e-9 - shape_height(&tip, (80 - i) * DX));
            assert_true(fabs(dilated[j * NX + i] - profile) < 1e-21);
        }
}

/* A ridge a u^2 + 2 rho sqrt(ab) u v + b v^2 below its summit, which lies between the pixels, under a tip that is all
 * but flat: the summit is found as it is a parabola, but for a ridge so long (rho above 0.9) that noise would throw its
 * summit anywhere; there each axis has its own parabola. */
static void ridges_across_the_pixels_have_their_summit(void **state)
{
    (void)state;
    enum { N = 41 };
    static double ridge[N * N], out[N * N];
    static const double rhos[] = {-0.98, -0.93, -0.87, -0.5, 0.0, 0.3, 0.87, 0.93, 0.98};
    const double a = 1e-11, b = 2.5e-11, x0 = 20.37, y0 = 19.58, summit = 40e-9;
    const nt_height_map map = {ridge, N, N, 1e-9, 1e-9};
    for (size_t n = 0; n < sizeof rhos / sizeof *rhos; n++) {
        const double c = 2.0 * rhos[n] * sqrt(a * b);
        int top = 0;
        for (int p = 0; p < N * N; p++) {
            const double u = p % N - x0, v = p / N - y0;
            ridge[p] = summit - a * u * u - c * u * v - b * v * v;
            top = ridge[p] > ridge[top] ? p : top;
        }
        assert_int_equal(nt_surface_dilate(&map, &(nt_tip_shape){1e-3, 0.35}, out), NT_OK);
        const double u = top % N - x0, v = top / N - y0, slope_x = 2.0 * a * u + c * v, slope_y = 2.0 * b * v + c * u;
        const double apart = ridge[top] + slope_x * slope_x / (4.0 * a) + slope_y * slope_y / (4.0 * b);
        assert_true(fabs(rhos[n]) < 0.1 || fabs(apart - summit) > 5e-14);
        assert_true(fabs(out[20 * N + 20] - (fabs(rhos[n]) < 0.9 ? summit : apart)) < 2e-14);
    }
}

static void flat_stays_flat(void **state)
{
    (void)state;
    for (int p = 0; p < NX * NY; p++)
        heights[p] = 3e-9;
    dilate(heights, &tip, dilated);
    for (int p = 0; p < NX * NY; p++)
        assert_true(dilated[p] == 3e-9);
}

/* Never below the surface; eroding the dilated map (by duality, dilating its negative) closes it, and where the body is
 * smooth and nowhere as hollow as the tip that gives the body back: to 10 pm, of the pixels' 110. */
static void is_bounded_and_closes(void **state)
{
    (void)state;
    for (int p = 0; p < NX * NY; p++)
        heights[p] = hills(p % NX * DX, p / NX * DY);
    dilate(heights, &tip, dilated);
    for (int p = 0; p < NX * NY; p++) {
        assert_true(dilated[p] >= heights[p]);
        again[p] = -dilated[p];
    }
    static double closed[NX * NY];
    dilate(again, &tip, closed);
    for (int j = 15; j < NY - 15; j++)
        for (int i = 20; i < NX - 20; i++)
            assert_true(fabs(-closed[j * NX + i] - heights[j * NX + i]) < 10e-12);
}

static void refuses_bad_tips_and_maps(void **state)
{
    (void)state;
    nt_height_map map = {heights, NX, NY, DX, DY};
    assert_int_equal(nt_surface_dilate(&map, &(nt_tip_shape){20.0, 0.3}, dilated), NT_E_RANGE);
    assert_int_equal(nt_surface_dilate(&map, &(nt_tip_shape){20e-9, 1.6}, dilated), NT_E_RANGE);
    assert_int_equal(nt_surface_dilate(&map, &(nt_tip_shape){20e-9, (double)NAN}, dilated), NT_E_NOT_FINITE);
    assert_int_equal(nt_surface_dilate(&map, &tip, NULL), NT_E_ARGUMENT);
    map.dx = 0.0;
    assert_int_equal(nt_surface_dilate(&map, &tip, dilated), NT_E_RANGE);
}

/* A grating of 480 nm over 512 x 512 pixels, the tip reaching 15 pixels (31 x 31): the time is printed, not judged. */
static void large_maps_keep_floor_and_ridge(void **state)
{
    (void)state;
    enum { N = 512 };
    static double big[N * N], out[N * N];
    const nt_grating grating = nt_grating_defaults();
    const double pixel = 6e-6 / N;
    for (int p = 0; p < N * N; p++)
        big[p] = nt_grating_height(&grating, (p % N) * pixel, 0.0);
    const nt_height_map map = {big, N, N, pixel, pixel};
    const clock_t start = clock();
    assert_int_equal(nt_surface_dilate(&map, &(nt_tip_shape){20e-9, 0.35}, out), NT_OK);
    const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    print_message("512 x 512, grating: %.3f s\n", seconds);
    double lowest = out[0], highest = out[0];
    for (int p = 0; p < N * N; p++) {
        lowest = smaller(lowest, out[p]);
        highest = larger(highest, out[p]);
    }
    assert_true(lowest == 0.0);
    assert_true(highest == grating.height);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tip_is_a_sphere_that_runs_into_a_cone),
        cmocka_unit_test(agrees_with_brute_force),
        cmocka_unit_test(smooth_bodies_are_touched_between_the_pixels),
        cmocka_unit_test(spike_gives_the_reflected_tip),
        cmocka_unit_test(step_gives_the_profile_of_the_tip),
        cmocka_unit_test(ridges_across_the_pixels_have_their_summit),
        cmocka_unit_test(flat_stays_flat),
        cmocka_unit_test(is_bounded_and_closes),
        cmocka_unit_test(refuses_bad_tips_and_maps),
        cmocka_unit_test(large_maps_keep_floor_and_ridge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
