/* SPDX-License-Identifier: BSD-3-Clause
 * Time-domain passivity of the two-port between hand and tip: what goes in at the hand, f_m dx_m, minus what comes out
 * at the tip, alpha_f f_s dx_s/alpha_p, is swallowed by damping; holds, delays and a large K_f can turn it negative.
 * Then K_f backs off by 5 % and stays there: damping injection alone does not stop that limit cycle (docs/control.md).
 * The hand's port alone would not do: a surface that rises under a moving tip gives energy to the operator, and that is
 * the physics. What has been swallowed is forgotten beyond a small store, or it would hide an instability that begins
 * late. */
#include <math.h>

#include "nanotouch/control.h"

#define BACK_OFF 0.95

static double work(const nt_port *from, const nt_port *to)
{
    return 0.5 * (from->force + to->force) * (to->position - from->position);
}

double nt_passivity_step(nt_passivity_state *state, const nt_port *hand, const nt_port *tip, double dead_zone)
{
    const double swallowed = work(&state->last_hand, hand) - work(&state->last_tip, tip);
    state->energy = fmin(state->energy + swallowed, NT_PASSIVITY_STORE * dead_zone);
    state->last_hand = *hand;
    state->last_tip = *tip;
    if (state->energy < -dead_zone) {
        state->gain *= BACK_OFF;
        state->energy = 0.0;
        ++state->trips;
    }
    return state->gain;
}
