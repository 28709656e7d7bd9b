/* SPDX-License-Identifier: BSD-3-Clause
 * The simulated rig: hand, master, stage, probe, surface and sensors, one period at a time. Master and stage are exact
 * under the held command, from the moment within the period at which it begins to act; what the sensors read is from
 * the moment that their converters' latency says. */
#include <math.h>
#include <stddef.h>

#include "parts.h"

#define FIRST_CLEAR_DISTANCE 1e-9 /* a rig starts at least this clear of the surface [m] */
#define SUBSTEP 0.25              /* of the dynamic cantilever [rad] */

/* The coarser of a sensor's own step and that of its converter, over +- range. */
static void init_converters(nt_sim *sim)
{
    const nt_rig real = nt_rig_with_steps(&sim->rig);
    const nt_probe *probe = &real.probe;
    const nt_master *master = &real.master;
    const double metres_per_volt = probe->sensitivity;
    sim->deflection_sensor = (nt_sensor){metres_per_volt * probe->noise / 6.0, metres_per_volt * probe->resolution,
                                         nt_probe_deflection_range(probe)};
    sim->stage_sensor = (nt_sensor){real.stage.noise, real.stage.resolution, 0.5 * real.stage.travel};
    sim->master_sensor = (nt_sensor){0.0, master->resolution, 0.5 * master->travel};
    sim->gauge = (nt_sensor){master->gauge_noise, master->gauge_resolution, master->gauge_range};
    sim->command_step = real.stage.command_resolution;
}

/* A command acts after delay and latency; a part of a period splits the period in two. */
static nt_status init_delay(nt_sim *sim, double delay)
{
    const double total = delay + sim->rig.converters.dac_latency / sim->period;
    if (!(total >= 0.0 && total <= NT_SIM_DELAY_MAX) ||
        sim->rig.converters.adc_latency / sim->period > NT_SIM_DELAY_MAX)
        return NT_E_RANGE;
    sim->delay = (int)total;
    sim->fraction = total - sim->delay;
    const double lengths[] = {sim->fraction * sim->period, (1.0 - sim->fraction) * sim->period};
    nt_status status = NT_OK;
    for (int i = 0; i < 2 && status == NT_OK; i++) {
        nt_sim_part *part = &sim->parts[i];
        part->length = lengths[i];
        if (lengths[i] == 0.0)
            continue;
        status = nt_stage_model_init(&part->stage, &sim->rig.stage, lengths[i]);
        if (status == NT_OK)
            status = nt_master_model_init(&part->master, &sim->rig.master, &sim->rig.hand, lengths[i]);
    }
    return status;
}

static nt_status check_setup(const nt_sim_setup *setup)
{
    if (!setup->plan || !setup->rig)
        return NT_E_ARGUMENT;
    if (!isfinite(setup->x) || !isfinite(setup->y) || !isfinite(setup->clearance) ||
        !isfinite(setup->master_position) || !isfinite(setup->period) || !isfinite(setup->delay) ||
        !isfinite(setup->substep))
        return NT_E_NOT_FINITE;
    if (setup->clearance < FIRST_CLEAR_DISTANCE || setup->period <= 0.0 || setup->delay < 0.0 || setup->substep < 0.0)
        return NT_E_RANGE;
    const nt_status status = nt_rig_check(setup->rig, NULL);
    if (status == NT_OK && fabs(setup->master_position) > 0.5 * setup->rig->master.travel)
        return NT_E_RANGE;
    return status;
}

static nt_moment moment_now(const nt_sim *sim)
{
    nt_hand_state hand = sim->hand;
    hand.random_force += nt_sim_push(sim);
    const double force = nt_master_grip_force(&sim->parts[1].master, &sim->master, &hand);
    return (nt_moment){.deflection = sim->cantilever.deflection,
                       .stage_position = sim->stage.position,
                       .master_position = sim->master.position,
                       .operator_force = sim->rig.master.gauge != 0.0 ? force : (double)NAN};
}

