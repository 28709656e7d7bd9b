/* SPDX-License-Identifier: BSD-3-Clause
 * Private to control/: what the motor does where no law speaks, and its limits. */
#ifndef NANOTOUCH_CONTROL_MOTOR_H
#define NANOTOUCH_CONTROL_MOTOR_H

#include "nanotouch/touch.h"

/* A spring draws the master to the height that the stage stands at. */
double nt_motor_height(const nt_gains *gains, double height_position, double master_position);
/* Within which a force on the hand is gone after an event [s]: 50 ms or product/|F|, the shorter, but no faster than
 * the motor's rate allows on each axis. */
double nt_motor_fade_time(double product, double rate, const double force[NT_AXES]);
/* Hand and tip are uncoupled in this period: the force that there was falls in a line to 0. What is left of it [-]. */
nt_sum nt_motor_fade(const nt_touch *touch, nt_touch_state *state);
/* What is left along an axis, while the hand moves at this speed; 0 where the speed is not known [N]. Damping takes
 * away from a force that drives the hand; it adds nothing, and turns nothing round. */
double nt_motor_faded(const nt_touch *touch, const nt_touch_state *state, int axis, double speed);
/* Power, rate and amplitude, in this order: the last one always holds. Only what drives the hand is limited in power:
 * a brake takes energy away. */
double nt_motor_limit(const nt_limits *limits, double largest_step, double last, double force, double speed);

#endif
