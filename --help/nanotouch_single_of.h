/* SPDX-License-Identifier: BSD-3-Clause
 * Made by tools/single.py from nanotouch 0.1.0: do not edit. From double to single precision. */

#ifndef NANOTOUCH_SINGLE_OF_H
#define NANOTOUCH_SINGLE_OF_H

#include "nanotouch/touch.h"
#include "nanotouch_single.h"

static inline ntf_sample ntf_sample_of(const nt_sample *from)
{
    ntf_sample to = {0};
    to.tick = (uint64_t)from->tick;
    to.age = (float)from->age;
    to.master_age = (float)from->master_age;
    to.lateness = (float)from->lateness;
    for (int i = 0; i < NT_AXES; ++i) to.master_position[i] = (float)from->master_position[i];
    for (int i = 0; i < NT_AXES; ++i) to.operator_force[i] = (float)from->operator_force[i];
    for (int i = 0; i < NT_AXES; ++i) to.stage_position[i] = (float)from->stage_position[i];
    for (int i = 0; i < NT_AXES; ++i) to.deflection[i] = (float)from->deflection[i];
    to.flags = (uint32_t)from->flags;
    return to;
}

static inline ntf_command ntf_command_of(const nt_command *from)
{
    ntf_command to = {0};
    for (int i = 0; i < NT_AXES; ++i) to.motor_force[i] = (float)from->motor_force[i];
    for (int i = 0; i < NT_AXES; ++i) to.stage_position[i] = (float)from->stage_position[i];
    to.state = (uint32_t)from->state;
    to.reasons = (uint32_t)from->reasons;
    return to;
}

static inline ntf_probe ntf_probe_of(const nt_probe *from)
{
    ntf_probe to = {0};
    to.spring_constant = (float)from->spring_constant;
    to.tilt = (float)from->tilt;
    to.sensitivity = (float)from->sensitivity;
    to.range = (float)from->range;
    to.noise = (float)from->noise;
    to.resolution = (float)from->resolution;
    to.resonance = (float)from->resonance;
    to.quality = (float)from->quality;
    to.temperature = (float)from->temperature;
    to.contact_viscosity = (float)from->contact_viscosity;
    to.spring_constant_sigma = (float)from->spring_constant_sigma;
    to.sensitivity_sigma = (float)from->sensitivity_sigma;
    to.drift = (float)from->drift;
    to.lateral_stiffness = (float)from->lateral_stiffness;
    return to;
}

static inline ntf_stage ntf_stage_of(const nt_stage *from)
{
    ntf_stage to = {0};
    to.resonance = (float)from->resonance;
    to.quality = (float)from->quality;
    to.stiffness = (float)from->stiffness;
    to.travel = (float)from->travel;
    to.resolution = (float)from->resolution;
    to.command_resolution = (float)from->command_resolution;
    to.max_speed = (float)from->max_speed;
    to.noise = (float)from->noise;
    to.hysteresis = (float)from->hysteresis;
    to.creep = (float)from->creep;
    to.axes = (float)from->axes;
    to.drift = (float)from->drift;
    to.slip = (float)from->slip;
    to.travel_sigma = (float)from->travel_sigma;
    to.position_sigma = (float)from->position_sigma;
    return to;
}

static inline ntf_master ntf_master_of(const nt_master *from)
{
    ntf_master to = {0};
    to.mass = (float)from->mass;
    to.damping = (float)from->damping;
    to.friction = (float)from->friction;
    to.travel = (float)from->travel;
    to.resolution = (float)from->resolution;
    to.max_force = (float)from->max_force;
    to.gauge = (int)from->gauge;
    to.gauge_range = (float)from->gauge_range;
    to.gauge_noise = (float)from->gauge_noise;
    to.gauge_resolution = (float)from->gauge_resolution;
    to.motor = (int)from->motor;
    to.rate = (float)from->rate;
    to.axes = (float)from->axes;
    return to;
}

static inline ntf_hand ntf_hand_of(const nt_hand *from)
{
    ntf_hand to = {0};
    to.mass = (float)from->mass;
    to.damping = (float)from->damping;
    to.stiffness = (float)from->stiffness;
    to.relaxation = (float)from->relaxation;
    to.random_force = (float)from->random_force;
    to.random_rate = (float)from->random_rate;
    return to;
}

static inline ntf_converters ntf_converters_of(const nt_converters *from)
{
    ntf_converters to = {0};
    to.adc_bits = (float)from->adc_bits;
    to.adc_rate = (float)from->adc_rate;
    to.adc_latency = (float)from->adc_latency;
    to.dac_bits = (float)from->dac_bits;
    to.dac_latency = (float)from->dac_latency;
    return to;
}

