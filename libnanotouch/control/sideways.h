/* SPDX-License-Identifier: BSD-3-Clause
 * Private to control/: x and y of a touch. */
#ifndef NANOTOUCH_CONTROL_SIDEWAYS_H
#define NANOTOUCH_CONTROL_SIDEWAYS_H

#include "nanotouch/touch.h"

/* How far the hand has gone sideways since the tip last followed, and how fast it goes. */
void nt_sideways_follow_hand(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample);
/* The lever's force sideways, and what a hand of one axis feels of it. After signals.slave_force. */
void nt_sideways_read(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample);
/* What goes in at the hand in x and y, and what comes out at the tip; counted while the loop is closed. */
void nt_sideways_watch(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample, int closed);
/* Where the tip goes: after the hand, or along its path. */
void nt_sideways_move(const nt_touch *touch, nt_touch_state *state);
/* Motor forces in x and y: alpha_f times the force on the tip, fading as the one that presses does. */
void nt_sideways_drive(const nt_touch *touch, nt_touch_state *state);

#endif
