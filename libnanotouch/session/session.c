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

/* Numbers of the setup that no other check sees; rig and settings have been checked. */
static nt_status check_setup(const nt_session_setup *setup, nt_problem *problem)
{
    if (setup->settings.gains.delay > NT_SIM_DELAY_MAX)
        return nt_session_refuse(problem, "gains.delay", "periods", setup->settings.gains.delay, 0.0, NT_SIM_DELAY_MAX);
    if (!(setup->clearance >= 1e-9 && setup->clearance <= 1e-3))
        return nt_session_refuse(problem, "clearance", "m", setup->clearance, 1e-9, 1e-3);
    if (setup->ring_capacity < 2 || setup->ring_capacity > 1L << 26)
        return nt_session_refuse(problem, "ring_capacity", "", (double)setup->ring_capacity, 2.0, 67108864.0);
    const double climb = setup->settings.gains.alpha_p * 0.8 * setup->rig.master.travel;
    if (!(setup->rise >= 0.0 && setup->rise <= setup->clearance + climb))
        return nt_session_refuse(problem, "rise", "m", setup->rise, 0.0, setup->clearance + climb);
    if (!(setup->slope >= 0.0 && setup->slope <= 1e3))
        return nt_session_refuse(problem, "slope", "", setup->slope, 0.0, 1e3);
    if (!(setup->minimum_margin >= 0.0))
        return nt_session_refuse(problem, "minimum_margin", "", setup->minimum_margin, 0.0, INFINITY);
    if (!isfinite(setup->x))
        return nt_session_refuse(problem, "x", "m", setup->x, -1.0, 1.0);
    if (!isfinite(setup->y))
        return nt_session_refuse(problem, "y", "m", setup->y, -1.0, 1.0);
    if (setup->surface && !nt_surface_contains(setup->surface, setup->x, setup->y)) {
        const nt_surface *surface = setup->surface;
        const double width = (double)(surface->nx - 1) * surface->dx;
        if (setup->x < 0.0 || setup->x > width)
            return nt_session_refuse(problem, "x", "m", setup->x, 0.0, width);
        return nt_session_refuse(problem, "y", "m", setup->y, 0.0, (double)(surface->ny - 1) * surface->dy);
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
                              .rig = &setup->rig,
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

static nt_status compose(nt_session *session, const nt_session_setup *setup, nt_problem *problem)
{
    nt_scene scene = setup->scene;
    scene.range.maximum_load = setup->settings.limits.force;
    const nt_plan_inputs inputs = {.scene = &scene,
                                   .demand = &setup->demand,
                                   .probe = &setup->rig.probe,
                                   .surface = setup->surface,
                                   .radii = setup->radii,
                                   .bank = setup->bank};
    nt_status status = nt_touch_make(&session->touch, &setup->rig, &setup->settings, setup->mode, problem);
    if (status == NT_OK)
        status = nt_plan_make(&session->plan, &inputs, problem);
    if (status == NT_OK)
        status = nt_session_promise(session, setup, problem);
    if (status == NT_OK)
        status = make_sim(session, setup);
    session->master_start = session->sim.master.position;
    if (status == NT_OK && setup->preflight)
        status = nt_session_fly(session, problem);
    if (status != NT_OK)
        return status;
    session->touch_state = nt_touch_start(&session->touch, session->master_start, setup->x, setup->y);
    nt_mailbox_init(&session->mailbox, session->mailbox_memory, sizeof(nt_input));
    return NT_OK;
}

/* Fresh memory gets its pages when it is first written; that shall not be in a control period. */
static void touch_pages(void *memory, size_t size)
{
    volatile unsigned char *bytes = memory;
    for (size_t i = 0; i < size; i += 1024)
        bytes[i] = 0;
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
    atomic_init(&made->stop, 0u);
    made->records = calloc(capacity, sizeof *made->records);
    if (made->records)
        touch_pages(made->records, capacity * sizeof *made->records);
    else
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
