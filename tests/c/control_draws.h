/* SPDX-License-Identifier: BSD-3-Clause
 * Random rigs and settings without a field at a value that hides a term: no 0, no 1, and nothing that cancels. */
#ifndef TESTS_CONTROL_DRAWS_H
#define TESTS_CONTROL_DRAWS_H

#include <math.h>

#include "nanotouch/advanced/random.h"
#include "nanotouch/settings.h"

static inline double between(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

static inline nt_rig drawn_rig(nt_random *random)
{
    nt_rig rig = nt_rig_defaults();
    rig.probe.spring_constant = between(random, 1.0, 40.0);
    rig.probe.sensitivity = between(random, 1e-8, 1e-7);
    rig.probe.noise = between(random, 3e-3, 0.1);
    rig.probe.resolution = between(random, 1e-5, 3e-4);
    rig.probe.spring_constant_sigma = between(random, 0.01, 0.1);
    rig.probe.sensitivity_sigma = between(random, 0.01, 0.1);
    rig.probe.drift = between(random, 1e-11, 1e-9);
    rig.probe.lateral_stiffness = between(random, 20.0, 200.0);
    rig.stage.resonance = between(random, 200.0, 2000.0);
    rig.stage.quality = between(random, 0.7, 40.0);
    rig.stage.travel = between(random, 1e-5, 1e-4);
    rig.stage.resolution = between(random, 1e-10, 3e-9);
    rig.stage.command_resolution = between(random, 1e-10, 3e-9);
    rig.stage.max_speed = between(random, 1e-4, 1e-2);
    rig.stage.hysteresis = between(random, 0.01, 0.15);
    rig.stage.creep = between(random, 0.001, 0.02);
    rig.stage.drift = between(random, 1e-10, 1e-8);
    rig.stage.slip = between(random, 1e-9, 1e-7);
    rig.stage.travel_sigma = between(random, 0.01, 0.05);
    rig.stage.position_sigma = between(random, 0.01, 0.05);
    rig.stage.axes = 3.0;
    rig.master.mass = between(random, 0.03, 0.5);
    rig.master.damping = between(random, 20.0, 200.0);
    rig.master.travel = between(random, 0.01, 0.1);
    rig.master.resolution = between(random, 1e-6, 1e-4);
    rig.master.max_force = between(random, 2.0, 10.0);
    rig.master.max_speed = between(random, 0.5, 3.0);
    rig.master.gauge_range = between(random, 2.0, 10.0);
    rig.master.rate = between(random, 1e3, 3e3);
    rig.converters.adc_latency = between(random, 1e-5, 1e-4);
    rig.converters.dac_latency = between(random, 1e-5, 1e-4);
    return rig;
}

static inline nt_settings drawn_settings(nt_random *random, const nt_rig *rig)
{
    nt_settings settings = nt_settings_defaults(rig);
    nt_gains *gains = &settings.gains;
    gains->rate = between(random, 5e3, 2e4);
    gains->alpha_p = between(random, 1e-5, 3e-4);
    gains->alpha_f = between(random, 1e5, 1e7);
    gains->alpha_f_retract = between(random, 1.1, 3.0);
    gains->force_gain = between(random, 0.3, 3.0);
    gains->force_filter = between(random, 30.0, 300.0);
    gains->stage_damping = between(random, 0.3, 1.3);
    gains->stage_integral = between(random, 10.0, 100.0);
    gains->delay = floor(between(random, 1.0, 4.0));
    nt_limits *limits = &settings.limits;
    limits->force = between(random, 1e-6, 1e-5);
    limits->lateral_force = between(random, 1e-7, 1e-6);
    limits->indentation = between(random, 1e-8, 1e-6);
    limits->stage_speed = between(random, 3e-6, 5e-5);
    limits->lateral_speed = between(random, 1e-6, 1e-5);
    limits->follow_error = between(random, 3e-8, 3e-7);
    limits->follow_time = between(random, 5e-3, 5e-2);
    return settings;
}

/* 1 where both are infinite, or apart by no more than this share. */
static inline int alike(double found, double expected, double tolerance)
{
    if (isinf(expected))
        return found == expected;
    return expected == 0.0 ? found == 0.0 : fabs(found / expected - 1.0) <= tolerance;
}

#endif
