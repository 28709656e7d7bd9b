/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "dynamics/dynamics.h"
#include "internal/random.h"
#include "nanotouch/dynamics.h"

static void ideal_sensor_is_transparent(void **state)
{
    (void)state;
    const nt_sensor sensor = {.noise = 0.0, .resolution = 0.0, .range = 10.0};
    assert_true(nt_sensor_read(&sensor, 1.23456789, NULL) == 1.23456789);
}

static void noise_has_its_deviation(void **state)
{
    (void)state;
    enum { N = 100000 };
    const nt_sensor sensor = {.noise = 0.3, .resolution = 0.0, .range = 100.0};
    nt_noise noise = nt_noise_of(3, 0);
    double mean = 0.0, variance = 0.0;
    for (int i = 0; i < N; i++) {
        const double error = nt_sensor_read(&sensor, 5.0, &noise) - 5.0;
        mean += error / N;
        variance += error * error / N;
    }
    assert_true(fabs(mean) < 4.0 * 0.3 / sqrt(N)); /* four standard errors */
    assert_true(fabs(variance / 0.09 - 1.0) < 4.0 * sqrt(2.0 / N));
}

static void rounds_to_its_steps(void **state)
{
    (void)state;
    const nt_sensor sensor = {.noise = 0.0, .resolution = 0.25, .range = 10.0};
    for (double value = -9.9; value < 9.9; value += 0.0137) {
        const double reading = nt_sensor_read(&sensor, value, NULL);
        assert_true(fabs(reading - value) <= 0.125);
        assert_true(reading * 4.0 == floor(reading * 4.0));
    }
}

/* Noise makes the steps disappear in the mean: rounding after noise, not before. */
static void noise_dithers_the_steps(void **state)
{
    (void)state;
    enum { N = 100000 };
    const nt_sensor sensor = {.noise = 1.0, .resolution = 1.0, .range = 100.0};
    nt_noise noise = nt_noise_of(5, 0);
    double mean = 0.0;
    for (int i = 0; i < N; i++)
        mean += nt_sensor_read(&sensor, 0.3, &noise) / N;
    assert_true(fabs(mean - 0.3) < 4.0 * sqrt(1.0 + 1.0 / 12.0) / sqrt(N));
}

static void saturates_at_its_range(void **state)
{
    (void)state;
    const nt_sensor sensor = {.noise = 0.0, .resolution = 0.3, .range = 1.0}; /* not a multiple of the step */
    assert_true(nt_sensor_read(&sensor, 7.0, NULL) == 1.0 && nt_sensor_read(&sensor, -7.0, NULL) == -1.0);
    assert_true(nt_sensor_read(&sensor, 1.06, NULL) == 1.0);
    assert_true(nt_sensor_read(&sensor, (double)INFINITY, NULL) == 1.0);
}

static void nan_stays_nan(void **state)
{
    (void)state;
    const nt_sensor sensor = {.noise = 0.1, .resolution = 0.01, .range = 1.0};
    nt_noise noise = nt_noise_of(1, 0);
    assert_true(isnan(nt_sensor_read(&sensor, (double)NAN, &noise)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ideal_sensor_is_transparent), cmocka_unit_test(noise_has_its_deviation),
        cmocka_unit_test(rounds_to_its_steps),         cmocka_unit_test(noise_dithers_the_steps),
        cmocka_unit_test(saturates_at_its_range),      cmocka_unit_test(nan_stays_nan),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
