/* SPDX-License-Identifier: BSD-3-Clause
 * Opens and closes a session; the heap is used here and in composition.c only. */
#include "nanotouch/session.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/problem.h"
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
                              .rise = NAN,
                              .seed = 1,
                              .ring_capacity = 65536,
                              .minimum_margin = 1.5,
                              .preflight = 1};
    nt_settings_keep_to(&setup.settings, setup.scene.range.maximum_load);
    return setup;
}

static nt_status check_start(const nt_session_setup *setup, nt_problem *problem)
{
    const nt_surface *surface = setup->surface;
    const nt_height_map *map = &setup->map;
    const int is_flat = !surface && !map->heights;
    const double width = surface ? (double)(surface->nx - 1) * surface->dx : (double)(map->nx - 1) * map->dx;
    const double height = surface ? (double)(surface->ny - 1) * surface->dy : (double)(map->ny - 1) * map->dy;
    if (!isfinite(setup->x) || (!is_flat && !(setup->x >= 0.0 && setup->x <= width)))
        return nt_problem_set(problem, "x", "m", setup->x, is_flat ? -1.0 : 0.0, is_flat ? 1.0 : width);
    if (!isfinite(setup->y) || (!is_flat && !(setup->y >= 0.0 && setup->y <= height)))
        return nt_problem_set(problem, "y", "m", setup->y, is_flat ? -1.0 : 0.0, is_flat ? 1.0 : height);
    return NT_OK;
}

/* Numbers of the setup that no other check sees; rig and settings have been checked. */
static nt_status check_setup(const nt_session_setup *setup, nt_problem *problem)
{
    if (setup->settings.gains.delay > NT_SIM_DELAY_MAX)
        return nt_problem_set(problem, "gains.delay", "periods", setup->settings.gains.delay, 0.0, NT_SIM_DELAY_MAX);
    if (!(setup->clearance >= 1e-9 && setup->clearance <= 1e-3))
        return nt_problem_set(problem, "clearance", "m", setup->clearance, 1e-9, 1e-3);
    if (setup->ring_capacity < 0 || setup->ring_capacity == 1 || setup->ring_capacity > 1L << 26)
        return nt_problem_set(problem, "ring_capacity", "", (double)setup->ring_capacity, 2.0, 67108864.0);
    const double climb = setup->settings.gains.alpha_p * 0.8 * setup->rig.master.travel;
    if (!isnan(setup->rise) && !(setup->rise >= 0.0 && setup->rise <= setup->clearance + climb))
        return nt_problem_set(problem, "rise", "m", setup->rise, 0.0, setup->clearance + climb);
    if (!(setup->minimum_margin >= 0.0))
        return nt_problem_set(problem, "minimum_margin", "", setup->minimum_margin, 0.0, INFINITY);
    if (setup->settings.control.law && setup->settings.control.choice != NT_CONTROL_OWN)
        return nt_problem_set(problem, "control.choice beside a law of one's own", "default|paper|impedance|own",
                              (double)setup->settings.control.choice, NT_CONTROL_OWN, NT_CONTROL_OWN);
    return check_start(setup, problem);
}

/* Fresh memory gets its pages when it is first written; that shall not be in a control period. */
static void *take_memory(size_t count, size_t size)
{
    volatile unsigned char *bytes = calloc(count, size);
    for (size_t i = 0; bytes && i < count * size; i += 1024)
        bytes[i] = 0;
    return (void *)bytes;
}

static nt_status make_rings(nt_session *session, const nt_session_setup *setup)
{
    size_t capacity = 2;
    while (capacity < (size_t)setup->ring_capacity)
        capacity *= 2;
    session->event_memory = take_memory(NT_SESSION_EVENTS, sizeof *session->event_memory);
    session->client_memory = take_memory(NT_SESSION_CALLS, sizeof *session->client_memory);
    session->call_memory = take_memory(NT_SESSION_CALLS, sizeof *session->call_memory);
    if (setup->ring_capacity > 0)
        session->records = take_memory(capacity, sizeof *session->records);
    if (!session->event_memory || !session->call_memory || !session->client_memory ||
        (setup->ring_capacity > 0 && !session->records))
        return NT_E_NO_MEMORY;
    nt_mailbox_init(&session->mailbox, session->mailbox_memory, sizeof(nt_input));
    nt_status status = nt_ring_init(&session->events, session->event_memory, sizeof(nt_event), NT_SESSION_EVENTS);
    if (status == NT_OK)
        status = nt_ring_init(&session->calls, session->call_memory, sizeof(nt_call), NT_SESSION_CALLS);
    if (status == NT_OK)
        status = nt_ring_init(&session->clients, session->client_memory, sizeof(nt_request), NT_SESSION_CALLS);
    if (status == NT_OK && session->records)
        status = nt_ring_init(&session->ring, session->records, sizeof(nt_record), capacity);
    return status;
}

static nt_status begin(nt_session *session, const nt_session_setup *setup, nt_problem *problem)
{
    nt_status status = make_rings(session, setup);
    if (status == NT_OK)
        status = nt_compose(&session->now, setup, NULL, problem);
    if (status == NT_OK)
        status = nt_session_open_halves(session, problem);
    if (status == NT_OK && setup->preflight)
        status = nt_session_fly(session, problem);
    if (status != NT_OK)
        return status;
    session->touch_state = nt_touch_start(&session->now->touch, session->master_start, setup->x, setup->y);
    session->asked_mode = setup->mode;
    session->master_travel = setup->rig.master.travel;
    memcpy(session->borders, session->now->touch.borders, sizeof session->borders);
    session->asked_scaling = (nt_scaling){setup->settings.gains.alpha_p, setup->settings.gains.alpha_f};
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
    nt_session *made = calloc(1, sizeof *made);
    if (!made)
        return NT_E_NO_MEMORY;
    status = begin(made, setup, problem);
    if (status != NT_OK) {
        nt_session_close(made);
        return status;
    }
    *session = made;
    return NT_OK;
}

nt_status nt_session_publish(nt_session *session, const char *name)
{
    if (nt_session_is_running(session) || session->frames)
        return NT_E_STATE;
    return nt_frames_create(&session->frames, name);
}

nt_frames *nt_session_frames(nt_session *session)
{
    return session->frames;
}

void nt_session_close(nt_session *session)
{
    if (!session)
        return;
    (void)nt_session_halt(session);
    nt_hal_close(&session->master);
    nt_hal_close(&session->slave);
    nt_frames_close(session->frames);
    nt_composition_close(atomic_load(&session->retired), session->now);
    nt_composition_close(session->now, NULL);
    free(session->records);
    free(session->event_memory);
    free(session->call_memory);
    free(session->client_memory);
    free(session->history);
    free(session);
}
