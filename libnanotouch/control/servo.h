/* SPDX-License-Identifier: BSD-3-Clause
 * Private to control/: the motor laws. */
#ifndef NANOTOUCH_CONTROL_SERVO_H
#define NANOTOUCH_CONTROL_SERVO_H

#include "nanotouch/control.h"

/* Eq. 17: tau_m = -alpha_f f_s - K_f (alpha_f f_s - f_m). At rest f_m = alpha_f f_s for any K_f (erratum E16). */
double nt_servo_force(const nt_gains *gains, double gain_factor, double slave_force, double operator_force);
/* Topography: a spring draws the master to the scaled height. */
double nt_servo_height(const nt_gains *gains, double height_position, double master_position);
/* Not in RUN: the force fades to zero with damping against the master's motion. */
double nt_servo_fade(const nt_master *master, double force, double speed);
/* Amplitude and rate limits of the motor. */
double nt_servo_limit(const nt_limits *limits, double period, double last, double force);

#endif
