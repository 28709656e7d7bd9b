/* SPDX-License-Identifier: BSD-3-Clause
 * How far force and indentation can go past their limits (docs/safety.md). The sample that first shows too much is at
 * most one period old; the command that answers it is held, delayed, and followed by the stage: all that is the loop's
 * delay D of rule R1. Until then the tip goes on as fast as stage and surface may move, against at most the lever and
 * the stiffest contact in series, as stiff as it is on the mean of that way (nt_hazard). */
#include <math.h>

#include "control/bound.h"
#include "control/margins.h"
#include "control/servo.h"
#include "core/rig.h"
#include "core/same_bits.h"
#include "internal/control.h"
#include "internal/margins.h"
#include "nanotouch/control.h"
#include "nanotouch/margins.h"
#include "nanotouch/material.h"

#define SIGMAS 6.0
#define INTERVALS 400

/* A bare resonance overshoots a step by exp(-pi zeta/sqrt(1 - zeta^2)) of it. */
static double overshoot(const nt_stage *stage)
{
    const double zeta = 0.5 / stage->quality;
    return zeta < 1.0 ? exp(-NT_PI * zeta / sqrt(1.0 - zeta * zeta)) : 0.0;
}

/* A command in steps is off by up to half of one. The bare resonance behind it makes of that at most the integral of
 * its |impulse response|, coth(pi zeta/(2 sqrt(1 - zeta^2))): steps that come in time with it [m]. */
static double stepping_amplitude(const nt_stage *stage)
{
    return 0.5 * stage->command_resolution * (1.0 + overshoot(stage)) / (1.0 - overshoot(stage));
}

const char *nt_failure_name(nt_failure failure)
{
    static const char *const names[NT_FAILURES] = {"deflection read wrong", "deflection sensor dead",
                                                   "slip of stage or surface", "stage runs or turns"};
    return (unsigned)failure < NT_FAILURES ? names[failure] : "";
}

/* All that the terms have in common. */
typedef struct basis {
    nt_servo_equivalent equivalent;
    nt_supervisor supervisor;
    double share;                /* 3 sigma of k_c, 1 + that */
    double spring;               /* k_c as stiff as it may be [N/m] */
    double k_eff;                /* on the stiffest contact [N/m] */
    double failing[NT_FAILURES]; /* the same, as far as each failure presses [N/m] */
    double reaction;             /* D [s] */
    double travel;               /* of what is driven, as far as it may go instead: 1 + 3 sigma [-] */
    double unread;   /* of a way that the read-out tells, what it may leave out: 3 sigma/(1 - 3 sigma) [-] */
    double vertical; /* the stage's speed, with hysteresis and what its loop may add [m/s] */
} basis;

static double in_series(double spring, double stiffness)
{
    return spring / (1.0 + spring / stiffness);
}

static basis basis_of(const nt_rig *rig, const nt_settings *settings, const nt_hazard *hazard)
{
    basis b = {.equivalent = nt_servo_equivalent_of(rig, settings, hazard->stiffness),
               .supervisor = nt_supervisor_make(rig, settings)};
    const nt_limits *limits = &settings->limits;
    b.share = 1.0 + NT_GUARANTEE_SIGMAS * rig->probe.spring_constant_sigma;
    b.spring = b.share * rig->probe.spring_constant;
    b.k_eff = in_series(b.spring, hazard->stiffness);
    for (int i = 0; i < NT_FAILURES; ++i)
        b.failing[i] = in_series(b.spring, fmax(hazard->stiffness, hazard->failing[i]));
    nt_rig slave = b.equivalent.rig;
    slave.master.rate = 0.0; /* a slow master takes no part in a stop */
    b.reaction = nt_margins_loop_delay(&slave, &b.equivalent.gains);
    b.travel = 1.0 + NT_GUARANTEE_SIGMAS * rig->stage.travel_sigma;
    b.unread = 1.0 / (1.0 - NT_GUARANTEE_SIGMAS * rig->stage.position_sigma) - 1.0;
    b.vertical = b.travel * ((1.0 + rig->stage.hysteresis) * limits->stage_speed +
                             b.equivalent.gains.stage_integral * limits->follow_error);
    return b;
}

