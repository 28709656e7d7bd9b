/* SPDX-License-Identifier: BSD-3-Clause
 * Each field of a hazard by its definition, on a flat with friction and over a surface: forces are looked up in the
 * plan's own law, stiffnesses are secants of it, and what jumps and rings is put together from wells. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control/bound.h"
#include "control/preflight.h"
#include "control/servo.h"
#include "internal/control.h"
#include "internal/hazard.h"
#include "internal/margins.h"
#include "larger.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/advanced/terrain.h"
#include "nanotouch/control.h"
#include "nanotouch/friction.h"
#include "nanotouch/margins.h"
#include "nanotouch/plan.h"
#include "scene/interaction.h"
#include "scene/parts.h"
#include "session/grip.h"
#include "session/hazard.h"
#include "session/terrain.h"
#include "session/well.h"

#define PI 3.14159265358979323846
#define KT 1.380649e-23

static nt_terrain *flat;
static const nt_plan *plan;
static nt_rig rig;
static nt_settings settings;

static int open_flat(void **state)
{
    (void)state;
    nt_terrain_setup setup = nt_terrain_defaults();
    setup.scene.friction.shear_strength = 30e6;
    rig = nt_rig_defaults();
    rig.probe.tilt = 0.3;
    rig.probe.temperature = 300.0;
    rig.probe.lateral_stiffness = 80.0;
    settings = nt_settings_defaults(&rig);
    setup.scene.range.maximum_load = settings.limits.force;
    setup.probe = &rig.probe;
    if (nt_terrain_make(&flat, &setup, NULL) != NT_OK)
        return 1;
    plan = nt_terrain_plan(flat);
    return 0;
}

static int close_flat(void **state)
{
    (void)state;
    nt_terrain_close(flat);
    return 0;
}

static double force_at(int attached, double gap)
{
    const nt_interaction_state is = {.attached = attached};
    const nt_place place = {.radius = {.radius = plan->contact.radius}};
    return nt_interaction_eval_gap(plan, &is, &place, gap).F;
}

/* The gap inside which the force on the way in is more than this [m]. */
static double gap_of(double force)
{
    double shallow = 0.0, deep = -1e-6;
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (shallow + deep);
        *(force_at(0, middle) < force ? &shallow : &deep) = middle;
    }
    return deep;
}

/* Mean stiffness from a force on until base and lever have come closer by `way` [N/m]. */
static double secant(double spring, double force, double way)
{
    const double start = gap_of(force), first = force_at(0, start);
    double low = 0.0, high = way; /* of the indentation */
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        *(middle + (force_at(0, start - middle) - first) / spring < way ? &low : &high) = middle;
    }
    return (force_at(0, start - high) - first) / high;
}

static double off(void)
{
    return 3.0 * hypot(rig.probe.spring_constant_sigma, rig.probe.sensitivity_sigma);
}

/* Without what jumps: the stiffest contact of the plan alone. */
static nt_hazard bare(const nt_hazard *of)
{
    return (nt_hazard){.slope = of->slope,
                       .pull_off_force = plan->largest_pull_off_force,
                       .ring_down = rig.probe.quality / (PI * rig.probe.resonance),
                       .stiffness = plan->maximum_stiffness,
                       .tared = of->tared,
                       .unseen = of->unseen};
}

static void what_a_flat_holds_ready(void **state)
{
    (void)state;
    const nt_hazard h = nt_hazard_of(plan, &rig, &settings, 0.25, HUGE_VAL);
    assert_true(h.slope == 0.25 && h.tared == 0.0 && h.pull_off_force == plan->largest_pull_off_force);
    assert_true(fabs(h.ring_down - rig.probe.quality / (PI * rig.probe.resonance)) < 1e-12 * h.ring_down);
    const double free_force = nt_supervisor_make(&rig, &settings).free_force / (1.0 - off());
    assert_true(fabs(force_at(1, -h.unseen) / (2.0 * free_force) - 1.0) < 1e-6);
    const double most = nt_guarantee_within(&rig, &settings, &h, HUGE_VAL).force;
    assert_true(fabs(force_at(0, -h.deepest) / most - 1.0) < 1e-6);
    const nt_interaction_state attached = {.attached = 1};
    const nt_place place = {.radius = {.radius = plan->contact.radius}};
    const nt_friction_contact contact = nt_interaction_friction_contact(plan, &attached, &place, gap_of(most));
    assert_true(h.friction > 0.0 && fabs(h.friction / nt_friction_limit(&plan->friction.law, &contact) - 1.0) < 1e-6);
    assert_true(h.rise == 0.0 && h.curvature == 0.0);
    assert_true(nt_hazard_relief(plan) > 1e300);
    const double radius = nt_interaction_eval_gap(plan, &attached, &place, gap_of(most)).a;
    assert_true(fabs(h.stick / nt_friction_stiffness(&plan->friction.law, radius) - 1.0) < 1e-6);
}

