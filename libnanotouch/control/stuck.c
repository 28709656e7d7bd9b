/* SPDX-License-Identifier: BSD-3-Clause
 * A live sensor shows its noise; none while z moves means that it is dead. How much it has is learnt from its first
 * samples, so that a sensor better than declared is not taken for a dead one, and one that has lost its gain is. */
#include "control/stuck.h"

#include <math.h>

#include "core/clamp.h"

#define BAND 0.25     /* of its standard deviation: a living sensor keeps to it once in 10^35 */
#define BLOCK 50u     /* samples */
#define SAMPLES 200u  /* that are looked at */
#define STEP 1.128379 /* mean |difference| of two normal numbers, over sigma */

/* The noise of the quietest block; no more than declared. */
static void learn_noise(const nt_stuck_limits *limits, nt_stuck *stuck, double reading)
{
    if (stuck->noise_samples == SAMPLES)
        return;
    if (stuck->noise_samples > 0)
        stuck->noise_sum += fabs(reading - stuck->last);
    stuck->last = reading;
    if (++stuck->noise_samples % BLOCK > 0)
        return;
    const double noise = stuck->noise_sum / (STEP * BLOCK);
    stuck->noise = stuck->noise_samples == BLOCK ? noise : lesser(stuck->noise, noise);
    stuck->noise_sum = 0.0;
    if (stuck->noise_samples == SAMPLES)
        stuck->band = BAND * lesser(stuck->noise, limits->noise);
}

/* The count stands at NT_STUCK_SAMPLES until z has moved, so that HOLD comes first. */
nt_state nt_stuck_judge(const nt_stuck_limits *limits, nt_stuck *stuck, double reading, double position, int shows_none)
{
    if (limits->distance == 0.0)
        return NT_RUN;
    learn_noise(limits, stuck, reading);
    if (shows_none || !(fabs(reading - stuck->value) <= stuck->band)) {
        stuck->value = reading;
        stuck->position = position;
        stuck->run = 0;
        return NT_RUN;
    }
    const int moved = fabs(position - stuck->position) > limits->distance;
    if (stuck->run < NT_STUCK_SAMPLES || (moved && stuck->run < 2 * NT_STUCK_SAMPLES))
        ++stuck->run;
    if (stuck->run < NT_STUCK_SAMPLES || !moved)
        return NT_RUN;
    return stuck->run < 2 * NT_STUCK_SAMPLES ? NT_HOLD : NT_LATCHED;
}
