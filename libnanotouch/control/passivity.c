/* SPDX-License-Identifier: BSD-3-Clause
 * Time-domain passivity of the two-port between hand and tip. What goes in at the hand, f_m dx_m, minus what comes out
 * at the tip, alpha_f f_s dx_s/alpha_p, is by Eq. 12 and 17 (f_m - alpha_f f_s) dx = (m x'' + b x') dx/(1 + K_f): the
 * master's own damping, whatever the surface does. Holds and delays take from it; in a limit cycle nothing is left,
 * because the motor pays for the damping. So it is not enough that no energy comes out: a share of b v^2/(1 + K_f) must
 * be seen to go in. Where it is not, K_f backs off by a fifth and stays there: damping injection alone does not stop
 * that limit cycle (docs/control.md), so the motor adds damping only when there is no gain left to take. The hand's
 * port alone would not do: a surface that rises under a moving tip gives energy to the operator, and that is the
 * physics. What has been swallowed is forgotten beyond a small store, or it would hide an instability that begins late.
 */
#include <math.h>

#include "core/clamp.h"
#include "internal/control.h"
#include "nanotouch/advanced/control.h"

#define BACK_OFF 0.8
#define LEAST_GAIN 0.05  /* below it damping is added */
#define DAMPING_STEP 0.2 /* of the master's own, up to all of it */

static double work(const nt_port *from, const nt_port *to)
{
    return 0.5 * (from->force + to->force) * (to->position - from->position);
}

static double hand_work(const nt_passivity *passivity, const nt_passivity_state *state, const nt_port *hand)
{
    if (passivity->credit == 0.0)
        return work(&state->last_hand, hand);
    return (hand->force + passivity->credit * state->speed) * (hand->position - state->last_hand.position);
}

/* The least that the damping has to swallow in this period [J]. */
static double energy_due(const nt_passivity *passivity, nt_passivity_state *state, const nt_port *hand)
{
    const double speed = (hand->position - state->last_hand.position) / passivity->period;
    const double likely = clamp(speed, -passivity->speed_limit, passivity->speed_limit);
    state->speed += passivity->speed_filter * (likely - state->speed);
    const double floor = passivity->speed_floor;
    const double square = greater(0.0, state->speed * state->speed - floor * floor);
    return passivity->due * square / (1.0 + state->gain * passivity->force_gain);
}

double nt_passivity_step(const nt_passivity *passivity, nt_passivity_state *state, const nt_port *hand,
                         const nt_port *tip)
{
    const double due = energy_due(passivity, state, hand);
    const double given = hand_work(passivity, state, hand);
    const double swallowed = given - work(&state->last_tip, tip);
    state->energy = lesser(state->energy + swallowed - due, NT_PASSIVITY_STORE * passivity->dead_zone);
    state->last_hand = *hand;
    state->last_tip = *tip;
    if (state->energy < -passivity->dead_zone) {
        if (state->gain >= LEAST_GAIN)
            state->gain *= BACK_OFF;
        else
            state->damping = lesser(1.0, state->damping + DAMPING_STEP);
        state->energy = 0.0;
        ++state->trips;
    }
    return state->gain;
}

double nt_passivity_damping_force(const nt_passivity *passivity, const nt_passivity_state *state)
{
    const int is_motion = fabs(state->speed) > passivity->speed_floor;
    return is_motion ? -state->damping * passivity->damping * state->speed : 0.0;
}

int nt_passivity_is_exhausted(const nt_passivity_state *state)
{
    return state->gain < LEAST_GAIN && state->damping >= 1.0;
}
