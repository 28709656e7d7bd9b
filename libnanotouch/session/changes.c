/* SPDX-License-Identifier: BSD-3-Clause
 * Requests are prepared outside the loop: checked against range and margin, and for a change everything that follows
 * from it is composed anew. */
#include <math.h>
#include <string.h>

#include "core/problem.h"
#include "internal/session.h"
#include "session/state.h"
#include "session/terrain.h"

static nt_status compose_mode(const nt_session *session, nt_call *call, nt_problem *problem)
{
    const nt_gains *gains = &session->now->setup.settings.gains;
    const nt_scaling scaling = {gains->alpha_p, gains->alpha_f};
    const double mode = call->event.value[0];
    const int taps = session->now->setup.mode == NT_MODE_TAPPING;
    const double least = taps ? NT_MODE_TAPPING : 0.0, most = taps ? NT_MODE_TAPPING : NT_MODE_CURVE;
    if (!(mode >= least && mode <= most && mode == floor(mode))) { /* the drive is on or off while a session is open */
        (void)nt_problem_set(problem, "mode", NT_MODE_WORDS, mode, least, most);
        return NT_E_ARGUMENT;
    }
    return nt_compose_standing(&call->next, session->now, (nt_mode)mode, &scaling, problem);
}

static nt_status compose_scaling(const nt_session *session, nt_call *call, nt_problem *problem)
{
    const nt_scaling scaling = {call->event.value[0], call->event.value[1]};
    return nt_compose_standing(&call->next, session->now, session->now->setup.mode, &scaling, problem);
}

/* What a surface gives at each place is not the scene's to change. */
static int is_of_surface(const nt_properties *of, const char *field)
{
    static const char *const work[] = {"adhesion.given", "adhesion.work_of_adhesion", "adhesion.pull_off_force",
                                       "adhesion.tip_surface_energy", "adhesion.sample_surface_energy"};
    if (of && of->youngs_modulus.coefficients && strcmp(field, "sample.youngs_modulus") == 0)
        return 1;
    for (size_t i = 0; i < sizeof work / sizeof *work && of && of->work_of_adhesion.coefficients; ++i)
        if (strcmp(field, work[i]) == 0)
            return 1;
    return 0;
}

/* What cannot change while a session is open: the clock, the delay that the rig was built with, scales (rescale), drive
 * and lock-in amplifier, and the tip that a surface was dilated with. */
static int is_fixed(const nt_session *session, const char *field)
{
    static const char *const fixed[] = {"gains.rate", "gains.delay", "gains.alpha_p", "gains.alpha_f"};
    for (size_t i = 0; i < sizeof fixed / sizeof *fixed; ++i)
        if (strcmp(field, fixed[i]) == 0)
            return 1;
    if (strncmp(field, "tap.", 4) == 0 && strncmp(field, "tap.set_", 8) != 0)
        return 1;
    if (is_of_surface(session->now->setup.properties, field))
        return 1;
    return (nt_terrain_surface(session->now->terrain) || nt_composition_pushes(session->now)) &&
           strncmp(field, "tip.", 4) == 0;
}

static const nt_field *fields_of(uint32_t kind, int *count)
{
    return kind == NT_EVENT_SETTING ? nt_settings_fields(count) : nt_scene_fields(count);
}

/* The setup with one field changed, composed anew. */
static nt_status compose_change(const nt_session *session, nt_call *call, nt_problem *problem)
{
    int count;
    const nt_field *fields = fields_of(call->event.kind, &count);
    if (call->event.field >= (uint32_t)count)
        return NT_E_ARGUMENT;
    const nt_field *field = &fields[call->event.field];
    nt_session_setup setup = session->now->setup;
    const int is_setting = call->event.kind == NT_EVENT_SETTING;
    void *object = is_setting ? (void *)&setup.settings : (void *)&setup.scene;
    if (is_fixed(session, field->name)) {
        const double stays = nt_field_get(field, object);
        (void)nt_problem_set(problem, field->name, field->unit, call->event.value[0], stays, stays);
        return NT_E_ARGUMENT;
    }
    nt_field_set(field, object, call->event.value[0]);
    nt_status status = is_setting ? nt_settings_check(&setup.settings, problem) : nt_scene_check(&setup.scene, problem);
    if (status == NT_OK)
        status = nt_compose(&call->next, &setup, session->now, problem);
    if (status == NT_OK && !is_setting)
        call->next->touch = session->now->touch; /* it does not see the scene: a replay leaves it alone, too */
    return status;
}

static nt_status check_yes(double value, const char *what, nt_problem *problem)
{
    return value == 0.0 || value == 1.0 ? NT_OK : nt_problem_set(problem, what, "no|yes", value, 0.0, 1.0);
}

static nt_status check_held(const nt_session *session, const double value[4], nt_problem *problem)
{
    const nt_input input = {.master_position = {value[NT_X], value[NT_Y], value[NT_Z]},
                            .holds = 1,
                            .x = NAN,
                            .y = NAN,
                            .duration = value[NT_AXES]};
    return nt_session_check_input(session, &input, problem);
}