static inline ntf_rig ntf_rig_of(const nt_rig *from)
{
    ntf_rig to = {0};
    to.probe = ntf_probe_of(&from->probe);
    to.stage = ntf_stage_of(&from->stage);
    to.master = ntf_master_of(&from->master);
    to.hand = ntf_hand_of(&from->hand);
    to.converters = ntf_converters_of(&from->converters);
    return to;
}

static inline ntf_control ntf_control_of(const nt_control *from)
{
    ntf_control to = {0};
    to.choice = (ntf_control_choice)from->choice;
    return to;
}

static inline ntf_gains ntf_gains_of(const nt_gains *from)
{
    ntf_gains to = {0};
    to.rate = (float)from->rate;
    to.alpha_p = (float)from->alpha_p;
    to.alpha_f = (float)from->alpha_f;
    to.alpha_f_approach = (float)from->alpha_f_approach;
    to.alpha_f_retract = (float)from->alpha_f_retract;
    to.force_gain = (float)from->force_gain;
    to.force_filter = (float)from->force_filter;
    to.velocity_feedforward = (float)from->velocity_feedforward;
    to.stage_damping = (float)from->stage_damping;
    to.stage_integral = (float)from->stage_integral;
    to.stage_proportional = (float)from->stage_proportional;
    to.stage_derivative = (float)from->stage_derivative;
    to.coupling_stiffness = (float)from->coupling_stiffness;
    to.coupling_damping = (float)from->coupling_damping;
    to.projection_x = (float)from->projection_x;
    to.projection_y = (float)from->projection_y;
    to.ramp_time = (float)from->ramp_time;
    to.set_point = (float)from->set_point;
    to.height_gain = (float)from->height_gain;
    to.height_stiffness = (float)from->height_stiffness;
    to.approach_speed = (float)from->approach_speed;
    to.curve_length = (float)from->curve_length;
    to.delay = (float)from->delay;
    return to;
}

static inline ntf_limits ntf_limits_of(const nt_limits *from)
{
    ntf_limits to = {0};
    to.force = (float)from->force;
    to.lateral_force = (float)from->lateral_force;
    to.indentation = (float)from->indentation;
    to.stage_speed = (float)from->stage_speed;
    to.lateral_speed = (float)from->lateral_speed;
    to.motor_force = (float)from->motor_force;
    to.motor_rate = (float)from->motor_rate;
    to.motor_power = (float)from->motor_power;
    to.retract_distance = (float)from->retract_distance;
    to.retract_speed = (float)from->retract_speed;
    to.follow_error = (float)from->follow_error;
    to.follow_time = (float)from->follow_time;
    to.deflection_bias = (float)from->deflection_bias;
    to.deflection_drift = (float)from->deflection_drift;
    to.gauge_bias = (float)from->gauge_bias;
    to.gauge_drift = (float)from->gauge_drift;
    return to;
}

static inline ntf_settings ntf_settings_of(const nt_settings *from)
{
    ntf_settings to = {0};
    to.gains = ntf_gains_of(&from->gains);
    to.limits = ntf_limits_of(&from->limits);
    to.control = ntf_control_of(&from->control);
    return to;
}

static inline ntf_scaling ntf_scaling_of(const nt_scaling *from)
{
    ntf_scaling to = {0};
    to.alpha_p = (float)from->alpha_p;
    to.alpha_f = (float)from->alpha_f;
    return to;
}

static inline ntf_rescale ntf_rescale_of(const nt_rescale *from)
{
    ntf_rescale to = {0};
    to.share = (float)from->share;
    to.threshold = (float)from->threshold;
    to.spring_constant = (float)from->spring_constant;
    to.income = (float)from->income;
    to.capacity = (float)from->capacity;
    for (int i = 0; i < 3; ++i) to.factors[i] = (float)from->factors[i];
    return to;
}

static inline ntf_rescale_state ntf_rescale_state_of(const nt_rescale_state *from)
{
    ntf_rescale_state to = {0};
    to.now = ntf_scaling_of(&from->now);
    to.wanted = ntf_scaling_of(&from->wanted);
    to.region = (ntf_region)from->region;
    to.work = (float)from->work;
    to.tank = (ntf_sum)from->tank;
    to.last_position = (float)from->last_position;
    return to;
}

static inline ntf_passivity ntf_passivity_of(const nt_passivity *from)
{
    ntf_passivity to = {0};
    to.dead_zone = (float)from->dead_zone;
    to.due = (float)from->due;
    to.force_gain = (float)from->force_gain;
    to.damping = (float)from->damping;
    to.credit = (float)from->credit;
    to.speed_filter = (float)from->speed_filter;
    to.speed_floor = (float)from->speed_floor;
    to.speed_limit = (float)from->speed_limit;
    to.period = (float)from->period;
    return to;
}