static void stiffness_on_the_mean(void **state)
{
    (void)state;
    const nt_hazard h = nt_hazard_of(plan, &rig, &settings, 0.25, HUGE_VAL), before = bare(&h);
    const nt_guarantee still = nt_guarantee_within(&rig, &settings, &before, HUGE_VAL);
    const double spring = rig.probe.spring_constant * (1.0 + 3.0 * rig.probe.spring_constant_sigma);
    const double reckoned = spring * before.stiffness / (spring + before.stiffness);
    const double moved = still.motion + still.ringing, begins = still.force - moved - still.snap_in;
    const double mean = secant(spring, begins, moved / reckoned);
    assert_true(fabs(h.stiffness / larger(before.stiffness, mean) - 1.0) < 1e-6);
    const double ends = begins + moved / reckoned * spring * h.stiffness / (spring + h.stiffness);
    for (int i = 0; i < NT_FAILURES; ++i) {
        const double failing = isfinite(still.failure[i]) ? secant(spring, ends, still.failure[i] / reckoned) : 0.0;
        assert_true(fabs(h.failing[i] - failing) <= 1e-6 * failing);
    }
}

/* At both ends of what k_c may be: a jump and what a pull-off leaves strike at once, then all of it pressed; 18 k_B T.
 */
static void jumps_are_put_together(void **state)
{
    (void)state;
    const nt_hazard h = nt_hazard_of(plan, &rig, &settings, 0.25, HUGE_VAL);
    nt_hazard before = bare(&h);
    before.stiffness = h.stiffness;
    for (int i = 0; i < NT_FAILURES; ++i)
        before.failing[i] = h.failing[i];
    const nt_guarantee still = nt_guarantee_within(&rig, &settings, &before, HUGE_VAL);
    const nt_servo_equivalent equivalent = nt_servo_equivalent_of(&rig, &settings, h.stiffness);
    const double rings = nt_servo_ringing(&equivalent, larger(still.speed, settings.limits.retract_speed));
    const double kT = 18.0 * KT * rig.probe.temperature;
    double arrival = 0.0, snap_in = 0.0, thermal = 0.0, deep = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        const nt_interaction_state never = {0};
        const double k_c = rig.probe.spring_constant * (1.0 + side * 3.0 * rig.probe.spring_constant_sigma);
        nt_well w = {.plan = plan,
                     .place = {.radius = {.radius = plan->contact.radius}},
                     .spring = k_c / cos(0.3),
                     .rate = 2.0 * PI * rig.probe.resonance,
                     .quality = rig.probe.quality,
                     .stage_rate = 2.0 * PI * rig.stage.resonance,
                     .stage_rings = rings,
                     .outside = HUGE_VAL};
        const double inside = nt_plan_capture_gap(plan, &w.place);
        w.taken = larger(0.0, nt_interaction_eval_gap(plan, &never, &w.place, nextafter(inside, 1.0)).U -
                                  nt_interaction_eval_gap(plan, &never, &w.place, inside).U);
        double stiffness, depth;
        const double jump = nt_well_jump(&w, still.speed, &stiffness), freed = nt_well_freed(&w, still.speed);
        const double first = pow(sqrt(jump + freed) + sqrt(kT), 2.0);
        arrival = larger(arrival, nt_well_peak(&w, 0.0, first, &depth));
        deep = larger(deep, depth);
        const double pressed =
            nt_well_pressed(&w, still.force, jump, stiffness) + nt_well_pressed_from_free(&w, still.force, freed);
        const double then = pow(sqrt(pressed) + sqrt(kT), 2.0);
        snap_in = larger(snap_in, nt_well_peak(&w, still.force, then, &depth));
        deep = larger(deep, depth);
        thermal = larger(thermal, nt_well_peak(&w, still.force, kT, &depth));
    }
    assert_true(thermal > 0.0 && fabs(h.thermal / thermal - 1.0) < 1e-9);
    assert_true(fabs(h.arrival / arrival - 1.0) < 1e-9 && fabs(h.snap_in / snap_in - 1.0) < 1e-9);
    assert_true(fabs(h.snap_in_depth / deep - 1.0) < 1e-9);
}

