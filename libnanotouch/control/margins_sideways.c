/* SPDX-License-Identifier: BSD-3-Clause
 * Margins of a master of three axes (docs/margins.md, "Three axes").
 *
 * Sample, friction and lever together give no energy: what the hand gets comes from delays alone. Over a delay D a
 * force that grows by at most J with the way gives back less than J D times the mean square speed, and the master's
 * damping takes b times it. With J a matrix over the axes, and D_ij from the motion of axis j to the force on axis i,
 * that holds where the symmetric part of J_ij D_ij, over sqrt(b_i b_j), has no eigenvalue above 1. Mean delays make it
 * a rule; beside it stands the exact limit of all axes together, over a contact that sticks and one that slips. */
#include <math.h>

#include "control/known_law.h"
#include "control/margins.h"
#include "control/sampled.h"
#include "core/same_bits.h"
#include "internal/margins.h"
#include "internal/rig.h"
#include "nanotouch/control.h"
#include "nanotouch/margins.h"
#include "nanotouch/material.h"

enum { SLOPES = 4, CONTACTS = 4 };
#define ON_THE_AXIS 1e-6 /* of an eigenvalue: less is no imaginary part */

/* dF/dx of the tip over its base [N/m]: the lever gives way along z. */
typedef struct growth {
    double lateral;  /* of the lateral force with the lateral way */
    double by_z;     /* of the lateral force with the stage's travel */
    double of_z;     /* of the vertical force with the lateral way */
    double vertical; /* k_eff */
    double grips;    /* of friction's limit with the stage's travel */
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
                    .vertical = k_eff,
                    .grips = contact->grip * given};
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

/* --- the exact limit of all axes together ---
 *
 * The motors answer a force on the tip, r along z and f sideways, by y = -G r and x = -X f; a contact by (f, r) = J (x,
 * y). So the loop closes where det(1 + g diag(X, G) J) = 0, g a factor on alpha_f: where an eigenvalue of diag(X, G) J
 * passes through -1/g on the unit circle. */

typedef struct axes {
    nt_sampled_loop z;    /* of the law that is in force */
    nt_sampled_loop side; /* x or y: its master alone */
    double periods;       /* until the sample shows the stage's answer to x or y */
    double force_gain;
} axes;

static void loci_at(const axes *of, double J[2][2], double theta, double complex found[2])
{
    const nt_sampled_terms terms = nt_sampled_terms_at(&of->z, theta);
    const double complex G = nt_sampled_touch(&of->z, &terms, of->force_gain) /
                             (nt_sampled_servo(&of->z, &terms) * nt_sampled_air(&terms, of->force_gain));
    const double complex X = -open_loop(&of->side.master, of->periods, theta);
    const double complex half = 0.5 * (X * J[0][0] + G * J[1][1]);
    const double complex root = nt_complex_root(half * half - X * G * (J[0][0] * J[1][1] - J[0][1] * J[1][0]));
    found[0] = half + root;
    found[1] = half - root;
}

/* As they go on from `before`. */
static void follow_loci(const axes *of, double J[2][2], double theta, const double complex before[2],
                        double complex found[2])
{
    loci_at(of, J, theta, found);
    const double straight = cabs(found[0] - before[0]) + cabs(found[1] - before[1]);
    const double crossed = cabs(found[1] - before[0]) + cabs(found[0] - before[1]);
    if (straight <= crossed)
        return;
    const double complex first = found[0];
    found[0] = found[1];
    found[1] = first;
}

/* g where a locus crosses the negative axis between two angles. */
static double crossing_of(const axes *of, double J[2][2], const double ends[2], const double complex before[2], int i)
{
    double low = ends[0], high = ends[1];
    double complex from[2] = {before[0], before[1]}, at[2];
    follow_loci(of, J, high, from, at);
    for (int n = 0; n < 50; ++n) {
        const double middle = 0.5 * (low + high);
        double complex there[2];
        follow_loci(of, J, middle, from, there);
        if (cimag(from[i]) * cimag(there[i]) > 0.0) {
            low = middle;
            from[0] = there[0];
            from[1] = there[1];
        } else {
            high = middle;
            at[0] = there[0];
            at[1] = there[1];
        }
    }
    const int is_real = fabs(cimag(at[i])) <= ON_THE_AXIS * cabs(at[i]); /* else two have changed places */
    return is_real && creal(at[i]) < 0.0 ? -1.0 / creal(at[i]) : HUGE_VAL;
}

