/* SPDX-License-Identifier: BSD-3-Clause
 * Snap-in. The tip stands on approach at a minimum of V, until that is lost: at the first gap where K + k = 0, or where
 * adhesion takes hold. From there it falls into the well of contact, and swings about its bottom with the energy e
 * between the two. Nothing but the lever's own damping takes that away; what adhesion dissipates when it takes hold is
 * not the tip's.
 *
 * The hand presses on meanwhile, slowly beside the lever: then the action J = int p dz over a swing is constant
 * (adiabatic invariant; Landau and Lifshitz, Mechanics, 49). A swing that stays in contact has J = 2 pi e/w, w^2 ~
 * K + k. One that a pull-off has let go begins with K alone; pressed, it strikes and leaves ever faster and harder. */
#include "session/well.h"

#include <math.h>

#include "nanotouch/material.h"
#include "scene/parts.h"

#define NODES 64 /* of the integral of a swing */
#define TRIALS 16

nt_law_value nt_well_law(const nt_well *well, double gap)
{
    const nt_interaction_state never = {0};
    nt_law_value law = nt_interaction_eval_gap(well->plan, &never, &well->place, gap);
    const double capture = nt_plan_capture_gap(well->plan, &well->place);
    if (gap <= capture && well->outside > capture)
        law.U += well->taken;
    return law;
}

static double potential(const nt_well *w, double gap)
{
    const double stretch = gap - w->base;
    return nt_well_law(w, gap).U + 0.5 * w->spring * stretch * stretch;
}

double nt_well_gap_of_force(const nt_well *well, double force, double shallow)
{
    double deep = fmin(shallow, 0.0) - NT_WELL_DEEPEST;
    for (int i = 0; i < NT_WELL_BISECTIONS; ++i) {
        const double middle = 0.5 * (shallow + deep);
        if (nt_well_law(well, middle).F < force)
            shallow = middle;
        else
            deep = middle;
    }
    return deep;
}

/* The gap on approach where the tip is no longer held; 0 where it always is. Sets base and outside. */
static int find_jump(nt_well *w)
{
    const double capture = nt_plan_capture_gap(w->plan, &w->place);
    const double ratio = pow(NT_WELL_NEAREST / NT_WELL_FARTHEST, 1.0 / NT_WELL_SEARCHES);
    const double origin = fmax(capture, 0.0);
    double held = NT_WELL_FARTHEST;
    for (double above = NT_WELL_FARTHEST; above > NT_WELL_NEAREST; held = above, above *= ratio)
        if (w->spring + nt_well_law(w, origin + above).k <= 0.0)
            break;
    double lost = held * ratio;
    for (int i = 0; i < NT_WELL_BISECTIONS && held > 2.0 * NT_WELL_NEAREST; ++i) {
        const double middle = 0.5 * (held + lost);
        if (w->spring + nt_well_law(w, origin + middle).k <= 0.0)
            lost = middle;
        else
            held = middle;
    }
    w->outside = origin + held;
    const nt_law_value before = nt_well_law(w, w->outside), after = nt_well_law(w, w->outside - 4.0 * NT_WELL_NEAREST);
    w->base = w->outside - before.F / w->spring;
    return held > 2.0 * NT_WELL_NEAREST || after.F < before.F;
}

/* The bottom of the well inside: where the tip would come to rest. */
static double bottom_of(const nt_well *w)
{
    double up = w->outside - 4.0 * NT_WELL_NEAREST, down = up - NT_WELL_DEEPEST;
    for (int i = 0; i < 2 * NT_WELL_BISECTIONS; ++i) { /* in even ratios: the well is far narrower than DEEPEST */
        const double middle = w->outside - sqrt((w->outside - up) * (w->outside - down));
        if (nt_well_law(w, middle).F < w->spring * (middle - w->base))
            up = middle;
        else
            down = middle;
    }
    return down;
}

/* m v^2/2 of the closing speed, and what the base adds in half a period of the lever, are with it. */
double nt_well_jump(nt_well *well, double speed, double *stiffness)
{
    const double mass = well->spring / (well->rate * well->rate);
    const double arrival = 0.5 * mass * speed * speed;
    *stiffness = 0.0;
    if (!find_jump(well))
        return arrival;
    well->base -= speed * NT_PI / well->rate;
    const double bottom = bottom_of(well);
    *stiffness = fmax(0.0, nt_well_law(well, bottom).k);
    return potential(well, well->outside) - potential(well, bottom) + arrival;
}