/* A tip over the sample: the softest lever stands where it holds what pulls; one that is not held pulls with all. */
static void what_the_tare_takes_off(void **state)
{
    (void)state;
    const double spring = rig.probe.spring_constant * (1.0 - 3.0 * rig.probe.spring_constant_sigma) / cos(0.3);
    const nt_preflight preflight = nt_preflight_make(&rig, &settings);
    for (double clearance = 3e-9; clearance < 100e-9; clearance *= 1.7) {
        const double base = larger(0.0, clearance - rig.stage.drift * nt_preflight_time(&preflight));
        const double found = nt_hazard_of(plan, &rig, &settings, 0.0, clearance).tared;
        double gap = base;
        while (gap > 1e-13 && -force_at(0, gap) > spring * (base - gap))
            gap -= 1e-3 * gap;
        const double held = gap > 1e-13 ? -force_at(0, gap) : plan->largest_pull_off_force;
        assert_true(found > 0.999 * held && found < 1.16 * held); /* gaps in ratios of 5 % are tried */
    }
    assert_true(nt_hazard_of(plan, &rig, &settings, 0.0, 1e-10).tared == plan->largest_pull_off_force);
}

/* A spline's heights, slopes and curvatures lie within those of its coefficients, mirrored at the borders. */
static void a_surface_by_its_coefficients(void **state)
{
    (void)state;
    enum { NX = 7, NY = 5 };
    static double heights[NX * NY];
    for (int j = 0; j < NY; ++j)
        for (int i = 0; i < NX; ++i)
            heights[j * NX + i] = 1e-9 * sin(1.3 * i + 0.4 * j * j) + 2e-9 * cos(0.9 * j * i);
    nt_terrain_setup setup = nt_terrain_defaults();
    setup.scene.range.maximum_load = settings.limits.force;
    setup.map = (nt_height_map){.heights = heights, .nx = NX, .ny = NY, .dx = 20e-9, .dy = 30e-9};
    setup.dilated = 1;
    nt_terrain *made;
    assert_int_equal(nt_terrain_make(&made, &setup, NULL), NT_OK);
    const nt_plan *rough = nt_terrain_plan(made);
    const double *c = nt_terrain_surface(made)->coefficients;
    double low = HUGE_VAL, high = -HUGE_VAL, xx = 0.0, yy = 0.0, xy = 0.0;
    for (int j = 0; j < NY; ++j)
        for (int i = 0; i < NX; ++i) {
            const int r = i + 1 < NX ? i + 1 : NX - 2, l = i > 0 ? i - 1 : 1, u = j + 1 < NY ? j + 1 : NY - 2,
                      d = j > 0 ? j - 1 : 1;
            const double at = c[j * NX + i];
            low = smaller(low, at);
            high = larger(high, at);
            xx = larger(xx, fabs(c[j * NX + l] - 2.0 * at + c[j * NX + r]) / (20e-9 * 20e-9));
            yy = larger(yy, fabs(c[d * NX + i] - 2.0 * at + c[u * NX + i]) / (30e-9 * 30e-9));
            xy = larger(xy, fabs(at - c[j * NX + r] - c[u * NX + i] + c[u * NX + r]) / (20e-9 * 30e-9));
        }
    assert_true(fabs(nt_hazard_relief(rough) / (high - low) - 1.0) < 1e-12);
    const nt_sideways_contact grip = nt_grip_of(rough, 0.5, 1e-7);
    assert_true(fabs(grip.curvature / sqrt(xx * xx + yy * yy + 2.0 * xy * xy) - 1.0) < 1e-12);
    assert_true(grip.slope == 0.5 && grip.load == 1e-7 && grip.stick == 0.0 && grip.grip == 0.0);
    nt_terrain_close(made);
}

/* Friction's limit grows by no more than this with the indentation, from no load on. */
static void friction_grows_with_the_way(void **state)
{
    (void)state;
    const double load = 5e-7;
    const nt_sideways_contact grip = nt_grip_of(plan, 0.0, load);
    const nt_interaction_state attached = {.attached = 1};
    const nt_place place = {.radius = {.radius = plan->contact.radius}};
    const double shallow = gap_of(0.0), deep = gap_of(load), step = (shallow - deep) / 64.0;
    double most = 0.0;
    for (int i = 0; i < 64; ++i) {
        double limit[2];
        for (int k = 0; k < 2; ++k) {
            const nt_friction_contact at =
                nt_interaction_friction_contact(plan, &attached, &place, shallow - (i + k) * step);
            limit[k] = nt_friction_limit(&plan->friction.law, &at);
        }
        most = larger(most, (limit[1] - limit[0]) / step);
    }
    assert_true(most > 0.0 && fabs(grip.grip / most - 1.0) < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_a_flat_holds_ready),       cmocka_unit_test(stiffness_on_the_mean),
        cmocka_unit_test(jumps_are_put_together),        cmocka_unit_test(what_the_tare_takes_off),
        cmocka_unit_test(a_surface_by_its_coefficients), cmocka_unit_test(friction_grows_with_the_way),
    };
    return cmocka_run_group_tests(tests, open_flat, close_flat);
}
