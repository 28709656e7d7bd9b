/* SPDX-License-Identifier: BSD-3-Clause
 * Private to control/: what a sample says, channel by channel. */
#ifndef NANOTOUCH_CONTROL_OBSERVE_H
#define NANOTOUCH_CONTROL_OBSERVE_H

#include "nanotouch/touch.h"

/* After the supervisor has judged the sample: what is a measurement in it goes into the signals, and what is derived
 * from these; the rest stays as it was. */
void nt_observe(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample);
/* Of the master along z behind its low-pass; 0 while its position is not known [m/s]. */
double nt_observe_speed(const nt_touch_state *state);

#endif
