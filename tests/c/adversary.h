/* SPDX-License-Identifier: BSD-3-Clause
 * One run against the guarantee, drawn from dice: scene, rig as it is believed to be and as it is, settings, operator,
 * drift, and one fault; how close the truth comes to what was promised. The dice are random numbers, or genes that a
 * search changes. */
#ifndef TESTS_ADVERSARY_H
#define TESTS_ADVERSARY_H

#include <math.h>
#include <stdlib.h>

#include "larger.h"
#include "nanotouch/nanotouch.h"
#include "nanotouch/random.h"
#include "session/state.h" /* the truth between two ticks */

typedef enum attack { ATTACK_QUASI_STATIC, ATTACK_DYNAMIC, ATTACK_FAULT, ATTACKS } attack;

enum { GENES = 400 };
typedef struct dice {
    nt_random random;
    double *genes; /* NULL: random numbers */
    int used;
} dice;

static inline double throw_dice(dice *d)
{
    return d->genes ? d->genes[d->used++ % GENES] : nt_random_uniform(&d->random);
}
static inline double between(dice *d, double low, double high)
{
    return low + (high - low) * throw_dice(d);
}
/* Evenly in the logarithm. */
static inline double magnitude(dice *d, double low, double high)
{
    return low * pow(high / low, throw_dice(d));
}
static inline int chance(dice *d, double share)
{
    return throw_dice(d) < share;
}
static inline int choose(dice *d, int count)
{
    const int chosen = (int)between(d, 0.0, (double)count);
    return chosen < count ? chosen : count - 1;
}

enum { MAP = 40 };

/* What is run. The session is opened with the lever as it is, and a limit that trips where the believed one does. */
typedef struct plot {
    attack kind;
    int plain; /* the default scene, rig and settings: for a search */
    nt_session_setup setup;
    nt_rig believed;
    nt_settings settings; /* as the operator has set them */
    nt_faults faults;
    double heights[MAP * MAP];
} plot;

/* How close it came: 1 is the promise. */
typedef struct closeness {
    double force, indentation;
    double worst_force, promised_force; /* [N] */
    int stops, opened;
    const char *fault; /* "" for none */
    double value;
} closeness;

static inline void draw_scene(plot *p, dice *d)
{
    static const double moduli[] = {169e9, 70e9, 3e9, 50e6, 2e6};
    nt_scene *scene = &p->setup.scene;
    scene->sample.youngs_modulus = moduli[choose(d, 5)];
    scene->tip.radius = magnitude(d, 8e-9, 100e-9);
    scene->medium.relative_humidity = chance(d, 0.5) ? 0.0 : between(d, 0.1, 0.8);
}

/* Bumps, up to 100 nm; the tip may go anywhere on them. */
static inline void draw_surface(plot *p, dice *d)
{
    const double pitch = magnitude(d, 5e-9, 50e-9), height = magnitude(d, 1e-9, 100e-9);
    const double kx = between(d, 0.1, 1.0), ky = between(d, 0.0, 1.0), phase = between(d, 0.0, 6.28);
    for (int i = 0; i < MAP * MAP; ++i)
        p->heights[i] = height * sin(kx * (i % MAP) + phase) * cos(ky * (double)(i / MAP));
    p->setup.map = (nt_height_map){p->heights, MAP, MAP, pitch, pitch};
    p->setup.x = p->setup.y = 0.5 * pitch * (MAP - 1);
}

static inline void draw_rig(plot *p, dice *d)
{
    nt_rig *rig = &p->setup.rig;
    const int dynamic = p->kind == ATTACK_DYNAMIC;
    rig->probe.spring_constant = magnitude(d, dynamic ? 0.05 : 0.5, 40.0);
    rig->probe.noise = chance(d, 0.2) && p->kind != ATTACK_FAULT ? 0.0 : magnitude(d, 5e-3, 0.1);
    rig->probe.resonance = dynamic ? magnitude(d, 15e3, 150e3) : 100e3;
    rig->probe.quality = dynamic ? magnitude(d, 2.0, 1000.0) : 100.0;
    rig->probe.spring_constant_sigma = between(d, 0.0, 0.1);
    rig->probe.sensitivity_sigma = between(d, 0.0, 0.1);
    rig->probe.drift = magnitude(d, 1e-12, 1e-8);
    rig->stage.drift = magnitude(d, 1e-11, 1e-7);
    rig->stage.slip = magnitude(d, 1e-9, 50e-9);
    rig->stage.hysteresis = chance(d, 0.7) ? 0.0 : between(d, 0.0, 0.3);
    rig->master.mass = magnitude(d, 0.05, 0.5);
    rig->master.damping = magnitude(d, 20.0, 200.0);
    rig->master.gauge = chance(d, 0.2) ? 0.0 : 1.0;
    rig->stage.resonance = magnitude(d, 200.0, 2000.0);
    rig->stage.quality = magnitude(d, 2.0, 50.0);
}

