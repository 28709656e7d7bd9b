/* SPDX-License-Identifier: BSD-3-Clause
 * Private to control/: how a stop lifts the tip, and whether that helps. */
#ifndef NANOTOUCH_CONTROL_LIFT_H
#define NANOTOUCH_CONTROL_LIFT_H

#include "nanotouch/touch.h"

/* Growth of the force that is none: deflections may show it during a lift, beside their noise [N]. */
double nt_lift_tolerance(const nt_supervisor *supervisor);
/* Of a force that could be read [N], and where the stage is read to be [m]: 0 when it should have turned, is not seen
 * to rise, and the force has grown since. */
int nt_lift_helps(const nt_supervisor *supervisor, nt_supervisor_state *state, double force, double position);
/* Of where the stage is read to be [m]: 0 when it has gone the wrong way. */
int nt_lift_rises(const nt_supervisor *supervisor, nt_supervisor_state *state, double position);
/* How far the stop lifts in all [m]; begins anew, from retracted = 0, where the tip is not free yet or no more. */
double nt_lift_distance(const nt_touch *touch, nt_touch_state *state);

#endif
