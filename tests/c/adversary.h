/* SPDX-License-Identifier: BSD-3-Clause
 * One run against the guarantee, drawn from dice: scene, rig as it is believed to be and as it is, settings, operator,
 * drift, and one fault; how close the truth comes to what was promised. */
#ifndef TESTS_ADVERSARY_H
#define TESTS_ADVERSARY_H

#include <stdlib.h>

#include "adversary_draws.h"
#include "adversary_rigs.h"
#include "control/preflight.h"
#include "failure_of.h"
#include "internal/session.h"
#include "nanotouch/advanced/control.h"
#include "session/state.h" /* the truth between two ticks */

/* How close it came: 1 is the promise. */
typedef struct closeness {
    double force, indentation;
    double worst_force, promised_force; /* [N] */
    double worst_time;                  /* since the tare began [s] */
    double stopped;                     /* the first stop, 0: none [s] */
    double rehearsed;                   /* the worst force without the fault [N] */
    double last_time, idle;             /* of it, a stop has not lifted for so long [s] */
    int worst_pulls;                    /* 1: at the end of that tick the tip was drawn to the sample */
    int stops, opened;
    nt_problem refused; /* what was wrong with it */
    const char *fault;  /* "" for none */
    nt_channel channel;
    double value;
} closeness;

/* Operators that fight on one rig, one after the other: each is a run. A fault is one in a session. */
static inline int operators_of(attack kind)
{
    return kind == ATTACK_QUASI_STATIC ? 5 : 1;
}

/* A stop lifts at least this fast, whatever hysteresis and creep take of it [m/s]. */
static inline double lift_speed(const plot *p)
{
    const nt_stage *stage = &p->believed.stage;
    return (1.0 - 2.0 * stage->hysteresis - 4.0 * stage->creep) * p->settings.limits.retract_speed;
}

/* Any value that the kind may have and that a rig may show; a jump no larger than is reckoned with. */
static inline double draw_value(const plot *p, dice *d, nt_fault_kind kind, nt_channel channel)
{
    const double sign = chance(d, 0.5) ? -1.0 : 1.0;
    switch (kind) {
    case NT_FAULT_GAIN:
        return chance(d, 0.5) ? between(d, 0.0, 1.0) : sign * magnitude(d, 0.01, 20.0);
    case NT_FAULT_DRIFT:
        if (channel == NT_CHANNEL_OPERATOR_FORCE)
            return sign * magnitude(d, 0.01, 10.0);
        return sign * magnitude(d, 1e-9, channel == NT_CHANNEL_STAGE ? lift_speed(p) : 1e-5); /* no lift helps beyond */
    case NT_FAULT_NOISE:
        return magnitude(d, 1.0, 300.0);
    case NT_FAULT_JUMP:
        return sign * throw_dice(d) * p->believed.stage.slip;
    case NT_FAULT_SLIP:
        return sign * (channel == NT_CHANNEL_MASTER_POSITION ? magnitude(d, 1e-6, 1e-2) : magnitude(d, 1e-10, 1e-5));
    case NT_FAULT_POWER: /* where it rests, the tip is lifted */
        return -magnitude(d, 1e-7, 1e-4);
    case NT_FAULT_CLOCK_DRIFT:
        return sign * magnitude(d, 1e-7, 0.1);
    case NT_FAULT_LATE:
        return magnitude(d, 0.1, 200.0);
    case NT_FAULT_CLOCK:
        return sign * magnitude(d, 1e-5, 1e3);
    case NT_FAULT_LIMIT:
        return chance(d, 0.5) ? 0.0 : magnitude(d, 1e-9, 300e-9);
    case NT_FAULT_HYSTERESIS:
        return between(d, 0.0, 0.4);
    case NT_FAULT_PUSH:
        return between(d, -8.0, 8.0);
    default:
        return sign;
    }
}

/* The nth fault that is this failure; 0: there are fewer. */
static inline int find_fault(nt_failure failure, int nth, nt_fault_kind *kind, nt_channel *channel)
{
    int count = 0;
    const nt_fault_description *kinds = nt_fault_descriptions(&count);
    for (int i = 0; i < count; i++)
        for (int j = 0; j <= NT_CHANNEL_RIG; j++)
            if (kinds[i].channels & (1u << j) && failure_of((nt_fault_kind)i, (nt_channel)j) == failure && nth-- == 0) {
                *kind = (nt_fault_kind)i;
                *channel = (nt_channel)j;
                return 1;
            }
    return 0;
}

