/* SPDX-License-Identifier: BSD-3-Clause
 * What a scene may do to a tip before a stop shows, as numbers for the guarantee.
 *
 * Snap-in: the energy of a jump, m v^2/2 of the closing speed, thermal motion, and what is left of the lever's ringing
 * after a pull-off when the base comes down again as fast as it can; all of it while the hand presses on with all that
 * can be pressed (well.c). How much of it is left by then, the guarantee reckons (ring_down).
 *
 * Contact stiffens under load. What the lever's base still comes closer by, once the limit is reached, presses by the
 * contact's own law: its stiffness is the mean over that way. */
#include "internal/hazard.h"
#include "internal/control.h"
#include "internal/margins.h"
#include "nanotouch/margins.h"
#include "nanotouch/plan.h"

#include <math.h>

#include "control/bound.h"
#include "control/preflight.h"
#include "control/servo.h"
#include "core/same_bits.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/control.h"
#include "nanotouch/material.h"
#include "scene/parts.h"
#include "session/grip.h"
#include "session/hazard.h"
#include "session/well.h"

#define BOLTZMANN 1.380649e-23
#define THERMAL 18.0 /* times k_B T: 6 sigma of an amplitude */
#define RADII 5      /* of places, from the sharpest to the bluntest */

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
    double shallow = 0.0, deep = NT_WELL_DEEPEST;
    for (int i = 0; i < NT_WELL_BISECTIONS; ++i) {
        const double middle = 0.5 * (shallow + deep);
        if (nt_interaction_eval_gap(plan, &attached, &place, -middle).F > 2.0 * free_force)
            deep = middle;
        else
            shallow = middle;
    }
    return fmax(deep, nt_plan_slow_depth(plan, 2.0 * free_force));
}

/* U falls by this where adhesion takes hold [J]. */
static double taken_at(const nt_plan *plan, const nt_place *place)
{
    const nt_interaction_state never = {0};
    const double inside = nt_plan_capture_gap(plan, place), outside = nextafter(inside, HUGE_VAL);
    return fmax(0.0, nt_interaction_eval_gap(plan, &never, place, outside).U -
                         nt_interaction_eval_gap(plan, &never, place, inside).U);
}

/* The peak over a force of swings whose amplitudes add to the thermal one; their depth is kept [N]. */
static double peak_in_step(nt_well *w, double force, double energy, double thermal, nt_hazard *hazard)
{
    double depth;
    const double swing = sqrt(energy) + sqrt(thermal), peak = nt_well_peak(w, force, swing * swing, &depth);
    hazard->snap_in_depth = fmax(hazard->snap_in_depth, depth);
    return peak;
}

static void add_snap_in(nt_hazard *hazard, const nt_plan *plan, const nt_rig *rig, const nt_guarantee *still,
                        double rings, double radius)
{
    const nt_probe *probe = &rig->probe;
    nt_well w = {.plan = plan,
                 .place = place_of(plan, radius, 1),
                 .spring = probe->spring_constant / cos(probe->tilt),
                 .rate = 2.0 * NT_PI * probe->resonance,
                 .quality = probe->quality,
                 .stage_rate = 2.0 * NT_PI * rig->stage.resonance,
                 .stage_rings = rings,
                 .outside = HUGE_VAL};
    w.taken = taken_at(plan, &w.place);
    const double thermal = THERMAL * BOLTZMANN * probe->temperature;
    double stiffness, depth;
    const double jump = nt_well_jump(&w, still->speed, &stiffness), freed = nt_well_freed(&w, still->speed);
    const double first = peak_in_step(&w, 0.0, jump + freed, thermal, hazard); /* it strikes at once */
    const double pressed =
        nt_well_pressed(&w, still->force, jump, stiffness) + nt_well_pressed_from_free(&w, still->force, freed);
    const double then = peak_in_step(&w, still->force, pressed, thermal, hazard);
    hazard->arrival = fmax(hazard->arrival, first);
    hazard->snap_in = fmax(hazard->snap_in, then);
    hazard->thermal = fmax(hazard->thermal, nt_well_peak(&w, still->force, thermal, &depth));
}

