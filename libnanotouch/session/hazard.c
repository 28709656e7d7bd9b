/* SPDX-License-Identifier: BSD-3-Clause
 * What a scene may do to a tip before a stop shows, as numbers for the guarantee.
 *
 * Snap-in. In the potential of sample and lever, V(z) = U(z) + K (z - z_b)^2/2 with K = k_c/cos(alpha), the tip stands
 * on approach at a minimum, until that is lost: at the first gap where K + k = 0, or where adhesion takes hold. From
 * there it falls into the well of contact, and swings about its bottom with the energy e between the two. Nothing but
 * the lever's own damping takes that away; what adhesion dissipates when it takes hold is not the tip's. Beside it: m
 * v^2/2 of the closing speed, what the base adds in half a period of the lever, thermal motion, and what is left of the
 * lever's ringing after a pull-off when the base comes down again as fast as it can.
 *
 * The hand presses on meanwhile, slowly beside the lever: then e/w is constant (adiabatic invariant), w^2 ~ K + k. The
 * peak is the force where V regains its value with that e, at the base that presses with all that can be pressed; how
 * much of it is left by then, the guarantee reckons (ring_down). So peaks between two samples are counted.
 *
 * Contact stiffens under load. What the lever's base still comes closer by, once the limit is reached, presses by the
 * contact's own law: its stiffness is the mean over that way. */
#include "nanotouch/hazard.h"

#include <math.h>

#include "nanotouch/interaction.h"
#include "nanotouch/material.h"
#include "nanotouch/preflight.h"
#include "nanotouch/supervisor.h"

#define DEEPEST 10e-6 /* an indentation that nobody reaches [m] */
#define NEAREST 1e-13 /* gaps are searched in ratios from here [m] */
#define FARTHEST 1e-4 /* to here [m] */
#define SEARCHES 400  /* places */
#define BISECTIONS 60
#define BOLTZMANN 1.380649e-23
#define THERMAL 18.0 /* times k_B T: 6 sigma of an amplitude */
#define RADII 5      /* of places, from the sharpest to the bluntest */

/* Sample and lever. */
typedef struct well {
    nt_place place; /* stiffest and most adhesive, where a surface has properties */
    const nt_plan *plan;
    double spring;     /* K [N/m] */
    double rate;       /* w0 of the lever, free [rad/s] */
    double stage_rate; /* w_n of the stage [rad/s] */
    double base;       /* z_b [m] */
    double outside;    /* gap from which the tip falls [m] */
    double taken;      /* what adhesion dissipates when it takes hold [J] */
} well;

/* On the way in. */
static nt_law_value law_at(const well *w, double gap)
{
    const nt_interaction_state never = {0};
    nt_law_value law = nt_interaction_eval_gap(w->plan, &never, &w->place, gap);
    if (gap <= w->plan->capture_gap && w->outside > w->plan->capture_gap)
        law.U += w->taken;
    return law;
}

static double potential(const well *w, double gap)
{
    const double stretch = gap - w->base;
    return law_at(w, gap).U + 0.5 * w->spring * stretch * stretch;
}

/* A place of a radius, a modulus and the largest work of adhesion, of a surface that has them. */
static nt_place place_of(const nt_plan *plan, double radius, int stiffest)
{
    nt_place place = {.radius = {.radius = radius}};
    if (!plan->properties)
        return place;
    const nt_surface *moduli = &plan->properties->youngs_modulus;
    place.youngs_modulus.value = stiffest ? moduli->height_maximum : moduli->height_minimum;
    place.work_of_adhesion.value = plan->properties->work_of_adhesion.height_maximum;
    return place;
}

/* As deep as the tip may be, where the sample is softest, before the force leaves the noise for good: twice the
 * threshold, because a reading may be off by all of it [m]. */
static double unseen_indentation(const nt_plan *plan, double free_force)
{
    const nt_place place = place_of(plan, plan->contact.radius, 0);
    const nt_interaction_state attached = {.attached = 1};
    double shallow = 0.0, deep = DEEPEST;
    for (int i = 0; i < BISECTIONS; ++i) {
        const double middle = 0.5 * (shallow + deep);
        if (nt_interaction_eval_gap(plan, &attached, &place, -middle).F > 2.0 * free_force)
            deep = middle;
        else
            shallow = middle;
    }
    return deep;
}

