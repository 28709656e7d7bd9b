/* SPDX-License-Identifier: BSD-3-Clause
 * The loop taken apart: touch step and simulated rig joined by hand, so that a test can stand between them. */
#ifndef TESTS_LOOP_FIXTURE_H
#define TESTS_LOOP_FIXTURE_H

#include "hal/sim/sim.h"
#include "internal/margins.h"
#include "nanotouch/nanotouch.h"
#include "session/hazard.h"

typedef struct loop {
    nt_plan plan;
    nt_touch touch;
    nt_touch_state state;
    nt_sim sim;
    double clearance;   /* where a session would take its tare [m] */
    nt_sample sample;   /* as the touch step has seen it */
    nt_command command; /* as the touch step has given it */
} loop;

/* Rig and settings are those of setup; the scene's plan for the force limit. The loop must not be moved afterwards
 * (sim.slave.plan). */
static inline nt_status loop_open(loop *l, const nt_session_setup *setup)
{
    nt_scene scene = setup->scene;
    scene.range.maximum_load = setup->settings.limits.force;
    const nt_plan_inputs inputs = {
        .scene = &scene, .demand = &setup->demand, .probe = &setup->rig.probe, .surface = setup->surface};
    nt_status status = nt_plan_make(&l->plan, &inputs, NULL);
    if (status == NT_OK)
        status = nt_touch_make(&l->touch, &setup->rig, &setup->settings, setup->mode, NULL);
    if (status != NT_OK)
        return status;
    const nt_sim_setup sim = {.plan = &l->plan,
                              .rig = &l->touch.rig,
                              .period = l->touch.period,
                              .x = setup->x,
                              .y = setup->y,
                              .clearance = setup->clearance,
                              .master_position = -0.4 * setup->rig.master.travel,
                              .seed = setup->seed,
                              .delay = setup->settings.gains.delay,
                              .probe_model = setup->probe_model};
    l->clearance = setup->clearance;
    l->state = nt_touch_start(&l->touch, sim.master_position, setup->x, setup->y);
    return nt_sim_init(&l->sim, &sim);
}

/* Spoils a sample on its way, or does nothing. */
typedef void (*loop_fault)(nt_sample *sample, void *context);

static inline nt_status loop_tick(loop *l, loop_fault fault, void *context)
{
    nt_status status = nt_sim_read(&l->sim, &l->sample);
    if (status != NT_OK)
        return status;
    if (fault)
        fault(&l->sample, context);
    nt_touch_step(&l->touch, &l->state, &l->sample, &l->command);
    return nt_sim_write(&l->sim, &l->command);
}

static inline void loop_push(loop *l, double force, double duration)
{
    const nt_hand_target target = {.force = {[NT_Z] = force}, .duration = duration};
    nt_sim_aim_hand(&l->sim.master, &target);
}

/* What nt_guarantee has in store for a surface of this slope. */
static inline nt_guarantee promise(const loop *l, double slope)
{
    const nt_hazard hazard = nt_hazard_of(&l->plan, &l->touch.rig, &l->touch.settings, slope, l->clearance);
    return nt_guarantee_compute(&l->touch.rig, &l->touch.settings, &hazard);
}

/* What a session of the same setup promises; NaN where it cannot be opened. */
static inline nt_guarantee session_promise(const nt_session_setup *setup)
{
    nt_guarantee found = {.force = (double)NAN};
    nt_session *session = NULL;
    if (nt_session_open(&session, setup, NULL) == NT_OK)
        found = nt_session_guarantee(session);
    nt_session_close(session);
    return found;
}

#endif
