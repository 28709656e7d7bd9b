/* SPDX-License-Identifier: BSD-3-Clause
 * How far the height servo of a session that taps is from ringing: by the rule of the scanner's z loop (scan/loop.c),
 * with the stage, the notch and the dead time of the session. */
#include <math.h>

#include "control/known_law.h"
#include "control/sampled.h"
#include "nanotouch/control.h"
#include "nanotouch/material.h"
#include "scan/answer.h"
#include "scan/loop.h"
#include "session/state.h"

#define BELOW 1e-3 /* all corners */

/* An error is in the reference of the same period: T z/(z - 1). */
static double complex integral_and_stage(const void *context, double theta)
{
    const nt_sampled_loop *loop = context;
    const double complex less = nt_complex_from_one(theta);
    return loop->stage.period * (1.0 + less) / less * nt_sampled_stage(loop, theta);
}

static nt_zloop zloop_of(const nt_settings *settings)
{
    const nt_tap *tap = &settings->tap;
    nt_zloop zloop = nt_scan_defaults().zloop;
    zloop.mode = tap->hold ? NT_ZLOOP_PHASE : NT_ZLOOP_TAPPING;
    zloop.set_amplitude = tap->set_amplitude;
    zloop.set_phase = tap->set_phase;
    zloop.rate = settings->gains.rate;
    zloop.lock_in = tap->lock_in;
    return zloop;
}

nt_verdict nt_session_judge_tap(const nt_rig *rig, const nt_settings *settings, const nt_plan *plan)
{
    const nt_sim_lock_in lock_in = nt_session_lock_in(&settings->tap);
    const nt_zloop zloop = zloop_of(settings);
    nt_tapping lever;
    nt_tap_answer answer[NT_TAP_ANSWERS];
    if (nt_tapping_init(&lever, &rig->probe, &lock_in.drive, 1e-9, NULL) != NT_OK)
        return (nt_verdict)NT_VERDICT(INFINITY, "tap at the set point"); /* of a real lever alone: no model of it */
    nt_tap_answers(&lever, plan, &zloop, answer);
    const nt_tap_loop tap = nt_tap_loop_make(&lever, &zloop, answer);
    const nt_servo_equivalent equivalent = nt_servo_equivalent_of(rig, settings, INFINITY);
    const nt_sampled_loop sampled = nt_sampled_loop_of(&equivalent.rig, settings, &equivalent.gains);
    const double T = 1.0 / zloop.rate;
    const nt_open_loop loop = {.tap = &tap,
                               .stage = integral_and_stage,
                               .context = &sampled,
                               .first = BELOW * fmin(fmin(1.0, tap.share), 0.5 * lever.rate * T / lever.quality),
                               .angle = nt_sampled_angle(&sampled.stage),
                               .width = 0.5 * sampled.stage.damping / sampled.stage.mass * T};
    const nt_loop_limits limits = nt_open_loop_limits(&loop, 0.25 * NT_PI);
    return (nt_verdict)NT_VERDICT(limits.rings / settings->gains.height_gain, "tap at the set point");
}