static inline void draw_settings(plot *p, dice *d)
{
    nt_settings *settings = &p->settings;
    nt_gains *gains = &settings->gains;
    gains->rate = magnitude(d, 2e3, 20e3);
    gains->delay = floor(between(d, 0.0, 4.0));
    gains->force_gain = settings->control.choice == NT_CONTROL_IMPEDANCE ? 0.0 : between(d, 0.0, 10.0);
    gains->alpha_p *= magnitude(d, 0.3, 3.0);
    gains->alpha_f *= magnitude(d, 0.1, 2.0);
    gains->velocity_feedforward = between(d, 0.0, 0.5);
    gains->alpha_f_retract = between(d, 0.5, 1.5);
    gains->stage_integral = chance(d, 0.9) ? 60.0 : 0.0;
    settings->limits.force *= p->kind == ATTACK_DYNAMIC ? magnitude(d, 1e-2, 1.0) : between(d, 0.1, 1.0);
    settings->limits.indentation = magnitude(d, 2e-9, 300e-9);
    settings->limits.stage_speed = magnitude(d, 1e-6, 50e-6);
    settings->limits.lateral_speed = magnitude(d, 1e-7, 50e-6);
}

/* Calibration that is off by up to 3 sigma, both together: what the session is opened with. */
static inline void draw_errors(plot *p, dice *d)
{
    const double angle = between(d, 0.0, 6.2832), off = 2.999 * sqrt(throw_dice(d));
    const double k = 1.0 + off * cos(angle) * p->believed.probe.spring_constant_sigma;
    const double S = 1.0 + off * sin(angle) * p->believed.probe.sensitivity_sigma;
    p->setup.rig.probe.spring_constant *= k;
    p->setup.settings.limits.force *= k;
    p->setup.settings.gains.alpha_f /= k;
    const nt_fault gain = {NT_FAULT_GAIN, NT_CHANNEL_DEFLECTION, 0.0, HUGE_VAL, S};
    const nt_fault zero = {NT_FAULT_DRIFT, NT_CHANNEL_DEFLECTION, 0.0, HUGE_VAL,
                           between(d, -1.0, 1.0) * p->believed.probe.drift};
    const nt_fault frame = {NT_FAULT_DRIFT, NT_CHANNEL_STAGE, 0.0, HUGE_VAL,
                            between(d, -1.0, 1.0) * p->believed.stage.drift};
    (void)!nt_faults_add(&p->faults, &gain);
    (void)!nt_faults_add(&p->faults, &zero);
    (void)!nt_faults_add(&p->faults, &frame);
}

