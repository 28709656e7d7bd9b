/* SPDX-License-Identifier: BSD-3-Clause
 * The three laws (paper, Eq. 16-17). */
#include <stddef.h>

#include "internal/control.h"
#include "nanotouch/control.h"

/* tau_m = -alpha_f f_s - K_f (alpha_f f_s - f_m). At rest f_m = alpha_f f_s for any K_f (erratum E16). */
static double reflect(const nt_gains *gains, const nt_signals *signals, double operator_force)
{
    const double reflected = signals->scaling.alpha_f * signals->felt_force;
    return -reflected - signals->gain_factor * gains->force_gain * (reflected - operator_force);
}

static double feed_forward(const nt_gains *gains, const nt_signals *signals)
{
    return gains->velocity_feedforward * signals->master_damping * signals->smooth_speed;
}

nt_effort nt_servo_default(void *unused, const nt_gains *gains, const nt_signals *signals)
{
    (void)unused;
    const double force = reflect(gains, signals, signals->smooth_force);
    return (nt_effort){force + feed_forward(gains, signals), signals->target};
}

nt_effort nt_servo_paper(void *unused, const nt_gains *gains, const nt_signals *signals)
{
    (void)unused;
    const double speed = signals->scaling.alpha_p * signals->master_speed - signals->stage_speed;
    const double error = signals->target - signals->stage_position;
    const double drive = gains->stage_derivative * speed + gains->stage_proportional * error;
    return (nt_effort){reflect(gains, signals, signals->operator_force), drive};
}

nt_effort nt_servo_impedance(void *unused, const nt_gains *gains, const nt_signals *signals)
{
    (void)unused;
    const double reflected = signals->gain_factor * signals->scaling.alpha_f * signals->felt_force;
    return (nt_effort){feed_forward(gains, signals) - reflected, signals->target};
}

nt_control_law nt_control_law_of(const nt_control *control)
{
    switch (control->choice) {
    case NT_CONTROL_DEFAULT:
        return nt_servo_default;
    case NT_CONTROL_PAPER:
        return nt_servo_paper;
    case NT_CONTROL_IMPEDANCE:
        return nt_servo_impedance;
    case NT_CONTROL_OWN:
        return control->law;
    }
    return NULL;
}