/* A stage that is told to go faster than it can falls behind its command, and goes on when that turns: by all that
 * nothing shows [m]. */
static double falls_behind(const basis *b, const nt_stage *stage)
{
    const nt_supervisor *s = &b->supervisor;
    const double hidden = b->travel * (s->stage_most + s->correction_most);
    return b->vertical > b->travel * stage->max_speed ? hidden + 3.0 * b->vertical * s->period : 0.0;
}

/* The tip's way past first touch when the limit shows: the stage's reading may leave out part of its own way, which is
 * the tip's and the lever's [m]. */
static double indentation_limit(const basis *b, const nt_limits *limits)
{
    return limits->indentation + b->unread * (limits->indentation + limits->force * b->share / b->spring);
}

/* Deflection and travel watch each other. Read as g times what it is, the deflection x is stopped by the force limit
 * L = g k_c x and by the indentation I = (1 - g) x past a first touch that was noticed at f/g: most at k_c x = L + k_c
 * I L/(L - f). A zero that drifts away is the same. */
static double misread(const basis *b, const nt_limits *limits)
{
    const double seen = limits->force - 2.0 * b->supervisor.free_force;
    return seen > 0.0 ? b->spring * indentation_limit(b, limits) * limits->force / seen : HUGE_VAL;
}

/* How far the stage goes before a sensor without noise is called dead [m]. */
static double unnoticed(const basis *b)
{
    const nt_supervisor *s = &b->supervisor;
    const double way = (1.0 + b->unread) * s->stuck_distance;
    return way > 0.0 ? fmax(b->vertical * NT_STUCK_SAMPLES * s->period, way) : HUGE_VAL;
}

static void add_failures(nt_guarantee *found, const basis *b, const nt_rig *rig, const nt_limits *limits)
{
    const nt_stage *stage = &rig->stage;
    const nt_supervisor *s = &b->supervisor;
    const double three = 3.0 * s->period; /* ticks in a row */
    const double hidden = b->travel * (s->stage_most + s->correction_most), fastest = b->travel * stage->max_speed;
    const double stuck = (1.0 + overshoot(stage)) * (hidden + b->vertical * three);
    const double runs = fastest * (b->reaction + three) + 2.0 * (1.0 + b->unread) * s->turn_slack +
                        nt_servo_ringing(&b->equivalent, fastest);
    const double tolerance = s->free_force + b->spring * 1e-9;
    found->failure[NT_FAILURE_READ_OUT] = misread(b, limits);
    found->failure[NT_FAILURE_SENSOR] = b->failing[NT_FAILURE_SENSOR] * unnoticed(b);
    const int follows = b->equivalent.gains.stage_integral > 0.0; /* without, hysteresis hides a stage that sticks */
    found->failure[NT_FAILURE_SLIP] = follows ? b->failing[NT_FAILURE_SLIP] * fmax(stuck, stage->slip) : HUGE_VAL;
    found->failure[NT_FAILURE_STAGE] = b->failing[NT_FAILURE_STAGE] * runs + tolerance;
    double worst = 0.0;
    for (int i = 0; i < NT_FAILURES; ++i)
        worst = fmax(worst, found->failure[i]);
    found->with_failure = found->force + worst;
}

/* What the swing of a jump adds to the force `still`. It begins with the tip at the surface and dies away as
 * exp(-t/tau) while stage and surface press no faster than k_eff (v t + swing): the most that both have in any of some
 * intervals. */
static double outlasting(const nt_guarantee *g, const basis *b, const nt_hazard *hazard, double still)
{
    const double end = still / (b->k_eff * g->speed), dies = hazard->snap_in - hazard->thermal;
    double most = still + hazard->thermal;
    for (int i = 0; i < INTERVALS; ++i) {
        const double pressed = b->k_eff * g->speed * end * (i + 1) / INTERVALS + g->ringing;
        const double left = dies * exp(-end * i / INTERVALS / hazard->ring_down);
        most = fmax(most, fmin(still, pressed) + left + hazard->thermal);
    }
    return most - still;
}