/* At places from the sharpest to the bluntest: what a jump brings grows with the radius, but not as it. */
static void add_places(nt_hazard *hazard, const nt_plan *plan, const nt_rig *rig, const nt_guarantee *still,
                       double rings)
{
    const double sharpest = plan->least.radius, blunter = plan->most.radius / sharpest;
    for (int i = 0; i < (blunter > 1.0 ? RADII : 1); ++i)
        add_snap_in(hazard, plan, rig, still, rings, sharpest * pow(blunter, i / (RADII - 1.0)));
}

/* How far a force presses where the sample is softest, at the sharpest or the bluntest place: the one gives way more,
 * the other is drawn in farther [m]. */
static double deepest_under(const nt_plan *plan, double force)
{
    const nt_well sharp = {.plan = plan, .place = place_of(plan, plan->least.radius, 0)};
    const nt_well blunt = {.plan = plan, .place = place_of(plan, plan->most.radius, 0)};
    const double deepest = -fmin(nt_well_gap_of_force(&sharp, force, 0.0), nt_well_gap_of_force(&blunt, force, 0.0));
    return fmax(deepest, nt_plan_slow_depth(plan, force));
}

/* A tip that slides from the softest and sharpest place to the hardest and bluntest one is lifted by this [m]. */
static double rise_under(const nt_plan *plan, double force)
{
    const nt_well soft = {.plan = plan, .place = place_of(plan, plan->least.radius, 0)};
    nt_well hard = {.plan = plan, .place = place_of(plan, plan->most.radius, 1)};
    if (plan->properties)
        hard.place.work_of_adhesion.value = plan->properties->work_of_adhesion.height_minimum;
    return fmax(0.0, nt_well_gap_of_force(&hard, force, 0.0) - nt_well_gap_of_force(&soft, force, 0.0));
}

/* On the mean, from a force on until the lever's base has come closer by `way` [N/m]. */
static double stiffness_over(const nt_well *w, double force, double way)
{
    const double start = nt_well_gap_of_force(w, force, 0.0), first = nt_well_law(w, start).F;
    double up = start, down = start - way;
    for (int i = 0; i < NT_WELL_BISECTIONS; ++i) {
        const double middle = 0.5 * (up + down);
        if (start - middle + (nt_well_law(w, middle).F - first) / w->spring < way)
            up = middle;
        else
            down = middle;
    }
    return down < start ? (nt_well_law(w, down).F - first) / (start - down) : 0.0;
}

/* A sample that has relaxed under that force and is pressed on within a period: its stiffness at the end, above that on
 * the mean; 0 of any other [N/m]. */
static double quick_over(const nt_plan *plan, double force, double way)
{
    return nt_plan_quick_stiffness(plan, nt_plan_slow_depth(plan, force) + way);
}

/* The stiffest place under the stiffest lever: as far as the loop goes on past the limit, and from there as each
 * failure does. */