static double exact_of(const axes *of, double J[2][2])
{
    double last = fmin(nt_sampled_first(&of->z), nt_sampled_first(&of->side)), limit = HUGE_VAL;
    double complex before[2], now[2];
    loci_at(of, J, last, before);
    for (double theta = last; theta < NT_PI; last = theta) {
        theta = fmin(nt_sampled_next(&of->z, theta, 0.125), nt_sampled_next(&of->side, theta, 0.125));
        theta = fmin(fmin(theta, last + 0.25 / (of->periods + 1.0)), NT_PI);
        follow_loci(of, J, theta, before, now);
        for (int i = 0; i < 2; ++i) {
            if (cimag(before[i]) * cimag(now[i]) < 0.0)
                limit = fmin(limit, crossing_of(of, J, (double[2]){last, theta}, before, i));
            if (theta >= NT_PI && creal(now[i]) < 0.0 && fabs(cimag(now[i])) <= ON_THE_AXIS * cabs(now[i]))
                limit = fmin(limit, -1.0 / creal(now[i]));
            before[i] = now[i];
        }
    }
    return limit;
}

/* What the contact may be: smooth, stuck, or slipping down or up a slope, where friction grows or falls with the load.
 */
static void contact_of(const growth *g, const nt_sideways_contact *contact, double slope, int kind, double J[2][2])
{
    static const double slips[CONTACTS] = {0.0, 0.0, 1.0, -1.0};
    const double by_z = g->vertical * slope + slips[kind] * g->grips;
    J[0][0] = slope * by_z + contact->load * contact->curvature + (kind == 1 ? contact->stick : 0.0);
    J[0][1] = by_z;
    J[1][0] = g->vertical * slope;
    J[1][1] = g->vertical;
}

/* On the steepest slope and on gentler ones. */
static double exact_together(const axes *of, const growth *g, const nt_sideways_contact *contact, double scale)
{
    double limit = HUGE_VAL;
    const int kinds = contact->stick > 0.0 || contact->grip > 0.0 ? CONTACTS : 1; /* without friction: smooth */
    const int slopes = contact->slope > 0.0 ? SLOPES : 1;
    for (int i = 0; i < slopes * kinds; ++i) {
        double J[2][2];
        contact_of(g, contact, contact->slope * (1 + i / kinds) / slopes, i % kinds, J);
        limit = fmin(limit, exact_of(of, J));
    }
    return limit / scale;
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

/* A law of one's own by what it amounts to; one that amounts to nothing known has no margin along z. */
static axes axes_of(const nt_rig *rig, const nt_settings *own, double contact_stiffness, const nt_sampled_loop *loop)
{
    nt_settings settings = *own;
    if (own->control.choice == NT_CONTROL_OWN)
        (void)nt_margins_own_law(rig, own, contact_stiffness, &settings);
    const nt_servo_equivalent equivalent = nt_servo_equivalent_of(rig, &settings, contact_stiffness);
    axes all = {.z = nt_sampled_loop_of(&equivalent.rig, &settings, &equivalent.gains),
                .side = *loop,
                .periods = shown_after(rig, &own->gains),
                .force_gain = equivalent.gains.force_gain};
    all.side.stage = loop->master; /* the stage is there at once */
    return all;
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
    const int is_closed = loop.master.damping > 0.0 && loop.master.whole <= NT_SAMPLED_LONGEST;
    if (is_closed)
        find_exact(&found, &loop, periods, gains->rate);
    find_coupled(&found, &g, rig.master.damping, scale, along_z);
    if (is_closed && g.vertical > 0.0 && g.by_z > 0.0) {
        const axes all = axes_of(&rig, settings, contact_stiffness, &loop);
        found.coupled_margin = fmin(found.coupled_margin, exact_together(&all, &g, contact, scale));
    }
    return found;
}

nt_verdict nt_verdict_sideways(const nt_sideways_margins *margins)
{
    const nt_verdict verdicts[] = {NT_VERDICT(margins->margin, "R1 sideways"),
                                   NT_VERDICT(margins->exact_limit / margins->loop_stiffness, "exact sideways"),
                                   NT_VERDICT(margins->coupled_margin, "all axes")};
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
