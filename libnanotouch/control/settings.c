/* SPDX-License-Identifier: BSD-3-Clause
 * Gains and limits: defaults, one table of fields, checks. */
#include <math.h>
#include <stddef.h>

#include "nanotouch/control.h"

#define FIELD(path, unit, minimum, maximum, doc)                                                                       \
    {#path, unit, minimum, maximum, (unsigned)offsetof(nt_settings, path), doc}

static const nt_field settings_fields[] = {
    FIELD(gains.rate, "Hz", 10.0, 1e6, "rate of the force loop"),
    FIELD(gains.alpha_p, "", 1e-12, 1e3, "position scale alpha_p, stage over master"),
    FIELD(gains.alpha_f, "", 1e-3, 1e15, "force scale alpha_f, operator over tip"),
    FIELD(gains.force_gain, "", 0.0, 1e4, "force error gain K_f"),
    FIELD(gains.force_filter, "Hz", 1.0, 1e6, "low-pass of the operator force"),
    FIELD(gains.stage_damping, "", 0.1, 2.0, "damping ratio that the notch leaves to the stage"),
    FIELD(gains.stage_integral, "1/s", 0.0, 1e4, "integral gain of the stage loop"),
    FIELD(gains.ramp_time, "s", 0.0, 10.0, "the force fades in over this time"),
    FIELD(gains.set_point, "N", 1e-12, 1e-3, "force held in topography mode"),
    FIELD(gains.height_gain, "1/s", 0.0, 1e5, "integral gain of the height servo"),
    FIELD(gains.height_stiffness, "N/m", 0.0, 1e6, "how hard the master is drawn to the height"),
    FIELD(gains.delay, "periods", 0.0, 100.0, "conversion and computing delay"),
    FIELD(limits.force, "N", 1e-12, 1e-3, "largest force on the sample, either sign"),
    FIELD(limits.stage_speed, "m/s", 1e-9, 1.0, "largest speed of the stage"),
    FIELD(limits.lateral_speed, "m/s", 1e-9, 1.0, "largest lateral speed"),
    FIELD(limits.motor_force, "N", 1e-3, 1e3, "largest motor force"),
    FIELD(limits.motor_rate, "N/s", 1e-1, 1e9, "largest rate of the motor force"),
    FIELD(limits.retract_distance, "m", 1e-9, 1e-3, "RETRACT lifts by this"),
    FIELD(limits.retract_speed, "m/s", 1e-9, 1.0, "RETRACT lifts at this speed"),
    FIELD(limits.follow_error, "m", 1e-9, 1e-3, "the stage may be off its command by this"),
    FIELD(limits.follow_time, "s", 1e-4, 10.0, "the stage may be off for this long"),
};

nt_settings nt_settings_defaults(const nt_rig *rig)
{
    const nt_scaling scaling = nt_scaling_heuristic(rig, 0.4e-6, 0.6e-6); /* L = 0.1 um, delta_max = 0.3 um; Eq. 21 */
    const double saturation = rig->probe.spring_constant * nt_probe_deflection_range(&rig->probe);
    nt_settings settings = {
        .gains = {.rate = 10e3,
                  .alpha_p = scaling.alpha_p,
                  .alpha_f = scaling.alpha_f,
                  .force_gain = 2.0,
                  .force_filter = 200.0,
                  .stage_damping = 0.7,
                  .stage_integral = 60.0,
                  .ramp_time = 0.1,
                  .set_point = 0.1e-6,
                  .height_gain = 300.0,
                  .height_stiffness = 3000.0,
                  .delay = 1.0},
        .limits = {.force = 0.85 * saturation,
                   .stage_speed = 20e-6,
                   .lateral_speed = 20e-6,
                   .motor_force = rig->master.max_force,
                   .motor_rate = 2000.0,
                   .retract_distance = 0.5e-6,
                   .retract_speed = 10e-6,
                   .follow_error = 0.1e-6,
                   .follow_time = 0.05},
    };
    return settings;
}

const nt_field *nt_settings_fields(int *count)
{
    *count = (int)(sizeof settings_fields / sizeof settings_fields[0]);
    return settings_fields;
}

nt_status nt_settings_check(const nt_settings *settings, nt_problem *problem)
{
    int count = 0;
    const nt_field *fields = nt_settings_fields(&count);
    return nt_field_check(fields, count, settings, problem);
}
