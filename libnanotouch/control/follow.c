/* SPDX-License-Identifier: BSD-3-Clause
 * Does the stage move as it is told? What it is told passes its lag; its read-out may be off by a slack. */
#include "control/follow.h"

#include <math.h>

#include "core/clamp.h"

#define FOLLOW_TICKS 3u   /* in a row: HOLD; while lifting: LATCHED */
#define FOLLOW_SHARE 0.75 /* of the way it was to go lately: room for hysteresis */

void nt_follow_expect(const nt_supervisor *supervisor, nt_supervisor_state *state, nt_sum reference)
{
    if (isnan(state->expected))
        state->expected = reference;
    state->lifts = reference < state->reference;
    state->reference = reference;
    const double step = supervisor->stage_share * (reference - state->expected);
    state->expected += step;
    state->path = supervisor->path_kept * state->path + fabs(step);
}

/* What of the way that it lifts a stage may lose, while the integral stands still; and, where ticks come late and lift
 * farther, the lag: the filter's part of it counts ticks, the stage's own does not [m]. */
static double lost_in_lift(const nt_supervisor *supervisor, const nt_supervisor_state *state)
{
    const int lifts = state->state >= NT_RETRACT && isfinite(state->stopped);
    if (!lifts)
        return 0.0;
    const double late = supervisor->limits.retract_speed * state->late / supervisor->stage_share;
    return supervisor->lift_share * fabs(state->expected - state->stopped) + late;
}

int nt_follow_is_off(const nt_supervisor *supervisor, nt_supervisor_state *state, double position)
{
    const double slack = lesser(supervisor->stage_most, greater(supervisor->stage_slack, FOLLOW_SHARE * state->path));
    const double below = position - state->expected; /* a stop may be farther up than it was told */
    const double off = state->state >= NT_RETRACT ? below : fabs(below);
    if (off <= slack + lost_in_lift(supervisor, state)) {
        state->off_run = 0;
        return 0;
    }
    return ++state->off_run >= FOLLOW_TICKS;
}

nt_state nt_follow_judge(const nt_supervisor *supervisor, nt_supervisor_state *state, int tells_force)
{
    const int lasts = state->off_run * supervisor->period > supervisor->limits.follow_time;
    if (state->state < NT_RETRACT && lasts)
        state->lift = NT_LIFT_WAITS;
    else if (state->state >= NT_RETRACT && !tells_force)
        state->lift = state->lift < NT_LIFT_TRIES ? NT_LIFT_WAITS : NT_LIFT_GIVEN_UP;
    return state->state >= NT_RETRACT || lasts ? NT_LATCHED : NT_HOLD;
}
