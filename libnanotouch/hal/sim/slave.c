/* SPDX-License-Identifier: BSD-3-Clause
 * The simulated slave: stage, probe, surface and their sensors. The stage is exact under the held command, from the
 * moment within the period at which it begins to act; what the sensors read is from the moment that their converters'
 * latency says. */
#include <math.h>
#include <stddef.h>

#include "core/axes.h"
#include "core/clamp.h"
#include "core/rig.h"
#include "dynamics/dynamics.h"
#include "hal/sim/sim.h"
#include "internal/rig.h"
#include "parts.h"

#define SUBSTEP 0.25 /* of the dynamic cantilever [rad] */

/* The coarser of a sensor's own step and that of its converter, over +- range. */
static void init_sensors(nt_sim_slave *slave)
{
    const nt_rig real = nt_rig_with_steps(&slave->link.rig);
    const nt_probe *probe = &real.probe;
    const double metres_per_volt = probe->sensitivity;
    slave->deflection_sensor = (nt_sensor){metres_per_volt * probe->noise / 6.0, metres_per_volt * probe->resolution,
                                           nt_probe_deflection_range(probe)};
    slave->stage_sensor = (nt_sensor){real.stage.noise, real.stage.resolution, 0.5 * real.stage.travel};
    slave->command_step = real.stage.command_resolution;
}

static nt_status init_models(nt_sim_slave *slave)
{
    const nt_sim_link *link = &slave->link;
    const double lengths[] = {link->fraction * link->period, (1.0 - link->fraction) * link->period};
    nt_status status = NT_OK;
    for (int i = 0; i < 2 && status == NT_OK; i++)
        if (lengths[i] > 0.0)
            status = nt_stage_model_init(&slave->models[i], &link->rig.stage, lengths[i]);
    return status;
}

static void moment_now(const nt_sim_slave *slave, double moment[2])
{
    moment[0] = slave->stage.position;
    moment[1] = slave->cantilever.deflection;
}

static int is_dynamic(const nt_sim_slave *slave, nt_probe_model model)
{
    if (slave->pushed.laws.kind != NT_PUSHED_NOTHING || slave->plan->history == NT_HISTORY_RELAXES)
        return 0;
    return model == NT_PROBE_DYNAMIC ||
           (model == NT_PROBE_AUTO && nt_sim_needs_dynamics(slave->plan, &slave->link.rig, slave->link.period));
}

static nt_status begin(nt_sim_slave *slave, const nt_sim_setup *setup)
{
    init_sensors(slave);
    const nt_status tap = nt_sim_tap_init(slave, setup->lock_in);
    if (tap != NT_OK)
        return tap;
    nt_sim_list_slave(slave);
    for (int i = 0; i < NT_AXES; i++)
        slave->converted.position[i] = slave->converted.felt[i] = NAN;
    slave->converted.amplitude = slave->converted.lag = NAN;
    slave->start_height = nt_sim_surface_height(slave) + setup->clearance;
    slave->cantilever = nt_cantilever_at(setup->clearance);
    slave->place_x = slave->law_gap = NAN;       /* nothing is known yet */
    nt_status status = nt_sim_move_probe(slave); /* at rest, whatever the model */
    slave->dynamic = is_dynamic(slave, setup->probe_model);
    if (status == NT_OK && slave->dynamic)
        status = nt_cantilever_model_init(&slave->cantilever_model, &slave->link.rig.probe, slave->link.period,
                                          setup->substep > 0.0 ? setup->substep : SUBSTEP);
    double now[2];
    moment_now(slave, now);
    for (int i = 0; i < NT_SIM_SLOTS; ++i) {
        slave->pending[i][NT_X] = setup->x;
        slave->pending[i][NT_Y] = setup->y;
        slave->moments[i][0] = now[0];
        slave->moments[i][1] = now[1];
    }
    return status;
}

nt_status nt_sim_slave_init(nt_sim_slave *slave, const nt_sim_setup *setup)
{
    nt_status status = nt_sim_check_setup(setup);
    if (status != NT_OK)
        return status;
    const nt_plan *plan = setup->plan;
    if (plan->history == NT_HISTORY_RELAXES && setup->probe_model == NT_PROBE_DYNAMIC)
        return NT_E_UNSUPPORTED;
    if (plan->history == NT_HISTORY_RELAXES && plan->relaxation.bed.period != setup->period)
        return NT_E_ARGUMENT;
    nt_sim_slave made = {.plan = setup->plan, .x = setup->x, .y = setup->y};
    status = nt_sim_link_init(&made.link, setup, 0.0);
    if (status == NT_OK)
        status = init_models(&made);
    if (status == NT_OK)
        status = nt_sim_begin_pushed(&made, setup);
    if (status == NT_OK)
        status = begin(&made, setup);
    if (status == NT_OK)
        *slave = made;
    return status;
}

/* What a lever that gives way sideways shows of the force on its tip; as it is, without noise. */
static void read_sideways(const nt_sim_slave *slave, nt_reading *reading)
{
    const double stiffness = slave->link.rig.probe.lateral_stiffness;
    for (int i = NT_X; i < NT_Z && stiffness > 0.0; i++)
        reading->felt[i] = slave->truth.tip_force[i] / stiffness;
}

