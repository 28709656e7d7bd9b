/* SPDX-License-Identifier: BSD-3-Clause
 * A stop lifts, keeps watching and lifts again: by retract_distance, once more whenever force shows, and as far as
 * travel allows while no force can be read. A stage that did not follow, or that goes the wrong way, stays where it is
 * until the force grows; then the force alone tells. Once the stage should have turned, a lift makes no force grow;
 * where one does, and the read-out does not show it rising, it is no lift and is given up. A read-out that does show it
 * says that the frame comes down faster, or a flank passes by below: then lifting is all there is to do. */
#include "control/lift.h"

#include <math.h>

#include "core/clamp.h"

#define GROWTH_TICKS 3u /* in a row */
#define DRIFT 1e-9      /* [m] */
#define FALL_SLACKS 2.0 /* what the stage may yet go when it is told to turn: its lag, and its ringing */

double nt_lift_tolerance(const nt_supervisor *supervisor)
{
    return supervisor->free_force + DRIFT * supervisor->spring_constant;
}

/* A tip that is let go springs back to 0: that is no growth. */
static void begin(nt_supervisor_state *state, double force)
{
    state->turn = state->expected;
    state->lift_force = greater(0.0, force);
    state->growth_run = 0;
}

/* By its read-out, which has told the truth so far. */
static int shows_rise(const nt_supervisor *supervisor, const nt_supervisor_state *state, double position)
{
    return state->lift == NT_LIFT_GOES && position < state->turn_position - supervisor->turn_slack;
}

int nt_lift_helps(const nt_supervisor *supervisor, nt_supervisor_state *state, double force, double position)
{
    const int runs = state->state < NT_RETRACT, goes = state->lift == NT_LIFT_GOES;
    if (runs) {
        state->lift = NT_LIFT_GOES;
        state->stopped = state->expected;
    }
    if (runs || (goes && !state->lifts)) {
        begin(state, force);
        return 1;
    }
    const int has_turned = !goes || state->expected < state->turn - supervisor->turn_slack; /* else it began at rest */
    if (!has_turned)
        state->lift_force = greater(state->lift_force, force);
    const int grows = has_turned && force > state->lift_force + nt_lift_tolerance(supervisor);
    state->growth_run = grows ? state->growth_run + 1u : 0u;
    if (state->growth_run < GROWTH_TICKS || shows_rise(supervisor, state, position))
        return 1;
    if (state->lift == NT_LIFT_WAITS) {
        state->lift = NT_LIFT_TRIES;
        begin(state, force);
        return 1;
    }
    state->lift = NT_LIFT_GIVEN_UP;
    return 0;
}

/* Is it read well below the farthest that it has come, and farther down than where that began? A slip is over at once;
 * a stage that goes the wrong way goes on. */
static int falls_on(const nt_supervisor *supervisor, nt_supervisor_state *state, double position)
{
    state->top_position = lesser(state->top_position, position);
    if (position <= state->top_position + FALL_SLACKS * supervisor->turn_slack)
        state->fall_position = INFINITY;
    else if (isinf(state->fall_position))
        state->fall_position = position;
    return position > state->fall_position + supervisor->turn_slack;
}

int nt_lift_rises(const nt_supervisor *supervisor, nt_supervisor_state *state, double position)
{
    const int goes = state->state >= NT_RETRACT && state->lift == NT_LIFT_GOES && state->lifts;
    if (!goes) { /* from here it will */
        state->turn_position = state->top_position = position;
        state->fall_position = INFINITY;
        state->fall_run = 0;
        return 1;
    }
    state->fall_run = falls_on(supervisor, state, position) ? state->fall_run + 1u : 0u;
    if (state->fall_run < GROWTH_TICKS)
        return 1;
    state->lift = NT_LIFT_WAITS;
    return 0;
}

double nt_lift_distance(const nt_touch *touch, nt_touch_state *state)
{
    const double distance = touch->settings.limits.retract_distance;
    if (state->supervisor.lift != NT_LIFT_GOES && state->supervisor.lift != NT_LIFT_TRIES)
        return 0.0;
    if (state->supervisor.presses && state->retracted >= distance)
        state->retracted = 0.0;
    return distance;
}
