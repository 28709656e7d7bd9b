/* SPDX-License-Identifier: BSD-3-Clause
 * Before a session is armed: how far it is from its stability limit, what it promises, and the preflight. */
#include <math.h>

#include "session/state.h"

#define DEEPEST 10e-6 /* an indentation that nobody reaches [m] */

nt_status nt_session_refuse(nt_problem *problem, const char *field, const char *unit, double value, double minimum,
                            double maximum)
{
    if (problem) {
        nt_problem found = {.field = field, .unit = unit, .value = value, .minimum = minimum, .maximum = maximum};
        *problem = found;
    }
    return isfinite(value) ? NT_E_RANGE : NT_E_NOT_FINITE;
}

/* A law of one's own is not tried where the margin is overridden: it may have a memory. */
nt_verdict nt_session_judge(const nt_session *session, const nt_settings *settings, nt_mode mode, nt_margins *margins)
{
    nt_settings judged = *settings;
    if (!(session->minimum_margin > 0.0) && judged.control.choice == NT_CONTROL_OWN)
        judged.control.law = NULL;
    return nt_margins_judge(&session->touch.rig, &judged, session->plan.maximum_stiffness, mode, margins);
}

int nt_session_allows(const nt_session *session, double margin)
{
    return session->minimum_margin <= 0.0 || margin >= session->minimum_margin;
}

/* As deep as the tip may be before the force leaves the noise for good: twice the threshold, because a reading may be
 * off by all of it [m]. */
static double unseen_indentation(const nt_plan *plan, double free_force)
{
    const nt_interaction_state attached = {.attached = 1};
    double shallow = 0.0, deep = DEEPEST;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (shallow + deep);
        const double force = nt_interaction_eval_gap(plan, &attached, NULL, -middle).F;
        if (force > 2.0 * free_force)
            deep = middle;
        else
            shallow = middle;
    }
    return deep;
}

nt_status nt_session_promise(nt_session *session, const nt_session_setup *setup, nt_problem *problem)
{
    session->minimum_margin = setup->minimum_margin;
    const nt_verdict verdict = nt_session_judge(session, &setup->settings, setup->mode, &session->margins);
    if (!nt_session_allows(session, verdict.margin))
        return nt_session_refuse(problem, verdict.field, "", verdict.margin, setup->minimum_margin, INFINITY);
    const nt_plan *plan = &session->plan;
    const nt_hazard hazard = {.slope = setup->slope,
                              .snap_in_force = plan->largest_pull_off_force,
                              .stiffness = plan->maximum_stiffness,
                              .unseen = unseen_indentation(plan, session->touch.supervisor.free_force)};
    session->guarantee = nt_guarantee_compute(&setup->rig, &setup->settings, &hazard);
    return NT_OK;
}

nt_status nt_session_fly(nt_session *session, nt_problem *problem)
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
