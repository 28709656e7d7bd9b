/* SPDX-License-Identifier: BSD-3-Clause
 * How far the loop is from its stability limit (docs/margins.md).
 *
 * Loop gain kappa C(s)/(s (m s + b)), kappa = (1 + K_f) alpha_f alpha_p k_eff. C: two sampled hops (stage command and
 * motor force), each half a period of hold and a dead time, and the stage. */
#include "internal/margins.h"
#include "internal/control.h"
#include "internal/rig.h"
#include "nanotouch/margins.h"

#include <math.h>

#include "control/known_law.h"
#include "control/margins.h"
#include "control/sampled.h"
#include "core/rig.h"
#include "core/same_bits.h"
#include "nanotouch/control.h"
#include "nanotouch/material.h"

/* The stage's share of D = sup -Im C(jw)/w. At w = 0 it is the delay of notch and stage, 2 zeta/wn and, where samples
 * are few, what the sampled notch adds; below zeta = 1/sqrt(2) the resonance has more, without a notch nearly Q/wn. */
static double stage_lag(const nt_stage *stage, const nt_gains *gains)
{
    const nt_stage_loop loop = nt_stage_loop_make(stage, gains);
    const double zeta = nt_stage_loop_notches(stage, gains) ? gains->stage_damping : 0.5 / stage->quality;
    const double notch = (loop.b[1] + 2.0 * loop.b[2]) / (loop.b[0] + loop.b[1] + loop.b[2]) -
                         (loop.a[1] + 2.0 * loop.a[2]) / (1.0 + loop.a[1] + loop.a[2]); /* [periods] */
    const double delay = notch / gains->rate + 1.0 / (2.0 * NT_PI * stage->resonance * stage->quality);
    return 2.0 * zeta * zeta < 1.0 ? delay / (4.0 * zeta * zeta * (1.0 - zeta * zeta)) : delay;
}

/* One hop: half a period of hold and the dead time. */
static double hop_delay(const nt_rig *rig, const nt_gains *gains)
{
    return 0.5 / gains->rate + nt_sampled_dead_time(rig, gains);
}

/* Round the slave: from the stage's command to the reading of the force. */
static double slave_delay(const nt_rig *rig, const nt_gains *gains)
{
    return hop_delay(rig, gains) + stage_lag(&rig->stage, gains);
}

/* The whole loop, with what a slow master holds: its reading, and the motor's force. */
static double loop_delay(const nt_rig *rig, const nt_gains *gains)
{
    return hop_delay(rig, gains) + slave_delay(rig, gains) + 2.0 * nt_sampled_master_hold(rig, gains);
}

/* Standard deviation of the gauge behind the low-pass y += c (u - y), which passes c/(2 - c) of the variance. */
static double filtered_gauge_noise(const nt_master *master, const nt_gains *gains)
{
    const double c = -expm1(-2.0 * NT_PI * gains->force_filter / gains->rate);
    return sqrt(c / (2.0 - c)) * hypotenuse(master->gauge_noise, master->gauge_resolution / sqrt(12.0));
}

/* R2: v[k+1] = v[k] - (K_f b_h T/m) v[k-d] turns over at 2 sin(pi/(4 d + 2)). */
static double pad_limit(const nt_rig *rig, const nt_gains *gains)
{
    const double dead_time = nt_sampled_dead_time(rig, gains) + nt_sampled_master_hold(rig, gains);
    const double delay = dead_time * gains->rate; /* [periods] */
    return rig->master.mass * gains->rate / rig->hand.damping * 2.0 * sin(NT_PI / (4.0 * delay + 2.0));
}

/* alpha_f alpha_p k_eff: the contact at the operator's scale; k_c on a rigid sample. */
static double reflected_stiffness(const nt_rig *rig, const nt_gains *gains, double contact_stiffness)
{
    const double k_c = rig->probe.spring_constant;
    return gains->alpha_f * gains->alpha_p * k_c / (1.0 + k_c / contact_stiffness);
}

/* Who may hold the master of a loop with a virtual coupling: the hand of the rig, none, and the weight of a handle that
 * was let go. A hand that holds it still has a limit of its own (tool_stiffness). Without a coupling the rig's alone.
 */
