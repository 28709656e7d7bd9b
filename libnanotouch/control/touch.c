/* SPDX-License-Identifier: BSD-3-Clause
 * One control period: supervisor, passivity, motor law, stage reference, stage loop. */
#include <math.h>
#include <stddef.h>

#include "control/servo.h"
#include "nanotouch/material.h"

#define SPEED_BANDWIDTH 20.0 /* of the estimate of the master's speed [Hz]: its position comes in steps */
#define FADE_TIME 0.05       /* outside RUN the force is gone after this [s] */

static double low_pass_factor(double bandwidth, double period)
{
    return -expm1(-2.0 * NT_PI * bandwidth * period);
}

/* No limit may promise more than the rig can keep: beyond saturation no force would be seen. */
static nt_status check_against_rig(const nt_limits *limits, const nt_rig *rig, nt_problem *problem)
{
    const double saturation = rig->probe.spring_constant * nt_probe_deflection_range(&rig->probe);
    const nt_problem promises[] = {
        {"limits.force", "N", limits->force, 0.0, saturation},
        {"limits.stage_speed", "m/s", limits->stage_speed, 0.0, rig->stage.max_speed},
        {"limits.motor_force", "N", limits->motor_force, 0.0, rig->master.max_force},
    };
    for (size_t i = 0; i < sizeof promises / sizeof promises[0]; ++i) {
        if (promises[i].value <= promises[i].maximum)
            continue;
        if (problem)
            *problem = promises[i];
        return NT_E_RANGE;
    }
    return NT_OK;
}

nt_status nt_touch_make(nt_touch *touch, const nt_rig *rig, const nt_settings *settings, nt_mode mode,
                        nt_problem *problem)
{
    nt_status status = nt_rig_check(rig, problem);
    if (status == NT_OK)
        status = nt_settings_check(settings, problem);
    if (status == NT_OK)
        status = check_against_rig(&settings->limits, rig, problem);
    if (status != NT_OK)
        return status;
    if (mode != NT_MODE_TOUCH && mode != NT_MODE_TOPOGRAPHY)
        return NT_E_ARGUMENT;
    const double period = 1.0 / settings->gains.rate;
    nt_touch made = {.rig = *rig,
                     .settings = *settings,
                     .mode = mode,
                     .period = period,
                     .stage_loop = nt_stage_loop_make(&rig->stage, &settings->gains),
                     .force_filter = low_pass_factor(settings->gains.force_filter, period),
                     .speed_filter = low_pass_factor(SPEED_BANDWIDTH, period),
                     .passivity = nt_passivity_make(rig, &settings->gains)};
    *touch = made;
    return NT_OK;
}

nt_touch_state nt_touch_start(const nt_touch *touch, double master_position, double x, double y)
{
    nt_touch_state state = {.passivity = {.gain = 1.0, .last_hand = {.position = master_position}},
                            .last_position = master_position,
                            .target_x = x,
                            .target_y = y,
                            .command = {.x = x, .y = y}};
    state.offset = -touch->settings.gains.alpha_p * master_position; /* the stage begins at 0 */
    state.supervisor.stuck_deflection = NAN;                         /* equal to no sample */
    return state;
}

static void observe(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    const double speed = (sample->master_position - state->last_position) / touch->period;
    state->speed += touch->speed_filter * (speed - state->speed);
    state->last_position = sample->master_position;
    state->filtered_force += touch->force_filter * (sample->operator_force - state->filtered_force);
    if (touch->mode != NT_MODE_TOUCH)
        return; /* the height servo is meant to move the hand */
    const nt_gains *gains = &touch->settings.gains;
    const double slave_force = touch->rig.probe.spring_constant * sample->deflection;
    const nt_port hand = {sample->operator_force, sample->master_position};
    const nt_port tip = {gains->alpha_f * slave_force, sample->stage_position / gains->alpha_p};
    nt_passivity_step(&touch->passivity, &state->passivity, &hand, &tip);
}

/* Moves the reference towards `wanted`, no faster than the stage may go and inside its travel. */
static void move_reference(const nt_touch *touch, nt_touch_state *state, double wanted)
{
    const double step = touch->settings.limits.stage_speed * touch->period;
    const double end = 0.5 * touch->rig.stage.travel;
    double reference = fmin(fmax(wanted, state->reference - step), state->reference + step);
    reference = fmin(fmax(reference, -end), end);
    if (reference != wanted)
        state->supervisor.reasons |= NT_REASON_COMMAND_LIMITED;
    state->reference = reference;
}

