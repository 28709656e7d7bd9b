/* SPDX-License-Identifier: BSD-3-Clause
 * What may be asked of a running touch from outside, between two steps. */
#include <math.h>

#include "core/clamp.h"
#include "core/same_bits.h"
#include "internal/control.h"
#include "nanotouch/touch.h"

nt_status nt_touch_aim(const nt_touch *touch, nt_touch_state *state, double x, double y, double duration)
{
    if (!isfinite(x) || !isfinite(y) || !isfinite(duration))
        return NT_E_NOT_FINITE;
    if (duration < 0.0)
        return NT_E_RANGE;
    const double distance =
        hypotenuse(x - state->command.stage_position[NT_X], y - state->command.stage_position[NT_Y]);
    state->target_x = x;
    state->target_y = y;
    state->target_time = greater(duration, distance / touch->settings.limits.lateral_speed);
    return NT_OK;
}

nt_status nt_touch_arm(nt_touch_state *state, int confirmed)
{
    const nt_status status = nt_supervisor_arm(&state->supervisor, confirmed);
    if (status != NT_OK)
        return status;
    nt_passivity_state *watched[] = {&state->passivity, &state->passivity_sideways[NT_X],
                                     &state->passivity_sideways[NT_Y]};
    for (int i = 0; i < NT_AXES; ++i) {
        watched[i]->gain = 1.0;
        watched[i]->damping = 0.0;
        watched[i]->energy = 0.0;
    }
    state->retracted = 0.0;
    state->phase = NT_PHASE_DOWN;
    state->target_x =
        state->command.stage_position[NT_X]; /* the path that a stop has cut short does not go on by itself */
    state->target_y = state->command.stage_position[NT_Y];
    state->target_time = 0.0;
    return NT_OK;
}

nt_status nt_touch_set_mode(nt_touch_state *state, nt_mode mode)
{
    if (mode > NT_MODE_TAPPING)
        return NT_E_ARGUMENT;
    state->wanted_mode = mode;
    if (mode == state->mode)
        state->phase = NT_PHASE_DOWN; /* once more */
    return NT_OK;
}

nt_status nt_touch_rescale(nt_touch_state *state, const nt_scaling *scaling)
{
    if (!isfinite(scaling->alpha_p) || !isfinite(scaling->alpha_f))
        return NT_E_NOT_FINITE;
    if (scaling->alpha_p <= 0.0 || scaling->alpha_f <= 0.0)
        return NT_E_RANGE;
    state->rescale.wanted = *scaling;
    return NT_OK;
}

void nt_touch_clutch(nt_touch_state *state, int open)
{
    state->clutch_open = open;
}

void nt_touch_index(nt_touch_state *state, double master_position)
{
    nt_signals *signals = &state->signals;
    state->offset += signals->scaling.alpha_p * (signals->master_position - master_position);
    signals->master_position = master_position;
    state->passivity.last_hand.position = master_position;
    state->hand_at[NT_X] = state->hand_at[NT_Y] = NAN; /* until it is seen */
}
