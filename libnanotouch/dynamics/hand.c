/* SPDX-License-Identifier: BSD-3-Clause
 * The operator's hand as a script: straight to a target over a time, then it stays. */
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

void nt_hand_step(nt_hand_state *hand, double period)
{
    hand->elapsed += period;
}
