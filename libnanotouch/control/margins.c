/* SPDX-License-Identifier: BSD-3-Clause
 * How far the loop is from its stability limit (docs/control.md, rules R1, R4, R5).
 *
 * Loop gain kappa C(s)/(s (m s + b)), kappa = (1 + K_f) alpha_f alpha_p k_eff. C: two sampled hops (stage command and
 * motor force), each half a period of hold and d periods of delay, and the stage. */
#include <math.h>

#include "nanotouch/control.h"
#include "nanotouch/material.h"

/* The stage's share of D = sup -Im C(jw)/w. At w = 0 it is the delay of notch and stage, 2 zeta/wn and, where samples
 * are few, what the sampled notch adds; below zeta = 1/sqrt(2) the resonance has more, without a notch nearly Q/wn. */
static double stage_lag(const nt_stage *stage, const nt_gains *gains)
{
    const nt_stage_loop loop = nt_stage_loop_make(stage, gains);
    const int notched = loop.a[2] != 0.0;
    const double zeta = notched ? gains->stage_damping : 0.5 / stage->quality;
    const double notch = (loop.b[1] + 2.0 * loop.b[2]) / (loop.b[0] + loop.b[1] + loop.b[2]) -
                         (loop.a[1] + 2.0 * loop.a[2]) / (1.0 + loop.a[1] + loop.a[2]); /* [periods] */
    const double delay = notch / gains->rate + 1.0 / (2.0 * NT_PI * stage->resonance * stage->quality);
    return 2.0 * zeta * zeta < 1.0 ? delay / (4.0 * zeta * zeta * (1.0 - zeta * zeta)) : delay;
}

/* Standard deviation of the gauge behind the low-pass y += c (u - y), which passes c/(2 - c) of the variance. */
static double filtered_gauge_noise(const nt_master *master, const nt_gains *gains)
{
    const double c = -expm1(-2.0 * NT_PI * gains->force_filter / gains->rate);
    return sqrt(c / (2.0 - c)) * hypot(master->gauge_noise, master->gauge_resolution / sqrt(12.0));
}

nt_margins nt_margins_compute(const nt_rig *rig, const nt_gains *gains, double contact_stiffness)
{
    const double k_c = rig->probe.spring_constant;
    const double k_eff = k_c / (1.0 + k_c / contact_stiffness); /* k_c on a rigid sample */
    const double T = 1.0 / gains->rate;
    const double reflected = (1.0 + gains->force_gain) * gains->alpha_f;
    nt_margins margins = {
        .loop_stiffness = reflected * gains->alpha_p * k_eff,
        .loop_delay = 2.0 * (0.5 * T + gains->delay * T) + stage_lag(&rig->stage, gains),
        .quantisation_step =
            reflected * k_eff * fmax(rig->stage.command_resolution, gains->alpha_p * rig->master.resolution),
        .force_noise = hypot(reflected * nt_probe_force_noise(&rig->probe),
                             gains->force_gain * filtered_gauge_noise(&rig->master, gains)),
    };
    margins.stability_limit = rig->master.damping / margins.loop_delay; /* R1 */
    margins.margin = margins.stability_limit / margins.loop_stiffness;
    const double hop = 0.5 * T + gains->delay * T;
    const double servo = gains->height_gain * k_eff / k_c * (margins.loop_delay - hop); /* integral gain times lag */
    margins.height_margin = fmin(1.0 / servo, rig->master.damping / (hop * gains->height_stiffness));
    return margins;
}

double nt_margins_force_overshoot(const nt_rig *rig, const nt_settings *settings, double slope)
{
    const nt_limits *limits = &settings->limits;
    const double speed = limits->stage_speed + slope * limits->lateral_speed;
    const double delay = nt_margins_compute(rig, &settings->gains, INFINITY).loop_delay;
    return rig->probe.spring_constant * speed * delay + 6.0 * nt_probe_force_noise(&rig->probe);
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
