/* SPDX-License-Identifier: BSD-3-Clause
 * One control period: supervisor, observation, mode and law, limits, stage loop. */
#include "nanotouch/touch.h"

#include <math.h>

#include "control/lift.h"
#include "control/modes.h"
#include "control/motor.h"
#include "control/sideways.h"
#include "core/clamp.h"
#include "core/same_bits.h"

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

/* A single reading that nothing real can have made gives way to the one between it and the last two; a true jump shows
 * one period late. */
static double without_spike(const nt_touch *touch, nt_touch_state *state, double deflection)
{
    const double last = state->deflections[0], before = state->deflections[1];
    state->deflections[1] = last;
    state->deflections[0] = deflection;
    if (fabs(deflection - last) <= touch->spike)
        return deflection;
    return greater(lesser(deflection, last), lesser(greater(deflection, last), before));
}

/* Positions, and speeds by differences. */
static void follow_motion(const nt_touch *touch, nt_signals *signals, const nt_sample *sample)
{
    const double rate = touch->settings.gains.rate;
    signals->master_speed = (sample->master_position[NT_Z] - signals->master_position) * rate;
    signals->smooth_speed += touch->speed_filter * (signals->master_speed - signals->smooth_speed);
    signals->stage_speed = (sample->stage_position[NT_Z] - signals->stage_position) * rate;
    signals->master_position = sample->master_position[NT_Z];
    signals->stage_position = sample->stage_position[NT_Z];
}

/* A new alpha_p counts from where the master is: no bump. */
static void rescale(const nt_touch *touch, nt_touch_state *state)
{
    nt_signals *signals = &state->signals;
    const double alpha_p = state->rescale.now.alpha_p;
    nt_rescale_step(&touch->rescale, &state->rescale, signals->slave_force, signals->stage_position,
                    signals->smooth_speed);
    signals->scaling = state->rescale.now;
    state->offset += (alpha_p - signals->scaling.alpha_p) * signals->master_position;
}

/* What goes in at the hand, and what comes out at the tip at the operator's scale; behind a virtual coupling, whose
 * spring stores energy, what goes into that. */
static void watch_energy(const nt_touch *touch, nt_touch_state *state, double stage_step)
{
    const nt_signals *signals = &state->signals;
    const nt_scaling *scaling = &signals->scaling;
    nt_passivity_state *passivity = &state->passivity;
    const uint64_t acting = state->ticks + NT_TOUCH_SENT - 1u - touch->delay; /* the tick whose force has been held */
    const double hand_force =
        touch->rig.master.gauge ? signals->operator_force : -state->sent[acting % NT_TOUCH_SENT][NT_Z];
    const nt_port hand = {hand_force, signals->master_position};
    const int coupled = touch->settings.gains.coupling_stiffness > 0.0;
    const double tip_step =
        coupled ? signals->master_position - passivity->last_hand.position : stage_step / scaling->alpha_p;
    const nt_port tip = {scaling->alpha_f * (coupled ? signals->felt_force : state->projected_force),
                         passivity->last_tip.position + tip_step};
    if (state->supervisor.reasons & NT_REASON_OPERATOR_CLIPPED) { /* the hand gives more than the gauge can tell */
        passivity->last_hand = hand;
        passivity->last_tip = tip;
        return;
    }
    nt_passivity_step(&touch->passivity, passivity, &hand, &tip);
    state->signals.gain_factor = passivity->gain;
}

static void observe(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    nt_signals *signals = &state->signals;
    const double stage_step = sample->stage_position[NT_Z] - signals->stage_position;
    follow_motion(touch, signals, sample);
    if (touch->leads_sideways)
        nt_sideways_follow_hand(touch, state, sample);
    signals->operator_force = touch->rig.master.gauge ? sample->operator_force[NT_Z] : 0.0;
    signals->smooth_force += touch->force_filter * (signals->operator_force - signals->smooth_force);
    signals->slave_force = touch->rig.probe.spring_constant * without_spike(touch, state, sample->deflection[NT_Z]);
    state->amplitude = sample->amplitude;
    state->lag = sample->lag;
    nt_sideways_read(touch, state, sample);
    rescale(touch, state);
    const int closes = touch->rig.master.motor; /* without a motor no loop closes through the hand */
    if (closes && state->mode == NT_MODE_TOUCH) /* a servo is meant to move the hand */
        watch_energy(touch, state, stage_step);
    if (touch->feels_sideways)
        nt_sideways_watch(touch, state, sample, closes && state->mode == NT_MODE_TOUCH);
}

static int moves_sideways(const nt_touch_state *state)
{
    return state->sideways[NT_X] != 0.0 || state->sideways[NT_Y] != 0.0 ||
           state->target_x != state->command.stage_position[NT_X] ||
           state->target_y != state->command.stage_position[NT_Y];
}

static int is_exhausted(const nt_touch_state *state)
{
    return nt_passivity_is_exhausted(&state->passivity) || nt_passivity_is_exhausted(&state->passivity_sideways[NT_X]);
}

static nt_state supervise(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    const nt_situation situation = {.reference = state->reference,
                                    .moves_sideways = moves_sideways(state),
                                    .unstable = state->mode == NT_MODE_TOUCH && is_exhausted(state)};
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

static void drive_motor(const nt_touch *touch, nt_touch_state *state, double wanted)
{
    state->motor_force = nt_motor_limit(&touch->settings.limits, touch->motor_step, state->motor_force, wanted,
                                        state->signals.smooth_speed);
    const int coupled = state->supervisor.state == NT_RUN && state->mode == state->wanted_mode && !state->clutch_open;
    if (coupled && (state->mode <= NT_MODE_TOPOGRAPHY || state->mode == NT_MODE_TAPPING))
        state->coupled_force = state->motor_force;
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

void nt_touch_step(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample, nt_command *command)
{
    supervise(touch, state, sample);
    if (state->supervisor.invalid_run == 0)
        observe(touch, state, sample);
    drive_motor(touch, state, act(touch, state));
    nt_sideways_drive(touch, state);
    state->command.stage_position[NT_Z] = drive_stage(touch, state, sample);
    if (state->passivity.gain < 1.0 || state->passivity_sideways[NT_X].gain < 1.0)
        state->supervisor.reasons |= NT_REASON_BACKED_OFF;
    state->command.motor_force[NT_Z] = state->motor_force;
    state->command.drive_amplitude = touch->drive_amplitude;
    state->command.drive_frequency = touch->drive_frequency;
    for (int i = 0; i < NT_AXES; ++i)
        state->sent[state->ticks % NT_TOUCH_SENT][i] = state->command.motor_force[i];
    state->command.state = (uint32_t)state->supervisor.state;
    state->command.reasons = state->supervisor.reasons;
    ++state->ticks;
    *command = state->command;
}