static inline void draw_kind(dice *d, nt_fault_kind *kind, nt_channel *channel)
{
    int count = 0;
    const nt_fault_description *kinds = nt_fault_descriptions(&count);
    int pair = choose(d, count * (NT_CHANNEL_RIG + 1));
    do {
        pair = (pair + 1) % (count * (NT_CHANNEL_RIG + 1));
        *kind = (nt_fault_kind)(pair / (NT_CHANNEL_RIG + 1));
        *channel = (nt_channel)(pair % (NT_CHANNEL_RIG + 1));
    } while (!(kinds[*kind].channels & (1u << *channel)));
}

/* Of any kind at any time; a search: that which it is about, at any time or about when a stop comes. */
static inline void draw_fault(plot *p, dice *d, closeness *found)
{
    nt_fault_kind kind;
    nt_channel channel;
    if (!p->known)
        draw_kind(d, &kind, &channel);
    else if (!find_fault(p->sought, p->nth, &kind, &channel))
        return;
    double start = between(d, 0.2, 1.2);
    const double duration = magnitude(d, 1e-4, 3.0);
    if (p->known && chance(d, 0.5) && p->stopped > 0.03)
        start = p->stopped + (chance(d, 0.5) ? -1.0 : 1.0) * magnitude(d, 1e-4, 0.03);
    const int lasts = chance(d, 0.6);
    const double value = draw_value(p, d, kind, channel);
    const int runs = kind == NT_FAULT_GAIN && channel == NT_CHANNEL_STAGE && !(value >= 0.0 && value <= 1.0);
    const nt_fault fault = {kind, channel, start, lasts || runs ? HUGE_VAL : duration, value}; /* it would jump back */
    if (!p->rehearses)
        (void)!nt_faults_add(&p->faults, &fault);
    found->fault = nt_fault_descriptions(NULL)[kind].name;
    found->channel = channel;
    found->value = fault.value;
    p->sought = failure_of(kind, channel);
}

static inline void draw_plot(plot *p, dice *d, closeness *found)
{
    p->setup = nt_session_defaults();
    p->setup.ring_capacity = 0;
    p->setup.demand.relative_accuracy = 0.5; /* it judges no force */
    p->faults.count = 0;
    if (p->known) {
        p->known->tune(p);
    } else {
        draw_scene(p, d);
        draw_rig(p, d);
        p->settings = nt_settings_defaults(&p->setup.rig);
        draw_settings(p, d);
        if (p->kind != ATTACK_FAULT && chance(d, 0.4))
            draw_surface(p, d);
    }
    /* as far as a hand of 1 N goes in so many seconds: the tip does come down */
    const double quick = p->settings.gains.alpha_p / p->setup.rig.master.damping;
    const double seconds = p->kind == ATTACK_DYNAMIC ? between(d, 0.001, 0.02) : between(d, 0.01, 0.1);
    const nt_preflight preflight = nt_preflight_make(&p->setup.rig, &p->settings);
    p->setup.clearance =
        smaller(larger(seconds * quick, 1e-9), 100e-9) + p->setup.rig.stage.drift * nt_preflight_time(&preflight);
    dice fault_dice = {.genes = d->genes ? d->genes + GENES - FAULT_GENES : NULL};
    p->believed = p->setup.rig;
    p->setup.settings = p->settings;
    draw_errors(p, d);
    if (p->kind == ATTACK_FAULT)
        draw_fault(p, d->genes ? &fault_dice : d, found);
    p->setup.faults = &p->faults;
    p->setup.probe_model = p->kind == ATTACK_DYNAMIC ? NT_PROBE_DYNAMIC : NT_PROBE_QUASI_STATIC;
    p->setup.seed = (uint64_t)(1e9 * throw_dice(d));
}

/* Time as it passes: a late tick takes many periods. A stop that does not lift needs help at once, as is printed: the
 * frame's drift goes on pressing. */
static inline double pass_time(const nt_session *session, closeness *found)
{
    const double time = (double)session->sim.slave.link.tick * nt_session_touch(session)->period;
    const nt_supervisor_state *supervisor = &nt_session_touch_state(session)->supervisor;
    found->idle += supervisor->lift != NT_LIFT_GOES ? time - found->last_time : 0.0;
    found->last_time = time;
    return time;
}

