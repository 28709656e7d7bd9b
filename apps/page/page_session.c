/* SPDX-License-Identifier: BSD-3-Clause
 * The session of the page: the public C API, stepped by a worker (page.h). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "page.h"

enum { KEPT = 26 };              /* snapshots */
static const double EACH = 0.25; /* between two of them [s] */

static struct {
    nt_session *session;
    page_update update;
    nt_snapshot *kept[KEPT];
    double kept_at[KEPT];
    int newest; /* of kept; -1: none */
    int touches;
    double *properties[2], *given[2]; /* of each place, of the session and of the next one: modulus, work of adhesion */
    nt_properties *of_places;
} page = {.newest = -1};

nt_session *page_the_session(void)
{
    return page.session;
}

static void forget(void)
{
    for (int i = 0; i < KEPT; ++i) {
        nt_snapshot_close(page.kept[i]);
        page.kept[i] = NULL;
    }
    page.newest = -1;
}

static void clear_update(void)
{
    page.update = (page_update){.version = PAGE_VERSION, .least = INFINITY, .largest = -INFINITY};
}

/* Properties of each place for the next page_open, on the pixels of its heights: E_s [Pa] and w [J/m^2]; NULL: those of
 * the scene everywhere. */
PAGE_API(page_properties)
int page_properties(const double *youngs_modulus, const double *work_of_adhesion, int nx, int ny)
{
    const double *const values[] = {youngs_modulus, work_of_adhesion};
    const size_t size = sizeof(double) * (size_t)nx * (size_t)ny;
    for (int i = 0; i < 2; ++i) {
        free(page.given[i]);
        page.given[i] = NULL;
        if (values[i] && !(page.given[i] = malloc(size)))
            return NT_E_NO_MEMORY;
        if (values[i])
            memcpy(page.given[i], values[i], size);
    }
    return NT_OK;
}

/* Those that were given, for a session on a map. */
static nt_status take_properties(nt_session_setup *setup, nt_properties *made, nt_problem *problem)
{
    if (!page.given[0] && !page.given[1])
        return NT_OK;
    const nt_surface grid = {setup->map.heights, setup->map.nx, setup->map.ny, setup->map.dx, setup->map.dy, 0.0, 0.0};
    setup->properties = made;
    return nt_properties_init(made, &grid, page.given[0], page.given[1], problem);
}

static void keep_properties(void)
{
    for (int i = 0; i < 2; ++i) {
        free(page.properties[i]);
        page.properties[i] = page.given[i];
        page.given[i] = NULL;
    }
}

/* A session over ny rows of nx heights of a body [m] (freed by the caller), with scene, rig and settings as they are.
 * The one before is closed once this one is open. */
PAGE_API(page_open) int page_open(const double *heights, int nx, int ny, const page_opening *opening)
{
    page_world *world = page_the_world();
    nt_session_setup setup = nt_session_defaults();
    setup.scene = world->scene;
    setup.rig = world->rig;
    setup.settings = world->settings;
    setup.demand = world->demand;
    if (heights)
        setup.map = (nt_height_map){heights, nx, ny, opening->dx, opening->dy};
    setup.x = opening->x;
    setup.y = opening->y;
    setup.clearance = opening->clearance;
    setup.rise = opening->rise;
    setup.seed = (uint64_t)opening->seed;
    setup.minimum_margin = opening->margin;
    setup.ring_capacity = 0;
    setup.particles = page_given_particles();
    setup.rod = page_given_rod();
    world->problem = (nt_problem){0};
    nt_session *session = NULL;
    nt_properties *of_places = malloc(sizeof *of_places);
    nt_status status = of_places ? take_properties(&setup, of_places, &world->problem) : NT_E_NO_MEMORY;
    if (status == NT_OK)
        status = nt_session_open(&session, &setup, &world->problem);
    if (status != NT_OK) {
        free(of_places);
        return (int)status;
    }
    forget();
    nt_session_close(page.session);
    page.session = session;
    keep_properties();
    free(page.of_places);
    page.of_places = of_places;
    page.touches = 0;
    clear_update();
    return NT_OK;
}

PAGE_API(page_close) void page_close(void)
{
    forget();
    nt_session_close(page.session);
    page.session = NULL;
}

/* --- running --- */