nt_status nt_session_prepare(const nt_session *session, nt_call *call, nt_problem *problem)
{
    const double *value = call->event.value;
    switch ((nt_event_kind)call->event.kind) {
    case NT_EVENT_STOP:
        return check_yes(value[0], "stop", problem);
    case NT_EVENT_ARM:
        return check_yes(value[0], "arm", problem);
    case NT_EVENT_CLUTCH:
        return check_yes(value[0], "clutch", problem);
    case NT_EVENT_AIM:
        if (call->event.field == NT_AIM_HAND)
            return check_held(session, value, problem);
        return nt_session_check_place(session, value[0], value[1], value[2], problem);
    case NT_EVENT_MODE:
        return compose_mode(session, call, problem);
    case NT_EVENT_RESCALE:
        return compose_scaling(session, call, problem);
    case NT_EVENT_SETTING:
    case NT_EVENT_SCENE:
        return compose_change(session, call, problem);
    case NT_EVENT_REWIND:
        return session->history && value[0] >= 0.0 ? NT_OK : NT_E_UNSUPPORTED;
    case NT_EVENT_UNDENT:
        return nt_session_dents(session) ? NT_OK : NT_E_UNSUPPORTED;
    case NT_EVENT_LAY:
    case NT_EVENT_LAY_ROD:
        return session->simulates[NT_HALF_SLAVE] && nt_composition_pushes(session->now) ? NT_OK : NT_E_UNSUPPORTED;
    case NT_EVENT_INDEX:
    case NT_EVENT_DENT:
    case NT_EVENT_PUSHED:
    case NT_EVENT_TURNED:
    case NT_EVENT_KINDS:
        break;
    }
    return NT_E_ARGUMENT;
}

static nt_status request(nt_session *session, const nt_event *event, nt_problem *problem)
{
    nt_call call = {.event = *event};
    if (!session)
        return NT_E_ARGUMENT;
    if (nt_session_runs_here(session))
        return NT_E_STATE;
    nt_session_lock(session);
    nt_status status = nt_session_prepare(session, &call, problem);
    if (status == NT_OK)
        status = nt_session_ask(session, &call);
    nt_session_unlock(session);
    return status;
}

nt_status nt_session_arm(nt_session *session, int confirmed)
{
    return request(session, &(nt_event){.kind = NT_EVENT_ARM, .value = {confirmed != 0}}, NULL);
}

nt_status nt_session_clutch(nt_session *session, int open)
{
    return request(session, &(nt_event){.kind = NT_EVENT_CLUTCH, .value = {open != 0}}, NULL);
}

nt_status nt_session_undent(nt_session *session)
{
    return request(session, &(nt_event){.kind = NT_EVENT_UNDENT}, NULL);
}

nt_status nt_session_set_mode(nt_session *session, nt_mode mode, nt_problem *problem)
{
    return request(session, &(nt_event){.kind = NT_EVENT_MODE, .value = {(double)mode}}, problem);
}

nt_status nt_session_rescale(nt_session *session, const nt_scaling *scaling, nt_problem *problem)
{
    if (!scaling)
        return NT_E_ARGUMENT;
    const nt_event event = {.kind = NT_EVENT_RESCALE, .value = {scaling->alpha_p, scaling->alpha_f}};
    return request(session, &event, problem);
}

nt_status nt_session_change(nt_session *session, nt_event_kind kind, const char *field, double value,
                            nt_problem *problem)
{
    nt_event event = {.kind = (uint32_t)kind, .value = {value}};
    if (!field || (kind != NT_EVENT_SETTING && kind != NT_EVENT_SCENE))
        return NT_E_ARGUMENT;
    int count;
    const nt_field *fields = fields_of(event.kind, &count);
    while (event.field < (uint32_t)count && strcmp(fields[event.field].name, field) != 0)
        ++event.field;
    return request(session, &event, problem);
}

nt_status nt_session_rewind(nt_session *session, double duration, nt_problem *problem)
{
    if (!(duration >= 0.0 && isfinite(duration)))
        return nt_problem_set(problem, "rewind", "s", duration, 0.0, INFINITY);
    return request(session, &(nt_event){.kind = NT_EVENT_REWIND, .value = {duration}}, problem);
}

nt_status nt_session_inject(nt_session *session, const nt_fault *fault)
{
    if (!session || !fault)
        return NT_E_ARGUMENT;
    nt_fault shifted = *fault;
    if (nt_session_is_running(session))
        return NT_E_STATE;
    if (fault->start < 0.0)
        return NT_E_RANGE;
    if (!nt_session_has_fault(fault, session->simulates[NT_HALF_MASTER], session->simulates[NT_HALF_SLAVE]))
        return NT_E_UNSUPPORTED;
    shifted.start += (double)session->flights * session->now->touch.period;
    nt_status status = NT_E_UNSUPPORTED;
    if (session->simulates[NT_HALF_MASTER])
        status = nt_faults_add(&session->sim.master.link.faults, &shifted);
    if (session->simulates[NT_HALF_SLAVE] && status != NT_E_ARGUMENT)
        status = nt_faults_add(&session->sim.slave.link.faults, &shifted);
    return status;
}
