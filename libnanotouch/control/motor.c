/* SPDX-License-Identifier: BSD-3-Clause
 * The motor of the master where no law speaks, and its limits. */
#include "control/motor.h"

#include <math.h>

#include "core/clamp.h"
#include "core/same_bits.h"

#define FADE_TIME 0.05 /* after an event the force is gone within this, a small one, too [s] */
#define FADED 1e-6     /* with no more than this left it is gone: rounding shall not decide in which tick */
/* Share of the master's own damping that the motor adds while it fades out; well below the sampled limit 2 b. */
#define FADE_DAMPING 0.5

double nt_motor_height(const nt_gains *gains, double height_position, double master_position)
{
    return gains->height_stiffness * (height_position - master_position);
}

double nt_motor_fade_time(double product, double rate, const double force[NT_AXES])
{
    const double sideways = greater(fabs(force[NT_X]), fabs(force[NT_Y]));
    const double size = hypotenuse(hypotenuse(force[NT_X], force[NT_Y]), force[NT_Z]);
    const double wanted = FADE_TIME * size > product ? product / size : FADE_TIME;
    return greater(wanted, greater(sideways, fabs(force[NT_Z])) / rate);
}

static void begin_fade(const nt_touch *touch, nt_touch_state *state)
{
    for (int i = 0; i < NT_AXES; ++i)
        state->fade.from[i] = state->command.motor_force[i];
    state->fade.step =
        touch->period / nt_motor_fade_time(touch->fade_product, touch->settings.limits.motor_rate, state->fade.from);
}

nt_sum nt_motor_fade(const nt_touch *touch, nt_touch_state *state)
{
    nt_fade *fade = &state->fade;
    if (fade->left == 1.0)
        begin_fade(touch, state);
    const nt_sum left = fade->left - fade->step;
    if (!(left > FADED))
        return fade->left = state->engaged = 0.0;
    state->engaged *= left / fade->left;
    return fade->left = left;
}

/* What the damping has taken away does not come back: it never rises. */
double nt_motor_faded(const nt_touch *touch, const nt_touch_state *state, int axis, double speed)
{
    const double left = state->fade.left * state->fade.from[axis], last = state->command.motor_force[axis];
    const double braked = left - FADE_DAMPING * touch->rig.master.damping * speed;
    return left > 0.0 ? clamp(braked, 0.0, lesser(left, greater(0.0, last)))
                      : clamp(braked, greater(left, lesser(0.0, last)), 0.0);
}

double nt_motor_limit(const nt_limits *limits, double largest_step, double last, double force, double speed)
{
    const double power = force * speed;
    const double allowed = power > limits->motor_power ? limits->motor_power / speed : force;
    const double slewed = clamp(allowed, last - largest_step, last + largest_step);
    return clamp(slewed, -limits->motor_force, limits->motor_force);
}
