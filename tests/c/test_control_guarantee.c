/* SPDX-License-Identifier: BSD-3-Clause
 * The terms of the guarantee, one by one; all together they are tried by test_session_adversary. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/lti.h"
#include "larger.h"
#include "nanotouch/guarantee.h"
#include "nanotouch/margins.h"
#include "nanotouch/material.h"

static const nt_hazard flat = {.snap_in_force = 18e-9, .stiffness = 1000.0, .unseen = 0.3e-9};

static void it_is_the_limit_and_its_terms(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    const nt_guarantee g = nt_guarantee_compute(&rig, &settings, &flat);
    const double terms = g.motion + g.ringing + g.snap_in + g.noise;
    assert_true(fabs(g.force - settings.limits.force - terms) < 1e-18);
    assert_true(g.snap_in == flat.snap_in_force);
    assert_true(g.reaction_time == nt_margins_compute(&rig, &settings.gains, flat.stiffness).loop_delay);
    /* 26 um/s (20, and 60 1/s of 0.1 um) for D, on 8 and 1000 N/m in series */
    assert_true(fabs(g.motion - 26e-6 * g.reaction_time * 8.0 / 1.008) < 1e-15);
    const double k_eff = 8.0 / 1.008, share = settings.limits.retract_speed / 26e-6; /* the wrong way, ringing */
    assert_true(fabs(g.with_faults - g.force - k_eff * settings.limits.retract_distance - share * g.ringing) < 1e-18);
    assert_true(g.indentation > settings.limits.indentation + 26e-6 * g.reaction_time);
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
    worse.snap_in_force *= 2.0;
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
    const double bound = g.ringing / (8.0 / 1.008), wn = 2.0 * NT_PI * rig.stage.resonance, T = 1e-5;
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_limit_and_its_terms),
        cmocka_unit_test(every_hazard_counts),
        cmocka_unit_test(the_stage_rings_no_farther),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
