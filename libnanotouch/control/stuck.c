/* SPDX-License-Identifier: BSD-3-Clause
 * A live sensor shows its noise; none while the stage moves means that it is dead. A way sideways counts as one in z
 * does: a servo whose reading has died at the set point leaves z where it is, and a scan goes on over the slopes. How
 * much noise it has is learnt from its first samples, so that a sensor better than declared is not taken for a dead
 * one, and one that has lost its gain is. */
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

/* By more than the distance, along any axis; x and y that nobody measures have not. */
static int has_moved(const nt_stuck_limits *limits, const nt_stuck *stuck, const double position[NT_AXES])
{
    for (int i = 0; i < NT_AXES; ++i)
        if (fabs(position[i] - stuck->position[i]) > limits->distance)
            return 1;
    return 0;
}

/* The count stands at NT_STUCK_SAMPLES until the stage has moved, so that HOLD comes first. */
nt_state nt_stuck_judge(const nt_stuck_limits *limits, nt_stuck *stuck, double reading, const double position[NT_AXES],
                        int shows_none)
{
    if (limits->distance == 0.0)
        return NT_RUN;
    const int is_first = stuck->noise_samples == 0 && stuck->run == 0;
    learn_noise(limits, stuck, reading);
    if (is_first || shows_none || !(fabs(reading - stuck->value) <= stuck->band)) {
        stuck->value = reading;
        for (int i = 0; i < NT_AXES; ++i)
            stuck->position[i] = position[i];
        stuck->run = 0;
        return NT_RUN;
    }
    const int moved = has_moved(limits, stuck, position);
    if (stuck->run < NT_STUCK_SAMPLES || (moved && stuck->run < 2 * NT_STUCK_SAMPLES))
        ++stuck->run;
    if (stuck->run < NT_STUCK_SAMPLES || !moved)
        return NT_RUN;
    return stuck->run < 2 * NT_STUCK_SAMPLES ? NT_HOLD : NT_LATCHED;
}
