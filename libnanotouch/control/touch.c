/* SPDX-License-Identifier: BSD-3-Clause
 * One control period: supervisor, observation, mode and law, limits, stage loop. */
#include "nanotouch/touch.h"
#include "internal/control.h"

#include <math.h>

#include "control/lift.h"
#include "control/modes.h"
#include "control/motor.h"
#include "control/observe.h"
#include "control/sideways.h"
#include "core/clamp.h"

#define PROBE_STEPS 20.0 /* a sensor that seems stuck is tried by stepping away by this many of the stage's steps */

nt_touch_state nt_touch_start(const nt_touch *touch, double master_position, double x, double y)
{
    const nt_gains *gains = &touch->settings.gains;
    const nt_scaling scaling = {gains->alpha_p, gains->alpha_f};
    nt_touch_state state = {.mode = touch->mode,
                            .wanted_mode = touch->mode,
                            .supervisor = nt_supervisor_start(),
                            .passivity = {.gain = 1.0, .last_hand = {.position = master_position}},
                            .passivity_sideways = {{.gain = 1.0}, {.gain = 1.0}},
                            .rescale = nt_rescale_start(&touch->rescale, &scaling),
                            .signals = {.period = touch->period,
                                        .master_position = master_position,
                                        .master_damping = touch->rig.master.damping,
                                        .gain_factor = 1.0},
                            .target_x = x,
                            .target_y = y,
                            .command = {.stage_position = {x, y}}};
    state.signals.scaling = state.rescale.now;
    state.hand_at[NT_X] = state.hand_at[NT_Y] = NAN; /* until it is seen */
    state.stage_at[NT_X] = state.stage_at[NT_Y] = NAN;
    state.offset = -gains->alpha_p * master_position; /* the stage begins at 0 */
    return state;
}

static int moves_sideways(const nt_touch_state *state)
{
    return state->sideways[NT_X] != 0.0 || state->sideways[NT_Y] != 0.0 ||
           state->target_x != state->command.stage_position[NT_X] ||
           state->target_y != state->command.stage_position[NT_Y];
}

static int has_backed_off(const nt_touch_state *state)
{
    return state->passivity.gain < 1.0 || state->passivity_sideways[NT_X].gain < 1.0;
}

static int is_exhausted(const nt_touch_state *state)
{
    return nt_passivity_is_exhausted(&state->passivity) || nt_passivity_is_exhausted(&state->passivity_sideways[NT_X]);
}

static nt_state supervise(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    const nt_situation situation = {.reference = state->reference,
                                    .moves_sideways = moves_sideways(state),
                                    .unstable =
                                        state->mode == NT_MODE_TOUCH && has_backed_off(state) && is_exhausted(state)};
    return nt_supervisor_step(&touch->supervisor, &state->supervisor, sample, &situation);
}

/* How far a stop lifts in all [m]. */
static double lift_of(const nt_touch *touch, nt_touch_state *state)
{
    if (state->supervisor.state >= NT_RETRACT)
        return nt_lift_distance(touch, state);
    return state->supervisor.reasons & NT_REASON_STUCK ? PROBE_STEPS * touch->rig.stage.resolution : 0.0;
}

/* Mode and law, or what a stop leaves; the motor force that is wanted. */
static double act(const nt_touch *touch, nt_touch_state *state)
{
    if (state->supervisor.state == NT_RUN) {
        const double force = nt_mode_run(touch, state);
        if (isfinite(force)) {
            state->supervisor.law_run = 0;
            state->retracted = 0.0;
            nt_sideways_move(touch, state);
            return force;
        }
        nt_supervisor_fail_law(&state->supervisor);
    }
    return nt_mode_stop(touch, state, lift_of(touch, state));
}

/* A law speaks; else what it left fades. */
static int is_coupled(const nt_touch_state *state)
{
    return state->supervisor.state == NT_RUN && state->mode == state->wanted_mode && !state->clutch_open &&
           (state->mode <= NT_MODE_TOPOGRAPHY || state->mode == NT_MODE_TAPPING);
}

static void drive_motor(const nt_touch *touch, nt_touch_state *state, double wanted)
{
    if (is_coupled(state))
        state->fade.left = 1.0;
    state->motor_force =
        nt_motor_limit(&touch->settings.limits, touch->motor_step, state->motor_force, wanted, nt_observe_speed(state));
}

/* A read-out that cannot be trusted (not RUN) or that follow_error calls a fault takes no part: the integral stands
 * still. */
static double drive_stage(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    const double error = state->reference - sample->stage_position[NT_Z];
    const int trusted = state->supervisor.state == NT_RUN && fabs(error) <= touch->settings.limits.follow_error;
    const nt_sum measured = trusted ? sample->stage_position[NT_Z] : state->reference;
    const nt_sum wanted = nt_stage_loop_step(&touch->stage_loop, &state->stage_loop, state->reference, measured);
    const double most = touch->supervisor.correction_most; /* it shall hide no stage that does not follow */
    state->stage_loop.correction = clamp(state->stage_loop.correction, -most, most);
    const nt_sum command = clamp(wanted, -touch->stage_end, touch->stage_end);
    if (command != wanted)
        state->supervisor.reasons |= NT_REASON_COMMAND_LIMITED;
    return command;
}

/* Farther from where it was told to be than all of its travel no stage can be, sideways. */
static int is_elsewhere(const nt_touch *touch, const nt_touch_state *state, const nt_sample *sample)
{
    const double *read = sample->stage_position, *sent = state->command.stage_position;
    const double dx = read[NT_X] - sent[NT_X], dy = read[NT_Y] - sent[NT_Y], most = touch->rig.stage.travel;
    return !(dx * dx + dy * dy <= most * most);
}

void nt_touch_step(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample, nt_command *command)
{
    nt_sample blind;
    if (is_elsewhere(touch, state, sample)) {
        blind = *sample;
        blind.stage_position[NT_X] = blind.stage_position[NT_Y] = NAN; /* as bad as no numbers */
        sample = &blind;
    }
    supervise(touch, state, sample);
    nt_observe(touch, state, sample);
    drive_motor(touch, state, act(touch, state));
    nt_sideways_drive(touch, state);
    state->command.stage_position[NT_Z] = drive_stage(touch, state, sample);
    if (has_backed_off(state))
        state->supervisor.reasons |= NT_REASON_BACKED_OFF;
    state->command.motor_force[NT_Z] = state->motor_force;
    state->command.drive_amplitude = touch->drive_amplitude;
    state->command.drive_frequency = touch->drive_frequency;
    double *sent = state->sent[state->ticks % NT_TOUCH_SENT];
    sent[NT_X] = state->command.motor_force[NT_X];
    sent[NT_Y] = state->command.motor_force[NT_Y];
    sent[NT_Z] = state->motor_force;
    if (state->command.state != (uint32_t)state->supervisor.state)
        state->since = state->ticks;
    state->command.state = (uint32_t)state->supervisor.state;
    state->command.reasons = state->supervisor.reasons;
    ++state->ticks;
    *command = state->command;
}
