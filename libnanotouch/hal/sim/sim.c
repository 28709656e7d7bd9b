/* SPDX-License-Identifier: BSD-3-Clause
 * The simulated rig: hand, master, stage, probe, surface and sensors, one period at a time. Master and stage are exact
 * under the held command; the probe is at rest at every tick (its resonance lies far above the loop). */
#include <math.h>
#include <stddef.h>

#include "nanotouch/sim.h"

#define FIRST_CLEAR_DISTANCE 1e-9 /* a rig starts at least this clear of the surface [m] */

/* What the cantilever asks: the force if the tip stood at z_t, here. The last answer is kept: contact laws are by far
 * the dearest part of a period, and the probe begins each one where it ended the last. */
typedef struct probe_context {
    const nt_plan *plan;
    nt_interaction_state *interaction;
    double surface_height;
    double gap; /* of the last answer [m] */
    nt_law_value law;
} probe_context;

static nt_law_value force_at(void *context, double z_t)
{
    probe_context *probe = context;
    const double gap = z_t - probe->surface_height;
    if (gap != probe->gap) {
        probe->gap = gap;
        probe->law = nt_interaction_eval_gap(probe->plan, probe->interaction, gap);
    }
    return probe->law;
}

static void moved_to(void *context, double z_t)
{
    probe_context *probe = context;
    nt_interaction_advance(probe->plan, probe->interaction, z_t - probe->surface_height);
}

static double surface_height(const nt_sim *sim)
{
    return sim->plan->surface ? nt_surface_eval(sim->plan->surface, sim->x, sim->y).z : 0.0;
}

/* The shortest distance over which the force changes shape: the range of adhesion, or a thousandth of the tip. */
static double force_length(const nt_plan *plan)
{
    const nt_contact *contact = &plan->contact.maugis.contact;
    if (contact->work_of_adhesion > 0.0)
        return contact->work_of_adhesion / contact->cohesive_stress;
    return 1e-3 * contact->radius;
}

/* The law at the gap where the probe came to rest: that of its last question, one Newton step (1e-7 of the length over
 * which the force changes) away. */
static nt_law_value law_at_rest(probe_context *probe, double gap, double length)
{
    const double step = gap - probe->gap;
    if (!(fabs(step) <= 1e-6 * length))
        return nt_interaction_eval_gap(probe->plan, probe->interaction, gap);
    nt_law_value law = probe->law;
    law.U -= law.F * step;
    law.F -= law.k * step;
    return law;
}

static nt_status settle(nt_sim *sim)
{
    probe_context context = {sim->plan, &sim->interaction, surface_height(sim), sim->truth.gap, sim->law};
    const nt_force_field field = {force_at, moved_to, &context, force_length(sim->plan)};
    const double base = sim->start_height - sim->stage.position;
    const nt_status status = nt_cantilever_settle(&sim->cantilever, &sim->rig.probe, &field, base, NULL);
    const double gap = sim->cantilever.tip_height - context.surface_height;
    const nt_law_value law = law_at_rest(&context, gap, field.length);
    sim->law = law;
    nt_truth truth = {.gap = gap,
                      .tip_force = law.F,
                      .contact_radius = law.a,
                      .surface_height = context.surface_height,
                      .tip_height = sim->cantilever.tip_height,
                      .energy = law.U};
    sim->truth = truth;
    return status;
}

static void init_sensors(nt_sim *sim)
{
    const nt_probe *probe = &sim->rig.probe;
    const nt_master *master = &sim->rig.master;
    const double metres_per_volt = probe->sensitivity;
    nt_sensor deflection = {metres_per_volt * probe->noise / 6.0, metres_per_volt * probe->resolution,
                            nt_probe_deflection_range(probe)};
    nt_sensor stage = {0.0, sim->rig.stage.resolution, 0.5 * sim->rig.stage.travel};
    nt_sensor position = {0.0, master->resolution, 0.5 * master->travel};
    nt_sensor gauge = {master->gauge_noise, master->gauge_resolution, master->gauge_range};
    sim->deflection_sensor = deflection;
    sim->stage_sensor = stage;
    sim->master_sensor = position;
    sim->gauge = gauge;
}