/* Any value that the kind may have and that a rig may show; a jump no larger than is reckoned with. */
static inline double draw_value(const plot *p, dice *d, nt_fault_kind kind, nt_channel channel)
{
    const double sign = chance(d, 0.5) ? -1.0 : 1.0;
    switch (kind) {
    case NT_FAULT_GAIN:
        return chance(d, 0.5) ? between(d, 0.0, 1.0) : sign * magnitude(d, 0.01, 20.0);
    case NT_FAULT_DRIFT:
        return sign * (channel == NT_CHANNEL_OPERATOR_FORCE ? magnitude(d, 0.01, 10.0) : magnitude(d, 1e-9, 1e-5));
    case NT_FAULT_NOISE:
        return magnitude(d, 1.0, 300.0);
    case NT_FAULT_JUMP:
        return sign * throw_dice(d) * p->believed.stage.slip;
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

static inline void draw_fault(plot *p, dice *d, closeness *found)
{
    int count = 0;
    const nt_fault_description *kinds = nt_fault_descriptions(&count);
    const nt_fault_kind kind = (nt_fault_kind)choose(d, count);
    nt_channel channel = (nt_channel)choose(d, NT_CHANNEL_RIG + 1);
    while (!(kinds[kind].channels & (1u << channel)))
        channel = (nt_channel)((channel + 1) % (NT_CHANNEL_RIG + 1));
    const double start = between(d, 0.2, 1.2), duration = magnitude(d, 1e-4, 3.0);
    const int lasts = chance(d, 0.6);
    const nt_fault fault = {kind, channel, start, lasts ? HUGE_VAL : duration, draw_value(p, d, kind, channel)};
    (void)!nt_faults_add(&p->faults, &fault);
    found->fault = kinds[kind].name;
    found->value = fault.value;
}

static inline void draw_plot(plot *p, dice *d, closeness *found)
{
    p->setup = nt_session_defaults();
    p->setup.ring_capacity = 0;
    p->setup.clearance = 5e-9;
    p->faults.count = 0;
    if (!p->plain) {
        draw_scene(p, d);
        draw_rig(p, d);
        p->setup.clearance = magnitude(d, 2e-9, 50e-9);
    }
    p->settings = p->setup.settings = nt_settings_defaults(&p->setup.rig);
    if (!p->plain)
        draw_settings(p, d);
    if (!p->plain && p->kind != ATTACK_FAULT && chance(d, 0.25))
        draw_surface(p, d);
    p->believed = p->setup.rig;
    p->settings.gains.set_point = smaller(p->settings.gains.set_point, 0.5 * p->settings.limits.force);
    p->setup.settings = p->settings;
    draw_errors(p, d);
    if (p->kind == ATTACK_FAULT)
        draw_fault(p, d, found);
    p->setup.faults = &p->faults;
    p->setup.probe_model = p->kind == ATTACK_DYNAMIC ? NT_PROBE_DYNAMIC : NT_PROBE_QUASI_STATIC;
    p->setup.seed = (uint64_t)(1e9 * throw_dice(d));
}

static inline void watch(const nt_session *session, const plot *p, const nt_guarantee *promised, double time,
                         closeness *found)
{
    const nt_truth *truth = &session->sim.slave.truth;
    const double force = found->fault[0] ? promised->with_failure : promised->force;
    const double most = force + promised->zero_drift * time;
    const double worst = truth->peak_force;
    if (!(worst <= found->worst_force)) /* NaN too */
        found->worst_force = worst;
    found->force = larger(found->force, worst / most);
    if (!isfinite(worst))
        found->force = HUGE_VAL;
    found->promised_force = force;
    /* the indentation is promised at rest sideways, while the zero has not drifted out of the noise */
    if (!found->fault[0] && !p->setup.map.heights && promised->zero_drift * time < 0.5 * promised->noise)
        found->indentation = larger(found->indentation, -truth->deepest_gap / promised->indentation);
}

/* A blow: any force at any time; scales, mode, clutch and place changed between them. */
static inline void blow(nt_session *session, const plot *p, dice *d, int first)
{
    const nt_gains *gains = &nt_session_touch(session)->settings.gains;
    nt_input input = {.operator_force[NT_Z] = first ? 2.0 : between(d, -3.0, 8.0),
                      .duration = magnitude(d, 1e-4, 0.05),
                      .x = NAN,
                      .y = NAN};
    if (p->setup.map.heights && chance(d, 0.5)) {
        input.x = throw_dice(d) * p->setup.map.dx * (MAP - 1);
        input.y = throw_dice(d) * p->setup.map.dy * (MAP - 1);
    }
    (void)!nt_session_aim(session, &input, NULL);
    const double share = throw_dice(d);
    const nt_scaling scaling = {gains->alpha_p * magnitude(d, 0.5, 2.0), gains->alpha_f * magnitude(d, 0.5, 2.0)};
    if (first || p->plain)
        return;
    if (share < 0.1)
        (void)!nt_session_rescale(session, &scaling, NULL); /* may be too close to the limit */
    else if (share < 0.15)
        (void)!nt_session_clutch(session, share < 0.125);
    else if (share < 0.2)
        (void)!nt_session_set_mode(session, (nt_mode)choose(d, 4), NULL); /* this too */
}

/* Blows for as long; whatever stops is armed again, but after a fault. */
static inline void fight(nt_session *session, const plot *p, dice *d, closeness *found)
{
    static const double lasts[ATTACKS] = {1.5, 0.08, 2.5}; /* [s] */
    const nt_touch *touch = nt_session_touch(session);
    const nt_hazard hazard =
        nt_hazard_of(nt_session_plan(session), &p->believed, &p->settings, nt_session_reach(session).slope);
    const nt_guarantee promised = nt_guarantee_compute(&p->believed, &p->settings, &hazard);
    const long end = (long)(lasts[p->kind] / touch->period);
    const double tare = 0.2; /* the preflight [s] */
    long tick = 0;
    for (int number = 0; tick < end; number++) {
        blow(session, p, d, number < (p->kind == ATTACK_DYNAMIC ? 1 : 3));
        const long until = tick + 1 + (long)(magnitude(d, 1e-4, p->plain ? 0.5 : 0.1) / touch->period);
        for (; tick < until && tick < end; tick++) {
            if (nt_session_advance(session, 1) != NT_OK) {
                found->force = HUGE_VAL; /* it must not end */
                return;
            }
            watch(session, p, &promised, tare + (double)tick * touch->period, found);
        }
        if (nt_session_touch_state(session)->supervisor.state >= NT_RETRACT && !found->fault[0]) {
            found->stops++;
            (void)!nt_session_arm(session, 1);
        }
    }
}

/* One run. opened: 0 where it was refused before arming. */
static inline closeness run_plot(plot *p, dice *d)
{
    closeness found = {.fault = ""};
    draw_plot(p, d, &found);
    nt_session *session = NULL;
    if (nt_session_open(&session, &p->setup, NULL) != NT_OK)
        return found;
    found.opened = 1;
    fight(session, p, d, &found);
    nt_session_close(session);
    return found;
}

#endif