/* The most of K (s^2 - h^2)/2 with s = s0 exp(-t/tau), and h = s0 less what the base goes: what a stage of resonance
 * w_n that turns there goes at the speed v, v (t - (1 - exp(-w_n t))/w_n), and the way of its own ringing. A base that
 * moves adds to s0 what it goes in half a period of the lever. */
double nt_well_freed(const nt_well *well, double speed)
{
    const double pulled = well->plan->largest_pull_off_force / well->spring, tau = 2.0 * well->quality / well->rate;
    const double first = pulled + (speed + well->stage_rate * well->stage_rings) * NT_PI / well->rate;
    const double lag = 1.0 / well->stage_rate, end = pulled / speed + lag;
    double most = 0.0;
    for (int i = 1; i <= NT_WELL_SEARCHES; ++i) {
        const double time = end * i / NT_WELL_SEARCHES, turned = fmin(time / lag, NT_PI);
        const double gone = speed * (time + lag * expm1(-time / lag)) + well->stage_rings * (1.0 - cos(turned));
        const double height = fmax(0.0, pulled - gone), swing = first * exp(-time / tau);
        most = fmax(most, 0.5 * well->spring * (swing * swing - height * height));
    }
    return pulled > 0.0 ? most : 0.0;
}

/* Where the base that presses with `force` holds the tip at rest; sets the base [m]. */
static double rest_under(nt_well *w, double force)
{
    const double capture = nt_plan_capture_gap(w->plan, &w->place);
    const double rest = nt_well_gap_of_force(w, force, fmin(w->outside, fmax(capture, 0.0)));
    w->base = rest - force / w->spring;
    return rest;
}

/* Where a tip of so much energy [J] turns, between a gap inside and one beyond [m]. */
static double turning_gap(const nt_well *w, double inside, double beyond, double end)
{
    for (int i = 0; i < NT_WELL_BISECTIONS; ++i) {
        const double middle = 0.5 * (inside + beyond);
        if (potential(w, middle) < end)
            inside = middle;
        else
            beyond = middle;
    }
    return beyond;
}

double nt_well_pressed(const nt_well *well, double force, double energy, double stiffness)
{
    nt_well w = *well;
    const double rest = rest_under(&w, force);
    return energy * sqrt(fmax(1.0, (w.spring + nt_well_law(&w, rest).k) / (w.spring + stiffness)));
}

/* J/sqrt(8 m) of a swing about the rest: the integral of sqrt(e - V + V(rest)) from one turn to the other, by
 * Chebyshev's nodes, at which the root's ends are smooth. */
static double action(const nt_well *w, double rest, double energy)
{
    const double end = potential(w, rest) + energy;
    double beyond = rest + sqrt(2.0 * energy / w->spring);
    while (potential(w, beyond) < end)
        beyond += beyond - rest;
    const double low = turning_gap(w, rest, rest - NT_WELL_DEEPEST, end), high = turning_gap(w, rest, beyond, end);
    double sum = 0.0;
    for (int i = 0; i < NODES; ++i) {
        const double angle = NT_PI * (i + 0.5) / NODES;
        const double gap = 0.5 * (low + high) - 0.5 * (high - low) * cos(angle);
        sum += sqrt(fmax(0.0, end - potential(w, gap))) * sin(angle);
    }
    return 0.5 * (high - low) * sum * NT_PI / NODES;
}

double nt_well_pressed_from_free(nt_well *well, double force, double energy)
{
    const double rest = rest_under(well, force);
    const double free = NT_PI * energy / sqrt(2.0 * well->spring); /* of a spring alone: J = 2 pi e/w0 */
    double least = energy, most = 2.0 * energy;
    if (!(energy > 0.0))
        return 0.0;
    while (action(well, rest, most) < free)
        most *= 2.0;
    for (int i = 0; i < TRIALS; ++i) {
        const double middle = 0.5 * (least + most);
        if (action(well, rest, middle) < free)
            least = middle;
        else
            most = middle;
    }
    return most;
}

/* V regains its value with that energy. So peaks between two samples are counted. */
double nt_well_peak(nt_well *well, double force, double energy, double *depth)
{
    const double rest = rest_under(well, force);
    const double turn = turning_gap(well, rest, rest - NT_WELL_DEEPEST, potential(well, rest) + energy);
    *depth = rest - turn;
    return nt_well_law(well, turn).F - nt_well_law(well, rest).F;
}
