/* SPDX-License-Identifier: BSD-3-Clause
 * What the sample is made of at each place: a mean of its pixels by the weights of the B-spline, C2, never outside the
 * range of the pixels; what is no property is refused by name. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "nanotouch/advanced/random.h"
#include "nanotouch/surface.h"

enum { NX = 17, NY = 11, PIXELS = NX * NY };
static const double DX = 3e-9, DY = 5e-9;
static double coefficients[PIXELS], modulus[PIXELS], work[PIXELS];
static nt_surface surface;
static nt_properties properties;

/* Two materials, five decades apart, pixel by pixel. */
static int set_up(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(7);
    for (int p = 0; p < PIXELS; p++) {
        coefficients[p] = 1e-9 * nt_random_normal(&random);
        modulus[p] = nt_random_uniform(&random) < 0.5 ? 1e5 : 1e10;
        work[p] = 0.001 + 0.1 * nt_random_uniform(&random);
    }
    const nt_height_map map = {coefficients, NX, NY, DX, DY};
    return nt_surface_init(&surface, &map, coefficients) != NT_OK ||
           nt_properties_init(&properties, &surface, modulus, work, NULL) != NT_OK;
}

/* B(u) as the integral of its definition: the convolution of four boxes. */
static double spline(double u)
{
    const double a = fabs(u);
    return a < 1.0 ? (4.0 - 6.0 * a * a + 3.0 * a * a * a) / 6.0 : a < 2.0 ? pow(2.0 - a, 3) / 6.0 : 0.0;
}

static int mirrored(int i, int n)
{
    return i < 0 ? -i : i < n ? i : 2 * (n - 1) - i;
}

static double mean_at(const double *values, double x, double y)
{
    double sum = 0.0;
    for (int j = -2; j < NY + 2; j++)
        for (int i = -2; i < NX + 2; i++)
            sum += values[mirrored(j, NY) * NX + mirrored(i, NX)] * spline(x / DX - i) * spline(y / DY - j);
    return sum;
}

static void is_the_mean_of_its_pixels(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(8);
    for (int n = 0; n < 5000; n++) {
        const double x = (NX - 1) * DX * nt_random_uniform(&random), y = (NY - 1) * DY * nt_random_uniform(&random);
        const nt_place place = nt_surface_place(&surface, NULL, &properties, x, y);
        assert_true(fabs(place.youngs_modulus.value - mean_at(modulus, x, y)) < 1e-14 * 1e10);
        assert_true(fabs(place.work_of_adhesion.value - mean_at(work, x, y)) < 1e-14);
        assert_true(place.youngs_modulus.value >= 1e5 && place.youngs_modulus.value <= 1e10 * (1.0 + 1e-15));
        assert_true(place.radius.radius == 0.0 && place.surface.z == nt_surface_height(&surface, x, y).z);
    }
    assert_true(properties.youngs_modulus.height_minimum == 1e5 && properties.youngs_modulus.height_maximum == 1e10);
}

static void slopes_are_the_derivatives(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(9);
    const double h = 1e-6 * DX;
    for (int n = 0; n < 2000; n++) {
        const double x = (1.0 + (NX - 3) * nt_random_uniform(&random)) * DX;
        const double y = (1.0 + (NY - 3) * nt_random_uniform(&random)) * DY;
        const nt_property_value at = nt_surface_place(&surface, NULL, &properties, x, y).work_of_adhesion;
        const double over_x = nt_surface_place(&surface, NULL, &properties, x + h, y).work_of_adhesion.value -
                              nt_surface_place(&surface, NULL, &properties, x - h, y).work_of_adhesion.value;
        const double over_y = nt_surface_place(&surface, NULL, &properties, x, y + h).work_of_adhesion.value -
                              nt_surface_place(&surface, NULL, &properties, x, y - h).work_of_adhesion.value;
        assert_true(fabs(at.dx - over_x / (2.0 * h)) < 1e-8 * 0.1 / DX);
        assert_true(fabs(at.dy - over_y / (2.0 * h)) < 1e-8 * 0.1 / DX);
    }
}

static void what_is_not_given_is_the_scenes(void **state)
{
    (void)state;
    nt_properties stiff;
    assert_int_equal(nt_properties_init(&stiff, &surface, modulus, NULL, NULL), NT_OK);
    const nt_place place = nt_surface_place(&surface, NULL, &stiff, 2e-9, 3e-9);
    assert_true(place.youngs_modulus.value > 0.0 && place.work_of_adhesion.value == 0.0);
    assert_true(isnan(nt_surface_place(&surface, NULL, &stiff, (double)NAN, 0.0).surface.z));
    assert_true(nt_surface_place(&surface, NULL, NULL, 2e-9, 3e-9).youngs_modulus.value == 0.0);
}

static void assert_refused(double *value, double wrong, nt_status status, const char *field)
{
    const double right = *value;
    nt_properties untouched = properties;
    nt_problem problem = {0};
    *value = wrong;
    assert_int_equal(nt_properties_init(&untouched, &surface, modulus, work, &problem), status);
    assert_string_equal(problem.field, field);
    assert_memory_equal(&untouched, &properties, sizeof properties);
    *value = right;
}

static void what_is_no_property_is_refused(void **state)
{
    (void)state;
    assert_refused(&modulus[5], (double)NAN, NT_E_NOT_FINITE, "surface.youngs_modulus");
    assert_refused(&modulus[5], -1e9, NT_E_RANGE, "surface.youngs_modulus");
    assert_refused(&modulus[5], 0.0, NT_E_RANGE, "surface.youngs_modulus");
    assert_refused(&work[9], (double)INFINITY, NT_E_NOT_FINITE, "surface.work_of_adhesion");
    assert_refused(&work[9], -0.01, NT_E_RANGE, "surface.work_of_adhesion");
    assert_refused(&work[9], 0.0, NT_E_RANGE, "surface.work_of_adhesion");
    assert_refused(&work[9], 5.0, NT_E_RANGE, "surface.work_of_adhesion"); /* the others are below a thousandth */
    const nt_surface flat = nt_surface_flat();
    nt_properties none;
    assert_int_equal(nt_properties_init(&none, &flat, modulus, work, NULL), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_the_mean_of_its_pixels),
        cmocka_unit_test(slopes_are_the_derivatives),
        cmocka_unit_test(what_is_not_given_is_the_scenes),
        cmocka_unit_test(what_is_no_property_is_refused),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
