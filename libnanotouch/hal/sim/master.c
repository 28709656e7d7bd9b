/* SPDX-License-Identifier: BSD-3-Clause
 * The simulated master: the hand, the arm that it holds, its gauge. The arm is exact under the held command, from the
 * moment within the period at which it begins to act; what the sensors read is from the moment that their converters'
 * latency says. The hand moves the arm by force (Eq. 12), or holds it where it will: then the arm follows the hand's
 * position, whatever the motor does. */
#include <math.h>
#include <stddef.h>

#include "core/axes.h"
#include "core/clamp.h"
#include "core/same_bits.h"
#include "dynamics/dynamics.h"
#include "hal/sim/sim.h"
#include "internal/rig.h"
#include "parts.h"

static void init_sensors(nt_sim_master *master)
{
    const nt_rig real = nt_rig_with_steps(&master->link.rig);
    const nt_master *arm = &real.master;
    master->position_sensor = (nt_sensor){0.0, arm->resolution, 0.5 * arm->travel};
    master->gauge = (nt_sensor){arm->gauge_noise, arm->gauge_resolution, arm->gauge_range};
    const double bits = real.converters.dac_bits;
    master->motor_step = bits > 0.0 ? arm->max_force * power_of_two(1.0 - bits) : 0.0;
}

/* A command acts after delay and latency; a part of a period splits the period in two. */
static nt_status init_models(nt_sim_master *master)
{
    const nt_sim_link *link = &master->link;
    const double lengths[] = {link->fraction * link->period, (1.0 - link->fraction) * link->period};
    nt_status status = NT_OK;
    for (int i = 0; i < 2 && status == NT_OK; i++)
        if (lengths[i] > 0.0)
            status = nt_master_model_init(&master->models[i], &link->rig.master, &link->rig.hand, lengths[i]);
    return status;
}

static double effort_of(const nt_sim_master *master)
{
    return nt_hand_effort(&master->hand) + nt_sim_push(&master->link);
}

/* Position and grip force along NT_Z, as they are. */
static void moment_now(const nt_sim_master *master, double moment[2])
{
    const nt_master_state *arm = &master->arm[NT_Z];
    const int measures = master->link.rig.master.gauge;
    moment[0] = arm->position;
    moment[1] =
        measures ? nt_master_grip_force(&master->models[1], arm, effort_of(master), master->hand.rest) : (double)NAN;
}

nt_status nt_sim_master_init(nt_sim_master *master, const nt_sim_setup *setup)
{
    nt_status status = nt_sim_check_setup(setup);
    if (status != NT_OK)
        return status;
    nt_sim_master made = {.arm[NT_Z].position = setup->master_position, .hand.rest = setup->master_position};
    status = nt_sim_link_init(&made.link, setup, setup->rig->master.rate);
    if (status == NT_OK)
        status = init_models(&made);
    if (status != NT_OK)
        return status;
    init_sensors(&made);
    nt_sim_list_master(&made);
    for (int i = 0; i < NT_AXES; i++)
        made.converted.position[i] = made.converted.felt[i] = NAN;
    double now[2];
    moment_now(&made, now);
    for (int i = 0; i < NT_SIM_SLOTS; ++i) {
        made.moments[i][0] = now[0];
        made.moments[i][1] = now[1];
    }
    *master = made;
    return NT_OK;
}

nt_status nt_sim_master_read(nt_sim_master *master, nt_reading *reading)
{
    nt_sim_link *link = &master->link;
    moment_now(master, master->moments[link->tick % NT_SIM_SLOTS]);
    nt_reading *converted = &master->converted;
    if (nt_sim_is_converted(link)) {
        double seen[2];
        nt_sim_moment_before(link, master->moments, seen);
        converted->position[NT_Z] = nt_sim_sense(link, &master->position_sensor, NT_CHANNEL_MASTER_POSITION, seen[0]);
        converted->felt[NT_Z] = nt_sim_sense(link, &master->gauge, NT_CHANNEL_OPERATOR_FORCE, seen[1]);
        for (int i = NT_X; i < NT_Z && link->rig.master.axes > 1.0; i++) /* sideways it is read as it is */
            converted->position[i] = master->arm[i].position;
        link->converted = link->tick;
    }
    *reading = *converted;
    nt_sim_give(link, &(nt_sim_sensors){NT_HALF_MASTER, &master->position_sensor, &master->gauge}, reading);
    return NT_OK;
}

