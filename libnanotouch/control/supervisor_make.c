/* SPDX-License-Identifier: BSD-3-Clause
 * The supervisor's thresholds, from a rig and its settings; its reasons by name. */
#include <math.h>

#include "control/sampled.h"
#include "core/clamp.h"
#include "core/rig.h"
#include "core/same_bits.h"
#include "internal/control.h"
#include "nanotouch/control.h"
#include "nanotouch/material.h"

#define STUCK_STEPS 5.0         /* of the stage's read-out */
#define LEAST_STAGE_STEP 0.1e-9 /* of a read-out without steps [m] */
#define FREE_SIGMA 6.0          /* of the force noise: below it is free air */
#define FREE_STEPS 1.001        /* of the converter: at one step rounding would decide what is free air */
#define FOLLOW_STEPS 20.0       /* of read-out or converter, which it may be off besides */
#define LEAST_SLACK 20e-9       /* [m] */
#define CREEP_DECADES 4.0       /* of time, 0.1 s to 1000 s, that creep goes on for */

const char *nt_reason_name(uint32_t reason)
{
    static const char *const names[] = {"invalid sample",
                                        "deflection saturated",
                                        "force limit",
                                        "stale sample",
                                        "sensor stuck",
                                        "stage does not follow",
                                        "loop unstable",
                                        "emergency stop",
                                        "limit switch",
                                        "operator force clipped",
                                        "command limited",
                                        "ticks late",
                                        "device lost",
                                        "indentation limit",
                                        "control law gave no number",
                                        "gain backed off",
                                        "stale master",
                                        "lateral force limit",
                                        "amplitude lost"};
    for (uint32_t bit = 0; bit < sizeof names / sizeof *names; ++bit)
        if (reason == 1u << bit)
            return names[bit];
    return "";
}

/* An amplitude so small over A0 is no tapping, and one so large is of another drive. */
#define LOST_SHARE 0.1
#define MOST_SHARE 1.5
#define SETTLING 3.0 /* time constants of lever and lock-in amplifier in which an amplitude comes back */
#define WINDOW 10.0  /* of them, over which power and loss are averaged */

/* Time constant of the stage behind its reference: what the notch leaves of the resonance, and dead time [s]. */
static double stage_lag(const nt_rig *rig, const nt_gains *gains)
{
    return 2.0 * gains->stage_damping / (2.0 * NT_PI * rig->stage.resonance) + nt_sampled_dead_time(rig, gains);
}

/* Hysteresis, half its opening, and creep that the rig declares, over all of the travel [m]. */
static double declared(const nt_stage *stage)
{
    return 0.5 * stage->travel * (stage->hysteresis + CREEP_DECADES * stage->creep);
}

/* How far off a stage at rest may be: steps, and what full speed makes of its lag and a period [m]. */
static double slack_of(const nt_rig *rig, const nt_settings *settings, const nt_gains *gains)
{
    const double step = greater(rig->stage.resolution, rig->stage.command_resolution);
    const double way = settings->limits.stage_speed * (stage_lag(rig, gains) + 1.0 / gains->rate);
    return greater(greater(LEAST_SLACK, way), FOLLOW_STEPS * step);
}

nt_supervisor nt_supervisor_make(const nt_rig *rig, const nt_settings *settings)
{
    const nt_servo_equivalent equivalent = nt_servo_equivalent_of(rig, settings, INFINITY);
    const nt_probe *probe = &equivalent.rig.probe;
    const nt_stage *stage = &equivalent.rig.stage;
    const double period = 1.0 / settings->gains.rate;
    const double sigma = probe->sensitivity * probe->noise / 6.0; /* of the deflection [m] */
    const double step = probe->sensitivity * probe->resolution;
    const int shows_noise = sigma > step; /* identical codes are normal where the noise is below one step */
    const double travelled = STUCK_STEPS * greater(stage->resolution, LEAST_STAGE_STEP);
    const double slack = slack_of(&equivalent.rig, settings, &equivalent.gains);
    const double all = settings->limits.follow_error + declared(&rig->stage);
    const int follows = equivalent.gains.stage_integral > 0.0; /* without, hysteresis and creep are left */
    const double most = follows ? settings->limits.follow_error : all;
    return (nt_supervisor){.period = period,
                           .master_period = rig->master.rate > 0.0 ? greater(period, 1.0 / rig->master.rate) : period,
                           .spring_constant = probe->spring_constant,
                           .lateral_stiffness = probe->lateral_stiffness,
                           .deflection_range = nt_probe_deflection_range(probe),
                           .free_force = probe->spring_constant * (FREE_SIGMA * sigma + FREE_STEPS * step),
                           .master_range = rig->master.travel,
                           .leads_sideways = rig->master.axes > 1.0 && rig->stage.axes > 1.0,
                           .gauge_range = rig->master.gauge ? rig->master.gauge_range : 0.0,
                           .stage_range = rig->stage.travel,
                           .stuck_distance = shows_noise ? travelled : 0.0,
                           .stage_share = period / (period + stage_lag(rig, &equivalent.gains)),
                           .noise = sigma,
                           .stage_slack = follows ? slack : most,
                           .stage_most = most,
                           .correction_most = follows ? all : 0.0,
                           .turn_slack = slack,
                           .lift_share = 2.0 * rig->stage.hysteresis + CREEP_DECADES * rig->stage.creep,
                           .path_kept = exp(-period / settings->limits.follow_time),
                           .limits = settings->limits};
}

nt_amplitude_limits nt_supervisor_amplitude(const nt_rig *rig, const nt_settings *settings)
{
    const nt_tap *tap = &settings->tap;
    const double travelled = STUCK_STEPS * greater(rig->stage.resolution, LEAST_STAGE_STEP);
    const double Q = rig->probe.quality, f0 = rig->probe.resonance;
    const double r = tap->frequency > 0.0 ? tap->frequency / f0 : 1.0;
    const double window = WINDOW * nt_tap_lag(rig, tap), swing = hypotenuse(1.0 - r * r, r / Q);
    const double strength = tap->free_amplitude * swing / (tap->at ? r * hypotenuse(r, 1.0 / Q) : 1.0);
    return (nt_amplitude_limits){
        .lost = LOST_SHARE * tap->free_amplitude,
        .most = MOST_SHARE * tap->free_amplitude,
        .settling = 1u + (uint32_t)ceil(SETTLING * nt_tap_lag(rig, tap) * settings->gains.rate),
        .stuck = {tap->noise > tap->resolution ? travelled : 0.0, tap->noise},
        .shake = tap->at ? strength : 0.0,
        .reach = strength * Q / r,
        .memory = Q / (2.0 * NT_PI * f0) / window,
        .kept = exp(-1.0 / (window * settings->gains.rate)),
        .share = 1.0 / ((1.0 + tap->tolerance) * (1.0 + tap->tolerance)),
    };
}
