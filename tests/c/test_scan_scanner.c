/* SPDX-License-Identifier: BSD-3-Clause
 * Scans: what is flat is flat, a tilt is a tilt, a loop that is told to be stable is, a step down is parachuted down as
 * derived, a slope is followed with the error that the speed limit says. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "dynamics/dynamics.h"
#include "internal/scan.h"
#include "internal/tapping.h"
#include "larger.h"
#include "nanotouch/advanced/scan.h"

enum { N = 256, LINES = 4 };
static double heights[LINES * N], coefficients[LINES * N];
static double trace_height[N], trace_error[N], trace_signal[N], back_height[N], peak[N];
static nt_plan plan;
static nt_surface surface;

/* Over x alone, 1 um wide. */
static void make_plan(double (*shape)(double))
{
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = 10e-9;
    scene.sample.youngs_modulus = 10e9;
    scene.medium.relative_humidity = 0.0;
    const nt_plan_inputs inputs = {.scene = &scene, .surface = shape ? &surface : NULL};
    for (int i = 0; shape && i < LINES * N; i++)
        heights[i] = shape((i % N) * 1e-6 / N);
    const nt_height_map map = {heights, N, LINES, 1e-6 / N, 1e-6 / N};
    if (shape)
        assert_int_equal(nt_surface_init(&surface, &map, coefficients), NT_OK);
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
}

/* A scanner of 20 kHz and a lever of 300 kHz, 40 N/m, Q = 200. */
static nt_rig fast_rig(void)
{
    nt_rig rig = nt_rig_defaults();
    rig.stage.resonance = 20e3;
    rig.stage.quality = 5.0;
    rig.probe.spring_constant = 40.0;
    rig.probe.quality = 200.0;
    rig.probe.resonance = 300e3;
    return rig;
}

static nt_scan quiet(int mode)
{
    nt_scan scan = nt_scan_defaults();
    scan.zloop.mode = mode;
    scan.zloop.noise = 0.0;
    scan.raster.height = 4e-9;
    scan.raster.lines = 1.0;
    return scan;
}

static nt_scanner made(const nt_scan *scan)
{
    const nt_rig rig = fast_rig();
    const nt_drive drive = nt_drive_defaults();
    const nt_scanner_inputs inputs = {scan, &rig, &drive, &plan};
    nt_scanner scanner;
    assert_int_equal(nt_scanner_init(&scanner, &inputs, NULL), NT_OK);
    return scanner;
}

static void run(const nt_scanner *scanner)
{
    nt_scan_row trace = {.height = trace_height, .error = trace_error, .signal = trace_signal, .peak_force = peak};
    nt_scan_row back = {.height = back_height};
    nt_scanner_state state;
    assert_int_equal(nt_scanner_engage(scanner, &state, 0, 1), NT_OK);
    assert_int_equal(nt_scanner_line(scanner, &state, 0, &trace, &back), NT_OK);
}

/* A flat with a tilt of 1 % and a drift: heights are that plane but for a constant, to the lag of the loop, v s/K_I. */
static void a_tilted_flat(void **state)
{
    (void)state;
    make_plan(NULL);
    for (int mode = 0; mode < 2; mode++) {
        nt_scan scan = quiet(mode);
        scan.raster.tilt_x = 0.01;
        scan.raster.drift = 2e-9;
        const nt_scanner scanner = made(&scan);
        run(&scanner);
        const double speed = 1e-6 * 2.0, lag = 1.1 * (speed * 0.01 + 2e-9) / scanner.integral + 1e-13;
        for (int i = 2; i < N; i++) {
            const double x = (i - 2) * 1e-6 / N, expected = 0.01 * x + 2e-9 * x / speed;
            assert_true(fabs(trace_height[i] - trace_height[2] - expected) < 2.0 * lag);
            assert_true(fabs(trace_error[i]) < lag);
        }
        /* back later by the drift: at pixel i by (N - i) pixels twice */
        const double later = 2e-9 * 2.0 * (N - 100.5) * 1e-6 / N / speed;
        assert_true(fabs(back_height[100] - trace_height[100] - later) < 4.0 * lag);
        if (mode == NT_ZLOOP_CONTACT)
            assert_true(fabs(peak[100] / scan.zloop.set_force - 1.0) < 0.1);
        else
            assert_true(fabs(trace_signal[100] / (0.7 * 20e-9) - 1.0) < 1e-3);
    }
}

