/* SPDX-License-Identifier: BSD-3-Clause
 * Composes plan, simulated rig, touch step and ring; the heap is used in open only. */
#include "nanotouch/session.h"

#include <math.h>
#include <stdlib.h>

#include "session/state.h"

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
                              .minimum_margin = 1.5,
                              .preflight = 1};
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
    if (!(setup->slope >= 0.0 && setup->slope <= 1e3))
        return refuse(problem, "slope", "", setup->slope, 0.0, 1e3);
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
                              .delay = setup->settings.gains.delay,
                              .probe_model = setup->probe_model,
                              .substep = setup->substep,
                              .faults = setup->faults};
    const nt_status status = nt_sim_init(&session->sim, &sim);
    return status == NT_OK ? nt_hal_open(&session->hal, nt_sim_backend(), &session->sim) : status;
}

/* Of this law at the stiffest contact of the plan; the margin that counts in a mode comes back. */
double nt_session_margin(const nt_session *session, const nt_settings *settings, nt_margins *margins)
{
    const nt_servo_shape shape = nt_servo_shape_of(&session->touch.rig, settings, session->plan.maximum_stiffness);
    *margins = nt_margins_compute(&shape.rig, &shape.gains, shape.contact_stiffness);
    if (session->touch.mode == NT_MODE_TOUCH) {
        const double coupling =
            nt_servo_coupling_margin(&shape.rig, &shape.gains, session->plan.maximum_stiffness, margins->loop_delay);
        return fmin(margins->margin, coupling);
    }
    return session->touch.mode == NT_MODE_CURVE ? (double)INFINITY : margins->height_margin;
}

static nt_status judge_margin(nt_session *session, const nt_session_setup *setup, nt_problem *problem)
{
    const double margin = nt_session_margin(session, &setup->settings, &session->margins);
    if (!(margin >= setup->minimum_margin))
        return refuse(problem, "stability margin", "", margin, setup->minimum_margin, INFINITY);
    session->minimum_margin = setup->minimum_margin;
    const nt_hazard hazard = {.slope = setup->slope,
                              .snap_in_force = session->plan.pull_off_force,
                              .stiffness = session->plan.maximum_stiffness};
    session->guarantee = nt_guarantee_compute(&setup->rig, &setup->settings, &hazard);
    return NT_OK;
}

/* Tare and sign test, on the rig's own time. */
static nt_status fly(nt_session *session, nt_problem *problem)
{
    const nt_preflight preflight = nt_preflight_make(&session->touch.rig, &session->touch.settings);
    nt_preflight_state state = {.verdict = NT_PREFLIGHT_RUNNING};
    nt_command command = {.x = session->sim.x, .y = session->sim.y};
    nt_status status = NT_OK;
    while (status == NT_OK && state.verdict == NT_PREFLIGHT_RUNNING) {
        nt_sample sample;
        status = nt_hal_read(&session->hal, &sample);
        if (status == NT_OK && nt_preflight_step(&preflight, &state, &sample, &command) <= NT_PREFLIGHT_PASSED)
            status = nt_hal_write(&session->hal, &command);
    }
    if (status == NT_OK && state.verdict != NT_PREFLIGHT_PASSED) {
        if (problem)
            *problem = nt_preflight_problem(&preflight, &state);
        return NT_E_RANGE;
    }
    session->tare = state.tare;
    session->first_tick = session->sim.tick;
    return status;
}

static nt_status compose(nt_session *session, const nt_session_setup *setup, nt_problem *problem)
{
    nt_scene scene = setup->scene;
    scene.range.maximum_load = setup->settings.limits.force;
    const nt_plan_inputs inputs = {
        .scene = &scene, .demand = &setup->demand, .probe = &setup->rig.probe, .surface = setup->surface};
    nt_status status = nt_touch_make(&session->touch, &setup->rig, &setup->settings, setup->mode, problem);
    if (status == NT_OK)
        status = nt_plan_make(&session->plan, &inputs, problem);
    if (status == NT_OK)
        status = judge_margin(session, setup, problem);
    if (status == NT_OK)
        status = make_sim(session, setup);
    session->master_start = session->sim.master.position;
    if (status == NT_OK && setup->preflight)
        status = fly(session, problem);
    if (status != NT_OK)
        return status;
    session->touch_state = nt_touch_start(&session->touch, session->master_start, setup->x, setup->y);
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