/* As deep as contact carries `force` [N]: a gap, and one that is less deep to begin with. */
static double gap_of_force(const well *w, double force, double shallow)
{
    double deep = fmin(shallow, 0.0) - DEEPEST;
    for (int i = 0; i < BISECTIONS; ++i) {
        const double middle = 0.5 * (shallow + deep);
        if (law_at(w, middle).F < force)
            shallow = middle;
        else
            deep = middle;
    }
    return deep;
}

/* The gap on approach where the tip is no longer held; 0 where it always is. Sets base and outside. */
static int find_jump(well *w)
{
    const double capture = w->plan->capture_gap, ratio = pow(NEAREST / FARTHEST, 1.0 / SEARCHES);
    const double origin = fmax(capture, 0.0);
    double held = FARTHEST;
    for (double above = FARTHEST; above > NEAREST; held = above, above *= ratio)
        if (w->spring + law_at(w, origin + above).k <= 0.0)
            break;
    double lost = held * ratio;
    for (int i = 0; i < BISECTIONS && held > 2.0 * NEAREST; ++i) {
        const double middle = 0.5 * (held + lost);
        if (w->spring + law_at(w, origin + middle).k <= 0.0)
            lost = middle;
        else
            held = middle;
    }
    w->outside = origin + held;
    const nt_law_value before = law_at(w, w->outside), after = law_at(w, w->outside - 4.0 * NEAREST);
    w->base = w->outside - before.F / w->spring;
    return held > 2.0 * NEAREST || after.F < before.F;
}

/* The bottom of the well inside: where the tip would come to rest. */
static double bottom_of(const well *w)
{
    double up = w->outside - 4.0 * NEAREST, down = up - DEEPEST;
    for (int i = 0; i < 2 * BISECTIONS; ++i) { /* in even ratios: the well is far narrower than DEEPEST */
        const double middle = w->outside - sqrt((w->outside - up) * (w->outside - down));
        if (law_at(w, middle).F < w->spring * (middle - w->base))
            up = middle;
        else
            down = middle;
    }
    return down;
}

/* What is left of the ringing after a pull-off, when the base has come down to where it matters: the most of
 * K (s^2 - h^2)/2 with s = s0 exp(-t/tau), and h = s0 less what a stage of resonance w_n that turns there goes at the
 * speed v: v (t - (1 - exp(-w_n t))/w_n) [J]. */
static double ringing_left(const well *w, double quality, double speed)
{
    const double first = w->plan->largest_pull_off_force / w->spring, tau = 2.0 * quality / w->rate;
    const double lag = 1.0 / w->stage_rate, end = first / speed + lag;
    double most = 0.0;
    for (int i = 1; i <= SEARCHES; ++i) {
        const double time = end * i / SEARCHES, gone = speed * (time + lag * expm1(-time / lag));
        const double height = fmax(0.0, first - gone), swing = first * exp(-time / tau);
        most = fmax(most, 0.5 * w->spring * (swing * swing - height * height));
    }
    return most;
}

/* Energy about the bottom of contact [J], and how stiff it is there. */
static double energy_of_jump(well *w, const nt_probe *probe, double speed, double *stiffness)
{
    const double mass = w->spring / (w->rate * w->rate);
    const double arrival = 0.5 * mass * speed * speed;
    *stiffness = 0.0;
    if (!find_jump(w))
        return arrival;
    w->base -= speed * NT_PI / w->rate;
    const double bottom = bottom_of(w);
    *stiffness = fmax(0.0, law_at(w, bottom).k);
    return potential(w, w->outside) - potential(w, bottom) + arrival + ringing_left(w, probe->quality, speed);
}

/* Where the tip turns, pressed with `force` at rest and swinging with `energy` besides [m]. */
static double turning_gap(well *w, double rest, double force, double energy)
{
    w->base = rest - force / w->spring;
    const double end = potential(w, rest) + energy;
    double up = rest, down = rest - DEEPEST;
    for (int i = 0; i < BISECTIONS; ++i) {
        const double middle = 0.5 * (up + down);
        if (potential(w, middle) < end)
            up = middle;
        else
            down = middle;
    }
    return down;
}

