/* SPDX-License-Identifier: BSD-3-Clause
 * What observers see of one tick.
 *
 * The outer radius c of the cohesive zone follows from what is known already, without iteration. In contact Maugis
 * (1992) has delta = a^2/R - (2 sigma0/E*) sqrt(c^2 - a^2). Apart (a = 0) the zone ends where the gap is h0 = w/sigma0:
 * delta = c^2/(2R) - 4 sigma0 c/(pi E*) - h0, whose larger c is the stable one. Where a meniscus is the source of
 * adhesion, its Laplace pressure is sigma0: c is where it ends. */
#include <math.h>

#include "internal/session.h"
#include "nanotouch/material.h"
#include "scene/parts.h"
#include "session/frames.h"
#include "session/state.h"

static int has_zone(const nt_plan *plan)
{
    return nt_form_is_maugis(plan->terms[NT_PLAN_CONTACT].form) && plan->contact.work_of_adhesion > 0.0 &&
           isfinite(plan->lambda);
}

/* At indentation -gap. */
static double zone_at(const nt_contact *contact, double gap, double a)
{
    const double sigma0 = contact->cohesive_stress, E = contact->effective_modulus, R = contact->radius;
    if (contact->work_of_adhesion == 0.0) /* of this place */
        return NAN;
    if (a > 0.0) {
        const double b = 0.5 * E / sigma0 * (a * a / R + gap);
        return b > 0.0 ? sqrt(a * a + b * b) : a; /* the a of a table is not exact */
    }
    const double q = 4.0 * sigma0 / (NT_PI * E);
    const double square = q * q + 2.0 * (contact->work_of_adhesion / sigma0 - gap) / R;
    return square >= 0.0 ? R * (q + sqrt(square)) : 0.0;
}

/* 0 where nothing holds them together; NaN where no law of the plan knows. */
static double cohesive_radius(const nt_session *session, const nt_record *record)
{
    if (!session->simulates[NT_HALF_SLAVE] || isnan(record->gap))
        return NAN;
    const nt_sim_slave *slave = &session->sim.slave;
    const nt_plan *plan = slave->plan;
    if (!has_zone(plan))
        return NAN;
    if (record->contact_radius == 0.0 && !slave->interaction.attached)
        return 0.0;
    if (!nt_plan_follows(plan))
        return zone_at(&plan->contact, record->gap, record->contact_radius);
    const nt_place place = nt_interaction_place(plan, slave->x, slave->y);
    const nt_contact here = nt_plan_contact_of_place(plan, &place);
    return zone_at(&here, record->gap, record->contact_radius);
}

nt_frame nt_session_frame(const nt_session *session, const nt_record *record)
{
    const nt_probe *probe = &session->now->touch.rig.probe;
    nt_frame frame = nt_frame_unknown();
    frame.sequence = record->tick;
    frame.time = record->time;
    frame.base_height = nt_session_start_height(session) - record->stage_position[NT_Z];
    frame.deflection = record->deflection[NT_Z];
    frame.tip_position[NT_X] = record->stage_position[NT_X];
    frame.tip_position[NT_Y] = record->stage_position[NT_Y];
    frame.tip_position[NT_Z] = frame.base_height + record->deflection[NT_Z] * cos(probe->tilt);
    for (int i = 0; i < NT_AXES; ++i) {
        frame.tip_force[i] = record->tip_force[i];
        frame.master_position[i] = record->master_position[i];
        frame.motor_force[i] = record->motor_force[i];
    }
    frame.gap = record->gap;
    frame.contact_radius = record->contact_radius;
    frame.cohesive_radius = cohesive_radius(session, record);
    if (session->simulates[NT_HALF_SLAVE])
        frame.neck_radius = session->sim.slave.plan->source == NT_ADHESION_MENISCUS ? frame.cohesive_radius : 0.0;
    frame.state = record->state;
    frame.reasons = record->reasons;
    frame.phase = record->phase;
    frame.changes = session->frames ? nt_frames_changes(session->frames) : 0u;
    return frame;
}