/* Friction and slope can hold the tip with no more than this. A lever that shows it is stopped at the limit: x and y
 * stand within D, and what the sample meanwhile presses the more acts along its slope. */
static double lateral_force(const nt_guarantee *found, const basis *b, const nt_rig *rig, const nt_settings *settings,
                            const nt_hazard *hazard)
{
    const nt_limits *limits = &settings->limits;
    const double most = hazard->friction + hazard->slope * found->force;
    if (!(rig->probe.lateral_stiffness > 0.0))
        return most;
    const double grows = hazard->stick + hazard->slope * hazard->slope * b->k_eff + hazard->curvature * found->force;
    const double way = b->travel * limits->lateral_speed * (b->reaction + 2.0 / settings->gains.rate);
    const double pressed = hazard->slope * fmax(0.0, found->force - limits->force);
    return fmin(most, limits->lateral_force + grows * way + pressed);
}

nt_guarantee nt_guarantee_compute(const nt_rig *rig, const nt_settings *settings, const nt_hazard *hazard)
{
    return nt_guarantee_within(rig, settings, hazard, HUGE_VAL);
}

nt_guarantee nt_guarantee_within(const nt_rig *rig, const nt_settings *settings, const nt_hazard *hazard, double relief)
{
    const nt_limits *limits = &settings->limits;
    const basis b = basis_of(rig, settings, hazard);
    const nt_probe *probe = &b.equivalent.rig.probe;
    const double swing =
        nt_servo_ringing(&b.equivalent, b.vertical) + b.travel * stepping_amplitude(&b.equivalent.rig.stage);
    const double read_error = NT_GUARANTEE_SIGMAS * probe->sensitivity_sigma;
    nt_guarantee found = {.reaction_time = b.reaction,
                          .moves_sideways = rig->stage.axes > 1.0,
                          .arrival = hazard->arrival,
                          .zero_drift = b.spring * probe->drift,
                          .frame_drift = b.spring * rig->stage.drift, /* however deep it presses in the end */
                          .tare = hazard->tared,
                          .help_time = (2.0 - b.travel) * 0.5 * rig->stage.travel / rig->stage.drift};
    /* (1 + a)/(1 - b) of the limit, a^2/sigma_k^2 + b^2/sigma_S^2 = 9: a + b is at most 3 hypot */
    const double off = NT_GUARANTEE_SIGMAS * hypotenuse(probe->spring_constant_sigma, probe->sensitivity_sigma);
    found.calibration = limits->force * off / (1.0 - off);
    const double climbs = found.moves_sideways ? b.travel * hazard->slope * limits->lateral_speed : 0.0;
    found.speed = b.vertical + climbs;
    const double closer = b.vertical * b.reaction + fmin(climbs * b.reaction, relief) + falls_behind(&b, &rig->stage);
    const int slides = found.moves_sideways && limits->lateral_speed > 0.0;
    found.motion = b.k_eff * closer + (slides ? b.spring * hazard->rise : 0.0);
    found.ringing = b.k_eff * swing;
    const double sigma = nt_probe_force_noise(probe) / probe->spring_constant;
    found.noise = b.spring * (SIGMAS * sigma + probe->sensitivity * probe->resolution);
    const double still = limits->force + found.calibration + found.motion + found.ringing + found.noise + found.tare;
    found.snap_in = fmax(outlasting(&found, &b, hazard, still), hazard->pull_off_force); /* of either sign */
    found.force = still + found.snap_in;
    found.lateral_force = lateral_force(&found, &b, rig, settings, hazard);
    add_failures(&found, &b, rig, limits);
    /* first touch is noticed where the force leaves the noise, and read with it; a tip that snaps in goes over what
     * that stretches the lever by */
    const double read =
        (2.0 * found.noise + found.tare + hazard->pull_off_force + read_error * limits->force) / probe->spring_constant;
    const double by_travel =
        indentation_limit(&b, limits) + closer + swing + read + hazard->unseen + hazard->snap_in_depth;
    found.indentation = fmin(by_travel, hazard->deepest); /* a hard sample is not pressed in that far by this force */
    return found;
}