/* What swings of `energy` [J] add to a force at rest [N]; depth [m]. */
static double peak_over(well *w, double force, double energy, double *depth)
{
    const double rest = gap_of_force(w, force, fmin(w->outside, fmax(w->plan->capture_gap, 0.0)));
    const double turn = turning_gap(w, rest, force, energy);
    *depth = rest - turn;
    return law_at(w, turn).F - law_at(w, rest).F;
}

/* How much stiffer the tip is held under a force than at the bottom of its well: w over w. */
static double stiffened(const well *w, double force, double stiffness)
{
    const double rest = gap_of_force(w, force, fmin(w->outside, fmax(w->plan->capture_gap, 0.0)));
    return sqrt(fmax(1.0, (w->spring + law_at(w, rest).k) / (w->spring + stiffness)));
}

/* U falls by this where adhesion takes hold [J]. */
static double taken_at(const nt_plan *plan, const nt_place *place)
{
    const nt_interaction_state never = {0};
    const double inside = plan->capture_gap, outside = nextafter(inside, HUGE_VAL);
    return fmax(0.0, nt_interaction_eval_gap(plan, &never, place, outside).U -
                         nt_interaction_eval_gap(plan, &never, place, inside).U);
}

static void add_snap_in(nt_hazard *hazard, const nt_plan *plan, const nt_rig *rig, const nt_guarantee *still,
                        double radius)
{
    const nt_probe *probe = &rig->probe;
    well w = {.plan = plan,
              .place = place_of(plan, radius, 1),
              .spring = probe->spring_constant / cos(probe->tilt),
              .rate = 2.0 * NT_PI * probe->resonance,
              .stage_rate = 2.0 * NT_PI * rig->stage.resonance,
              .outside = HUGE_VAL};
    w.taken = taken_at(plan, &w.place);
    const double forces[] = {0.0, still->force}, thermal = THERMAL * BOLTZMANN * probe->temperature;
    double stiffness, found[2], depth;
    const double energy = energy_of_jump(&w, probe, still->speed, &stiffness);
    for (int i = 0; i < 2; ++i) {
        const double swing = sqrt(energy * stiffened(&w, forces[i], stiffness)) + sqrt(thermal); /* in step */
        found[i] = peak_over(&w, forces[i], swing * swing, &depth);
        hazard->snap_in_depth = fmax(hazard->snap_in_depth, depth);
    }
    hazard->arrival = fmax(hazard->arrival, found[0]);
    hazard->snap_in = fmax(hazard->snap_in, found[1]);
    hazard->thermal = fmax(hazard->thermal, peak_over(&w, still->force, thermal, &depth));
}

/* At places from the sharpest to the bluntest: what a jump brings grows with the radius, but not as it. */
static void add_places(nt_hazard *hazard, const nt_plan *plan, const nt_rig *rig, const nt_guarantee *still)
{
    const double sharpest = plan->least.radius, blunter = plan->most.radius / sharpest;
    for (int i = 0; i < (blunter > 1.0 ? RADII : 1); ++i)
        add_snap_in(hazard, plan, rig, still, sharpest * pow(blunter, i / (RADII - 1.0)));
}

/* How far a force presses where the sample is softest; not known where each place has a radius of its own [m]. */
static double deepest_under(const nt_plan *plan, double force)
{
    const well soft = {.plan = plan, .place = place_of(plan, plan->contact.radius, 0)};
    return plan->radii ? HUGE_VAL : -gap_of_force(&soft, force, 0.0);
}

/* A tip that slides from the softest and sharpest place to the hardest and bluntest one is lifted by this [m]. */
static double rise_under(const nt_plan *plan, double force)
{
    const well soft = {.plan = plan, .place = place_of(plan, plan->least.radius, 0)};
    well hard = {.plan = plan, .place = place_of(plan, plan->most.radius, 1)};
    if (plan->properties)
        hard.place.work_of_adhesion.value = plan->properties->work_of_adhesion.height_minimum;
    return fmax(0.0, gap_of_force(&hard, force, 0.0) - gap_of_force(&soft, force, 0.0));
}

/* On the mean, from a force on until the lever's base has come closer by `way` [N/m]. */
static double stiffness_over(const well *w, double force, double way)
{
    const double start = gap_of_force(w, force, 0.0), first = law_at(w, start).F;
    double up = start, down = start - way;
    for (int i = 0; i < BISECTIONS; ++i) {
        const double middle = 0.5 * (up + down);
        if (start - middle + (law_at(w, middle).F - first) / w->spring < way)
            up = middle;
        else
            down = middle;
    }
    return down < start ? (law_at(w, down).F - first) / (start - down) : 0.0;
}

