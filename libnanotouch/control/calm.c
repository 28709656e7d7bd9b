/* SPDX-License-Identifier: BSD-3-Clause
 * What the hand feels of a loop that is stable (docs/margins.md): ripple, ringing, and a stage too slow for the steps.
 *
 * At the operator's scale y = x_s/alpha_p, with k_r = alpha_f alpha_p k_eff and the read force r = k_r y + n:
 *   y = Hs (x_m + e_m) + D e_c + E e_y,   x_m = W (-(1 + K_f) r + K_f P e_g),
 * Hs the stage with its loop, W the master with the hand on it, P the low-pass of f_m; e_m, e_c, e_y, e_g the errors of
 * master, stage command, its read-out and gauge, n the probe's. Behind a virtual coupling of stiffness K the tool q
 * (x_m
 * - r/K) leads the stage, and the spring K (x_m - tool) is felt instead of r. With G = q/(1 + q k_r Hs/K), the share of
 * r that is felt, Z = k_r Hs where it is rigid and K (1 - G) behind a coupling, L = (1 + K_f) Z W and S = 1/(1 + L)
 *   r = S (Z e_m + G (k_r (D e_c + E e_y) + n)) + K_f/(1 + K_f) P L S e_g.
 * A hand that holds still feels f = (1 + K_f) r - K_f P f: behind its own low-pass that is r behind one of 1 + K_f
 * times the corner. An oscillating push of a hand comes back from the contact times L S.
 *
 * Steps are not white. They come in time with the loop or with a resonance: then each makes the largest |r/e| of its
 * own size. The stage's bare resonance comes after the steps of its command, and the loop broken there, L_q, tells how
 * much of its swing comes back to them. */
#include <math.h>

#include "control/sampled.h"
#include "core/clamp.h"
#include "core/same_bits.h"
#include "nanotouch/control.h"
#include "nanotouch/margins.h"
#include "nanotouch/material.h"

#define PEAK_TO_PEAK 6.0 /* standard deviations */
#define LIMIT_CYCLE 2.0  /* limit cycles of steps stay within this times white errors, or the largest answer */
#define THROWN 4.0       /* steps of the command that one of the master makes: none keeps time with a resonance, */
#define BACK 0.05        /* if no more than this of the swing there comes back, |L_q| */
#define FINE 0.01        /* of a walk along the circle */
#define SHARE_OF_LIMIT 0.25
#define ARMED 1.5 /* margin at which sessions are; near 1 the observer sees the energy that is given */

/* Errors, each with a step and noise of its own. */
typedef struct source {
    double step;  /* [m], [N] */
    double noise; /* standard deviation */
    double unit;  /* force at the hand of one unit, where nothing filters it [N per unit] */
    double least; /* the same of what a step makes at least: limit cycles go to and fro by it */
    int rings;    /* its steps may keep time with what the loop answers most */
} source;

typedef struct walk {
    double squares[NT_RIPPLE_SOURCES]; /* integrals of |r/e|^2 over theta/pi */
    double highest[NT_RIPPLE_SOURCES]; /* largest |r/e|^2 */
    double ringing;
    double back; /* |L_q| where that of the stage's command is largest */
} walk;

/* |r/e|^2 behind the low-pass of a hand that holds still. */
static walk gains_at(const nt_sampled_loop *loop, const nt_gains *gains, const source *sources, double theta)
{
    const double K_f = gains->force_gain;
    const double k_r = sources[NT_RIPPLE_MASTER].unit;
    const nt_sampled_flow flow = nt_sampled_flow_at(loop, K_f, theta);
    const double complex share = flow.tool / (1.0 + flow.tool * k_r * loop->tool.give * flow.stage);
    const double complex felt = loop->tool.give > 0.0 ? (1.0 - share) / loop->tool.give : k_r * flow.stage;
    const double complex L = (1.0 + K_f) * felt * flow.master, S = 1.0 / (1.0 + L);
    const double c = lesser(1.0, (1.0 + K_f) * loop->force_filter);
    const double complex back = nt_complex(cos(theta), -sin(theta)), behind = c / (1.0 - (1.0 - c) * back) * S;
    const double complex answers[NT_RIPPLE_SOURCES] = {
        felt,
        share * sources[NT_RIPPLE_STAGE_COMMAND].unit * flow.command,
        share * sources[NT_RIPPLE_STAGE_READING].unit * flow.reading,
        share * sources[NT_RIPPLE_PROBE].unit,
        K_f / (1.0 + K_f) * flow.low_pass * L,
    };
    walk found = {.ringing = cabs(L * S), .back = cabs(flow.tool / (share * S * (1.0 - flow.reading)) - 1.0)};
    for (int i = 0; i < NT_RIPPLE_SOURCES; i++) {
        const double size = cabs(answers[i] * behind);
        found.squares[i] = found.highest[i] = size * size;
    }
    return found;
}

static walk integrate(const nt_sampled_loop *loop, const nt_gains *gains, const source *sources)
{
    double from = nt_sampled_first(loop);
    walk last = gains_at(loop, gains, sources, from), all = {.ringing = 0.0};
    while (from < NT_PI) {
        const double to = lesser(nt_sampled_next(loop, from, FINE), NT_PI);
        const walk now = gains_at(loop, gains, sources, to);
        if (now.squares[NT_RIPPLE_STAGE_COMMAND] > all.highest[NT_RIPPLE_STAGE_COMMAND])
            all.back = now.back;
        for (int i = 0; i < NT_RIPPLE_SOURCES; i++) {
            all.squares[i] += 0.5 * (last.squares[i] + now.squares[i]) * (to - from) / NT_PI;
            all.highest[i] = fmax(all.highest[i], now.squares[i]);
        }
        all.ringing = fmax(all.ringing, now.ringing);
        last = now;
        from = to;
    }
    return all;
}

