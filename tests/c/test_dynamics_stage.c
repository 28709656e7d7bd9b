/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "dynamics/dynamics.h"
#include "larger.h"
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
                nt_stage_step(&model, &now, step, &(nt_stage_load){.force = 0.0});
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
        nt_stage_state a = {.position = 3e-8, .speed = -2e-5}, b = a;
        for (int k = 0; k < 50; k++) {
            const double command = 1e-7 * sin(0.3 * k), force = 1e-7 * cos(0.7 * k);
            nt_stage_step(&whole, &a, command, &(nt_stage_load){.force = force});
            nt_stage_step(&half, &b, command, &(nt_stage_load){.force = force});
            nt_stage_step(&half, &b, command, &(nt_stage_load){.force = force});
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
        nt_stage_step(&model, &now, 5e-6, &(nt_stage_load){.force = 2.6e-6});
    assert_true(fabs(now.position - (5e-6 - 2.6e-6 / 2e5)) < 4e-21); /* a few roundings of 5 um */
    const nt_stage_state rest = {.position = 5e-6};
    now = rest;
    for (int k = 0; k < 1000; k++)
        nt_stage_step(&model, &now, 5e-6, &(nt_stage_load){.force = 0.0});
    assert_true(now.position == rest.position && now.speed == 0.0); /* rest is rest, to the last bit */
}

/* A stage of Q = 1e6 on a sample, in steps of a fifth of a radian: a force that came a step late would feed it. */
static void a_stiff_load_does_not_feed_the_resonance(void **state)
{
    (void)state;
    for (double stiffness = 1.0; stiffness < 2e9; stiffness *= 100.0) {
        nt_stage stage = nt_rig_defaults().stage;
        stage.quality = 1e6;
        nt_stage_model model;
        assert_int_equal(nt_stage_model_init(&model, &stage, 1e-4), NT_OK);
        nt_stage_state now = {.position = 1e-9};
        double largest = 0.0;
        for (int k = 0; k < 200000; k++) {
            const nt_stage_load load = {stiffness * now.position, stiffness};
            nt_stage_step(&model, &now, 0.0, &load);
            largest = larger(largest, fabs(now.position));
        }
        assert_true(largest < 1.0000001e-9);
    }
}

/* A stage quick enough that it stands where the ceramic does. */
static nt_stage_model ceramic(double hysteresis, double creep, double period)
{
    nt_stage stage = nt_rig_defaults().stage;
    stage.resonance = 1e6;
    stage.quality = 0.5;
    stage.hysteresis = hysteresis;
    stage.creep = creep;
    nt_stage_model model;
    assert_int_equal(nt_stage_model_init(&model, &stage, period), NT_OK);
    return model;
}

typedef struct loop {
    double opening, work, end; /* widest [m], of u dx around [m^2], where it closes [m] */
} loop;

/* Once around between -amplitude and amplitude, after a first rise, in `steps` steps per side. */
static loop go_around(const nt_stage_model *model, double amplitude, int steps)
{
    nt_stage_state now = {0};
    loop l = {0};
    for (int k = 0; k <= steps; k++)
        nt_stage_step(model, &now, amplitude * k / steps, &(nt_stage_load){.force = 0.0});
    double up[64], last = now.position;
    assert_true(steps <= 32);
    for (int k = 0; k <= 4 * steps; k++) {
        const double u = amplitude * (1.0 - (k <= 2 * steps ? k : 4 * steps - k) / (double)steps);
        nt_stage_step(model, &now, u, &(nt_stage_load){.force = 0.0});
        l.work += u * (now.position - last);
        last = now.position;
        if (k < 2 * steps)
            up[k] = now.position;
        else if (k > 2 * steps)
            l.opening = larger(l.opening, up[4 * steps - k < 2 * steps ? 4 * steps - k : 0] - now.position);
    }
    l.end = now.position;
    return l;
}

/* Full stroke: opens by h of it, and ends where it was told to. Small strokes open as their square (Rayleigh). The loop
 * takes work, in any number of steps, and a slower one is the same loop. */
