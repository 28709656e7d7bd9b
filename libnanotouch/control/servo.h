/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_CONTROL_SERVO_PRIVATE_H
#define NANOTOUCH_CONTROL_SERVO_PRIVATE_H

#include "nanotouch/control.h"

/* Largest amplitude at which the stage rings, whose command goes to and fro at a limit of speed [m/s] to [m]. */
double nt_servo_ringing(const nt_servo_equivalent *equivalent, double speed);

#endif
