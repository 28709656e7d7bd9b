/* SPDX-License-Identifier: BSD-3-Clause
 * Private to control/: what the motor does where no law speaks, and its limits. */
#ifndef NANOTOUCH_CONTROL_MOTOR_H
#define NANOTOUCH_CONTROL_MOTOR_H

#include "nanotouch/settings.h"

/* A spring draws the master to the height that the stage stands at. */
double nt_motor_height(const nt_gains *gains, double height_position, double master_position);
/* Not in RUN: the force fades to zero with damping against the master's motion. */
double nt_motor_fade(const nt_master *master, double force, double speed);
/* Power, rate and amplitude, in this order: the last one always holds. Only what drives the hand is limited in power:
 * a brake takes energy away. */
double nt_motor_limit(const nt_limits *limits, double largest_step, double last, double force, double speed);

#endif