void page_sum_up(page_update *update, const nt_frame *frame)
{
    const float force = (float)frame->tip_force[NT_Z];
    update->state = (uint8_t)frame->state;
    update->phase = (uint8_t)frame->phase;
    update->reasons = frame->reasons;
    update->sequence = frame->sequence;
    update->time = frame->time;
    memcpy(update->tip, frame->tip_position, sizeof update->tip);
    update->gap = frame->gap;
    update->force = frame->tip_force[NT_Z];
    update->side[0] = (float)frame->tip_force[NT_X];
    update->side[1] = (float)frame->tip_force[NT_Y];
    if (force < update->least)
        update->least = force;
    if (force > update->largest)
        update->largest = force;
    update->base = (float)frame->base_height;
    update->deflection = (float)frame->deflection;
    update->contact = (float)frame->contact_radius;
    update->cohesive = (float)frame->cohesive_radius;
    update->neck = (float)frame->neck_radius;
    update->motor = (float)frame->motor_force[NT_Z];
    for (int axis = 0; axis < NT_AXES; ++axis)
        update->master[axis] = (float)frame->master_position[axis];
    ++update->ticks;
}

static void keep_snapshot(double time)
{
    if (page.newest >= 0 && time < page.kept_at[page.newest] + EACH)
        return;
    const int next = (page.newest + 1) % KEPT;
    nt_snapshot_close(page.kept[next]);
    page.kept[next] = NULL;
    if (nt_session_snapshot(page.session, &page.kept[next]) == NT_OK) {
        page.kept_at[next] = time;
        page.newest = next;
    }
}

/* Runs so many ticks; the update grows by them. */
PAGE_API(page_run) int page_run(int ticks)
{
    nt_frame frame;
    for (int i = 0; i < ticks; ++i) {
        const nt_status status = nt_session_step(page.session, NULL, &frame);
        if (status != NT_OK)
            return (int)status;
        page_sum_up(&page.update, &frame);
        page_host_see(&frame);
        const int touches = frame.contact_radius > 0.0;
        if (touches != page.touches)
            page.update.events |= touches ? PAGE_SNAP : PAGE_TEAR;
        page.touches = touches;
    }
    if (ticks > 0)
        keep_snapshot(page.update.time);
    return NT_OK;
}

/* The update since page_taken. */
PAGE_API(page_update_of) const page_update *page_update_of(void)
{
    return &page.update;
}

/* It was taken: the next one begins. */
PAGE_API(page_taken) void page_taken(void)
{
    page.update.least = INFINITY;
    page.update.largest = -INFINITY;
    page.update.ticks = 0;
    page.update.events = 0;
}

/* --- the hand and what is asked --- */

/* The hand pushes, as in the reference session. */
PAGE_API(page_push) int page_push(double force, double x, double y, double duration)
{
    const nt_input input = {.operator_force = {0.0, 0.0, force}, .x = x, .y = y, .duration = duration};
    page_the_world()->problem = (nt_problem){0};
    return (int)nt_session_aim(page.session, &input, &page_the_world()->problem);
}

PAGE_API(page_stop) void page_stop(void)
{
    nt_session_emergency_stop(page.session, 1);
    nt_session_emergency_stop(page.session, 0);
}

PAGE_API(page_arm) int page_arm(void)
{
    return (int)nt_session_arm(page.session, 1);
}

/* It was changed: a snapshot belongs to the world that it was taken in. */
PAGE_API(page_changed) void page_changed(void)
{
    page_world *world = page_the_world();
    forget();
    world->scene = nt_session_setup_of(page.session)->scene;
    world->settings = nt_session_setup_of(page.session)->settings;
}

/* Back by a duration [s], to the nearest kept moment before that. */
PAGE_API(page_rewind) int page_rewind(double duration)
{
    const double wanted = page.update.time - duration;
    int best = -1;
    for (int i = 0; i < KEPT; ++i)
        if (page.kept[i] && page.kept_at[i] <= wanted && (best < 0 || page.kept_at[i] > page.kept_at[best]))
            best = i;
    page_the_world()->problem = (nt_problem){0};
    if (best < 0)
        return NT_E_NO_SOLUTION;
    const nt_status status = nt_session_restore(page.session, page.kept[best], &page_the_world()->problem);
    if (status != NT_OK)
        return (int)status;
    for (int i = 0; i < KEPT; ++i)
        if (page.kept[i] && page.kept_at[i] > page.kept_at[best]) {
            nt_snapshot_close(page.kept[i]);
            page.kept[i] = NULL;
        }
    page.newest = best;
    return page_run(1);
}

/* Height [m], effective radius [m], E_s [Pa] and w [J/m^2] at a place of what is touched; 0: not given there. */
PAGE_API(page_place) void page_place(double x, double y, double found[4])
{
    const nt_place place = nt_interaction_place(nt_session_plan(page.session), x, y);
    found[0] = place.surface.z;
    found[1] = place.radius.radius;
    found[2] = place.youngs_modulus.value;
    found[3] = place.work_of_adhesion.value;
}
