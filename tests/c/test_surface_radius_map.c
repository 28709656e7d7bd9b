/* SPDX-License-Identifier: BSD-3-Clause
 * The effective radius on surfaces of known curvature: sphere on sphere, sphere in a bowl, on a cylinder, on an edge.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/random.h"
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
    return sqrt(fmax(60e-9 * 60e-9 - r2, 40e-9 * 40e-9));
}

/* A bowl of 80 nm: 1/R_eff = 1/R - 1/80 nm. */
static double bowl(double x, double y)
{
    const double r2 = (x - X0) * (x - X0) + (y - Y0) * (y - Y0);
    return -sqrt(fmax(80e-9 * 80e-9 - r2, 30e-9 * 30e-9));
}

/* A cylinder of 50 nm along y: R_eff = R sqrt(50/(50 + 20)). */
static double cylinder(double x, double y)
{
    (void)y;
    return sqrt(fmax(50e-9 * 50e-9 - (x - X0) * (x - X0), 20e-9 * 20e-9));
}

/* Where the body is analytic under the tip. The dilation is exact for the pixels only: between them it lies lower by up
 * to (pixel/2)^2/2 (1/R + kappa) < 1e-11 m and rough on that scale, which curvature shows; averaged over the middle it
 * is 5 %. */
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
        double sum = 0.0;
        int count = 0;
        for (double x = -15e-9; x <= 15e-9; x += 0.37e-9)
            for (double y = -15e-9; y <= 15e-9; y += 0.41e-9) {
                const nt_radius_value at = nt_radius_map_eval(&map, X0 + x, Y0 + y);
                sum += at.radius;
                count++;
            }
        if (!(fabs(sum / count / bodies[b].expected - 1.0) < 0.05))
            fail_msg("body %d: %g instead of %g", (int)b, sum / count, bodies[b].expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(spheres_on_spheres)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