/* All travel is used up: nothing lifts from a frame that runs on, and help is needed. */
static inline int has_no_travel_left(const nt_session *session)
{
    const double reference = nt_session_touch_state(session)->supervisor.reference;
    return reference <= -0.999 * nt_session_touch(session)->stage_end;
}

static inline void watch(const nt_session *session, const plot *p, closeness *found)
{
    const nt_truth *truth = &session->sim.slave.truth;
    const nt_guarantee *promised = &p->promised;
    const double time = pass_time(session, found);
    if (found->stopped == 0.0 && nt_session_touch_state(session)->supervisor.state >= NT_RETRACT)
        found->stopped = time;
    if (has_no_travel_left(session))
        return;
    const int fails = p->kind == ATTACK_FAULT && p->sought < NT_FAILURES;
    const double force = promised->force + (fails ? promised->failure[p->sought] : 0.0);
    const double most = force + promised->zero_drift * time + promised->frame_drift * found->idle;
    const double worst = truth->peak_force;
    if (!(worst <= found->worst_force)) { /* NaN too */
        found->worst_force = worst;
        found->worst_time = time;
        found->worst_pulls = truth->tip_force[NT_Z] < 0.0;
    }
    found->force = larger(found->force, worst / most);
    if (!isfinite(worst) || !isfinite(truth->tip_force[NT_Z]))
        found->force = HUGE_VAL;
    found->promised_force = force;
    /* the indentation is promised at rest sideways, while the zero has not drifted out of the noise */
    const int rests = !p->setup.map.heights && p->kind != ATTACK_FAULT;
    if (rests && promised->zero_drift * time < 0.5 * promised->noise)
        found->indentation = larger(found->indentation, -truth->deepest_gap / promised->indentation);
}

/* How one operator goes about it. */
typedef struct temper {
    double least, most; /* of a blow [N] */
    double longest;     /* until the next [s] */
    double quickest;    /* a blow comes in this, at least [s] */
    double sideways;    /* share of blows that lead elsewhere */
    double holds;       /* share of blows that take the master somewhere, whatever it pushes back with */
    double reach;       /* so far at the tip, at most [m] */
    double regrips;     /* share of blows before which the master is taken back, uncoupled: a search */
} temper;

static inline temper draw_temper(const plot *p, dice *d)
{
    return (temper){.least = between(d, -5.0, 0.0),
                    .most = magnitude(d, 0.3, 10.0),
                    .longest = magnitude(d, 1e-3, p->known ? 0.5 : 0.2),
                    .quickest = magnitude(d, 1e-4, 0.03),
                    .sideways = throw_dice(d),
                    .holds = chance(d, 0.5) ? 0.0 : throw_dice(d),
                    .reach = magnitude(d, 1e-9, 3e-6),
                    .regrips = p->known && chance(d, 0.5) ? 0.3 * throw_dice(d) : 0.0};
}

/* A blow: any force at any time, and anywhere on a relief. */
static inline void aim(nt_session *session, const plot *p, dice *d, const temper *is)
{
    nt_input input = {.operator_force[NT_Z] = is ? between(d, is->least, is->most) : magnitude(d, 0.5, 5.0),
                      .duration = magnitude(d, is ? is->quickest : 1e-4, 0.05),
                      .x = NAN,
                      .y = NAN};
    if (is && chance(d, is->holds)) {
        const double end = 0.49 * p->setup.rig.master.travel;
        const double sign = chance(d, 0.4) ? -1.0 : 1.0;
        const double way = sign * magnitude(d, 0.3e-9, is->reach) / p->settings.gains.alpha_p;
        input.holds = 1;
        input.master_position[NT_Z] = larger(-end, smaller(end, session->unkept.master_position[NT_Z] + way));
    }
    if (p->setup.map.heights && is && chance(d, is->sideways)) {
        input.x = throw_dice(d) * p->setup.map.dx * (MAP - 1);
        input.y = throw_dice(d) * p->setup.map.dy * (MAP - 1);
    }
    (void)!nt_session_aim(session, &input, NULL);
}