static nt_status begin(nt_sim *sim, const nt_sim_setup *setup)
{
    init_converters(sim);
    sim->start_height = nt_sim_surface_height(sim) + setup->clearance;
    sim->cantilever = nt_cantilever_at(setup->clearance);
    sim->truth.gap = NAN; /* nothing is known yet */
    sim->hand.rest = setup->master_position;
    const int is_dynamic =
        setup->probe_model == NT_PROBE_DYNAMIC ||
        (setup->probe_model == NT_PROBE_AUTO && nt_sim_needs_dynamics(sim->plan, &sim->rig, sim->period));
    nt_status status = nt_sim_move_probe(sim); /* at rest, whatever the model */
    sim->dynamic = is_dynamic;
    if (status == NT_OK && is_dynamic)
        status = nt_cantilever_model_init(&sim->cantilever_model, &sim->rig.probe, sim->period,
                                          setup->substep > 0.0 ? setup->substep : SUBSTEP);
    const nt_moment now = moment_now(sim);
    for (int i = 0; i < NT_SIM_SLOTS; ++i) {
        sim->pending[i] = (nt_command){.x = setup->x, .y = setup->y};
        sim->moments[i] = now;
    }
    return status;
}

nt_status nt_sim_init(nt_sim *sim, const nt_sim_setup *setup)
{
    nt_status status = check_setup(setup);
    if (status != NT_OK)
        return status;
    nt_sim made = {.plan = setup->plan,
                   .rig = *setup->rig,
                   .period = setup->period,
                   .x = setup->x,
                   .y = setup->y,
                   .master = {.position = setup->master_position}};
    for (uint32_t i = 0; i < NT_SIM_NOISES; i++)
        made.noise[i] = nt_noise_of(setup->seed, i);
    status = init_delay(&made, setup->delay);
    for (int i = 0; setup->faults && i < setup->faults->count && status == NT_OK; i++)
        status = nt_faults_add(&made.faults, &setup->faults->list[i]);
    if (status == NT_OK)
        status = begin(&made, setup);
    if (status == NT_OK)
        *sim = made;
    return status;
}

static double between(double older, double newer, double share)
{
    return newer + share * (older - newer);
}

/* What there was a latency ago, between two ticks on a straight line. */
static nt_moment moment_before(const nt_sim *sim, double latency)
{
    const double back = latency / sim->period;
    const uint64_t whole = (uint64_t)back;
    const double share = back - (double)whole;
    const uint64_t at = sim->tick + 2u * NT_SIM_SLOTS - whole;
    const nt_moment newer = sim->moments[at % NT_SIM_SLOTS], older = sim->moments[(at - 1u) % NT_SIM_SLOTS];
    return (nt_moment){.deflection = between(older.deflection, newer.deflection, share),
                       .stage_position = between(older.stage_position, newer.stage_position, share),
                       .master_position = between(older.master_position, newer.master_position, share),
                       .operator_force = between(older.operator_force, newer.operator_force, share)};
}

/* Does a conversion end in this tick? */
static int is_converted(const nt_sim *sim)
{
    const double per_tick = sim->rig.converters.adc_rate * sim->period;
    if (sim->tick == 0 || per_tick == 0.0 || per_tick >= 1.0)
        return 1;
    return floor((double)sim->tick * per_tick) > floor((double)(sim->tick - 1u) * per_tick);
}

static double convert(nt_sim *sim, const nt_sensor *sensor, nt_channel channel, double value)
{
    return nt_sensor_read(sensor, value, nt_sim_noise_now(sim, (int)channel));
}

nt_status nt_sim_read(nt_sim *sim, nt_sample *sample)
{
    const double latency = sim->rig.converters.adc_latency;
    sim->moments[sim->tick % NT_SIM_SLOTS] = moment_now(sim);
    if (is_converted(sim)) {
        const nt_moment seen = moment_before(sim, latency);
        sim->converted = (nt_sample){
            .tick = sim->tick,
            .master_position = convert(sim, &sim->master_sensor, NT_CHANNEL_MASTER_POSITION, seen.master_position),
            .operator_force = convert(sim, &sim->gauge, NT_CHANNEL_OPERATOR_FORCE, seen.operator_force),
            .stage_position = convert(sim, &sim->stage_sensor, NT_CHANNEL_STAGE_POSITION, seen.stage_position),
            .deflection = convert(sim, &sim->deflection_sensor, NT_CHANNEL_DEFLECTION, seen.deflection)};
    }
    nt_sample found = sim->converted;
    found.age = latency + (double)(sim->tick - found.tick) * sim->period;
    found.tick = sim->tick;
    found.x = sim->x;
    found.y = sim->y;
    found.flags = sim->flags;
    nt_sim_spoil(sim, &found);
    *sample = found;
    return NT_OK;
}

static double limit(double value, double minimum, double maximum)
{
    return fmin(fmax(value, minimum), maximum);
}

static double in_steps(double value, double step)
{
    return step > 0.0 ? step * round(value / step) : value;
}