/* On the way to the next line the loop follows: the step of 2.5 nm between two lines is no blow. */
static void a_slope_across_the_lines(void **state)
{
    (void)state;
    make_plan(NULL);
    for (int mode = 0; mode < 2; mode++) {
        nt_scan scan = quiet(mode);
        scan.zloop.set_force = 20e-9;
        scan.raster.tilt_y = 0.05;
        scan.raster.height = 200e-9;
        scan.raster.lines = 4.0;
        const nt_scanner scanner = made(&scan);
        nt_scan_row trace = {.height = trace_height, .peak_force = peak}, back = {.height = back_height};
        nt_scanner_state at;
        assert_int_equal(nt_scanner_engage(&scanner, &at, 0, 1), NT_OK);
        for (long line = 0; line < 3; line++)
            assert_int_equal(nt_scanner_line(&scanner, &at, line, &trace, &back), NT_OK);
        assert_true(fabs(peak[0] / peak[100] - 1.0) < 0.1);
        assert_true(fabs(trace_height[0] - trace_height[100]) < 20e-12);
        assert_true(fabs(at.time - 6.0 * (double)scanner.ticks * scanner.period) < 1e-6);
    }
}

/* The advised gain has the margins that it is advised for, and beyond its gain margin the loop is refused. */
static void margins_of_the_loop(void **state)
{
    (void)state;
    make_plan(NULL);
    for (int mode = 0; mode < 2; mode++) {
        nt_scan scan = quiet(mode);
        const nt_scanner scanner = made(&scan);
        const nt_zloop_margins m = nt_scanner_margins(&scanner);
        assert_true(m.gain >= 2.0 - 1e-9 && m.phase >= 0.25 * 3.14159 - 0.02);
        assert_true(m.gain < 2.0 + 1e-9 || m.phase < 0.25 * 3.14159 + 0.02);
        scan.zloop.integral = 1.01 * scanner.integral * m.gain;
        const nt_rig rig = fast_rig();
        const nt_drive drive = nt_drive_defaults();
        const nt_scanner_inputs inputs = {&scan, &rig, &drive, &plan};
        nt_scanner refused;
        nt_problem problem;
        assert_int_equal(nt_scanner_init(&refused, &inputs, &problem), NT_E_RANGE);
        assert_string_equal(problem.field, "zloop.integral");
        assert_true(fabs(problem.maximum / (scanner.integral * m.gain) - 1.0) < 1e-9);
    }
}

/* The simulated loop itself: where the stage's resonance is what limits it, it rings up beyond its gain margin and dies
 * away below it, within 10 %. */
static double swing_at(double share)
{
    nt_scan scan = quiet(NT_ZLOOP_CONTACT);
    scan.zloop.set_force = 20e-9;
    nt_scanner scanner = made(&scan);
    const nt_stage slow = {
        .resonance = 1e3, .quality = 20.0, .stiffness = 1e6, .travel = 1e-4, .max_speed = 1.0, .axes = 1.0};
    assert_int_equal(nt_stage_model_init(&scanner.stage, &slow, scanner.period), NT_OK);
    scanner.integral = nt_scanner_gain(&scanner);
    scanner.probe.spring_constant = 1.0; /* far below the sample's, so that the deflection follows the stage */
    nt_scanner_state state;
    assert_int_equal(nt_scanner_engage(&scanner, &state, 0, 1), NT_OK);
    scanner.integral *= share * nt_scanner_margins(&scanner).gain;
    state.command += 1e-11;
    double first = 0.0, last = 0.0;
    nt_scan_row trace = {.error = trace_error}, back = {.error = trace_signal};
    scanner.ticks = 10000;
    assert_int_equal(nt_scanner_line(&scanner, &state, 0, &trace, &back), NT_OK);
    for (int i = 0; i < 16; i++) {
        first = larger(first, fabs(trace_error[16 + i]));
        last = larger(last, fabs(trace_error[N - 1 - i]));
    }
    return last / first;
}

static void margins_are_those_of_the_simulation(void **state)
{
    (void)state;
    make_plan(NULL);
    assert_true(swing_at(0.9) < 0.9);
    assert_true(swing_at(1.1) > 1.1);
}

/* In tapping mode, behind a lock-in amplifier of any speed: at 0.9 of the gain margin a deviation dies away. */
static void a_slow_lock_in_amplifier_counts(void **state)
{
    (void)state;
    make_plan(NULL);
    const double constants[] = {60e-6, 600e-6, 6e-3};
    for (int n = 0; n < 3; n++) {
        nt_scan scan = quiet(NT_ZLOOP_TAPPING);
        scan.zloop.lock_in = constants[n];
        nt_scanner scanner = made(&scan);
        nt_scanner_state at;
        assert_int_equal(nt_scanner_engage(&scanner, &at, 0, 1), NT_OK);
        scanner.integral *= 0.9 * nt_scanner_margins(&scanner).gain;
        at.command += 50e-12;
        nt_scan_row trace = {.error = trace_error}, back = {.error = trace_signal};
        scanner.ticks = 2560 + (long)(30.0 * constants[n] / scanner.period);
        assert_int_equal(nt_scanner_line(&scanner, &at, 0, &trace, &back), NT_OK);
        double first = 0.0, last = 0.0;
        for (int i = 0; i < 32; i++) {
            first = larger(first, fabs(trace_error[i]));
            last = larger(last, fabs(trace_error[N - 1 - i]));
        }
        assert_true(first > 1e-12 && last < 0.1 * first);
    }
}

