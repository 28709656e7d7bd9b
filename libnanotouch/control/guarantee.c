/* SPDX-License-Identifier: BSD-3-Clause
 * How far force and indentation can go past their limits (docs/safety.md). The sample that first shows too much is at
 * most one period old; the command that answers it is held, delayed, and followed by the stage: all that is the loop's
 * delay D of rule R1. Until then the tip goes on as fast as stage and surface may move, against at most the lever and
 * the stiffest contact in series. */
#include <math.h>

#include "nanotouch/guarantee.h"
#include "nanotouch/margins.h"
#include "nanotouch/material.h"
#include "nanotouch/servo.h"

#define SIGMAS 6.0

/* Largest amplitude at which the stage rings if its command goes to and fro at its limit of speed [m]: the square
 * wave's fundamental times the gain of the resonance that the notch leaves, or, where that is more, all that a speed
 * can make of the step response, v int |1 - s| dt = 2 v/(w_n (1 - exp(-pi zeta/sqrt(1 - zeta^2)))), less the lag 2 zeta
 * v/w_n that the reaction time holds already. */
static double ringing_amplitude(const nt_stage *stage, double zeta, double speed)
{
    const double split = zeta < 1.0 ? sqrt(1.0 - zeta * zeta) : 0.0;
    const double gain = 2.0 * zeta * zeta < 1.0 ? 0.5 / (zeta * split) : 1.0;
    const double all = split > 0.0 ? -2.0 / expm1(-NT_PI * zeta / split) - 2.0 * zeta : 0.0;
    return fmax(4.0 / NT_PI * gain, all) * speed / (2.0 * NT_PI * stage->resonance);
}

nt_guarantee nt_guarantee_compute(const nt_rig *rig, const nt_settings *settings, const nt_hazard *hazard)
{
    const nt_limits *limits = &settings->limits;
    const nt_servo_shape shape = nt_servo_shape_of(rig, settings, hazard->stiffness);
    const nt_probe *probe = &shape.rig.probe;
    const double k_eff = probe->spring_constant / (1.0 + probe->spring_constant / hazard->stiffness);
    const double integral = shape.gains.stage_integral * limits->follow_error; /* what the stage loop may add [m/s] */
    const double vertical = limits->stage_speed + integral;
    const double ringing = ringing_amplitude(&rig->stage, shape.gains.stage_damping, vertical);
    const double step = probe->sensitivity * probe->resolution;
    const double sigma = nt_probe_force_noise(probe) / probe->spring_constant;
    nt_rig slave = shape.rig;
    slave.master.rate = 0.0; /* a slow master takes no part in a stop */
    nt_guarantee found = {.reaction_time = nt_margins_compute(&slave, &shape.gains, hazard->stiffness).loop_delay};
    found.moves_sideways = rig->stage.axes > 1.0;
    const double lateral = found.moves_sideways ? hazard->slope * limits->lateral_speed : 0.0;
    const double closer = (vertical + lateral) * found.reaction_time;
    found.motion = k_eff * closer;
    found.ringing = k_eff * ringing;
    found.snap_in = hazard->snap_in_force;
    found.noise = probe->spring_constant * (SIGMAS * sigma + step);
    found.force = limits->force + found.motion + found.ringing + found.snap_in + found.noise;
    const double lift =
        limits->retract_distance + ringing_amplitude(&rig->stage, shape.gains.stage_damping, limits->retract_speed);
    found.with_faults = found.force + k_eff * lift;
    /* first touch is noticed where the force leaves the noise, and read with it; a tip that snaps in goes over what
     * that stretches the lever by */
    const double read = (2.0 * found.noise + hazard->snap_in_force) / probe->spring_constant;
    found.indentation = limits->indentation + closer + ringing + read + hazard->unseen;
    return found;
}
