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
static void learn_noise(const nt_supervisor *supervisor, nt_supervisor_state *state, double deflection)
{
    if (state->noise_samples == SAMPLES)
        return;
    if (state->noise_samples > 0)
        state->noise_sum += fabs(deflection - state->last_deflection);
    state->last_deflection = deflection;
    if (++state->noise_samples % BLOCK > 0)
        return;
    const double noise = state->noise_sum / (STEP * BLOCK);
    state->noise = state->noise_samples == BLOCK ? noise : lesser(state->noise, noise);
    state->noise_sum = 0.0;
    if (state->noise_samples == SAMPLES)
        state->stuck_band = BAND * lesser(state->noise, supervisor->noise);
}

/* The count stands at NT_STUCK_SAMPLES until z has moved, so that HOLD comes first. */
nt_state nt_stuck_judge(const nt_supervisor *supervisor, nt_supervisor_state *state, const nt_sample *sample,
                        int shows_none)
{
    const double deflection = sample->deflection[NT_Z], position = sample->stage_position[NT_Z];
    if (supervisor->stuck_distance == 0.0)
        return NT_RUN;
    learn_noise(supervisor, state, deflection);
    if (shows_none || !(fabs(deflection - state->stuck_deflection) <= state->stuck_band)) {
        state->stuck_deflection = deflection;
        state->stuck_position = position;
        state->stuck_run = 0;
        return NT_RUN;
    }
    const int moved = fabs(position - state->stuck_position) > supervisor->stuck_distance;
    if (state->stuck_run < NT_STUCK_SAMPLES || (moved && state->stuck_run < 2 * NT_STUCK_SAMPLES))
        ++state->stuck_run;
    if (state->stuck_run < NT_STUCK_SAMPLES || !moved)
        return NT_RUN;
    return state->stuck_run < 2 * NT_STUCK_SAMPLES ? NT_HOLD : NT_LATCHED;
}
