/* SPDX-License-Identifier: BSD-3-Clause
 * Composes plan, simulated rig, touch step and ring; the heap is used in open only. */
#include "nanotouch/session.h"

#include <math.h>
#include <stdlib.h>

#include "core/ring.h"

struct nt_session {
    nt_plan plan;
    nt_touch touch;
    nt_touch_state touch_state;
    double master_start; /* [m] */
    nt_margins margins;
    nt_sim sim;
    nt_hal hal;
    nt_mailbox mailbox;
    nt_input mailbox_memory[3];
    nt_ring ring;
    nt_record *records;
};

nt_session_setup nt_session_defaults(void)
{
    const nt_rig rig = nt_rig_defaults();
    nt_session_setup setup = {.scene = nt_scene_defaults(),
                              .rig = rig,
                              .demand = nt_demand_defaults(),
                              .settings = nt_settings_defaults(&rig),
                              .mode = NT_MODE_TOUCH,
                              .clearance = 0.1e-6,
                              .seed = 1,
                              .ring_capacity = 65536,
                              .minimum_margin = 1.5};
    return setup;
}

static nt_status refuse(nt_problem *problem, const char *field, const char *unit, double value, double minimum,
                        double maximum)
{
    if (problem) {
        nt_problem found = {.field = field, .unit = unit, .value = value, .minimum = minimum, .maximum = maximum};
        *problem = found;
    }
    return isfinite(value) ? NT_E_RANGE : NT_E_NOT_FINITE;
}

/* Numbers of the setup that no other check sees; rig and settings have been checked. */
static nt_status check_setup(const nt_session_setup *setup, nt_problem *problem)
{
    if (setup->settings.gains.delay > NT_SIM_DELAY_MAX)
        return refuse(problem, "gains.delay", "periods", setup->settings.gains.delay, 0.0, NT_SIM_DELAY_MAX);
    if (!(setup->clearance >= 1e-9 && setup->clearance <= 1e-3))
        return refuse(problem, "clearance", "m", setup->clearance, 1e-9, 1e-3);
    if (setup->ring_capacity < 2 || setup->ring_capacity > 1L << 26)
        return refuse(problem, "ring_capacity", "", (double)setup->ring_capacity, 2.0, 67108864.0);
    const double climb = setup->settings.gains.alpha_p * 0.8 * setup->rig.master.travel;
    if (!(setup->rise >= 0.0 && setup->rise <= setup->clearance + climb))
        return refuse(problem, "rise", "m", setup->rise, 0.0, setup->clearance + climb);
    if (!isfinite(setup->x))
        return refuse(problem, "x", "m", setup->x, -1.0, 1.0);
    if (!isfinite(setup->y))
        return refuse(problem, "y", "m", setup->y, -1.0, 1.0);
    if (setup->surface && !nt_surface_contains(setup->surface, setup->x, setup->y)) {
        const nt_surface *surface = setup->surface;
        const double width = (double)(surface->nx - 1) * surface->dx;
        if (setup->x < 0.0 || setup->x > width)
            return refuse(problem, "x", "m", setup->x, 0.0, width);
        return refuse(problem, "y", "m", setup->y, 0.0, (double)(surface->ny - 1) * surface->dy);
    }
    return NT_OK;
}

/* Room to press, and room to draw back: a margin, and what the surface rises above the clearance. */
static double master_start(const nt_session_setup *setup)
{
    const double climb = fmax(0.0, setup->rise - setup->clearance) / setup->settings.gains.alpha_p;
    return -0.4 * setup->rig.master.travel + climb;
}

static nt_status make_sim(nt_session *session, const nt_session_setup *setup)
{
    const nt_sim_setup sim = {.plan = &session->plan,
                              .rig = &session->touch.rig,
                              .period = session->touch.period,
                              .x = setup->x,
                              .y = setup->y,
                              .clearance = setup->clearance,
                              .master_position = master_start(setup),
                              .seed = setup->seed,
                              .delay = (int)ceil(setup->settings.gains.delay)};
    const nt_status status = nt_sim_init(&session->sim, &sim);
    return status == NT_OK ? nt_hal_open(&session->hal, nt_sim_backend(), &session->sim) : status;
}

static nt_status compose(nt_session *session, const nt_session_setup *setup, nt_problem *problem)
{
    nt_demand demand = setup->demand;
    demand.maximum_load = setup->settings.limits.force;
    nt_status status = nt_touch_make(&session->touch, &setup->rig, &setup->settings, setup->mode, problem);
    if (status == NT_OK)
        status = nt_plan_make(&session->plan, &setup->scene, &demand, setup->surface, problem);
    if (status != NT_OK)
        return status;
    session->margins = nt_margins_compute(&setup->rig, &setup->settings.gains, session->plan.maximum_stiffness);
    const int touching = setup->mode == NT_MODE_TOUCH;
    const double margin = touching ? session->margins.margin : session->margins.height_margin;
    if (!(margin >= setup->minimum_margin))
        return refuse(problem, "stability margin", "", margin, setup->minimum_margin, INFINITY);
    status = make_sim(session, setup);
    if (status != NT_OK)
        return status;
    session->touch_state = nt_touch_start(&session->touch, session->sim.master.position, setup->x, setup->y);
    session->master_start = session->sim.master.position;
    nt_mailbox_init(&session->mailbox, session->mailbox_memory, sizeof(nt_input));
    return NT_OK;
}

