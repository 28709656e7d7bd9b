/* SPDX-License-Identifier: BSD-3-Clause
 * The bound of any tap: beside the time domain, where a lever that comes down goes over from the attractive to the
 * repulsive motion, and at its limits. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/random.h"
#include "internal/scan.h"
#include "internal/tapping.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/advanced/scan.h"
#include "nanotouch/material.h"

enum { LEVERS = 12, PERIODS = 20 };

static nt_plan plan;
static nt_rig rig;
static nt_drive drive;
static nt_scan scan;

/* A lever over a flat; NT_OK where the plan takes the scene. */
static nt_status draw(uint64_t seed, int humid)
{
    nt_noise dice = nt_noise_of(seed, 0);
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = 5e-9 * pow(4.0, nt_noise_uniform(&dice));
    scene.sample.youngs_modulus = 5e9 * pow(20.0, nt_noise_uniform(&dice));
    scene.medium.relative_humidity = humid ? 0.4 : 0.0;
    rig = nt_rig_defaults();
    rig.probe.spring_constant = 5.0 * pow(10.0, nt_noise_uniform(&dice));
    rig.probe.quality = 50.0 * pow(8.0, nt_noise_uniform(&dice));
    rig.probe.resonance = 300e3;
    drive = nt_drive_defaults();
    drive.free_amplitude = 10e-9 * pow(4.0, nt_noise_uniform(&dice));
    scan = nt_scan_defaults();
    scan.zloop.set_amplitude = 0.4;
    const nt_plan_inputs inputs = {.scene = &scene};
    return nt_plan_make(&plan, &inputs, NULL);
}

static nt_scanner made(void)
{
    const nt_scanner_inputs inputs = {&scan, &rig, &drive, &plan};
    nt_scanner scanner;
    assert_int_equal(nt_scanner_init(&scanner, &inputs, NULL), NT_OK);
    return scanner;
}

/* The largest force while the base comes down by 2 pm a period, from far above to a third of the free amplitude. */
static double come_down(const nt_tapping *lever)
{
    const double A0 = lever->free_amplitude;
    nt_tapping_state state = nt_tapping_free(lever);
    double most = -HUGE_VAL;
    for (double height = 1.1 * A0; height > 0.4 * A0; height -= PERIODS * 2e-12) {
        const nt_tapping_over over = {&plan, NULL, height};
        nt_tapping_value value;
        assert_int_equal(nt_tapping_run(lever, &state, &over, PERIODS, &value), NT_OK);
        most = larger(most, value.peak_force);
    }
    return most;
}

static void a_change_of_motion_in_the_time_domain(void **state)
{
    (void)state;
    double largest = 0.0;
    int taps = 0;
    for (uint64_t seed = 0; seed < LEVERS; seed++) {
        if (draw(seed, (int)(seed % 3 == 0)) != NT_OK)
            continue;
        const nt_scanner scanner = made();
        nt_tapping coarse = scanner.lever;
        coarse.tolerance = 1e-6;
        const nt_relief moving = {2e-12 * rig.probe.resonance, 0.05 * drive.free_amplitude};
        const double reached = come_down(&coarse), bound = nt_scanner_peak_bound(&scanner, NULL, &moving);
        assert_true(reached <= bound);
        largest = larger(largest, reached / bound);
        taps += reached > 0.05 * bound;
    }
    print_message("%d levers tap; at most %.2f of the bound\n", taps, largest);
    assert_true(taps > LEVERS / 3 && largest > 0.2);
}

/* It grows with the speed, is never below a steady motion, and is not there where the base comes as fast as the tip,
 * or the lever may stop. */
static void limits(void **state)
{
    (void)state;
    assert_int_equal(draw(1, 0), NT_OK);
    const nt_scanner scanner = made();
    const double fastest = 0.5 * scanner.lever.rate * scanner.lever.strength;
    double before = 0.0;
    for (double share = 0.0; share < 0.5; share += 0.1) {
        const nt_relief relief = {share * fastest, 1e-9};
        const double bound = nt_scanner_peak_bound(&scanner, NULL, &relief);
        assert_true(bound >= before && isfinite(bound));
        before = bound;
    }
    const nt_relief rises = {4.0 * fastest, 1.0};
    assert_true(isinf(nt_scanner_peak_bound(&scanner, NULL, &rises)));
    const double set = scanner.scan.zloop.set_amplitude * drive.free_amplitude;
    const nt_relief stops = {1.001 * set * scanner.integral, 2.0 * set}; /* the loop lags by the set point */
    assert_true(isinf(nt_scanner_peak_bound(&scanner, NULL, &stops)));
    const nt_relief flat = {0.0, 0.0};
    nt_flow_state flow = nt_flow_free(&scanner.lever);
    nt_flow_value value;
    const nt_tapping_over over = {&plan, NULL, 0.5 * drive.free_amplitude};
    assert_int_equal(nt_flow_settle(&scanner.lever, &flow, &over, &value, NULL), NT_OK);
    assert_true(value.peak_force > 0.0 && value.peak_force <= nt_scanner_peak_bound(&scanner, NULL, &flat));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_change_of_motion_in_the_time_domain),
        cmocka_unit_test(limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
