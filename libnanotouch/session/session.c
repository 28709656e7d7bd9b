/* SPDX-License-Identifier: BSD-3-Clause
 * Opens and closes a session; the heap is used here and in composition.c only. */
#include "internal/session.h"
#include "nanotouch/session.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "session/state.h"

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
    nt_mailbox_init(&session->shown, session->shown_memory, sizeof(nt_session_particles));
    nt_status status = nt_ring_init(&session->events, session->event_memory, sizeof(nt_event), NT_SESSION_EVENTS);
    if (status == NT_OK)
        status = nt_ring_init(&session->calls, session->call_memory, sizeof(nt_call), NT_SESSION_CALLS);
    if (status == NT_OK)
        status = nt_ring_init(&session->clients, session->client_memory, sizeof(nt_request), NT_SESSION_CALLS);
    if (status == NT_OK && session->records)
        status = nt_ring_init(&session->ring, session->records, sizeof(nt_record), capacity);
    return status;
}

/* The tip is led no farther than the stage says that it goes. One that starts outside of it has other coordinates. */
static void narrow_to_stage(nt_session *session, const nt_session_setup *setup)
{
    const nt_capabilities *stage = &session->slave.capabilities;
    const double start[] = {setup->x, setup->y};
    for (int i = 0; i < stage->rows; ++i) {
        const nt_channel_row *row = &stage->channels[i];
        if (!row->driven || row->axis >= NT_Z || start[row->axis] < row->minimum || start[row->axis] > row->maximum)
            continue;
        double *borders = session->now->touch.borders[row->axis];
        borders[0] = fmax(borders[0], row->minimum);
        borders[1] = fmin(borders[1], row->maximum);
    }
}

static nt_status begin(nt_session *session, const nt_session_setup *setup, nt_problem *problem)
{
    nt_status status = make_rings(session, setup);
    if (status == NT_OK)
        status = nt_compose(&session->now, setup, NULL, problem);
    if (status == NT_OK)
        status = nt_session_open_halves(session, problem);
    if (status == NT_OK)
        narrow_to_stage(session, setup);
    if (status == NT_OK && setup->preflight)
        status = nt_session_fly(session, problem);
    if (status == NT_OK && setup->mode == NT_MODE_TAPPING)
        status = nt_session_find_amplitude(session, problem);
    if (status != NT_OK)
        return status;
    session->touch_state = nt_touch_start(&session->now->touch, session->master_start, setup->x, setup->y);
    session->comes_back = !session->simulates[NT_HALF_MASTER];
    session->origin = nt_origin_of(setup);
    if (nt_composition_pushes(session->now))
        nt_session_show_particles(session);
    session->opened = nt_clock_now();
    session->master_travel = setup->rig.master.travel;
    session->master_axes = setup->rig.master.axes;
    memcpy(session->borders, session->now->touch.borders, sizeof session->borders);
    session->keeps_to_path = setup->path && setup->rig.master.axes == 1.0 && setup->rig.stage.axes > 1.0;
    return NT_OK;
}

nt_status nt_session_open(nt_session **session, const nt_session_setup *setup, nt_problem *problem)
{
    if (!session || !setup)
        return NT_E_ARGUMENT;
    nt_status status = nt_session_check_setup(setup, problem);
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
    if (!session)
        return NT_E_ARGUMENT;
    if (nt_session_runs_here(session) || nt_session_is_running(session) || session->frames)
        return NT_E_STATE;
    return nt_frames_create(&session->frames, name);
}

nt_frames *nt_session_frames(nt_session *session)
{
    return session->frames;
}

void nt_session_close(nt_session *session)
{
    if (!session || nt_session_runs_here(session))
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
