/* SPDX-License-Identifier: BSD-3-Clause
 * The operator's hand: a script, straight to a target over a time, then it stays; an adversary that adds any force at
 * any time; and the rest position of the spring with which it holds the master (its mass, damping and spring move with
 * the master: master.c). */
#include <math.h>

#include "nanotouch/dynamics.h"

void nt_hand_aim(nt_hand_state *hand, const nt_hand_target *target)
{
    hand->from = nt_hand_now(hand);
    hand->to = *target;
    hand->elapsed = 0.0;
}

nt_hand_target nt_hand_now(const nt_hand_state *hand)
{
    const nt_hand_target *from = &hand->from, *to = &hand->to;
    nt_hand_target now = {.force = to->force, .x = to->x, .y = to->y};
    if (hand->elapsed < to->duration) {
        const double rest = 1.0 - hand->elapsed / to->duration;
        now.force -= rest * (to->force - from->force);
        now.x -= rest * (to->x - from->x);
        now.y -= rest * (to->y - from->y);
    }
    return now;
}

double nt_hand_effort(const nt_hand_state *hand)
{
    return nt_hand_now(hand).force + hand->random_force;
}

void nt_hand_step(nt_hand_state *state, const nt_hand *hand, double position, double period, nt_noise *noise)
{
    state->elapsed += period;
    if (hand->relaxation > 0.0)
        state->rest -= expm1(-period / hand->relaxation) * (position - state->rest);
    if (hand->random_force > 0.0 && nt_noise_uniform(noise) < -expm1(-hand->random_rate * period))
        state->random_force = hand->random_force * (2.0 * nt_noise_uniform(noise) - 1.0);
}
