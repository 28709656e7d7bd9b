/* SPDX-License-Identifier: BSD-3-Clause
 * The operator's hand: a script, straight to a target over a time, then it stays; an adversary that adds any force at
 * any time; and the rest position of the spring with which it holds the master (its mass, damping and spring move with
 * the master: master.c). */
#include <math.h>

#include "dynamics/dynamics.h"
#include "internal/random.h"
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
    nt_hand_target now = *to;
    now.duration = 0.0;
    if (hand->elapsed < to->duration) {
        const double rest = 1.0 - hand->elapsed / to->duration;
        for (int i = 0; i < NT_AXES; ++i) {
            now.force[i] -= rest * (to->force[i] - from->force[i]);
            now.position[i] -= rest * (to->position[i] - from->position[i]);
        }
    }
    return now;
}

double nt_hand_effort(const nt_hand_state *hand)
{
    const nt_hand_target *from = &hand->from, *to = &hand->to;
    const double rest = hand->elapsed < to->duration ? 1.0 - hand->elapsed / to->duration : 0.0;
    return to->force[NT_Z] - rest * (to->force[NT_Z] - from->force[NT_Z]) + hand->random_force;
}

void nt_hand_step(nt_hand_state *state, const nt_hand *hand, double position, double period, nt_noise *noise)
{
    state->elapsed += period;
    if (hand->relaxation > 0.0)
        state->rest -= expm1(-period / hand->relaxation) * (position - state->rest);
    if (hand->random_force > 0.0 && nt_noise_uniform(noise) < -expm1(-hand->random_rate * period))
        state->random_force = hand->random_force * (2.0 * nt_noise_uniform(noise) - 1.0);
}