static void add_stiffness(nt_hazard *hazard, const nt_plan *plan, const nt_rig *rig, const nt_settings *settings)
{
    const nt_guarantee still = nt_guarantee_within(rig, settings, hazard, nt_hazard_relief(plan));
    const double spring = rig->probe.spring_constant * (1.0 + NT_GUARANTEE_SIGMAS * rig->probe.spring_constant_sigma);
    const nt_well hard = {.plan = plan, .place = place_of(plan, plan->most.radius, 1), .spring = spring};
    const double reckoned = spring / (1.0 + spring / hazard->stiffness), moved = still.motion + still.ringing;
    const double begins = still.force - moved - still.snap_in, way = moved / reckoned;
    hazard->stiffness = fmax(hazard->stiffness, stiffness_over(&hard, begins, way));
    hazard->stiffness = fmax(hazard->stiffness, quick_over(plan, begins, way));
    const double ends = begins + way * spring / (1.0 + spring / hazard->stiffness);
    for (int i = 0; i < NT_FAILURES; ++i)
        if (isfinite(still.failure[i]))
            hazard->failing[i] = fmax(stiffness_over(&hard, ends, still.failure[i] / reckoned),
                                      quick_over(plan, ends, still.failure[i] / reckoned));
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
    const nt_well w = {.plan = plan,
                       .place = place_of(plan, plan->most.radius, 1),
                       .spring = softest * rig->probe.spring_constant / cos(rig->probe.tilt)};
    const double base = fmax(0.0, clearance - rig->stage.drift * nt_preflight_time(&preflight));
    const double pushed = nt_well_law(&w, base).F,
                 ratio = pow(NT_WELL_NEAREST / NT_WELL_FARTHEST, 1.0 / NT_WELL_SEARCHES);
    if (pushed >= 0.0)
        return pushed;
    for (double gap = base * ratio; gap > NT_WELL_NEAREST; gap *= ratio) {
        const double pulled = -nt_well_law(&w, gap).F, held = w.spring * (base - gap);
        if (pulled <= held)
            return fmin(fmax(0.0, pulled), held);
    }
    return plan->largest_pull_off_force;
}

/* No spline is beyond its coefficients. A sample that keeps dents is deeper than its surface, and what lies on a flat
 * is higher. */
double nt_hazard_relief(const nt_plan *plan)
{
    const nt_surface *surface = plan->surface;
    double low = HUGE_VAL, high = -HUGE_VAL;
    if (!surface || !surface->coefficients || plan->history == NT_HISTORY_DENTS)
        return HUGE_VAL;
    for (long i = 0; i < surface->nx * surface->ny; ++i) {
        low = fmin(low, surface->coefficients[i]);
        high = fmax(high, surface->coefficients[i]);
    }
    return high > low ? high - low : HUGE_VAL;
}

nt_hazard nt_hazard_of(const nt_plan *plan, const nt_rig *rig, const nt_settings *settings, double slope,
                       double clearance)
{
    const nt_probe *lever = &rig->probe;
    const double relief = nt_hazard_relief(plan);
    const double off = NT_GUARANTEE_SIGMAS * hypotenuse(lever->spring_constant_sigma, lever->sensitivity_sigma);
    const double free_force = nt_supervisor_make(rig, settings).free_force / (1.0 - off); /* as it may be */
    nt_hazard hazard = {.slope = slope,
                        .pull_off_force = plan->largest_pull_off_force,
                        .ring_down = lever->quality / (NT_PI * lever->resonance),
                        .stiffness = plan->maximum_stiffness,
                        .tared = force_at_tare(plan, rig, settings, clearance)};
    hazard.unseen = unseen_indentation(plan, free_force + 0.5 * hazard.tared);
    add_stiffness(&hazard, plan, rig, settings);
    const nt_guarantee still = nt_guarantee_within(rig, settings, &hazard, relief);
    hazard.rise = rise_under(plan, still.force);
    const nt_servo_equivalent equivalent = nt_servo_equivalent_of(rig, settings, hazard.stiffness);
    const double rings = nt_servo_ringing(&equivalent, fmax(still.speed, settings->limits.retract_speed));
    for (int side = -1; side <= 1; side += 2) { /* k_c as it may be */
        nt_rig real = *rig;
        real.probe.spring_constant *= 1.0 + side * NT_GUARANTEE_SIGMAS * rig->probe.spring_constant_sigma;
        add_places(&hazard, plan, &real, &still, rings);
    }
    const double most = nt_guarantee_within(rig, settings, &hazard, relief).force;
    hazard.deepest = deepest_under(plan, most);
    if (rig->stage.axes > 1.0) /* a tip that stands goes aside with the slope alone: friction holds it back */
        hazard.friction = nt_grip_friction(plan, most);
    if (lever->lateral_stiffness > 0.0) { /* what it shows can be stopped */
        const nt_sideways_contact grip = nt_grip_of(plan, slope, most);
        hazard.stick = grip.stick;
        hazard.curvature = grip.curvature;
    }
    return hazard;
}