/* What the stage's driver makes of a command: travel, slew, steps. */
static double drive_stage(nt_sim *sim, double command, double time)
{
    const nt_stage *stage = &sim->rig.stage;
    const double slew = stage->max_speed * time, half = 0.5 * stage->travel;
    const double reached = limit(command, sim->stage_drive - slew, sim->stage_drive + slew);
    sim->stage_drive = limit(reached, -half, half);
    return in_steps(sim->stage_drive, sim->command_step);
}

static double drive_motor(const nt_sim *sim, double command)
{
    const double most = sim->rig.master.max_force;
    const double force = nt_sim_spoil_motor(sim, command);
    const double bits = sim->rig.converters.dac_bits, step = bits > 0.0 ? most * exp2(1.0 - bits) : 0.0;
    return in_steps(limit(force, -most, most), step);
}

/* How the tip force grows as the stage goes on [N/m]; where it pulls the more, it is the probe that jumps. */
static double tip_stiffness(const nt_sim *sim)
{
    const double k = sim->law.k, spring = sim->rig.probe.spring_constant;
    return k > 0.0 ? spring / (1.0 + spring / k) : 0.0;
}

static void pass_part(nt_sim *sim, nt_sim_part *part, const nt_command *acting)
{
    const double hysteresis = nt_sim_stage_hysteresis(sim);
    if (part->stage.stage.hysteresis == 0.0 && hysteresis > 0.0)
        nt_stage_set_plays(&sim->stage, sim->stage_drive); /* begins without a jump */
    part->stage.stage.hysteresis = hysteresis;
    const double effort = nt_hand_effort(&sim->hand) + nt_sim_push(sim);
    nt_master_step(&part->master, &sim->master, drive_motor(sim, acting->motor_force) + effort, sim->hand.rest);
    const double drive = drive_stage(sim, acting->stage_position, part->length);
    const nt_stage_load load = {sim->truth.tip_force, tip_stiffness(sim)};
    nt_stage_step(&part->stage, &sim->stage, nt_sim_spoil_stage(sim, drive), &load);
    sim->x = acting->x;
    sim->y = acting->y;
}

static nt_status pass_period(nt_sim *sim, const nt_command *command)
{
    sim->pending[sim->tick % NT_SIM_SLOTS] = *command;
    const uint64_t newest = sim->tick + NT_SIM_SLOTS - (uint64_t)sim->delay;
    if (sim->parts[0].length > 0.0)
        pass_part(sim, &sim->parts[0], &sim->pending[(newest - 1u) % NT_SIM_SLOTS]);
    pass_part(sim, &sim->parts[1], &sim->pending[newest % NT_SIM_SLOTS]);
    nt_hand_step(&sim->hand, &sim->rig.hand, sim->master.position, sim->period,
                 nt_sim_noise_now(sim, NT_SIM_NOISE_HAND));
    ++sim->tick;
    return nt_sim_move_probe(sim);
}

nt_status nt_sim_write(nt_sim *sim, const nt_command *command)
{
    if (!isfinite(command->motor_force) || !isfinite(command->stage_position) || !isfinite(command->x) ||
        !isfinite(command->y))
        return NT_E_NOT_FINITE;
    const int lost = nt_sim_lost_periods(sim);
    sim->fault_memory.lateness = lost * sim->period;
    nt_status status = NT_OK;
    for (int i = 0; i < lost && status == NT_OK; i++) {
        const nt_command before = sim->pending[(sim->tick + NT_SIM_SLOTS - 1u) % NT_SIM_SLOTS];
        status = pass_period(sim, &before);
        sim->moments[sim->tick % NT_SIM_SLOTS] = moment_now(sim);
    }
    return status == NT_OK ? pass_period(sim, command) : status;
}

void nt_sim_aim_hand(nt_sim *sim, const nt_hand_target *target)
{
    nt_hand_aim(&sim->hand, target);
}

nt_status nt_sim_inject(nt_sim *sim, const nt_fault *fault)
{
    return nt_faults_add(&sim->faults, fault);
}

static nt_status read_operation(void *context, nt_sample *sample)
{
    return nt_sim_read(context, sample);
}
static nt_status write_operation(void *context, const nt_command *command)
{
    return nt_sim_write(context, command);
}

const nt_hal_backend *nt_sim_backend(void)
{
    static const nt_hal_backend backend = {"sim", NT_HAL_API_VERSION, read_operation, write_operation, NULL};
    return &backend;
}