static nt_sampled_limits limits_of(const nt_sampled_loop *loop, double force_gain, double reflected_stiffness)
{
    static const nt_hand others[] = {{.mass = 0.0}, {.mass = NT_RELEASED_HANDLE}};
    nt_sampled_limits least = nt_sampled_limits_of(loop, force_gain, reflected_stiffness);
    for (size_t i = 0; i < sizeof others / sizeof others[0] && loop->tool.give > 0.0; i++) {
        const nt_sampled_loop held = nt_sampled_loop_held(loop, &others[i]);
        const nt_sampled_limits found = nt_sampled_limits_of(&held, force_gain, reflected_stiffness);
        least.force_gain = fmin(least.force_gain, found.force_gain);
        if (found.loop_stiffness < least.loop_stiffness) {
            least.loop_stiffness = found.loop_stiffness;
            least.angle = found.angle;
        }
    }
    return least;
}

/* What the loop amounts to; contact_stiffness: as it is. A coupling softens it where rules of thumb see it. */
static nt_margins compute(const nt_rig *rig, const nt_gains *gains, double contact_stiffness,
                          const nt_sampled_loop *loop)
{
    const double K_f = gains->force_gain, whole = reflected_stiffness(rig, gains, contact_stiffness);
    const double softens = 1.0 / (1.0 + whole * loop->tool.give), k_r = whole * softens;
    const double step = fmax(rig->stage.command_resolution, gains->alpha_p * rig->master.resolution);
    nt_margins margins = {
        .loop_stiffness = (1.0 + K_f) * k_r,
        .loop_delay = loop_delay(rig, gains),
        .pad_limit = pad_limit(rig, gains),
        .mass_limit = 1.0 + rig->master.mass / rig->hand.mass,
        .quantisation_step = (1.0 + K_f) * k_r / gains->alpha_p * step,
        .force_noise = hypotenuse((1.0 + K_f) * gains->alpha_f * nt_probe_force_noise(&rig->probe),
                                  K_f * filtered_gauge_noise(&rig->master, gains)),
    };
    /* R1. Above its corner the stage's integral g lifts C by 1 + g times the lag that it sees. */
    const double lift = 1.0 + gains->stage_integral * (margins.loop_delay - hop_delay(rig, gains));
    margins.stability_limit = rig->master.damping / (margins.loop_delay * lift);
    margins.margin = margins.stability_limit / margins.loop_stiffness;
    const double servo = gains->height_gain * k_r / (gains->alpha_f * gains->alpha_p * rig->probe.spring_constant) *
                         slave_delay(rig, gains); /* integral gain times lag */
    const double hand_hop = hop_delay(rig, gains) + 2.0 * nt_sampled_master_hold(rig, gains);
    const double height = rig->master.damping / (hand_hop * gains->height_stiffness);
    margins.height_margin = rig->master.motor ? fmin(1.0 / servo, height) : 1.0 / servo;
    const nt_sampled_limits limits = limits_of(loop, K_f, whole);
    margins.exact_limit = limits.loop_stiffness * softens;
    margins.exact_frequency = limits.angle / (2.0 * NT_PI) * gains->rate;
    margins.force_gain_limit = limits.force_gain;
    margins.integral_limit = limits.stage_gain * gains->rate;
    margins.coupling_margin = limits.tool_stiffness / whole;
    return margins;
}

nt_margins nt_margins_compute(const nt_rig *rig, const nt_gains *gains, double contact_stiffness)
{
    const nt_rig real = nt_rig_with_steps(rig);
    const nt_sampled_loop loop = nt_sampled_loop_make(&real, gains);
    return compute(&real, gains, contact_stiffness, &loop);
}

double nt_margins_loop_delay(const nt_rig *rig, const nt_gains *gains)
{
    const nt_rig real = nt_rig_with_steps(rig);
    return loop_delay(&real, gains);
}

/* In touch; rig and gains are those that the law amounts to. */
static nt_verdict judge_touch(const nt_margins *margins, const nt_rig *rig, const nt_gains *gains)
{
    const nt_verdict verdicts[] = {
        NT_VERDICT(margins->margin, "R1 contact"),
        NT_VERDICT(margins->exact_limit / margins->loop_stiffness, "exact contact"),
        NT_VERDICT(gains->force_gain > 0.0 ? margins->force_gain_limit / gains->force_gain : (double)INFINITY,
                   "exact K_f"),
        NT_VERDICT(rig->master.max_force / margins->quantisation_step, "R4 steps"),
        NT_VERDICT(rig->master.max_force / (3.0 * margins->force_noise), "R5 noise"),
        NT_VERDICT(margins->coupling_margin, "virtual coupling"),
    };
    enum { VERDICTS = (int)(sizeof verdicts / sizeof verdicts[0]) };
    nt_verdict least = verdicts[0];
    for (int i = 1; i < VERDICTS; i++)
        if (!(verdicts[i].margin >= least.margin))
            least = verdicts[i];
    return least;
}

