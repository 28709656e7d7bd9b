/* SPDX-License-Identifier: BSD-3-Clause
 * How far the loop is from its stability limit (docs/control.md, rules R1, R4, R5).
 *
 * Loop gain kappa C(s)/(s (m s + b)), kappa = (1 + K_f) alpha_f alpha_p k_eff: two sampled hops (stage command and
 * motor force), each half a period of hold and d periods of delay, and the damped stage's lag 2 zeta/wn. */
#include <math.h>

#include "nanotouch/control.h"
#include "nanotouch/material.h"

nt_margins nt_margins_compute(const nt_rig *rig, const nt_gains *gains, double contact_stiffness)
{
    const double k_c = rig->probe.spring_constant;
    const double k_eff = contact_stiffness * k_c / (contact_stiffness + k_c);
    const double T = 1.0 / gains->rate;
    const double tau_stage = 2.0 * gains->stage_damping / (2.0 * NT_PI * rig->stage.resonance);
    const double reflected = (1.0 + gains->force_gain) * gains->alpha_f;
    const double slave_noise = reflected * nt_probe_force_noise(&rig->probe);
    /* the gauge's noise passes the low-pass, whose noise bandwidth is pi/2 times its cut-off */
    const double pass = fmin(1.0, NT_PI * gains->force_filter * T);
    const double gauge_noise =
        gains->force_gain * sqrt(pass) * hypot(rig->master.gauge_noise, rig->master.gauge_resolution / sqrt(12.0));
    nt_margins margins = {
        .loop_stiffness = reflected * gains->alpha_p * k_eff,
        .loop_delay = 2.0 * (0.5 * T + gains->delay * T) + tau_stage,
        .quantisation_step =
            reflected * k_eff * fmax(rig->stage.command_resolution, gains->alpha_p * rig->master.resolution),
        .force_noise = hypot(slave_noise, gauge_noise),
    };
    margins.stability_limit = rig->master.damping / margins.loop_delay; /* R1 */
    margins.margin = margins.stability_limit / margins.loop_stiffness;
    return margins;
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
