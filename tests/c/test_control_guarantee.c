/* SPDX-License-Identifier: BSD-3-Clause
 * The terms of the guarantee, one by one; all together they are tried by test_session_adversary. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/lti.h"
#include "internal/margins.h"
#include "larger.h"
#include "nanotouch/margins.h"
#include "nanotouch/material.h"

/* A lever that rings on for ever. */
static const nt_hazard flat = {.pull_off_force = 18e-9,
                               .snap_in = 50e-9,
                               .snap_in_depth = 0.2e-9,
                               .arrival = 40e-9,
                               .thermal = 5e-9,
                               .ring_down = HUGE_VAL,
                               .stiffness = 1000.0,
                               .unseen = 0.3e-9,
                               .deepest = HUGE_VAL};

static void it_is_the_limit_and_its_terms(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    const nt_guarantee g = nt_guarantee_compute(&rig, &settings, &flat);
    const double terms = g.calibration + g.motion + g.ringing + g.snap_in + g.noise + g.tare;
    assert_true(fabs(g.force - settings.limits.force - terms) < 1e-18);
    assert_true(fabs(g.snap_in - flat.snap_in) < 1e-18 && g.arrival == flat.arrival);
    const double off = 3.0 * sqrt(0.05 * 0.05 + 0.02 * 0.02);
    assert_true(fabs(g.calibration / settings.limits.force - off / (1.0 - off)) < 1e-12);
    assert_true(1.0 + off / (1.0 - off) > (1.0 + 0.05 * 2.9) / (1.0 - 0.02 * 0.76)); /* 2.9^2 + 0.76^2 = 9 */
    assert_true(g.reaction_time == nt_margins_compute(&rig, &settings.gains, flat.stiffness).loop_delay);
    /* 26 um/s (20, and 60 1/s of 0.1 um) for D, on a lever of up to 8 and 15 % and 1000 N/m in series */
    const double k_eff = 9.2 / 1.0092;
    assert_true(fabs(g.speed - 26e-6) < 1e-18);
    assert_true(fabs(g.motion - 26e-6 * g.reaction_time * k_eff) < 1e-15);
    assert_true(g.indentation > settings.limits.indentation + 26e-6 * g.reaction_time + flat.snap_in_depth);
    nt_hazard hard = flat;
    hard.deepest = 2e-9;
    assert_true(nt_guarantee_compute(&rig, &settings, &hard).indentation == 2e-9);
    assert_true(fabs(g.zero_drift - 9.2 * 0.1e-9) < 1e-20 && fabs(g.frame_drift - 9.2 * 1e-9) < 1e-20);
    assert_true(fabs(g.help_time - 50e3) < 1e-6); /* half of 100 um at 1 nm/s */
}

/* One thing that fails adds the most of what each kind adds. */
static void one_failure_is_the_worst_of_them(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    const nt_guarantee g = nt_guarantee_compute(&rig, &settings, &flat);
    double worst = 0.0;
    for (int i = 0; i < NT_FAILURES; i++) {
        assert_true(isfinite(g.failure[i]) && g.failure[i] > 0.0);
        assert_true(nt_failure_name((nt_failure)i)[0] != 0);
        worst = larger(worst, g.failure[i]);
    }
    assert_string_equal(nt_failure_name(NT_FAILURES), "");
    assert_true(g.with_failure == g.force + worst);
    /* a deflection read with any gain between 0 and 1 is stopped by the force limit or by the indentation */
    const double limit = settings.limits.force, noise = 2.0 * 13e-9; /* first touch is noticed above it */
    for (double gain = 0.05; gain < 1.0; gain += 0.01) {
        const double by_travel = 9.2 * settings.limits.indentation / (1.0 - gain) + noise / gain;
        assert_true(smaller(limit / gain, by_travel) < limit + 1.02 * g.failure[NT_FAILURE_READ_OUT]);
    }
    settings.limits.indentation = 30e-9;
    assert_true(nt_guarantee_compute(&rig, &settings, &flat).failure[NT_FAILURE_READ_OUT] <
                0.11 * g.failure[NT_FAILURE_READ_OUT]);
    /* without an integral nothing tells a stage that sticks from one with hysteresis */
    nt_settings open = settings;
    open.gains.stage_integral = 0.0;
    assert_true(isinf(nt_guarantee_compute(&rig, &open, &flat).failure[NT_FAILURE_SLIP]));
    /* a sensor whose noise is below one step is not told from a dead one */
    rig.probe.noise = 0.0;
    const nt_guarantee silent = nt_guarantee_compute(&rig, &settings, &flat);
    assert_true(isinf(silent.failure[NT_FAILURE_SENSOR]) && isinf(silent.with_failure) && isfinite(silent.force));
    /* a jump of the surface, where it is more than a stage may stick by */
    rig.stage.slip = 1e-6;
    assert_true(fabs(nt_guarantee_compute(&rig, &settings, &flat).failure[NT_FAILURE_SLIP] - 1e-6 * 9.2 / 1.0092) <
                1e-15);
}