static void hysteresis_opens_as_stated(void **state)
{
    (void)state;
    const double half = 0.5 * nt_rig_defaults().stage.travel, h = 0.15;
    const nt_stage_model model = ceramic(h, 0.0, 1e-3), slow = ceramic(h, 0.0, 1.0);
    const loop full = go_around(&model, half, 32), again = go_around(&slow, half, 32);
    assert_true(fabs(full.opening / (2.0 * half) / h - 1.0) < 1e-5); /* ten plays: 4^-10 */
    assert_true(fabs(full.end / half - 1.0) < 1e-3);                 /* ... and 2^-10 */
    assert_true(fabs(again.opening / full.opening - 1.0) < 1e-12 && fabs(again.end - full.end) < 1e-18);
    for (double share = 0.5; share > 0.01; share *= 0.5) {
        const loop small = go_around(&model, share * half, 32);
        assert_true(fabs(small.opening / full.opening / (share * share) - 1.0) < 0.15); /* plays are octaves apart */
    }
    nt_stage_state middle = {.position = 0.3 * half};
    nt_stage_set_plays(&middle, 0.3 * half);
    nt_stage_step(&model, &middle, 0.3 * half, &(nt_stage_load){0});
    assert_true(fabs(middle.position / (0.3 * half) - 1.0) < 1e-12);
    nt_random random = nt_random_seed(5);
    nt_stage_state now = {0};
    double work = 0.0, u = 0.0;
    for (int k = 0; k < 20000; k++) { /* passive on any path: never more out than was put in, linear part aside */
        const double last = now.position, before = u;
        u = half * (2.0 * nt_random_uniform(&random) - 1.0);
        nt_stage_step(&model, &now, u, &(nt_stage_load){.force = 0.0});
        work += 0.5 * (u + before) * (now.position - last);
        assert_true(work > -1e-20);
    }
}

/* A ceramic whose hysteresis changes keeps its place, wherever it stands in its loop: fault 9502085 of the adversary
 * leapt by 1 um, and rang. From there on it follows the new loop. */
static void a_change_of_hysteresis_moves_nothing(void **state)
{
    (void)state;
    static const double values[] = {0.385, 0.02, 0.0, 0.2};
    const double half = 0.5 * nt_rig_defaults().stage.travel;
    nt_stage_model model = ceramic(0.09, 0.0, 1.0);
    nt_stage_state now = {0};
    nt_random random = nt_random_seed(7);
    double u = 0.0;
    for (int i = 0; i < 400; i++) {
        u = half * (2.0 * nt_random_uniform(&random) - 1.0);
        nt_stage_step(&model, &now, u, &(nt_stage_load){0});
        const double stood = now.position;
        nt_stage_set_hysteresis(&model, &now, values[i % 4], u);
        nt_stage_step(&model, &now, u, &(nt_stage_load){0});
        assert_true(fabs(now.position - stood) < 1e-12 * half);
        assert_true(model.stage.hysteresis == values[i % 4]);
    }
}

/* After 1, 10, 100 s a step has crept by about `creep` of it per decade; the sum of lags is log t to 0.15 of a decade.
 */
static void creep_is_logarithmic(void **state)
{
    (void)state;
    const nt_stage_model model = ceramic(0.0, 0.01, 1e-3);
    nt_stage_state now = {0};
    double at[4] = {0};
    for (int k = 1; k <= 100000; k++) {
        nt_stage_step(&model, &now, 1e-6, &(nt_stage_load){.force = 0.0});
        for (int i = 0; i < 4; i++)
            at[i] = k == (int)pow(10.0, 2.0 + i) ? now.position : at[i];
    }
    for (int i = 1; i < 4; i++)
        assert_true(fabs((at[i] - at[i - 1]) / 1e-6 / 0.01 - 1.0) < 0.15);
}

static void options_change_nothing_when_off(void **state)
{
    (void)state;
    const nt_stage closed = nt_stage_closed_loop(), open = nt_stage_open_loop();
    assert_true(closed.hysteresis == 0.0 && closed.creep == 0.0 && closed.resolution == 10e-9);
    assert_true(open.hysteresis > 0.0 && open.creep > 0.0 && open.resolution == 1e-9);
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
    nt_stage_step(&model, &now, (double)NAN, &(nt_stage_load){.force = 0.0});
    assert_true(isnan(now.position) && isnan(now.speed));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(step_response_is_exact),
        cmocka_unit_test(half_steps_compose),
        cmocka_unit_test(force_pushes_back_by_its_stiffness),
        cmocka_unit_test(a_stiff_load_does_not_feed_the_resonance),
        cmocka_unit_test(hysteresis_opens_as_stated),
        cmocka_unit_test(a_change_of_hysteresis_moves_nothing),
        cmocka_unit_test(creep_is_logarithmic),
        cmocka_unit_test(options_change_nothing_when_off),
        cmocka_unit_test(refuses_bad_stages_and_periods),
        cmocka_unit_test(nan_is_not_hidden),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
