/* SPDX-License-Identifier: BSD-3-Clause
 * The simulated rig: its two halves as backends, and both by hand as one rig. */
#include "nanotouch/advanced/sim.h"
#include "hal/hal.h"
#include "hal/sim/sim.h"

#include <math.h>
#include <stddef.h>

static nt_status open_master(void *context, const nt_host *host, nt_problem *problem)
{
    (void)problem;
    ((nt_sim_master *)context)->link.host = host;
    return NT_OK;
}

static nt_status open_slave(void *context, const nt_host *host, nt_problem *problem)
{
    (void)problem;
    ((nt_sim_slave *)context)->link.host = host;
    return NT_OK;
}

static void list_channels(const nt_sim_link *link, nt_capabilities *capabilities)
{
    capabilities->channels = link->channels;
    capabilities->rows = link->channel_count;
}

static nt_status describe_master(void *context, nt_capabilities *capabilities)
{
    const nt_master *master = &((nt_sim_master *)context)->link.rig.master;
    capabilities->can = (master->motor ? NT_CAN_PUSH : 0u) | (master->gauge ? NT_CAN_FEEL : 0u);
    capabilities->axes = (int)master->axes;
    capabilities->period = master->rate > 0.0 ? 1.0 / master->rate : 0.0;
    list_channels(&((nt_sim_master *)context)->link, capabilities);
    return NT_OK;
}

static nt_status describe_slave(void *context, nt_capabilities *capabilities)
{
    capabilities->can = NT_CAN_FEEL | (((nt_sim_slave *)context)->tap.is_there ? NT_CAN_TAP : 0u);
    capabilities->axes = (int)((nt_sim_slave *)context)->link.rig.stage.axes;
    list_channels(&((nt_sim_slave *)context)->link, capabilities);
    return NT_OK;
}

static nt_status read_master(void *context, nt_reading *reading)
{
    return nt_sim_master_read(context, reading);
}
static nt_status write_master(void *context, const nt_action *action)
{
    return nt_sim_master_write(context, action);
}
static nt_status read_slave(void *context, nt_reading *reading)
{
    return nt_sim_slave_read(context, reading);
}
static nt_status write_slave(void *context, const nt_action *action)
{
    return nt_sim_slave_write(context, action);
}

/* What is driven goes to its safe value as soon as a command acts: no force, the stage drawn back. */
static void disarm_master(void *context)
{
    nt_sim_master *master = context;
    for (int i = 0; i < NT_SIM_SLOTS; i++)
        for (int axis = 0; axis < NT_AXES; axis++)
            master->pending[i][axis] = 0.0;
}
static void disarm_slave(void *context)
{
    nt_sim_slave *slave = context;
    for (int i = 0; i < NT_SIM_SLOTS; i++)
        slave->pending[i][NT_Z] = -0.5 * slave->link.rig.stage.travel;
    slave->tap.lever.strength = 0.0;
}

const nt_backend *nt_sim_master_backend(void)
{
    static const nt_backend backend = {.size = sizeof backend,
                                       .version = NT_HAL_API_VERSION,
                                       .name = "sim",
                                       .half = NT_HALF_MASTER,
                                       .open = open_master,
                                       .describe = describe_master,
                                       .read = read_master,
                                       .write = write_master,
                                       .disarm = disarm_master};
    return &backend;
}

const nt_backend *nt_sim_slave_backend(void)
{
    static const nt_backend backend = {.size = sizeof backend,
                                       .version = NT_HAL_API_VERSION,
                                       .name = "sim",
                                       .half = NT_HALF_SLAVE,
                                       .open = open_slave,
                                       .describe = describe_slave,
                                       .read = read_slave,
                                       .write = write_slave,
                                       .disarm = disarm_slave};
    return &backend;
}

nt_status nt_sim_init(nt_sim *sim, const nt_sim_setup *setup)
{
    nt_status status = nt_sim_master_init(&sim->master, setup);
    if (status == NT_OK)
        status = nt_sim_slave_init(&sim->slave, setup);
    return status;
}

nt_status nt_sim_read(nt_sim *sim, nt_sample *sample)
{
    nt_hal master = {.backend = nt_sim_master_backend(), .context = &sim->master, .is_model = 1};
    nt_hal slave = {.backend = nt_sim_slave_backend(), .context = &sim->slave, .is_model = 1};
    const nt_sim_link *link = &sim->slave.link;
    const int64_t now = llround((double)link->tick * link->period * 1e9);
    return nt_hal_sample(&master, &slave, link->tick, now, sample);
}

nt_status nt_sim_write(nt_sim *sim, const nt_command *command)
{
    for (int i = 0; i < NT_AXES; i++)
        if (!isfinite(command->motor_force[i]) || !isfinite(command->stage_position[i]))
            return NT_E_NOT_FINITE;
    nt_hal master = {.backend = nt_sim_master_backend(), .context = &sim->master, .is_model = 1};
    nt_hal slave = {.backend = nt_sim_slave_backend(), .context = &sim->slave, .is_model = 1};
    nt_action action = {.size = sizeof action, .tick = sim->slave.link.tick};
    return nt_hal_command(&master, &slave, command, &action);
}

nt_status nt_sim_inject(nt_sim *sim, const nt_fault *fault)
{
    const nt_status status = nt_faults_add(&sim->master.link.faults, fault);
    return status == NT_OK ? nt_faults_add(&sim->slave.link.faults, fault) : status;
}