/* Amplitude and lag of the lever in this tick. */
static void keep_swing(const nt_sim_tap *tap, double moment[2])
{
    moment[0] = tap->amplitude;
    moment[1] = tap->lag;
}

nt_status nt_sim_slave_read(nt_sim_slave *slave, nt_reading *reading)
{
    nt_sim_link *link = &slave->link;
    moment_now(slave, slave->moments[link->tick % NT_SIM_SLOTS]);
    nt_reading *converted = &slave->converted;
    if (slave->tap.is_there)
        keep_swing(&slave->tap, slave->tap.moments[link->tick % NT_SIM_SLOTS]);
    if (nt_sim_is_converted(link)) {
        if (slave->tap.is_there)
            nt_sim_tap_read(slave, converted);
        double seen[2];
        nt_sim_moment_before(link, slave->moments, seen);
        converted->position[NT_Z] = nt_sim_sense(link, &slave->stage_sensor, NT_CHANNEL_STAGE_POSITION, seen[0]);
        converted->felt[NT_Z] = nt_sim_sense(link, &slave->deflection_sensor, NT_CHANNEL_DEFLECTION, seen[1]);
        link->converted = link->tick;
    }
    *reading = *converted;
    if (link->rig.stage.axes > 1.0) {
        reading->position[NT_X] = slave->x;
        reading->position[NT_Y] = slave->y;
    }
    read_sideways(slave, reading);
    nt_sim_give(link, &(nt_sim_sensors){NT_HALF_SLAVE, &slave->stage_sensor, &slave->deflection_sensor}, reading);
    return NT_OK;
}

/* What the stage's driver makes of a command: travel, slew, steps. */
static double drive_stage(nt_sim_slave *slave, double command, double time)
{
    const nt_stage *stage = &slave->link.rig.stage;
    const double slew = stage->max_speed * time, half = 0.5 * stage->travel;
    const double reached = clamp(command, slave->stage_drive - slew, slave->stage_drive + slew);
    slave->stage_drive = clamp(reached, -half, half);
    return nt_sim_in_steps(slave->stage_drive, slave->command_step);
}

/* How the tip force grows as the stage goes on [N/m]; where it pulls the more, it is the probe that jumps. */
static double tip_stiffness(const nt_sim_slave *slave)
{
    const double k = slave->law.k, spring = slave->link.rig.probe.spring_constant;
    return k > 0.0 ? spring / (1.0 + spring / k) : 0.0;
}

/* A ceramic that ages keeps its place: only what it does from here on differs. */
static void follow_hysteresis(nt_sim_slave *slave)
{
    const double hysteresis = nt_sim_stage_hysteresis(&slave->link);
    nt_stage_model *first = &slave->models[slave->models[0].period > 0.0 ? 0 : 1];
    if (first->stage.hysteresis == hysteresis)
        return;
    nt_stage_set_hysteresis(first, &slave->stage, hysteresis, slave->driven);
    for (int part = 0; part < 2; part++)
        slave->models[part].stage.hysteresis = hysteresis;
}

static void move_stage(nt_sim_slave *slave, nt_stage_model *model, const double *command)
{
    follow_hysteresis(slave);
    const double drive = drive_stage(slave, command[NT_Z], model->period);
    const nt_stage_load load = {slave->truth.tip_force[NT_Z], tip_stiffness(slave)};
    nt_stage_step(model, &slave->stage, nt_sim_spoil_stage(slave, drive, model->period), &load);
    if (slave->link.rig.stage.axes > 1.0) {
        slave->x = command[NT_X];
        slave->y = command[NT_Y];
    }
}

static nt_status pass_period(nt_sim_slave *slave, const double *target)
{
    nt_sim_link *link = &slave->link;
    copy_axes(slave->pending[link->tick % NT_SIM_SLOTS], target);
    for (int part = 0; part < 2; part++)
        if (slave->models[part].period > 0.0)
            move_stage(slave, &slave->models[part], nt_sim_acting(link, slave->pending, part));
    ++link->tick;
    return nt_sim_move_probe(slave);
}

nt_status nt_sim_slave_write(nt_sim_slave *slave, const nt_action *action)
{
    if (!nt_sim_is_finite(action))
        return NT_E_NOT_FINITE;
    const nt_status driven =
        slave->tap.is_there ? nt_sim_tap_drive(slave, action->drive_amplitude, action->drive_frequency) : NT_OK;
    if (driven != NT_OK)
        return driven;
    nt_sim_link *link = &slave->link;
    const int lost = nt_sim_lost_periods(link);
    link->lateness = lost * link->period;
    nt_status status = NT_OK;
    for (int i = 0; i < lost && status == NT_OK; i++) {
        double before[NT_AXES];
        copy_axes(before, slave->pending[(link->tick + NT_SIM_SLOTS - 1u) % NT_SIM_SLOTS]);
        status = pass_period(slave, before);
        moment_now(slave, slave->moments[link->tick % NT_SIM_SLOTS]);
    }
    return status == NT_OK ? pass_period(slave, action->target) : status;
}