/* Scales, mode or clutch are changed between blows, some times in a run; what is refused stays. */
static inline void request(nt_session *session, dice *d)
{
    if (!chance(d, 0.36))
        return;
    const nt_gains *gains = &nt_session_touch(session)->settings.gains;
    const double share = throw_dice(d);
    const nt_scaling scaling = {gains->alpha_p * magnitude(d, 0.5, 2.0), gains->alpha_f * magnitude(d, 0.5, 2.0)};
    if (share < 0.33)
        (void)!nt_session_rescale(session, &scaling, NULL);
    else if (share < 0.66)
        (void)!nt_session_clutch(session, share < 0.5);
    else
        (void)!nt_session_set_mode(session, (nt_mode)choose(d, 4), NULL);
}

/* Uncoupled, the master goes back to where it began: a hand that presses farther than the travel allows at once. 0: the
 * session has ended. */
static inline int regrip(nt_session *session, const plot *p, long *tick, closeness *found)
{
    const nt_input back = {
        .holds = 1, .master_position[NT_Z] = -0.4 * p->setup.rig.master.travel, .duration = 0.02, .x = NAN, .y = NAN};
    (void)!nt_session_clutch(session, 1);
    (void)!nt_session_aim(session, &back, NULL);
    for (const double end = (double)*tick + 0.03 / nt_session_touch(session)->period; (double)*tick < end; ++*tick) {
        if (nt_session_advance(session, 1) != NT_OK)
            return 0;
        watch(session, p, found);
    }
    (void)!nt_session_clutch(session, 0);
    return 1;
}

/* One operator's blows; whatever stops is armed again, but after a fault. 0: the session has ended. */
static inline int strike(nt_session *session, const plot *p, dice *d, long end, closeness *found)
{
    const double period = nt_session_touch(session)->period;
    const temper is = draw_temper(p, d);
    const long pause = (long)(0.2 / period);
    long tick = (long)nt_session_touch_state(session)->ticks, asked = tick;
    while (tick < end) {
        if (is.regrips > 0.0 && chance(d, is.regrips) && !regrip(session, p, &tick, found))
            return 0;
        aim(session, p, d, tick == 0 ? NULL : &is); /* the first brings the tip down */
        if (tick - asked > pause && !p->known) {
            request(session, d);
            asked = tick;
        }
        const long until = tick + 1 + (long)(magnitude(d, 1e-4, is.longest) / period);
        for (; tick < until && tick < end; tick++) {
            if (nt_session_advance(session, 1) != NT_OK)
                return 0;
            watch(session, p, found);
        }
        if (nt_session_touch_state(session)->supervisor.state >= NT_RETRACT && !found->fault[0]) {
            found->stops++;
            (void)!nt_session_arm(session, 1);
        }
    }
    return 1;
}

/* What the operator reads before arming: promised of the same setup with the rig as it is believed to be, and of
 * nothing else. */
static inline nt_status take_promise(plot *p)
{
    nt_session_setup believed = p->setup;
    nt_session *session = NULL;
    believed.rig = p->believed;
    believed.settings = p->settings;
    believed.faults = NULL;
    believed.minimum_margin = 0.0; /* that was judged of the rig as it is */
    const nt_status status = nt_session_open(&session, &believed, NULL);
    if (status != NT_OK)
        return status;
    p->promised = nt_session_guarantee(session);
    p->reach = nt_session_reach(session);
    nt_session_close(session);
    return NT_OK;
}

/* One operator after the other. */
static inline void fight(nt_session *session, plot *p, dice *d, closeness *found)
{
    static const double lasts[ATTACKS] = {1.0, 0.06, 2.0}; /* of each [s] */
    const double period = nt_session_touch(session)->period;
    const int operators = p->known ? 1 : operators_of(p->kind);
    for (int i = 1; i <= operators; i++)
        if (!strike(session, p, d, (long)(i * lasts[p->kind] / period), found)) {
            found->force = HUGE_VAL; /* it must not end */
            return;
        }
}

/* One run. opened: 0 where it was refused before arming. */
static inline closeness run_plot(plot *p, dice *d)
{
    closeness found = {.fault = ""};
    draw_plot(p, d, &found);
    nt_session *session = NULL;
    nt_problem problem = {0};
    if (nt_session_open(&session, &p->setup, &problem) != NT_OK || take_promise(p) != NT_OK) {
        nt_session_close(session);
        found.refused = problem;
        return found;
    }
    found.opened = 1;
    fight(session, p, d, &found);
    nt_session_close(session);
    return found;
}

#endif