/* Steps add up, noises do so by their squares, and steps stand beside noise as noise does. */
static void add_up(const source *sources, const walk *found, nt_calm *calm)
{
    double steps = 0.0, noises = 0.0;
    for (int i = 0; i < NT_RIPPLE_SOURCES; i++) {
        const source *from = &sources[i];
        const double white = PEAK_TO_PEAK * sqrt(found->squares[i]), noise = white * from->noise;
        const double whole = from->rings ? sqrt(found->highest[i]) : 0.0;
        const double step = fmax(fmax(LIMIT_CYCLE * white / sqrt(12.0), from->least), whole) * from->step;
        calm->parts[i] = hypotenuse(step, noise);
        steps += step;
        noises = hypotenuse(noises, noise);
    }
    calm->ripple = hypotenuse(steps, noises);
}

static void list(const nt_rig *rig, const nt_gains *gains, double contact_stiffness, source *sources)
{
    const nt_probe *probe = &rig->probe;
    const double k_c = probe->spring_constant, k_eff = k_c / (1.0 + k_c / contact_stiffness);
    const double meter = gains->alpha_f * k_eff, volt = gains->alpha_f * k_c * probe->sensitivity;
    const int gauge = rig->master.gauge && gains->force_gain > 0.0;
    sources[NT_RIPPLE_MASTER] =
        (source){rig->master.resolution, 0.0, meter * gains->alpha_p, meter * gains->alpha_p, 1};
    sources[NT_RIPPLE_STAGE_COMMAND] = (source){rig->stage.command_resolution, 0.0, meter, meter, 1};
    sources[NT_RIPPLE_STAGE_READING] = (source){rig->stage.resolution, rig->stage.noise, meter, 0.5 * meter, 1};
    sources[NT_RIPPLE_PROBE] = (source){probe->resolution, probe->noise / PEAK_TO_PEAK, volt, volt, 0};
    sources[NT_RIPPLE_GAUGE] = (source){0.0, 0.0, 0.0, 0.0, 0};
    if (gauge) /* a step of the gauge is no step at the hand: the master's mass and the low-pass are in between */
        sources[NT_RIPPLE_GAUGE] =
            (source){0.0, hypotenuse(rig->master.gauge_noise, rig->master.gauge_resolution / sqrt(12.0)), 0.0, 0.0, 0};
}

static void judge(nt_calm *calm, double needed)
{
    const struct {
        double margin;
        const char *rule;
    } verdicts[] = {{calm->felt / calm->ripple, "ripple"},
                    {NT_RINGING_MOST / calm->ringing, "ringing"},
                    {calm->slewing / needed, "slewing"}};
    calm->margin = INFINITY;
    calm->rule = "ripple";
    for (int i = 0; i < 3; i++) {
        if (verdicts[i].margin >= calm->margin)
            continue;
        calm->margin = verdicts[i].margin;
        calm->rule = verdicts[i].rule;
    }
}

nt_calm nt_margins_calm(const nt_rig *rig, const nt_settings *settings, double contact_stiffness)
{
    nt_calm calm = {.felt = fmin(NT_CLEARLY_FELT, SHARE_OF_LIMIT * settings->gains.alpha_f * settings->limits.force),
                    .slewing = INFINITY};
    source sources[NT_RIPPLE_SOURCES];
    if (!rig->master.motor || contact_stiffness == 0.0) {
        judge(&calm, 1.0);
        return calm;
    }
    const nt_servo_equivalent equivalent = nt_servo_equivalent_of(rig, settings, contact_stiffness);
    const nt_sampled_loop loop = nt_sampled_loop_of(&equivalent.rig, settings, &equivalent.gains);
    if (!(loop.master.damping > 0.0) || loop.master.whole > NT_SAMPLED_LONGEST) {
        calm.ripple = calm.ringing = calm.slewing = calm.margin = NAN;
        calm.rule = "ripple";
        return calm;
    }
    list(&equivalent.rig, &equivalent.gains, contact_stiffness, sources);
    const walk found = integrate(&loop, &equivalent.gains, sources);
    const double thrown = equivalent.gains.alpha_p * sources[NT_RIPPLE_MASTER].step;
    sources[NT_RIPPLE_STAGE_COMMAND].rings =
        found.back >= BACK || thrown < THROWN * sources[NT_RIPPLE_STAGE_COMMAND].step;
    add_up(sources, &found, &calm);
    calm.ringing = found.ringing;
    const nt_margins margins = nt_margins_compute(&equivalent.rig, &equivalent.gains, contact_stiffness);
    const double step = equivalent.gains.alpha_p * equivalent.rig.master.resolution / settings->limits.stage_speed;
    const double slew = fmax(0.0, step - 1.0 / equivalent.gains.rate);
    calm.slewing = margins.margin * margins.loop_delay / (margins.loop_delay + slew);
    judge(&calm, slew > 0.0 ? ARMED : 1.0);
    return calm;
}
