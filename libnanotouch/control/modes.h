/* SPDX-License-Identifier: BSD-3-Clause
 * Private to control/: what moves the stage and the motor in each mode, and in none. */
#ifndef NANOTOUCH_CONTROL_MODES_H
#define NANOTOUCH_CONTROL_MODES_H

#include "nanotouch/touch.h"

/* RUN: moves the reference as the mode has it; returns the motor force wanted, not a number if the law gave none. */
double nt_mode_run(const nt_touch *touch, nt_touch_state *state);
/* The master is uncoupled and indexed anew; returns what is left of the force, with damping. */
double nt_mode_release(const nt_touch *touch, nt_touch_state *state);
/* Not RUN: lifts by up to `distance` [m] in all, and releases. */
double nt_mode_stop(const nt_touch *touch, nt_touch_state *state, double distance);

#endif
