/* SPDX-License-Identifier: BSD-3-Clause
 * Gains and limits: defaults, one table of fields, checks. */
#include <math.h>
#include <stddef.h>

#include "core/rig.h"
#include "internal/control.h"
#include "internal/field.h"
#include "internal/rig.h"
#include "nanotouch/control.h"
#include "nanotouch/material.h"
#include "nanotouch/settings.h"

#define FIELD(path, ...) NT_FIELD(nt_settings, path, __VA_ARGS__)

#define STAGE_SPEED 20e-6   /* [m/s] */
#define STAGE_INTEGRAL 60.0 /* [1/s] */
#define RINGING_STEPS 10.0  /* a hand keeps to such a speed for so many of them */

static const nt_field settings_fields[] = {
    FIELD(gains.rate, "Hz", 10.0, 1e6, "rate of the force loop"),
    FIELD(gains.alpha_p, "m/m", 1e-12, 1e3, "position scale alpha_p, stage over master"),
    FIELD(gains.alpha_f, "N/N", 1e-3, 1e15, "force scale alpha_f, operator over tip"),
    FIELD(gains.alpha_f_approach, "", 1e-3, 1e3, "factor on alpha_f before contact"),
    FIELD(gains.alpha_f_retract, "", 1e-3, 1e3, "factor on alpha_f where adhesion holds the tip"),
    FIELD(gains.force_gain, "", 0.0, 1e4, "force error gain K_f"),
    FIELD(gains.force_filter, "Hz", 1.0, 1e6, "low-pass of the operator force"),
    FIELD(gains.velocity_feedforward, "", 0.0, 0.8, "share of the master's damping that the motor takes over"),
    FIELD(gains.stage_damping, "", 0.1, 2.0, "damping ratio that the notch leaves to the stage"),
    FIELD(gains.stage_integral, "1/s", 0.0, 1e4, "integral gain of the stage loop"),
    FIELD(gains.stage_proportional, "", 0.0, 1e4, "K_p of the paper's law"),
    FIELD(gains.stage_derivative, "s", 0.0, 1e3, "K_v of the paper's law"),
    FIELD(gains.coupling_stiffness, "N/m", 0.0, 1e9, "spring between master and virtual tool, 0 for none"),
    FIELD(gains.coupling_damping, "N s/m", 0.0, 1e6, "damping of the virtual tool"),
    FIELD(gains.projection_x, "", -10.0, 10.0, "share of the lateral force in x that a master of one axis feels"),
    FIELD(gains.projection_y, "", -10.0, 10.0, "the same of the lateral force in y"),
    FIELD(gains.ramp_time, "s", 0.0, 10.0, "the force fades in over this time"),
    FIELD(gains.set_point, "N", 1e-12, 1e-3, "force held in topography, sought in approach and curve"),
    FIELD(gains.height_gain, "1/s", 0.0, 1e5, "integral gain of the height servo"),
    FIELD(gains.height_stiffness, "N/m", 0.0, 1e6, "how hard the master is drawn to the height"),
    FIELD(gains.approach_speed, "m/s", 1e-9, 1.0, "speed of the stage in approach and curve"),
    FIELD(gains.curve_length, "m", 1e-9, 1e-3, "a curve draws back by this"),
    FIELD(gains.delay, "periods", 0.0, 1000.0, "conversion, computing and link delay"),
    FIELD(limits.force, "N", 1e-12, 1e-3, "largest force on the sample, either sign"),
    FIELD(limits.lateral_force, "N", 1e-12, 1e-3, "largest lateral force on the sample, where the lever shows it"),
    FIELD(limits.indentation, "m", 1e-10, 1e-3, "largest indentation past first touch"),
    FIELD(limits.stage_speed, "m/s", 1e-9, 1.0, "largest speed of the stage"),
    FIELD(limits.lateral_speed, "m/s", 1e-9, 1.0, "largest lateral speed"),
    FIELD(limits.motor_force, "N", 1e-3, 1e3, "largest motor force"),
    FIELD(limits.motor_rate, "N/s", 1e-1, 1e9, "largest rate of the motor force"),
    FIELD(limits.motor_power, "W", 1e-6, 1e6, "largest power of the motor into the hand"),
    FIELD(limits.retract_distance, "m", 1e-9, 1e-3, "RETRACT lifts by this"),
    FIELD(limits.retract_speed, "m/s", 1e-9, 1.0, "RETRACT lifts at this speed"),
    FIELD(limits.follow_error, "m", 1e-9, 1e-3, "the stage may be off its command by this"),
    FIELD(limits.follow_time, "s", 1e-4, 10.0, "the stage may be off for this long"),
    FIELD(limits.deflection_bias, "m", 0.0, 1e-3, "largest bias of the deflection that is tared away"),
    FIELD(limits.deflection_drift, "m/s", 0.0, 1.0, "largest drift of the deflection at the tare"),
    FIELD(limits.gauge_bias, "N", 0.0, 1e3, "largest bias of the hand's gauge that is tared away"),
    FIELD(limits.gauge_drift, "N/s", 0.0, 1e6, "largest drift of the hand's gauge at the tare"),
    FIELD(tap.at, "tip|base", 0.0, 1.0, "where a simulated lever is driven"),
    FIELD(tap.frequency, "Hz", 0.0, 1e9, "frequency of the drive, 0 for the free resonance"),
    FIELD(tap.free_amplitude, "m", 1e-11, 1e-6, "amplitude A0 of the deflection far from the sample"),
    FIELD(tap.tolerance, "", 0.001, 0.5, "share of A0 by which the free amplitude may be off at opening"),
    FIELD(tap.hold, "amplitude|phase", 0.0, 1.0, "what the height servo holds"),
    FIELD(tap.set_amplitude, "", 0.2, 0.98, "amplitude that is held, over A0"),
    FIELD(tap.set_phase, "rad", 0.1, 1.5, "lag that is held, of a tip that is repelled: below pi/2"),
    FIELD(tap.lock_in, "s", 0.0, 1.0, "time constant of the lock-in amplifier"),
    FIELD(tap.noise, "m", 0.0, 1e-6, "standard deviation of a reading of the amplitude"),
    FIELD(tap.resolution, "m", 0.0, 1e-6, "step of a reading of the amplitude"),
};