static inline ntf_port ntf_port_of(const nt_port *from)
{
    ntf_port to = {0};
    to.force = (float)from->force;
    to.position = (float)from->position;
    return to;
}

static inline ntf_passivity_state ntf_passivity_state_of(const nt_passivity_state *from)
{
    ntf_passivity_state to = {0};
    to.energy = (ntf_sum)from->energy;
    to.gain = (float)from->gain;
    to.damping = (float)from->damping;
    to.speed = (float)from->speed;
    to.last_hand = ntf_port_of(&from->last_hand);
    to.last_tip = ntf_port_of(&from->last_tip);
    to.trips = (uint32_t)from->trips;
    return to;
}

static inline ntf_stage_loop ntf_stage_loop_of(const nt_stage_loop *from)
{
    ntf_stage_loop to = {0};
    for (int i = 0; i < 3; ++i) to.b[i] = (ntf_sum)from->b[i];
    for (int i = 0; i < 3; ++i) to.a[i] = (ntf_sum)from->a[i];
    to.integral = (ntf_sum)from->integral;
    return to;
}

static inline ntf_stage_loop_state ntf_stage_loop_state_of(const nt_stage_loop_state *from)
{
    ntf_stage_loop_state to = {0};
    for (int i = 0; i < 2; ++i) to.w[i] = (ntf_sum)from->w[i];
    to.correction = (ntf_sum)from->correction;
    return to;
}

static inline ntf_signals ntf_signals_of(const nt_signals *from)
{
    ntf_signals to = {0};
    to.period = (float)from->period;
    to.master_position = (float)from->master_position;
    to.master_speed = (float)from->master_speed;
    to.smooth_speed = (float)from->smooth_speed;
    to.operator_force = (float)from->operator_force;
    to.smooth_force = (float)from->smooth_force;
    to.slave_force = (float)from->slave_force;
    to.felt_force = (float)from->felt_force;
    to.stage_position = (float)from->stage_position;
    to.stage_speed = (float)from->stage_speed;
    to.target = (float)from->target;
    to.scaling = ntf_scaling_of(&from->scaling);
    to.master_damping = (float)from->master_damping;
    to.gain_factor = (float)from->gain_factor;
    return to;
}

static inline ntf_effort ntf_effort_of(const nt_effort *from)
{
    ntf_effort to = {0};
    to.motor_force = (float)from->motor_force;
    to.stage = (float)from->stage;
    return to;
}

static inline ntf_supervisor ntf_supervisor_of(const nt_supervisor *from)
{
    ntf_supervisor to = {0};
    to.master_period = (float)from->master_period;
    to.period = (float)from->period;
    to.spring_constant = (float)from->spring_constant;
    to.lateral_stiffness = (float)from->lateral_stiffness;
    to.deflection_range = (float)from->deflection_range;
    to.free_force = (float)from->free_force;
    to.master_range = (float)from->master_range;
    to.leads_sideways = (int)from->leads_sideways;
    to.gauge_range = (float)from->gauge_range;
    to.stage_range = (float)from->stage_range;
    to.stuck_distance = (float)from->stuck_distance;
    to.noise = (float)from->noise;
    to.stage_share = (float)from->stage_share;
    to.stage_slack = (float)from->stage_slack;
    to.stage_most = (float)from->stage_most;
    to.correction_most = (float)from->correction_most;
    to.turn_slack = (float)from->turn_slack;
    to.lift_share = (float)from->lift_share;
    to.path_kept = (float)from->path_kept;
    to.limits = ntf_limits_of(&from->limits);
    return to;
}

static inline ntf_supervisor_state ntf_supervisor_state_of(const nt_supervisor_state *from)
{
    ntf_supervisor_state to = {0};
    to.state = (ntf_state)from->state;
    to.reasons = (uint32_t)from->reasons;
    to.invalid_run = (uint32_t)from->invalid_run;
    to.law_run = (uint32_t)from->law_run;
    to.late_run = (uint32_t)from->late_run;
    to.late_ticks = (uint32_t)from->late_ticks;
    to.stuck_run = (uint32_t)from->stuck_run;
    to.stuck_deflection = (float)from->stuck_deflection;
    to.stuck_band = (float)from->stuck_band;
    to.noise_samples = (uint32_t)from->noise_samples;
    to.noise_sum = (float)from->noise_sum;
    to.noise = (float)from->noise;
    to.last_deflection = (float)from->last_deflection;
    to.stuck_position = (float)from->stuck_position;
    to.expected = (float)from->expected;
    to.path = (float)from->path;
    to.off_run = (uint32_t)from->off_run;
    to.lift = (ntf_lift)from->lift;
    to.presses = (int)from->presses;
    to.lifts = (int)from->lifts;
    to.reference = (ntf_sum)from->reference;
    to.turn = (float)from->turn;
    to.stopped = (float)from->stopped;
    to.lift_force = (float)from->lift_force;
    to.growth_run = (uint32_t)from->growth_run;
    to.turn_position = (float)from->turn_position;
    to.top_position = (float)from->top_position;
    to.fall_position = (float)from->fall_position;
    to.fall_run = (uint32_t)from->fall_run;
    to.late = (float)from->late;
    to.surface = (float)from->surface;
    to.indentation = (float)from->indentation;
    return to;
}

