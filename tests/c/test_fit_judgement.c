/* SPDX-License-Identifier: BSD-3-Clause
 * fit/judgement.cpp: white residuals are noise; those of another law, a wave or too little stated noise are not. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "fit_curve.h"

#define NOISE 20e-12

static void white_noise_is_noise(void **state)
{
    (void)state;
    for (int model = 0; model < NT_FIT_CUSTOM; model++)
        for (unsigned seed = 1; seed < 6; seed++) {
            const nt_fit_options options = options_of((nt_fit_model)model, 0.5);
            curve made;
            synthesise(&options, NOISE, seed, &made);
            const nt_fit_result result = run(&options, &made);
            assert_true(result.residuals_are_noise);
            assert_relative(result.residual_noise, NOISE, 0.3, "residual_noise");
            assert_null(strstr(result.message, "not noise"));
        }
}

static void a_wave_is_none(void **state)
{
    (void)state;
    const nt_fit_options options = options_of(NT_FIT_HERTZ, 0.5);
    curve made;
    synthesise(&options, NOISE, 1, &made);
    for (int i = 0; i < POINTS; i++)
        made.force[i] += 4.0 * NOISE * sin(20.0 * (double)i / POINTS);
    const nt_fit_result result = run(&options, &made);
    assert_false(result.residuals_are_noise);
    assert_relative(result.residual_noise, NOISE, 0.3, "residual_noise"); /* the wave is smooth from point to point */
    assert_non_null(strstr(result.message, "not noise"));
}

static void more_noise_than_stated_is_none(void **state)
{
    (void)state;
    nt_fit_options options = options_of(NT_FIT_JKR, 0.5);
    curve made;
    synthesise(&options, NOISE, 1, &made);
    options.force_noise = NOISE;
    assert_true(run(&options, &made).residuals_are_noise);
    options.force_noise = 0.3 * NOISE;
    assert_false(run(&options, &made).residuals_are_noise);
}

/* With a robust loss the outliers are none of the model's fault. */
static void outliers_are_left_to_a_robust_loss(void **state)
{
    (void)state;
    nt_fit_options options = options_of(NT_FIT_HERTZ, 0.5);
    curve made;
    synthesise(&options, NOISE, 3, &made);
    for (int i = 0; i < POINTS; i += 10)
        made.force[i] += 200.0 * NOISE;
    assert_false(run(&options, &made).residuals_are_noise);
    options.loss = NT_LOSS_CAUCHY;
    options.loss_scale = 3.0 * NOISE;
    assert_true(run(&options, &made).residuals_are_noise);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_noise_is_noise),
        cmocka_unit_test(a_wave_is_none),
        cmocka_unit_test(more_noise_than_stated_is_none),
        cmocka_unit_test(outliers_are_left_to_a_robust_loss),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
