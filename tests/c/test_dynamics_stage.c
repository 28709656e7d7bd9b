/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/dynamics.h"

static const double periods[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}; /* 100 Hz .. 1 MHz */

/* Closed form of the step response from rest (textbook, all three dampings), relative to the step. */
static void step_response(const nt_stage *stage, double t, double *x, double *v)
{
    const double wn = 2.0 * 3.14159265358979323846 * stage->resonance, zeta = 0.5 / stage->quality;
    const double s = zeta * wn;
    if (zeta < 1.0) {
        const double wd = wn * sqrt(1.0 - zeta * zeta), decay = exp(-s * t);
        *x = 1.0 - decay * (cos(wd * t) + s / wd * sin(wd * t));
        *v = decay * wn * wn / wd * sin(wd * t);
    } else if (zeta > 1.0) {
        const double root = wn * sqrt(zeta * zeta - 1.0), fast = s + root, slow = wn * wn / fast;
        *x = 1.0 + (slow * exp(-fast * t) - fast * exp(-slow * t)) / (fast - slow);
        *v = wn * wn * (exp(-slow * t) - exp(-fast * t)) / (fast - slow);
    } else {
        *x = 1.0 - exp(-s * t) * (1.0 + s * t);
        *v = s * s * t * exp(-s * t);
    }
}

/* To 1e-13 of the step, and 4e-15 per radian of the oscillation (2800 at most, where it is 1.1e-11): the phase is the
 * sum of rounded steps wn T. */
static void step_response_is_exact(void **state)
{
    (void)state;
    static const double qualities[] = {0.05, 0.3, 0.5, 0.7, 20.0, 1e6};
    const double step = 1e-7;
    for (size_t q = 0; q < sizeof qualities / sizeof *qualities; q++)
        for (size_t p = 0; p < sizeof periods / sizeof *periods; p++) {
            nt_stage stage = nt_rig_defaults().stage;
            stage.quality = qualities[q];
            nt_stage_model model;
            assert_int_equal(nt_stage_model_init(&model, &stage, periods[p]), NT_OK);
            nt_stage_state now = {0};
            const double wn = 2.0 * 3.14159265358979323846 * stage.resonance;
            for (int k = 1; k <= 100; k++) {
                double x, v;
                nt_stage_step(&model, &now, step, 0.0);
                step_response(&stage, k * periods[p], &x, &v);
                const double tolerance = 1e-13 + 4e-15 * wn * k * periods[p];
                assert_true(fabs(now.position / step - x) < tolerance);
                assert_true(fabs(now.speed / step - v) / wn < tolerance);
            }
        }
}

static void half_steps_compose(void **state)
{
    (void)state;
    for (size_t p = 0; p < sizeof periods / sizeof *periods; p++) {
        const nt_stage stage = nt_rig_defaults().stage;
        nt_stage_model whole, half;
        assert_int_equal(nt_stage_model_init(&whole, &stage, periods[p]), NT_OK);
        assert_int_equal(nt_stage_model_init(&half, &stage, periods[p] / 2.0), NT_OK);
        nt_stage_state a = {3e-8, -2e-5}, b = a;
        for (int k = 0; k < 50; k++) {
            const double command = 1e-7 * sin(0.3 * k), force = 1e-7 * cos(0.7 * k);
            nt_stage_step(&whole, &a, command, force);
            nt_stage_step(&half, &b, command, force);
            nt_stage_step(&half, &b, command, force);
            assert_true(fabs(a.position - b.position) < 1e-13 * 1e-7);
            assert_true(fabs(a.speed - b.speed) < 1e-13 * 1e-7 * 2827.0);
        }
    }
}

/* Erratum E15: at rest x_s = u - f / k_stage, metres from metres. */
static void force_pushes_back_by_its_stiffness(void **state)
{
    (void)state;
    nt_stage stage = nt_rig_defaults().stage;
    stage.stiffness = 2e5;
    nt_stage_model model;
    assert_int_equal(nt_stage_model_init(&model, &stage, 1e-4), NT_OK);
    nt_stage_state now = {0};
    for (int k = 0; k < 20000; k++) /* 2 s = 280 decay times */
        nt_stage_step(&model, &now, 5e-6, 2.6e-6);
    assert_true(fabs(now.position - (5e-6 - 2.6e-6 / 2e5)) < 4e-21); /* a few roundings of 5 um */
    const nt_stage_state rest = {5e-6, 0.0};
    now = rest;
    for (int k = 0; k < 1000; k++)
        nt_stage_step(&model, &now, 5e-6, 0.0);
    assert_true(now.position == rest.position && now.speed == 0.0); /* rest is rest, to the last bit */
}

static void published_matrices_are_the_transition(void **state)
{
    (void)state;
    const nt_stage stage = nt_rig_defaults().stage;
    nt_stage_model model;
    assert_int_equal(nt_stage_model_init(&model, &stage, 1e-4), NT_OK);
    nt_stage_state now = {2e-8, 1e-5};
    nt_stage_step(&model, &now, 1e-7, 0.0);
    const double x = model.phi[0][0] * 2e-8 + model.phi[0][1] * 1e-5 + model.gamma[0] * 1e-7;
    const double v = model.phi[1][0] * 2e-8 + model.phi[1][1] * 1e-5 + model.gamma[1] * 1e-7;
    assert_true(fabs(now.position - x) < 1e-22 && fabs(now.speed - v) < 1e-19);
}

static void refuses_bad_stages_and_periods(void **state)
{
    (void)state;
    nt_stage stage = nt_rig_defaults().stage;
    nt_stage_model model;
    assert_int_equal(nt_stage_model_init(&model, &stage, 0.0), NT_E_RANGE);
    assert_int_equal(nt_stage_model_init(&model, &stage, (double)NAN), NT_E_NOT_FINITE);
    stage.quality = 0.0;
    assert_int_equal(nt_stage_model_init(&model, &stage, 1e-4), NT_E_RANGE);
    stage.quality = (double)NAN;
    assert_int_equal(nt_stage_model_init(&model, &stage, 1e-4), NT_E_NOT_FINITE);
}

static void nan_is_not_hidden(void **state)
{
    (void)state;
    const nt_stage stage = nt_rig_defaults().stage;
    nt_stage_model model;
    assert_int_equal(nt_stage_model_init(&model, &stage, 1e-4), NT_OK);
    nt_stage_state now = {0};
    nt_stage_step(&model, &now, (double)NAN, 0.0);
    assert_true(isnan(now.position) && isnan(now.speed));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(step_response_is_exact),
        cmocka_unit_test(half_steps_compose),
        cmocka_unit_test(force_pushes_back_by_its_stiffness),
        cmocka_unit_test(published_matrices_are_the_transition),
        cmocka_unit_test(refuses_bad_stages_and_periods),
        cmocka_unit_test(nan_is_not_hidden),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
