/* SPDX-License-Identifier: BSD-3-Clause
 * What a touch needs in each period, worked out once: checks, filters, thresholds. */
#include "internal/control.h"
#include "internal/rig.h"
#include "nanotouch/touch.h"

#include <math.h>
#include <stddef.h>

#include "control/sampled.h"
#include "core/clamp.h"
#include "core/problem.h"
#include "core/rig.h"
#include "core/same_bits.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/material.h"

#define SPEED_BANDWIDTH 20.0 /* of the estimate of the master's speed [Hz]: its position comes in steps */
#define SPIKE_SIGMA 12.0     /* a reading may jump by this much noise and four times what stage and path can go */
#define SPIKE_MOTION 4.0

static double low_pass_factor(double bandwidth, double period)
{
    return -expm1(-2.0 * NT_PI * bandwidth * period);
}

/* The rate above which some samples are older than two periods [Hz]: one is repeated in as many ticks as begin before
 * the next, three without latency; with it two, if that is a period at most, or none. */
static double stale_rate(const nt_converters *converters)
{
    const double latency = converters->adc_latency, each = converters->adc_rate;
    if (each == 0.0)
        return 2.0 / latency;
    return latency == 0.0 ? 3.0 * each : greater(lesser(2.0 * each, 1.0 / latency), lesser(each, 2.0 / latency));
}

/* No limit may promise more than the rig can keep: beyond saturation no force would be seen. */
static nt_status check_against_rig(const nt_settings *settings, const nt_rig *rig, nt_problem *problem)
{
    const nt_limits *limits = &settings->limits;
    const double saturation = rig->probe.spring_constant * nt_probe_deflection_range(&rig->probe);
    const int needs_gauge = settings->control.choice != NT_CONTROL_IMPEDANCE && settings->gains.force_gain > 0.0;
    const int projects = rig->master.axes == 1.0 && rig->probe.lateral_stiffness > 0.0;
    const double share = fabs(settings->gains.projection_x) + fabs(settings->gains.projection_y);
    const nt_problem promises[] = {
        nt_problem_of("gains.rate", "Hz", settings->gains.rate, 0.0, stale_rate(&rig->converters)),
        nt_problem_of("limits.force", "N", limits->force, 0.0, saturation),
        nt_problem_of("gains.set_point", "N", settings->gains.set_point, 0.0, limits->force),
        nt_problem_of("limits.stage_speed", "m/s", limits->stage_speed, 0.0, rig->stage.max_speed),
        nt_problem_of("limits.retract_speed", "m/s", limits->retract_speed, 0.0, rig->stage.max_speed),
        nt_problem_of("limits.motor_force", "N", limits->motor_force, 0.0, rig->master.max_force),
        nt_problem_of("gains.projection_x, _y (of a master of one axis, over a lever of known lateral_stiffness)", "",
                      projects ? 0.0 : share, 0.0, 0.0),
        nt_problem_of("gains.force_gain", "", needs_gauge && !rig->master.gauge ? settings->gains.force_gain : 0.0, 0.0,
                      0.0),
    };
    for (size_t i = 0; i < sizeof promises / sizeof promises[0]; ++i) {
        if (promises[i].value <= promises[i].maximum)
            continue;
        return nt_problem_refuse(problem, promises[i]);
    }
    return NT_OK;
}

/* A held phase counts from the 90 degrees of the free resonance, and is told within a tenth of its width. */
static nt_status check_phase(const nt_settings *settings, const nt_rig *rig, nt_mode mode, nt_problem *problem)
{
    const nt_tap *tap = &settings->tap;
    const double f0 = rig->probe.resonance, width = 0.05 * f0 / rig->probe.quality;
    if (mode != NT_MODE_TAPPING || tap->hold == 0 || tap->frequency == 0.0 || fabs(tap->frequency - f0) <= width)
        return NT_OK;
    return nt_problem_set(problem, "tap.frequency (tap.hold = phase)", "Hz", tap->frequency, f0 - width, f0 + width);
}

/* More than probe, stage and path can do in a period, and more than noise [m]. */
static double spike_of(const nt_rig *rig, const nt_settings *settings)
{
    const double motion = settings->limits.stage_speed + settings->limits.lateral_speed;
    const double noise = rig->probe.sensitivity * hypotenuse(rig->probe.noise / 6.0, rig->probe.resolution);
    return SPIKE_SIGMA * noise + SPIKE_MOTION * motion / settings->gains.rate;
}

/* No force of the hand is known in x and y, K_f has no part there, and no more acts than the lateral limit. */
static nt_passivity sideways_passivity(const nt_rig *rig, const nt_settings *settings)
{
    nt_rig plain = *rig;
    nt_gains gains = settings->gains;
    const double most = gains.alpha_f * settings->limits.lateral_force;
    gains.force_gain = 0.0;
    plain.master.gauge = 0;
    plain.master.gauge_range = lesser(plain.master.gauge_range, most);
    return nt_passivity_make(&plain, &gains);
}

nt_status nt_touch_make(nt_touch *touch, const nt_rig *rig, const nt_settings *settings, nt_mode mode,
                        nt_problem *problem)
{
    nt_status status = nt_rig_check(rig, problem);
    if (status == NT_OK)
        status = nt_settings_check(settings, problem);
    if (status == NT_OK)
        status = check_against_rig(settings, rig, problem);
    if (status == NT_OK)
        status = check_phase(settings, rig, mode, problem);
    if (status != NT_OK)
        return status;
    if (mode > NT_MODE_TAPPING)
        return NT_E_ARGUMENT;
    const double period = 1.0 / settings->gains.rate;
    const nt_servo_equivalent equivalent = nt_servo_equivalent_of(rig, settings, INFINITY);
    nt_touch made = {.rig = nt_rig_with_steps(rig),
                     .settings = *settings,
                     .mode = mode,
                     .period = period,
                     .law = nt_control_law_of(&settings->control),
                     .stage_loop = nt_stage_loop_make(&rig->stage, &equivalent.gains),
                     .leads_sideways = rig->master.axes > 1.0 && rig->stage.axes > 1.0,
                     .feels_sideways = nt_sideways_is_felt(rig),
                     .borders = {{-HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, HUGE_VAL}},
                     .delay = (uint32_t)lesser(round(settings->gains.delay), NT_TOUCH_SENT - 1.0),
                     .force_filter = low_pass_factor(settings->gains.force_filter, period),
                     .speed_filter = low_pass_factor(SPEED_BANDWIDTH, period),
                     .stage_step = settings->limits.stage_speed * period,
                     .stage_end = 0.5 * rig->stage.travel,
                     .motor_step = settings->limits.motor_rate * period,
                     .fade_product = nt_motor_bound_compute(rig, settings).fade_product,
                     .spike = spike_of(&equivalent.rig, settings),
                     .passivity = nt_passivity_make(&equivalent.rig, &equivalent.gains),
                     .rescale = nt_rescale_make(rig, settings),
                     .supervisor = nt_supervisor_make(rig, settings)};
    if (mode == NT_MODE_TAPPING) {
        const nt_tap *tap = &settings->tap;
        made.drive_amplitude = tap->free_amplitude;
        made.drive_frequency = tap->frequency > 0.0 ? tap->frequency : rig->probe.resonance;
        made.supervisor.amplitude = nt_supervisor_amplitude(rig, settings);
    }
    made.passivity_sideways = sideways_passivity(rig, settings);
    made.passivity.damping = rig->master.damping; /* what the motor feeds forward is in its force already */
    made.passivity.credit = rig->master.gauge ? 0.0 : rig->master.damping;
    *touch = made;
    return NT_OK;
}