/* Without a motor no loop closes through the hand: a virtual coupling and the stage's own loop are left. */
static nt_verdict judge_without_motor(const nt_margins *margins, const nt_gains *gains)
{
    const nt_verdict coupled = NT_VERDICT(margins->coupling_margin, "virtual coupling");
    const nt_verdict stage = NT_VERDICT(margins->integral_limit / gains->stage_integral, "stage integral");
    const nt_verdict least = gains->stage_integral > 0.0 && !(stage.margin >= coupled.margin) ? stage : coupled;
    return isinf(least.margin) ? (nt_verdict)NT_VERDICT(INFINITY, "none: no loop is closed") : least;
}

/* The height servo over a hard sample, which the amplitude follows one to one, with the lags of a free lever and of the
 * lock-in amplifier in the loop: gain times lag, as of the force. */
static nt_verdict judge_tapping(const nt_margins *margins, const nt_rig *rig, const nt_settings *settings,
                                const nt_gains *gains)
{
    const double lag = slave_delay(rig, gains) + nt_tap_lag(rig, &settings->tap);
    return (nt_verdict)NT_VERDICT(fmin(margins->height_margin, 1.0 / (gains->height_gain * lag)), "amplitude servo");
}

nt_verdict nt_verdict_on_known(const nt_rig *rig, const nt_settings *settings, double contact_stiffness, nt_mode mode,
                               nt_margins *margins)
{
    const nt_servo_equivalent equivalent = nt_servo_equivalent_of(rig, settings, contact_stiffness);
    const nt_sampled_loop loop = nt_sampled_loop_of(&equivalent.rig, settings, &equivalent.gains);
    *margins = compute(&equivalent.rig, &equivalent.gains, contact_stiffness, &loop);
    if (mode == NT_MODE_CURVE)
        return (nt_verdict)NT_VERDICT(INFINITY, "none: no loop is closed");
    if (mode == NT_MODE_TAPPING)
        return judge_tapping(margins, &equivalent.rig, settings, &equivalent.gains);
    if (mode != NT_MODE_TOUCH)
        return (nt_verdict)NT_VERDICT(margins->height_margin, "height servo");
    const nt_verdict stage = NT_VERDICT(nt_servo_stage_margin(rig, settings), "stage of Eq. 17");
    const nt_verdict touch = rig->master.motor ? judge_touch(margins, &equivalent.rig, &equivalent.gains)
                                               : judge_without_motor(margins, &equivalent.gains);
    return stage.margin >= touch.margin ? touch : stage;
}

nt_resolution nt_resolution_compute(const nt_rig *own, const nt_gains *gains, double slave_path)
{
    const nt_rig real = nt_rig_with_steps(own), *rig = &real;
    const double k_c = rig->probe.spring_constant;
    const double range = 2.0 * k_c * nt_probe_deflection_range(&rig->probe); /* 20 k_c S in the paper */
    nt_resolution found = {.slave_step = fmax(rig->stage.command_resolution, rig->stage.resolution),
                           .master_steps = rig->master.travel / rig->master.resolution,
                           .gauge_steps =
                               rig->master.gauge ? 2.0 * rig->master.gauge_range / rig->master.gauge_resolution : 0.0,
                           .master_travel = slave_path / gains->alpha_p};
    found.slave_force = fmax(6.0 * nt_probe_force_noise(&rig->probe), k_c * found.slave_step);
    found.slave_steps = slave_path / found.slave_step;
    found.force_steps = range / found.slave_force;
    found.master_force = gains->alpha_f * found.slave_force;
    return found;
}

double nt_margins_jury_limit(const nt_master *master, double period)
{
    const double m = master->mass;
    const double b = master->damping;
    const double x = b * period / m;
    const double e = exp(-x); /* both limits divided through by e^x, so that large x does not overflow */
    const double rise = -expm1(-x);
    const double oscillating = b * b * rise / (m * (rise - x * e));
    const double denominator = (x - 2.0) + (x + 2.0) * e;
    const double flipping = 2.0 * b * b * (1.0 + e) / (m * denominator);
    return denominator > 0.0 ? fmin(oscillating, flipping) : oscillating;
}