static const nt_tap tap_defaults = {.at = 1, /* base */
                                    .free_amplitude = 20e-9,
                                    .tolerance = 0.1,
                                    .set_amplitude = 0.7,
                                    .set_phase = 0.25 * NT_PI,
                                    .lock_in = 20e-6,
                                    .noise = 20e-12};

nt_settings nt_settings_defaults(const nt_rig *rig)
{
    const nt_scaling scaling = nt_scaling_heuristic(rig, 0.4e-6, 0.6e-6); /* L = 0.1 um, delta_max = 0.3 um; Eq. 21 */
    const double saturation = rig->probe.spring_constant * nt_probe_deflection_range(&rig->probe);
    const nt_rig real = nt_rig_with_steps(rig);
    /* steps that come once in a period of the resonance, past the notch, add up to Q/pi of one; not for long */
    const double ringing = fmin(real.stage.quality / NT_PI, RINGING_STEPS) * real.stage.command_resolution;
    const double steps = ringing + 2.0 * fmax(real.stage.resolution, real.stage.command_resolution);
    /* after a turn the ceramic goes by 1 - 2 h of its command, and the integral, through it, takes the rest away */
    const double lost = 2.0 * rig->stage.hysteresis;
    const double hysteresis = lost / (1.0 - lost) * STAGE_SPEED / STAGE_INTEGRAL;
    nt_settings settings = {
        .gains = {.rate = 10e3,
                  .alpha_p = scaling.alpha_p,
                  .alpha_f = scaling.alpha_f,
                  .alpha_f_approach = 1.0,
                  .alpha_f_retract = 1.0,
                  .force_gain = 2.0,
                  .force_filter = 200.0,
                  .stage_damping = 0.7,
                  .stage_integral = STAGE_INTEGRAL,
                  .stage_proportional = 0.5,
                  .ramp_time = 0.1,
                  .set_point = fmin(0.1e-6, 0.1 * saturation),
                  .height_gain = 300.0,
                  .height_stiffness = 3000.0,
                  .approach_speed = 1e-6,
                  .curve_length = 0.5e-6,
                  .delay = 1.0},
        .limits = {.force = 0.85 * saturation,
                   .lateral_force = 0.85 * saturation,
                   .indentation = 0.3e-6,
                   .stage_speed = STAGE_SPEED,
                   .lateral_speed = 20e-6,
                   .motor_force = rig->master.max_force,
                   .motor_rate = 2000.0,
                   .motor_power = 2.0,
                   .retract_distance = 0.5e-6,
                   .retract_speed = 10e-6,
                   .follow_error = fmax(0.1e-6, steps) + hysteresis,
                   .follow_time = 0.05,
                   .deflection_bias = 0.1 * nt_probe_deflection_range(&rig->probe),
                   .deflection_drift = 0.3 * nt_probe_deflection_range(&rig->probe),
                   .gauge_bias = 0.1 * rig->master.gauge_range,
                   .gauge_drift = 0.3 * rig->master.gauge_range},
        .tap = tap_defaults,
        .control = {.choice = rig->master.gauge ? NT_CONTROL_DEFAULT : NT_CONTROL_IMPEDANCE},
    };
    return settings;
}

double nt_tap_lag(const nt_rig *rig, const nt_tap *tap)
{
    return tap->lock_in + rig->probe.quality / (NT_PI * rig->probe.resonance);
}

void nt_settings_keep_to(nt_settings *settings, double load)
{
    settings->limits.force = fmin(settings->limits.force, load);
    settings->gains.set_point = fmin(settings->gains.set_point, 0.5 * load);
}

const nt_field *nt_settings_fields(int *count)
{
    if (count)
        *count = (int)(sizeof settings_fields / sizeof settings_fields[0]);
    return settings_fields;
}

nt_status nt_settings_check(const nt_settings *settings, nt_problem *problem)
{
    int count = 0;
    const nt_field *fields = nt_settings_fields(&count);
    const nt_status status = nt_field_check(fields, count, settings, problem);
    const nt_control *control = &settings->control;
    const int known = control->choice <= NT_CONTROL_OWN && (control->choice != NT_CONTROL_OWN || control->law);
    return status == NT_OK && !known ? NT_E_ARGUMENT : status;
}