/* The swing of a jump dies away while the force grows: what is left is never more than both have at one time. */
static void a_swing_dies_away(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    nt_hazard hazard = flat;
    hazard.snap_in = 4e-6;
    const double whole = nt_guarantee_compute(&rig, &settings, &hazard).force, still = whole - hazard.snap_in;
    for (double tau = 1e-5; tau < 1.0; tau *= 3.0) {
        hazard.ring_down = tau;
        const nt_guarantee g = nt_guarantee_compute(&rig, &settings, &hazard);
        double most = still + hazard.thermal;
        for (double t = 0.0; t < 0.1; t += 1e-6) {
            const double pressed = smaller(still, g.motion / g.reaction_time * t + g.ringing);
            most = larger(most, pressed + hazard.thermal + (hazard.snap_in - hazard.thermal) * exp(-t / tau));
        }
        assert_true(g.force >= most * (1.0 - 1e-12) && g.force < 1.03 * most);
    }
    hazard.ring_down = 1e-5;
    hazard.snap_in = 50e-9;
    assert_true(nt_guarantee_compute(&rig, &settings, &hazard).snap_in == flat.pull_off_force); /* no less than that */
}

/* What makes it worse makes it larger. */
static void every_hazard_counts(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    const nt_guarantee before = nt_guarantee_compute(&rig, &settings, &flat);
    nt_hazard worse = flat;
    worse.slope = 1.0;
    assert_true(nt_guarantee_compute(&rig, &settings, &worse).force > before.force);
    worse = flat;
    worse.snap_in *= 2.0;
    assert_true(nt_guarantee_compute(&rig, &settings, &worse).force > before.force);
    worse = flat;
    worse.unseen *= 10.0;
    assert_true(nt_guarantee_compute(&rig, &settings, &worse).indentation > before.indentation);
    nt_settings slow = settings;
    slow.gains.delay += 5.0;
    assert_true(nt_guarantee_compute(&rig, &slow, &flat).force > before.force);
    nt_settings fast = settings;
    fast.limits.stage_speed *= 2.0;
    assert_true(nt_guarantee_compute(&rig, &fast, &flat).force > before.force);
    nt_rig noisy = rig;
    noisy.probe.noise *= 2.0;
    assert_true(nt_guarantee_compute(&noisy, &settings, &flat).force > before.force);
    nt_settings paper = settings;
    paper.control.choice = NT_CONTROL_PAPER; /* rings with all of Q */
    assert_true(nt_guarantee_compute(&rig, &paper, &flat).ringing > 10.0 * before.ringing);
}

/* The bare stage (the paper's law), its command to and fro at the speed limit: at its resonance it swings as far as the
 * ringing term has it, at no frequency farther. */
static void the_stage_rings_no_farther(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    settings.control.choice = NT_CONTROL_PAPER;
    const nt_guarantee g = nt_guarantee_compute(&rig, &settings, &flat);
    const double bound = g.ringing / (9.2 / 1.0092), wn = 2.0 * NT_PI * rig.stage.resonance, T = 1e-5;
    const nt_lti stage = {.order = 2, .a = {{0.0, wn}, {-wn, -wn / rig.stage.quality}}, .b = {0.0, wn}};
    nt_lti step;
    assert_int_equal(nt_lti_discretise(&stage, T, &step), NT_OK);
    double largest = 0.0;
    for (double frequency = 100.0; frequency < 1000.0; frequency += 10.0) {
        double u = 0.0, x = 0.0, v = 0.0, low = 0.0, high = 0.0;
        const double half = 0.5 / frequency, speed = settings.limits.stage_speed;
        for (int k = 0; k < 40000; k++) {
            u += (fmod(k * T + 0.5 * half, 2.0 * half) < half ? speed : -speed) * T;
            const double moved = step.a[0][0] * x + step.a[0][1] * v + step.b[0] * u;
            v = step.a[1][0] * x + step.a[1][1] * v + step.b[1] * u;
            x = moved;
            if (k > 20000)
                low = smaller(low, x), high = larger(high, x);
        }
        if (frequency >= 300.0) /* slower, it follows the command and does not ring */
            largest = larger(largest, 0.5 * (high - low));
    }
    print_message("rings by %.1f nm, promised %.1f nm\n", 1e9 * largest, 1e9 * bound);
    assert_true(largest < bound && largest > 0.9 * bound);
}

/* Two samples in a period of the resonance do not show it: the notch is off, and the stage as bare as under the paper's
 * law. */
static void without_a_notch_the_stage_rings_bare(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    rig.stage.command_resolution = 0.0;
    for (double ratio = 1.7; ratio < 2.4; ratio += 0.2) {
        nt_settings settings = nt_settings_defaults(&rig);
        settings.gains.rate = ratio * rig.stage.resonance;
        settings.gains.stage_integral = 0.0;
        nt_settings paper = settings;
        paper.control.choice = NT_CONTROL_PAPER;
        const double rings = nt_guarantee_compute(&rig, &settings, &flat).ringing;
        const double bare = nt_guarantee_compute(&rig, &paper, &flat).ringing;
        if (ratio < 2.0)
            assert_true(fabs(rings / bare - 1.0) < 1e-12);
        else
            assert_true(rings < 0.1 * bare);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_limit_and_its_terms),
        cmocka_unit_test(one_failure_is_the_worst_of_them),
        cmocka_unit_test(a_swing_dies_away),
        cmocka_unit_test(every_hazard_counts),
        cmocka_unit_test(the_stage_rings_no_farther),
        cmocka_unit_test(without_a_notch_the_stage_rings_bare),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