static inline ntf_situation ntf_situation_of(const nt_situation *from)
{
    ntf_situation to = {0};
    to.reference = (ntf_sum)from->reference;
    to.moves_sideways = (int)from->moves_sideways;
    to.unstable = (int)from->unstable;
    return to;
}

static inline ntf_touch ntf_touch_of(const nt_touch *from)
{
    ntf_touch to = {0};
    to.rig = ntf_rig_of(&from->rig);
    to.settings = ntf_settings_of(&from->settings);
    to.mode = (ntf_mode)from->mode;
    to.period = (float)from->period;
    to.law = ntf_control_law_of(&to.settings.control);
    to.stage_loop = ntf_stage_loop_of(&from->stage_loop);
    to.leads_sideways = (int)from->leads_sideways;
    to.feels_sideways = (int)from->feels_sideways;
    for (int i = 0; i < 2; ++i) for (int j = 0; j < 2; ++j) to.borders[i][j] = (float)from->borders[i][j];
    to.force_filter = (float)from->force_filter;
    to.delay = (uint32_t)from->delay;
    to.speed_filter = (float)from->speed_filter;
    to.stage_step = (float)from->stage_step;
    to.stage_end = (float)from->stage_end;
    to.motor_step = (float)from->motor_step;
    to.spike = (float)from->spike;
    to.passivity = ntf_passivity_of(&from->passivity);
    to.passivity_sideways = ntf_passivity_of(&from->passivity_sideways);
    to.rescale = ntf_rescale_of(&from->rescale);
    to.supervisor = ntf_supervisor_of(&from->supervisor);
    return to;
}

static inline ntf_touch_state ntf_touch_state_of(const nt_touch_state *from)
{
    ntf_touch_state to = {0};
    to.mode = (ntf_mode)from->mode;
    to.wanted_mode = (ntf_mode)from->wanted_mode;
    to.phase = (ntf_phase)from->phase;
    to.turn = (ntf_sum)from->turn;
    to.supervisor = ntf_supervisor_state_of(&from->supervisor);
    to.passivity = ntf_passivity_state_of(&from->passivity);
    for (int i = 0; i < 2; ++i) to.passivity_sideways[i] = ntf_passivity_state_of(&from->passivity_sideways[i]);
    to.rescale = ntf_rescale_state_of(&from->rescale);
    to.stage_loop = ntf_stage_loop_state_of(&from->stage_loop);
    to.signals = ntf_signals_of(&from->signals);
    for (int i = 0; i < 2; ++i) to.deflections[i] = (float)from->deflections[i];
    to.reference = (ntf_sum)from->reference;
    to.offset = (ntf_sum)from->offset;
    to.stretch = (float)from->stretch;
    to.clutch_open = (int)from->clutch_open;
    to.engaged = (ntf_sum)from->engaged;
    to.motor_force = (float)from->motor_force;
    to.coupled_force = (float)from->coupled_force;
    to.retracted = (ntf_sum)from->retracted;
    for (int i = 0; i < 2; ++i) to.hand_at[i] = (float)from->hand_at[i];
    for (int i = 0; i < 2; ++i) to.stage_at[i] = (float)from->stage_at[i];
    for (int i = 0; i < 2; ++i) to.sideways[i] = (float)from->sideways[i];
    for (int i = 0; i < 2; ++i) to.hand_speed[i] = (float)from->hand_speed[i];
    for (int i = 0; i < 2; ++i) to.lateral_force[i] = (float)from->lateral_force[i];
    to.projected_force = (float)from->projected_force;
    for (int i = 0; i < 2; ++i) to.coupled_sideways[i] = (float)from->coupled_sideways[i];
    to.target_x = (float)from->target_x;
    to.target_y = (float)from->target_y;
    to.target_time = (ntf_sum)from->target_time;
    for (int i = 0; i < NT_TOUCH_SENT; ++i) for (int j = 0; j < NT_AXES; ++j) to.sent[i][j] = (float)from->sent[i][j];
    to.command = ntf_command_of(&from->command);
    to.ticks = (uint64_t)from->ticks;
    return to;
}

#endif
