/* SPDX-License-Identifier: BSD-3-Clause
 * x and y of a touch: where the tip goes, and what the hand feels of what holds it. */
#include "control/sideways.h"

#include <math.h>

#include "control/motor.h"
#include "core/clamp.h"
#include "core/same_bits.h"
#include "internal/control.h"

#define ROUNDING (1.0 + 1e-9) /* of a way at the limit */

void nt_sideways_follow_hand(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    for (int i = NT_X; i < NT_Z; ++i) {
        const double step = sample->master_position[i] - state->hand_at[i];
        if (isfinite(step)) {
            const double speed = step * touch->settings.gains.rate;
            state->hand_speed[i] += touch->speed_filter * (speed - state->hand_speed[i]);
        }
        if (isfinite(step) && state->engaged > 0.0 && !state->clutch_open)
            state->sideways[i] += step; /* nothing while they are uncoupled */
        state->hand_at[i] = sample->master_position[i];
    }
}

/* What the hand shall feel of a force along an axis, before the motor's limits [N]. */
static double felt_of(const nt_touch_state *state, int axis, double force)
{
    return state->passivity_sideways[axis].gain * state->engaged * force;
}

/* x and y back off together. */
static void tie(nt_passivity_state of[2])
{
    of[NT_X].gain = of[NT_Y].gain = lesser(of[NT_X].gain, of[NT_Y].gain);
    of[NT_X].damping = of[NT_Y].damping = greater(of[NT_X].damping, of[NT_Y].damping);
}

void nt_sideways_watch(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample, int closed)
{
    const nt_passivity *passivity = &touch->passivity_sideways;
    const uint64_t acting = state->ticks + NT_TOUCH_SENT - 1u - touch->delay; /* the tick whose force has been held */
    for (int i = NT_X; i < NT_Z; ++i) {
        nt_passivity_state *of = &state->passivity_sideways[i];
        const double step = (sample->stage_position[i] - state->stage_at[i]) / state->signals.scaling.alpha_p;
        const nt_port hand = {-state->sent[acting % NT_TOUCH_SENT][i], sample->master_position[i]};
        const double force = state->signals.scaling.alpha_f * state->lateral_force[i];
        const nt_port tip = {-felt_of(state, i, force), of->last_tip.position + (isfinite(step) ? step : 0.0)};
        state->stage_at[i] = sample->stage_position[i];
        if (closed && isfinite(step) && isfinite(hand.position))
            nt_passivity_step(passivity, of, &hand, &tip);
        of->last_hand = hand;
        of->last_tip = tip;
    }
    tie(state->passivity_sideways);
}

void nt_sideways_read(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    const nt_gains *gains = &touch->settings.gains;
    const double stiffness = touch->rig.probe.lateral_stiffness;
    const double shares[] = {gains->projection_x, gains->projection_y};
    state->projected_force = state->signals.slave_force;
    for (int i = NT_X; i < NT_Z && stiffness > 0.0; ++i) {
        state->lateral_force[i] = stiffness * sample->deflection[i];
        if (shares[i] != 0.0)
            state->projected_force += shares[i] * state->lateral_force[i];
    }
}

/* A master of three axes leads the tip sideways, as it presses: from where it was last coupled, no faster than the
 * lateral limit. */
static void follow(const nt_touch *touch, nt_touch_state *state)
{
    const double most = touch->settings.limits.lateral_speed * touch->period;
    double *stage = state->command.stage_position, way[2];
    for (int i = NT_X; i < NT_Z; ++i)
        way[i] = state->signals.scaling.alpha_p * state->sideways[i];
    const double length = hypotenuse(way[NT_X], way[NT_Y]), share = length > most ? most / length : 1.0;
    for (int i = NT_X; i < NT_Z; ++i) {
        const double wanted = stage[i] + share * way[i];
        stage[i] = clamp(wanted, touch->borders[i][0], touch->borders[i][1]);
        if (stage[i] != wanted)
            state->supervisor.reasons |= NT_REASON_COMMAND_LIMITED;
        state->sideways[i] *= 1.0 - share; /* what is left is owed */
    }
    state->target_x = stage[NT_X];
    state->target_y = stage[NT_Y];
}

void nt_sideways_move(const nt_touch *touch, nt_touch_state *state)
{
    if (touch->leads_sideways) {
        follow(touch, state);
        return;
    }
    const nt_sum left = state->target_time;
    const double *stage = state->command.stage_position, most = touch->settings.limits.lateral_speed * touch->period;
    const double way[2] = {state->target_x - stage[NT_X], state->target_y - stage[NT_Y]};
    const double length = hypotenuse(way[NT_X], way[NT_Y]);
    double share = left > touch->period ? touch->period / left : 1.0;
    if (share * length > most * ROUNDING) /* the limit has been lowered on the way */
        share = most / length;
    state->command.stage_position[NT_X] += share * way[NT_X];
    state->command.stage_position[NT_Y] += share * way[NT_Y];
    state->target_time = greater(0.0, left - touch->period);
}

/* While a law speaks; where none does along x and y, damping is left. */
static double wanted_of(const nt_touch *touch, const nt_touch_state *state, int axis)
{
    const double force =
        state->mode == NT_MODE_TOUCH ? state->signals.scaling.alpha_f * state->lateral_force[axis] : 0.0;
    return felt_of(state, axis, force) +
           nt_passivity_damping_force(&touch->passivity_sideways, &state->passivity_sideways[axis]);
}

void nt_sideways_drive(const nt_touch *touch, nt_touch_state *state)
{
    if (!touch->feels_sideways)
        return;
    for (int i = NT_X; i < NT_Z; ++i) {
        const double speed = isfinite(state->hand_at[i]) ? state->hand_speed[i] : 0.0;
        const double wanted =
            state->fade.left == 1.0 ? wanted_of(touch, state, i) : nt_motor_faded(touch, state, i, speed);
        state->command.motor_force[i] =
            nt_motor_limit(&touch->settings.limits, touch->motor_step, state->command.motor_force[i], wanted, speed);
    }
}