nt_status nt_session_open(nt_session **session, const nt_session_setup *setup, nt_problem *problem)
{
    if (!session || !setup)
        return NT_E_ARGUMENT;
    nt_status status = nt_rig_check(&setup->rig, problem);
    if (status == NT_OK)
        status = nt_settings_check(&setup->settings, problem);
    if (status == NT_OK)
        status = check_setup(setup, problem);
    if (status != NT_OK)
        return status;
    size_t capacity = 2;
    while (capacity < (size_t)setup->ring_capacity)
        capacity *= 2;
    nt_session *made = calloc(1, sizeof *made);
    if (!made)
        return NT_E_NO_MEMORY;
    made->records = calloc(capacity, sizeof *made->records);
    if (!made->records)
        status = NT_E_NO_MEMORY;
    if (status == NT_OK)
        status = nt_ring_init(&made->ring, made->records, sizeof(nt_record), capacity);
    if (status == NT_OK)
        status = compose(made, setup, problem);
    if (status != NT_OK) {
        nt_session_close(made);
        return status;
    }
    *session = made;
    return NT_OK;
}

void nt_session_close(nt_session *session)
{
    if (!session)
        return;
    nt_hal_close(&session->hal);
    free(session->records);
    free(session);
}

nt_status nt_session_aim(nt_session *session, const nt_input *input)
{
    if (!isfinite(input->operator_force) || !isfinite(input->x) || !isfinite(input->y) || !isfinite(input->duration))
        return NT_E_NOT_FINITE;
    if (input->duration < 0.0)
        return NT_E_RANGE;
    if (session->plan.surface && !nt_surface_contains(session->plan.surface, input->x, input->y))
        return NT_E_RANGE;
    nt_mailbox_post(&session->mailbox, input);
    return NT_OK;
}

static nt_status take_input(nt_session *session)
{
    nt_input input;
    if (!nt_mailbox_take(&session->mailbox, &input))
        return NT_OK;
    const nt_hand_target target = {.force = input.operator_force, .duration = input.duration};
    nt_sim_aim_hand(&session->sim, &target);
    return nt_touch_aim(&session->touch, &session->touch_state, input.x, input.y, input.duration);
}

static nt_record record_of(const nt_session *session, const nt_sample *sample, const nt_command *command,
                           const nt_truth *truth)
{
    nt_record record = {.tick = sample->tick,
                        .time = (double)sample->tick * session->touch.period,
                        .x = sample->x,
                        .y = sample->y,
                        .master_position = sample->master_position,
                        .operator_force = sample->operator_force,
                        .stage_position = sample->stage_position,
                        .stage_command = command->stage_position,
                        .deflection = sample->deflection,
                        .slave_force = session->touch.rig.probe.spring_constant * sample->deflection,
                        .motor_force = command->motor_force,
                        .gap = truth->gap,
                        .tip_force = truth->tip_force,
                        .contact_radius = truth->contact_radius,
                        .surface_height = truth->surface_height,
                        .state = command->state,
                        .reasons = command->reasons};
    return record;
}

static nt_status step(nt_session *session)
{
    nt_sample sample;
    nt_command command;
    const nt_truth truth = session->sim.truth; /* at the moment of the sample */
    nt_status status = take_input(session);
    if (status == NT_OK)
        status = nt_hal_read(&session->hal, &sample);
    if (status != NT_OK)
        return status;
    nt_touch_step(&session->touch, &session->touch_state, &sample, &command);
    const nt_record record = record_of(session, &sample, &command, &truth);
    status = nt_ring_push(&session->ring, &record);
    return status == NT_OK ? nt_hal_write(&session->hal, &command) : status;
}

nt_status nt_session_advance(nt_session *session, long ticks)
{
    if (ticks < 0)
        return NT_E_RANGE;
    if ((size_t)ticks > session->ring.capacity - nt_ring_count(&session->ring))
        return NT_E_CAPACITY;
    nt_status status = NT_OK;
    for (long i = 0; i < ticks && status == NT_OK; ++i)
        status = step(session);
    return status;
}

long nt_session_read(nt_session *session, nt_record *records, long count)
{
    return count > 0 ? (long)nt_ring_pop(&session->ring, records, (size_t)count) : 0;
}

nt_status nt_session_arm(nt_session *session, int confirmed)
{
    return nt_touch_arm(&session->touch_state, confirmed);
}

void nt_session_emergency_stop(nt_session *session, int pressed)
{
    if (pressed)
        session->sim.flags |= NT_SAMPLE_EMERGENCY_STOP;
    else
        session->sim.flags &= ~(uint32_t)NT_SAMPLE_EMERGENCY_STOP;
}

const nt_plan *nt_session_plan(const nt_session *session)
{
    return &session->plan;
}
const nt_touch *nt_session_touch(const nt_session *session)
{
    return &session->touch;
}
nt_margins nt_session_margins(const nt_session *session)
{
    return session->margins;
}
double nt_session_start_height(const nt_session *session)
{
    return session->sim.start_height;
}
double nt_session_master_start(const nt_session *session)
{
    return session->master_start;
}