nt_status nt_sim_init(nt_sim *sim, const nt_sim_setup *setup)
{
    if (!setup->plan || !setup->rig || setup->delay < 0 || setup->delay > NT_SIM_DELAY_MAX)
        return NT_E_ARGUMENT;
    if (!isfinite(setup->x) || !isfinite(setup->y) || !isfinite(setup->clearance) || !isfinite(setup->master_position))
        return NT_E_NOT_FINITE;
    if (setup->clearance < FIRST_CLEAR_DISTANCE)
        return NT_E_RANGE;
    if (fabs(setup->master_position) > 0.5 * setup->rig->master.travel)
        return NT_E_RANGE;
    nt_sim made = {.plan = setup->plan,
                   .rig = *setup->rig,
                   .period = setup->period,
                   .delay = setup->delay,
                   .random = nt_random_seed(setup->seed),
                   .x = setup->x,
                   .y = setup->y,
                   .master = {.position = setup->master_position}};
    nt_status status = nt_stage_model_init(&made.stage_model, &made.rig.stage, setup->period);
    if (status == NT_OK)
        status = nt_master_model_init(&made.master_model, &made.rig.master, setup->period);
    if (status != NT_OK)
        return status;
    init_sensors(&made);
    made.start_height = surface_height(&made) + setup->clearance;
    made.cantilever = nt_cantilever_at(made.start_height);
    made.truth.gap = NAN; /* nothing is known yet */
    for (int i = 0; i <= NT_SIM_DELAY_MAX; ++i) {
        made.pending[i].x = setup->x;
        made.pending[i].y = setup->y;
    }
    status = settle(&made);
    if (status != NT_OK)
        return status;
    *sim = made;
    return NT_OK;
}

nt_status nt_sim_read(nt_sim *sim, nt_sample *sample)
{
    nt_sample found = {
        .tick = sim->tick,
        .age = 0.0,
        .master_position = nt_sensor_read(&sim->master_sensor, sim->master.position, &sim->random),
        .operator_force = nt_sensor_read(&sim->gauge, nt_hand_now(&sim->hand).force, &sim->random),
        .stage_position = nt_sensor_read(&sim->stage_sensor, sim->stage.position, &sim->random),
        .deflection = nt_sensor_read(&sim->deflection_sensor, sim->cantilever.deflection, &sim->random),
        .x = sim->x,
        .y = sim->y,
        .flags = sim->flags,
    };
    *sample = found;
    return NT_OK;
}

static double limit(double value, double minimum, double maximum)
{
    return fmin(fmax(value, minimum), maximum);
}

/* What the stage's driver makes of a command: travel, slew, steps. */
static double drive_stage(nt_sim *sim, double command)
{
    const nt_stage *stage = &sim->rig.stage;
    const double slew = stage->max_speed * sim->period;
    const double reached = limit(command, sim->stage_drive - slew, sim->stage_drive + slew);
    sim->stage_drive = limit(reached, -0.5 * stage->travel, 0.5 * stage->travel);
    const double step = stage->command_resolution;
    return step > 0.0 ? step * round(sim->stage_drive / step) : sim->stage_drive;
}

nt_status nt_sim_write(nt_sim *sim, const nt_command *command)
{
    if (!isfinite(command->motor_force) || !isfinite(command->stage_position) || !isfinite(command->x) ||
        !isfinite(command->y))
        return NT_E_NOT_FINITE;
    const uint64_t slots = (uint64_t)sim->delay + 1u;
    sim->pending[sim->tick % slots] = *command;
    const nt_command *acting = &sim->pending[(sim->tick + 1u) % slots]; /* the oldest; this one if delay is 0 */
    const double motor_force = limit(acting->motor_force, -sim->rig.master.max_force, sim->rig.master.max_force);
    nt_master_step(&sim->master_model, &sim->master, motor_force + nt_hand_now(&sim->hand).force);
    nt_hand_step(&sim->hand, sim->period);
    nt_stage_step(&sim->stage_model, &sim->stage, drive_stage(sim, acting->stage_position), sim->truth.tip_force);
    sim->x = acting->x;
    sim->y = acting->y;
    ++sim->tick;
    return settle(sim);
}

void nt_sim_aim_hand(nt_sim *sim, const nt_hand_target *target)
{
    nt_hand_aim(&sim->hand, target);
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