/* Without a motor nothing comes of a command. */
static double drive_motor(const nt_sim_master *master, double command)
{
    const nt_master *arm = &master->link.rig.master;
    if (!arm->motor)
        return 0.0;
    const double force = nt_sim_spoil_motor(&master->link, command);
    return nt_sim_in_steps(clamp(force, -arm->max_force, arm->max_force), master->motor_step);
}

static void push_arm(nt_sim_master *master, const nt_master_model *model, const double *motor_force)
{
    const double motor = drive_motor(master, motor_force[NT_Z]);
    nt_master_step(model, &master->arm[NT_Z], motor + effort_of(master), master->hand.rest);
    if (!(master->link.rig.master.axes > 1.0))
        return;
    const nt_hand_target hand = nt_hand_now(&master->hand);
    for (int i = NT_X; i < NT_Z; i++)
        nt_master_step(model, &master->arm[i], drive_motor(master, motor_force[i]) + hand.force[i], 0.0);
}

/* Where the hand holds it at the end of the period, within its travel. */
static void hold_arm(nt_sim_master *master)
{
    const double period = master->link.period, stop = 0.5 * master->link.rig.master.travel;
    nt_hand_state later = master->hand;
    later.elapsed += period;
    const nt_hand_target hand = nt_hand_now(&later);
    for (int i = 0; i < NT_AXES; i++) {
        nt_master_state *arm = &master->arm[i];
        const double position = clamp(hand.position[i], -stop, stop);
        const double speed = (position - arm->position) / period;
        *arm = (nt_master_state){position, speed, (speed - arm->speed) / period};
    }
    master->hand.rest = master->arm[NT_Z].position;
}

static void pass_period(nt_sim_master *master, const double *target)
{
    nt_sim_link *link = &master->link;
    copy_axes(master->pending[link->tick % NT_SIM_SLOTS], target);
    for (int part = 0; part < 2 && !master->hand.to.holds; part++)
        if (master->models[part].period > 0.0)
            push_arm(master, &master->models[part], nt_sim_acting(link, master->pending, part));
    if (master->hand.to.holds)
        hold_arm(master);
    nt_hand_step(&master->hand, &link->rig.hand, master->arm[NT_Z].position, link->period,
                 nt_sim_noise_now(link, NT_SIM_NOISE_HAND));
    ++link->tick;
}

nt_status nt_sim_master_write(nt_sim_master *master, const nt_action *action)
{
    if (!nt_sim_is_finite(action))
        return NT_E_NOT_FINITE;
    nt_sim_link *link = &master->link;
    const int lost = nt_sim_lost_periods(link);
    link->lateness = lost * link->period;
    for (int i = 0; i < lost; i++) {
        double before[NT_AXES];
        copy_axes(before, master->pending[(link->tick + NT_SIM_SLOTS - 1u) % NT_SIM_SLOTS]);
        pass_period(master, before);
        moment_now(master, master->moments[link->tick % NT_SIM_SLOTS]);
    }
    pass_period(master, action->target);
    return NT_OK;
}

void nt_sim_aim_hand(nt_sim_master *master, const nt_hand_target *target)
{
    const int held = master->hand.to.holds;
    nt_hand_aim(&master->hand, target);
    for (int i = 0; i < NT_AXES && !held; i++) /* takes hold where the arm is */
        master->hand.from.position[i] = master->arm[i].position;
}
