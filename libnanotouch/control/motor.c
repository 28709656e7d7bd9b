/* SPDX-License-Identifier: BSD-3-Clause
 * The motor of the master where no law speaks, and its limits. */
#include "control/motor.h"

#include "core/clamp.h"

/* Share of the master's own damping that the motor adds while it fades out; well below the sampled limit 2 b. */
#define FADE_DAMPING 0.5

double nt_motor_height(const nt_gains *gains, double height_position, double master_position)
{
    return gains->height_stiffness * (height_position - master_position);
}

double nt_motor_fade(const nt_master *master, double force, double speed)
{
    return force - FADE_DAMPING * master->damping * speed;
}

double nt_motor_limit(const nt_limits *limits, double largest_step, double last, double force, double speed)
{
    const double power = force * speed;
    const double allowed = power > limits->motor_power ? limits->motor_power / speed : force;
    const double slewed = clamp(allowed, last - largest_step, last + largest_step);
    return clamp(slewed, -limits->motor_force, limits->motor_force);
}
