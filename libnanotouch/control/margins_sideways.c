/* SPDX-License-Identifier: BSD-3-Clause
 * Margins of a master of three axes (docs/margins.md, "Three axes").
 *
 * Sample, friction and lever together give no energy: what the hand gets comes from delays alone. Over a delay D a
 * force that grows by at most J with the way gives back less than J D times the mean square speed, and the master's
 * damping takes b times it. With J a matrix over the axes, and D_ij from the motion of axis j to the force on axis i,
 * that holds where the symmetric part of J_ij D_ij, over sqrt(b_i b_j), has no eigenvalue above 1. */
#include <math.h>

#include "control/known_law.h"
#include "control/sampled.h"
#include "core/same_bits.h"
#include "nanotouch/margins.h"
#include "nanotouch/material.h"

/* dF/dx of the tip over its base [N/m]: the lever gives way along z. */
typedef struct growth {
    double lateral;  /* of the lateral force with the lateral way */
    double by_z;     /* of the lateral force with the stage's travel */
    double of_z;     /* of the vertical force with the lateral way */
    double vertical; /* k_eff */
} growth;

static growth growth_of(const nt_rig *rig, double contact_stiffness, const nt_sideways_contact *contact)
{
    const double k_c = rig->probe.spring_constant;
    const double k_eff = k_c / (1.0 + k_c / contact_stiffness);
    const double given = contact_stiffness > 0.0 ? k_eff / contact_stiffness : 1.0; /* indentation per travel */
    const double by_z = k_eff * contact->slope + contact->grip * given;
    return (growth){.lateral = contact->stick + contact->slope * by_z + contact->load * contact->curvature,
                    .by_z = by_z,
                    .of_z = k_eff * contact->slope,
                    .vertical = k_eff};
}

static double largest_alpha_f(const nt_gains *gains)
{
    return gains->alpha_f * fmax(1.0, fmax(gains->alpha_f_approach, gains->alpha_f_retract));
}

/* Whole periods from the command of x or y until the sample shows it: the stage is there at once. */
static double shown_after(const nt_rig *rig, const nt_gains *gains)
{
    return 1.0 + ceil(nt_sampled_dead_time(rig, gains) * gains->rate - 1e-9);
}

/* 1 + kappa z^-n X(z) = 0 on the circle: where -1/(z^-n X) is real and positive. */
static double complex open_loop(const nt_sampled *master, double periods, double theta)
{
    const nt_sampled_value value = nt_sampled_at(master, theta);
    const double turned = periods * theta;
    return -value.position / value.determinant * nt_complex(cos(turned), -sin(turned));
}

/* The first crossing is that of the smallest gain: |X| falls with frequency, as the hand has no resonance above b/m.
 * A stiff hand has one: all crossings are looked at. */
static void find_exact(nt_sideways_margins *found, const nt_sampled_loop *loop, double periods, double rate)
{
    nt_sampled_loop walked = *loop;
    walked.stage = loop->master;
    double last = nt_sampled_first(&walked), phase = cimag(open_loop(&loop->master, periods, last));
    found->exact_limit = HUGE_VAL;
    found->exact_frequency = NAN;
    for (double theta = last; theta < NT_PI; last = theta) {
        theta = fmin(fmin(nt_sampled_next(&walked, theta, 0.125), theta + 0.25 / (periods + 1.0)), NT_PI);
        double low = last, high = theta;
        const double next = cimag(open_loop(&loop->master, periods, theta));
        const int crosses = phase * next < 0.0;
        for (int i = 0; i < 60 && crosses; ++i) {
            const double middle = 0.5 * (low + high);
            *(phase * cimag(open_loop(&loop->master, periods, middle)) > 0.0 ? &low : &high) = middle;
        }
        const double gain = creal(open_loop(&loop->master, periods, high));
        if ((crosses || theta >= NT_PI) && gain * found->exact_limit > 1.0) {
            found->exact_limit = 1.0 / gain;
            found->exact_frequency = high / (2.0 * NT_PI) * rate;
        }
        phase = next;
    }
}

/* Larger eigenvalue of a symmetric matrix of two. */
static double larger_eigenvalue(double a, double b, double c)
{
    return 0.5 * (a + c) + hypotenuse(0.5 * (a - c), b);
}

/* b_z D_z is that of R1 along z, its law's K_f and all. */
static void find_coupled(nt_sideways_margins *found, const growth *g, double damping, double scale,
                         const nt_margins *along_z)
{
    const double gained = along_z->loop_stiffness / (scale * g->vertical);
    const double vertical = 1.0 / along_z->margin, lateral = 1.0 / found->margin;
    const double worth = sqrt(damping * along_z->stability_limit * along_z->loop_delay / gained);
    const double off = 0.5 * scale * (g->by_z * along_z->loop_delay + g->of_z * found->loop_delay) / worth;
    const int couples = g->vertical > 0.0 && g->by_z > 0.0;
    found->coupling = couples ? off / (0.5 * (vertical + lateral)) : 0.0;
    found->coupled_margin = 1.0 / larger_eigenvalue(lateral, couples ? off : 0.0, vertical);
}

nt_sideways_margins nt_margins_sideways(const nt_rig *own, const nt_settings *settings, double contact_stiffness,
                                        const nt_sideways_contact *contact, const nt_margins *along_z)
{
    const nt_rig rig = nt_rig_with_steps(own);
    const nt_gains *gains = &settings->gains;
    const growth g = growth_of(&rig, contact_stiffness, contact);
    const double periods = shown_after(&rig, gains);
    const double scale = largest_alpha_f(gains) * gains->alpha_p;
    nt_sideways_margins found = {.loop_stiffness = scale * g.lateral,
                                 .loop_delay = (periods + 0.5) / gains->rate + nt_sampled_dead_time(&rig, gains) +
                                               2.0 * nt_sampled_master_hold(&rig, gains)};
    found.margin = rig.master.damping / (found.loop_delay * found.loop_stiffness);
    const nt_sampled_loop loop = nt_sampled_loop_make(&rig, gains);
    if (loop.master.damping > 0.0 && loop.master.whole <= NT_SAMPLED_LONGEST)
        find_exact(&found, &loop, periods, gains->rate);
    find_coupled(&found, &g, rig.master.damping, scale, along_z);
    return found;
}

nt_verdict nt_verdict_sideways(const nt_sideways_margins *margins)
{
    const nt_verdict verdicts[] = {NT_VERDICT(margins->margin, "R1 sideways"),
                                   NT_VERDICT(margins->exact_limit / margins->loop_stiffness, "exact sideways"),
                                   NT_VERDICT(margins->coupled_margin, "R1 of all axes")};
    nt_verdict least = verdicts[0];
    for (int i = 1; i < 3; ++i)
        if (!(verdicts[i].margin >= least.margin))
            least = verdicts[i];
    return least;
}

double nt_margins_projected(const nt_rig *rig, const nt_settings *settings, double contact_stiffness,
                            const nt_sideways_contact *contact)
{
    const growth g = growth_of(rig, contact_stiffness, contact);
    const double share = hypotenuse(settings->gains.projection_x, settings->gains.projection_y);
    return share > 0.0 && g.vertical > 0.0 ? 1.0 + share * g.by_z / g.vertical : 1.0;
}
