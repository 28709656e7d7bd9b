/* SPDX-License-Identifier: BSD-3-Clause
 * Motor laws of the master (paper, Eq. 17). */
#include <math.h>

#include "control/servo.h"

/* Share of the master's own damping that the motor adds while it fades out; well below the sampled limit 2 b. */
#define FADE_DAMPING 0.5

double nt_servo_force(const nt_gains *gains, double gain_factor, double slave_force, double operator_force)
{
    const double reflected = gains->alpha_f * slave_force;
    return -reflected - gain_factor * gains->force_gain * (reflected - operator_force);
}

double nt_servo_height(const nt_gains *gains, double height_position, double master_position)
{
    return gains->height_stiffness * (height_position - master_position);
}

double nt_servo_fade(const nt_master *master, double force, double speed)
{
    return force - FADE_DAMPING * master->damping * speed;
}

double nt_servo_limit(const nt_limits *limits, double period, double last, double force)
{
    const double step = limits->motor_rate * period;
    const double slewed = fmin(fmax(force, last - step), last + step);
    return fmin(fmax(slewed, -limits->motor_force), limits->motor_force);
}