/* What it tells settles as 1 - exp(-t/tau): held at its height far from the surface the lever swings with A0 at once,
 * and the reading follows. */
static void the_lock_in_amplifier_settles(void **state)
{
    (void)state;
    make_plan(NULL);
    nt_scan scan = quiet(NT_ZLOOP_TAPPING);
    scan.zloop.lock_in = 1e-3;
    scan.raster.pixels = N;
    nt_scanner scanner = made(&scan);
    nt_scanner_state at;
    assert_int_equal(nt_scanner_engage(&scanner, &at, 0, 1), NT_OK);
    at.flow = nt_flow_free(&scanner.lever);
    at.command += 1e-6;
    at.stage.position = -at.command;
    at.measured = 0.0;
    scanner.integral = 1e-9; /* no loop */
    scanner.ticks = N;
    nt_scan_row trace = {.signal = trace_signal}, back = {.signal = trace_error};
    assert_int_equal(nt_scanner_line(&scanner, &at, 0, &trace, &back), NT_OK);
    for (int i = 0; i < N; i++) {
        const double t = (i + 1) * scanner.period;
        assert_true(fabs(trace_signal[i] / 20e-9 + expm1(-t / 1e-3)) < 0.03);
    }
    assert_true(trace_signal[N - 1] > 0.9 * 20e-9 && trace_signal[10] < 0.3 * 20e-9);
}

static double cliff(double x)
{
    return x < 0.3e-6 ? 200e-9 : 0.0;
}

/* A step down of 200 nm: back on the floor after v H/(K_I (A0 - A)), within 20 %; what A0 - A is of each mode. */
static void parachuting(void **state)
{
    (void)state;
    make_plan(cliff);
    for (int mode = 0; mode < 3; mode++) {
        nt_scan scan = quiet(mode);
        scan.zloop.set_amplitude = 0.9;
        scan.zloop.set_phase = asin(0.9);
        scan.zloop.set_force = 160e-9;
        scan.raster.line_rate = mode == NT_ZLOOP_PHASE ? 2.0 : 10.0; /* its advised K_I is a fifth */
        nt_scanner scanner = made(&scan);
        if (mode == NT_ZLOOP_CONTACT) {
            scan.zloop.integral = 3000.0;
            scanner = made(&scan);
        }
        const double left = mode == NT_ZLOOP_CONTACT ? 160e-9 / 40.0 : 0.1 * 20e-9;
        const double speed = 2.0 * scan.raster.width * scan.raster.line_rate;
        const double way = nt_scanner_parachute(&scanner, 200e-9, speed);
        assert_true(fabs(way * scanner.integral * left / (200e-9 * speed) - 1.0) < 1e-6);
        run(&scanner);
        assert_true(way > 0.05e-6 && way < 0.6e-6);
        int landed = N - 1;
        while (landed > 0 && fabs(trace_error[landed]) < 0.5 * left)
            landed--;
        const double found = landed * 1e-6 / N - 0.3e-6;
        print_message("mode %d: %.3g of what is told\n", mode, found / way);
        assert_true(fabs(found / way - 1.0) < 0.2);
    }
}

static double ramp(double x)
{
    return 0.1 * (x < 0.5e-6 ? x : 1e-6 - x);
}

/* On a slope of 0.1 at the speed that is said to keep 0.1 nm, the error is that, within 20 %. */
static void speed_limit(void **state)
{
    (void)state;
    make_plan(ramp);
    for (int mode = 0; mode < 2; mode++) {
        nt_scan scan = quiet(mode);
        scan.zloop.set_force = 20e-9;
        nt_scanner scanner = made(&scan);
        const double speed = nt_scanner_speed(&scanner, 0.1, 0.1e-9);
        scan.raster.line_rate = smaller(0.5 * speed / 1e-6, 90.0);
        scanner = made(&scan);
        run(&scanner);
        const double error = 0.1e-9 * scan.raster.line_rate * 2e-6 / speed;
        double mean = 0.0;
        for (int i = 64; i < 120; i++)
            mean += trace_error[i] / 56.0;
        assert_true(fabs(fabs(mean) / error - 1.0) < 0.2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tilted_flat),
        cmocka_unit_test(a_slope_across_the_lines),
        cmocka_unit_test(margins_of_the_loop),
        cmocka_unit_test(margins_are_those_of_the_simulation),
        cmocka_unit_test(a_slow_lock_in_amplifier_counts),
        cmocka_unit_test(the_lock_in_amplifier_settles),
        cmocka_unit_test(parachuting),
        cmocka_unit_test(speed_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