/* The stiffest place under the stiffest lever: as far as the loop goes on past the limit, and from there as each
 * failure does. */
static void add_stiffness(nt_hazard *hazard, const nt_plan *plan, const nt_rig *rig, const nt_settings *settings)
{
    const nt_guarantee still = nt_guarantee_compute(rig, settings, hazard);
    const double spring = rig->probe.spring_constant * (1.0 + NT_GUARANTEE_SIGMAS * rig->probe.spring_constant_sigma);
    const well hard = {.plan = plan, .place = place_of(plan, plan->most.radius, 1), .spring = spring};
    const double reckoned = spring / (1.0 + spring / hazard->stiffness), moved = still.motion + still.ringing;
    const double begins = still.force - moved - still.snap_in, way = moved / reckoned;
    hazard->stiffness = fmax(hazard->stiffness, stiffness_over(&hard, begins, way));
    const double ends = begins + way * spring / (1.0 + spring / hazard->stiffness);
    for (int i = 0; i < NT_FAILURES; ++i)
        if (isfinite(still.failure[i]))
            hazard->failing[i] = stiffness_over(&hard, ends, still.failure[i] / reckoned);
}

/* What the sample does to a tip that stands still while the tare is taken, as near as the frame may drift meanwhile. A
 * tip that is drawn nearer is found where the lever holds it; one that is not held pulls with no more than the pull-off
 * force [N]. */
static double force_at_tare(const nt_plan *plan, const nt_rig *rig, const nt_settings *settings, double clearance)
{
    if (!isfinite(clearance))
        return 0.0;
    const nt_preflight preflight = nt_preflight_make(rig, settings);
    const double softest = 1.0 - NT_GUARANTEE_SIGMAS * rig->probe.spring_constant_sigma;
    const well w = {.plan = plan,
                    .place = place_of(plan, plan->most.radius, 1),
                    .spring = softest * rig->probe.spring_constant / cos(rig->probe.tilt)};
    const double base = fmax(0.0, clearance - rig->stage.drift * nt_preflight_time(&preflight));
    const double pushed = law_at(&w, base).F, ratio = pow(NEAREST / FARTHEST, 1.0 / SEARCHES);
    if (pushed >= 0.0)
        return pushed;
    for (double gap = base * ratio; gap > NEAREST; gap *= ratio) {
        const double pulled = -law_at(&w, gap).F, held = w.spring * (base - gap);
        if (pulled <= held)
            return fmin(fmax(0.0, pulled), held);
    }
    return plan->largest_pull_off_force;
}

nt_hazard nt_hazard_of(const nt_plan *plan, const nt_rig *rig, const nt_settings *settings, double slope,
                       double clearance)
{
    const nt_probe *lever = &rig->probe;
    const double off = NT_GUARANTEE_SIGMAS * hypot(lever->spring_constant_sigma, lever->sensitivity_sigma);
    const double free_force = nt_supervisor_make(rig, settings).free_force / (1.0 - off); /* as it may be */
    nt_hazard hazard = {.slope = slope,
                        .pull_off_force = plan->largest_pull_off_force,
                        .ring_down = lever->quality / (NT_PI * lever->resonance),
                        .stiffness = plan->maximum_stiffness,
                        .tared = force_at_tare(plan, rig, settings, clearance)};
    hazard.unseen = unseen_indentation(plan, free_force + 0.5 * hazard.tared);
    add_stiffness(&hazard, plan, rig, settings);
    const nt_guarantee still = nt_guarantee_compute(rig, settings, &hazard);
    hazard.rise = rise_under(plan, still.force);
    for (int side = -1; side <= 1; side += 2) { /* k_c as it may be */
        nt_rig real = *rig;
        real.probe.spring_constant *= 1.0 + side * NT_GUARANTEE_SIGMAS * rig->probe.spring_constant_sigma;
        add_places(&hazard, plan, &real, &still);
    }
    hazard.deepest = deepest_under(plan, still.force + fmax(hazard.snap_in, hazard.pull_off_force));
    return hazard;
}