/* RUN: the operator moves the stage, or the height servo does; returns the motor force that is wanted. */
static double run(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    const nt_gains *gains = &touch->settings.gains;
    const double slave_force = touch->rig.probe.spring_constant * sample->deflection;
    const double ramp = gains->ramp_time > 0.0 ? touch->period / gains->ramp_time : 1.0;
    state->engaged = fmin(1.0, state->engaged + ramp);
    if (touch->mode == NT_MODE_TOPOGRAPHY) {
        const double error = (gains->set_point - slave_force) / touch->rig.probe.spring_constant;
        move_reference(touch, state, state->reference + gains->height_gain * touch->period * error);
        const double height_position = (state->reference - state->offset) / gains->alpha_p;
        return state->engaged * nt_servo_height(gains, height_position, sample->master_position);
    }
    move_reference(touch, state, gains->alpha_p * sample->master_position + state->offset);
    return state->engaged * nt_servo_force(gains, state->passivity.gain, slave_force, state->filtered_force);
}

/* Not RUN: nothing of the sample is used but what the supervisor found valid; the master is uncoupled. */
static double stop(const nt_touch *touch, nt_touch_state *state, int lift)
{
    const nt_limits *limits = &touch->settings.limits;
    if (lift && state->retracted < limits->retract_distance) {
        const double step = fmin(limits->retract_speed * touch->period, limits->retract_distance - state->retracted);
        state->retracted += step;
        state->reference = fmax(state->reference - step, -0.5 * touch->rig.stage.travel);
    }
    state->offset = state->reference - touch->settings.gains.alpha_p * state->last_position;
    const double engaged = fmax(0.0, state->engaged - touch->period / FADE_TIME);
    if (!(engaged > 0.0))
        return state->engaged = state->coupled_force = 0.0;
    state->coupled_force *= engaged / state->engaged; /* linear in time */
    state->engaged = engaged;
    return nt_servo_fade(&touch->rig.master, state->coupled_force, state->speed);
}

static void move_lateral(const nt_touch *touch, nt_touch_state *state)
{
    const double left = state->target_time;
    const double share = left > touch->period ? touch->period / left : 1.0;
    state->command.x += share * (state->target_x - state->command.x);
    state->command.y += share * (state->target_y - state->command.y);
    state->target_time = fmax(0.0, left - touch->period);
}

/* A read-out that cannot be trusted (not RUN) or that follow_error calls a fault takes no part: the integral stands
 * still. */
static double drive_stage(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample)
{
    const double error = state->reference - sample->stage_position;
    const int trusted = state->supervisor.state == NT_RUN && fabs(error) <= touch->settings.limits.follow_error;
    const double measured = trusted ? sample->stage_position : state->reference;
    const double wanted = nt_stage_loop_step(&touch->stage_loop, &state->stage_loop, state->reference, measured);
    const double end = 0.5 * touch->rig.stage.travel;
    const double command = fmin(fmax(wanted, -end), end);
    if (command != wanted)
        state->supervisor.reasons |= NT_REASON_COMMAND_LIMITED;
    return command;
}

void nt_touch_step(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample, nt_command *command)
{
    const int unstable = touch->mode == NT_MODE_TOUCH && state->passivity.gain < 0.05;
    const nt_state verdict = nt_supervisor_step(touch, &state->supervisor, sample, state->reference, unstable);
    const int valid = state->supervisor.invalid_run == 0;
    if (valid)
        observe(touch, state, sample);
    double motor_force;
    if (verdict == NT_RUN) {
        motor_force = run(touch, state, sample);
        move_lateral(touch, state);
    } else {
        motor_force = stop(touch, state, verdict >= NT_RETRACT);
    }
    state->motor_force = nt_servo_limit(&touch->settings.limits, touch->period, state->motor_force, motor_force);
    if (verdict == NT_RUN)
        state->coupled_force = state->motor_force;
    state->command.stage_position = drive_stage(touch, state, sample);
    state->command.motor_force = state->motor_force;
    state->command.state = (uint32_t)verdict;
    state->command.reasons = state->supervisor.reasons;
    ++state->ticks;
    *command = state->command;
}

nt_status nt_touch_aim(const nt_touch *touch, nt_touch_state *state, double x, double y, double duration)
{
    if (!isfinite(x) || !isfinite(y) || !isfinite(duration))
        return NT_E_NOT_FINITE;
    if (duration < 0.0)
        return NT_E_RANGE;
    const double distance = hypot(x - state->command.x, y - state->command.y);
    state->target_x = x;
    state->target_y = y;
    state->target_time = fmax(duration, distance / touch->settings.limits.lateral_speed);
    return NT_OK;
}

nt_status nt_touch_arm(nt_touch_state *state, int confirmed)
{
    if (state->supervisor.state == NT_LATCHED && !confirmed)
        return NT_E_STATE;
    const double stuck_deflection = state->supervisor.stuck_deflection;
    const nt_supervisor_state fresh = {.state = NT_RUN, .stuck_deflection = stuck_deflection};
    state->supervisor = fresh;
    state->passivity.gain = 1.0;
    state->passivity.energy = 0.0;
    state->retracted = 0.0;
    state->target_x = state->command.x; /* the path that a stop has cut short does not go on by itself */
    state->target_y = state->command.y;
    state->target_time = 0.0;
    return NT_OK;
}
