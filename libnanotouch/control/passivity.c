/* SPDX-License-Identifier: BSD-3-Clause
 * Operator-port passivity (time-domain): the operator may put energy in and get back no more than that. When more would
 * come out, the force gain K_f backs off by 5 % and stays there; damping injection alone does not stop the limit cycle of
 * a large K_f (docs/control.md). */
#include "nanotouch/control.h"

#define BACK_OFF 0.95

double nt_passivity_step(nt_passivity_state *state, double force, double position, double dead_zone) {
    state->energy += 0.5 * (force + state->last_force) * (position - state->last_position);
    state->last_force = force;
    state->last_position = position;
    if (state->energy < -dead_zone) {
        state->gain *= BACK_OFF;
        state->energy = 0.0;
        ++state->trips;
    }
    return state->gain;
}
