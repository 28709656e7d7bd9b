/* SPDX-License-Identifier: BSD-3-Clause
 * A tip in the potential of sample and lever: energies, turns and actions against sums over the force law itself, with
 * none of the searches of the library. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "larger.h"
#include "nanotouch/scene.h"
#include "scene/parts.h"
#include "session/well.h"

#define PI 3.14159265358979323846
enum { STEPS = 4000 };

static nt_plan plan;

static int make_plan(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    const nt_demand demand = nt_demand_defaults();
    const nt_plan_inputs inputs = {.scene = &scene, .demand = &demand};
    return nt_plan_make(&plan, &inputs, NULL) == NT_OK ? 0 : 1;
}

/* What adhesion dissipates where it takes hold, and the tip does not get [J]. */
static double taken(void)
{
    const nt_interaction_state never = {0};
    const nt_place place = {.radius = {.radius = plan.contact.radius}};
    const double inside = nt_plan_capture_gap(&plan, &place), outside = nextafter(inside, 1.0);
    return nt_interaction_eval_gap(&plan, &never, &place, outside).U -
           nt_interaction_eval_gap(&plan, &never, &place, inside).U;
}

static nt_well well_of(double spring)
{
    return (nt_well){.plan = &plan,
                     .place = {.radius = {.radius = plan.contact.radius}},
                     .spring = spring,
                     .rate = 2.0 * PI * 100e3,
                     .quality = 50.0,
                     .stage_rate = 2.0 * PI * 450.0,
                     .stage_rings = 2e-9,
                     .outside = HUGE_VAL,
                     .taken = taken()};
}

/* The force on the tip on its way in [N]. */
static double force_at(double gap)
{
    const nt_interaction_state never = {0};
    const nt_place place = {.radius = {.radius = plan.contact.radius}};
    return nt_interaction_eval_gap(&plan, &never, &place, gap).F;
}

/* What force and spring, whose base is at `base`, do on the way from a to b [J]: Simpson's rule. */
static double work_between(double spring, double base, double a, double b)
{
    const double h = (b - a) / (2 * STEPS);
    double sum = 0.0;
    for (int i = 0; i <= 2 * STEPS; ++i) {
        const double gap = a + i * h, f = force_at(gap) - spring * (gap - base);
        sum += (i == 0 || i == 2 * STEPS ? 1.0 : i % 2 ? 4.0 : 2.0) * f;
    }
    return sum * h / 3.0;
}

static void a_gap_carries_a_force(void **state)
{
    (void)state;
    const nt_well w = well_of(8.0);
    for (double force = 1e-9; force < 3e-6; force *= 3.0) {
        const double gap = nt_well_gap_of_force(&w, force, 0.0);
        assert_true(gap < 0.0 && fabs(force_at(gap) / force - 1.0) < 1e-6);
    }
    assert_true(nt_well_gap_of_force(&w, 1e-9, -1e-8) <= -1e-8); /* no less deep than that */
    assert_true(fabs(nt_well_gap_of_force(&w, 1e9, 0.0) + NT_WELL_DEEPEST) < 1e-18);
    assert_true(fabs(nt_well_gap_of_force(&w, 1e9, -1e-6) + 1e-6 + NT_WELL_DEEPEST) < 1e-18);
    assert_true(fabs(nt_well_gap_of_force(&w, 1e9, 1e-6) + NT_WELL_DEEPEST) < 1e-18);
}

/* From the rest to the turn sample and spring take all of the energy. */
static void a_peak_is_where_the_energy_is_gone(void **state)
{
    (void)state;
    for (double spring = 0.5; spring < 50.0; spring *= 4.0)
        for (double force = 50e-9; force < 2e-6; force *= 5.0)
            for (double energy = 1e-18; energy < 1e-15; energy *= 30.0) {
                nt_well w = well_of(spring);
                double depth;
                const double peak = nt_well_peak(&w, force, energy, &depth);
                const double rest = nt_well_gap_of_force(&w, force, 0.0), turn = rest - depth;
                assert_true(depth > 0.0 && fabs(w.base - (rest - force / spring)) < 1e-18);
                assert_true(fabs(peak - (force_at(turn) - force_at(rest))) < 1e-9 * peak);
                assert_true(fabs(-work_between(spring, w.base, rest, turn) / energy - 1.0) < 1e-5);
            }
}

/* J = 2 pi e/w, w^2 ~ K + k: a swing that stays in contact has more energy the stiffer that gets, and never less. */
static void a_swing_that_is_pressed(void **state)
{
    (void)state;
    const nt_well w = well_of(8.0);
    const double rest = nt_well_gap_of_force(&w, 1e-6, 0.0), h = 1e-13;
    const double k = (force_at(rest - h) - force_at(rest + h)) / (2.0 * h);
    const double softer = 0.3 * k, harder = 3.0 * k;
    assert_true(fabs(nt_well_pressed(&w, 1e-6, 2e-16, softer) / (2e-16 * sqrt((8.0 + k) / (8.0 + softer))) - 1.0) <
                1e-4);
    assert_true(nt_well_pressed(&w, 1e-6, 2e-16, harder) == 2e-16);
}

/* Integral of sqrt(e - V) from the rest to a turn, in even steps [m]; the last one is cut off. */
static double action_to(double spring, double rest, double base, double energy, double step)
{
    double sum = 0.0, left = energy, at = rest;
    for (;;) {
        const double next = at + step, pull = force_at(at) + force_at(next) - spring * (at + next - 2.0 * base);
        const double then = left + 0.5 * step * pull;
        if (!(then > 0.0))
            return sum + fabs(step) * left / (left - then) * 2.0 / 3.0 * sqrt(left);
        sum += 0.5 * fabs(step) * (sqrt(left) + sqrt(then));
        left = then;
        at = next;
    }
}

static double action_of(double spring, double force, double energy)
{
    nt_well w = well_of(spring);
    const double rest = nt_well_gap_of_force(&w, force, 0.0), base = rest - force / spring;
    return action_to(spring, rest, base, energy, -2e-13) + action_to(spring, rest, base, energy, 2e-12);
}

/* From a free lever the action is that of its spring alone, pi e/sqrt(2 K), and stays. */
static void a_swing_that_strikes_keeps_its_action(void **state)
{
    (void)state;
    for (double spring = 1.0; spring < 20.0; spring *= 4.0)
        for (double force = 100e-9; force < 2e-6; force *= 4.0) {
            nt_well w = well_of(spring);
            const double energy = 1e-16, found = nt_well_pressed_from_free(&w, force, energy);
            assert_true(found > energy);
            const double free = PI * energy / sqrt(2.0 * spring);
            assert_true(fabs(action_of(spring, force, found) / free - 1.0) < 3e-3);
            assert_true(nt_well_pressed_from_free(&w, force, 0.0) == 0.0);
            assert_true(nt_well_pressed_from_free(&w, force, -1e-18) == 0.0);
        }
}

/* A pulled lever swings with s0 exp(-t/tau), and finds the base again lower by what a stage that turns has gone. */
static void what_a_pull_off_leaves(void **state)
{
    (void)state;
    int some = 0;
    for (double resonance = 450.0; resonance < 1e6; resonance *= 10.0)
        for (double speed = 1e-6; speed < 2e-3; speed *= 5.0) {
            nt_well w = well_of(4.0);
            const double wn = w.stage_rate = 2.0 * PI * resonance;
            const double pulled = plan.largest_pull_off_force / 4.0, tau = 2.0 * 50.0 / w.rate;
            const double first = pulled + (speed + wn * 2e-9) * PI / w.rate, end = pulled / speed + 1.0 / wn;
            double most = 0.0;
            for (int i = 1; i <= 400; ++i) {
                const double t = end * i / 400.0, rings = 2e-9 * (1.0 - cos(smaller(wn * t, PI)));
                const double height = larger(0.0, pulled - speed * (t - (1.0 - exp(-wn * t)) / wn) - rings);
                const double swing = first * exp(-t / tau);
                most = larger(most, 0.5 * 4.0 * (swing * swing - height * height));
            }
            some += most > 0.0;
            assert_true(fabs(nt_well_freed(&w, speed) - most) < 1e-9 * larger(most, 1e-20));
        }
    assert_true(some > 5);
    nt_plan calm = plan;
    calm.largest_pull_off_force = 0.0; /* nothing pulls: nothing is let go */
    nt_well w = well_of(4.0);
    w.plan = &calm;
    assert_true(nt_well_freed(&w, 1e-4) == 0.0);
}

/* Held until K + k = 0; from there to the bottom sample and spring give what the work between them is. */
static void a_jump_gives_what_lies_between(void **state)
{
    (void)state;
    for (double spring = 0.3; spring < 10.0; spring *= 3.0)
        for (double speed = 0.0; speed < 1e-3; speed += 4e-4) {
            nt_well w = well_of(spring);
            const nt_interaction_state never = {0};
            const double capture = nt_plan_capture_gap(&plan, &w.place), mass = spring / (w.rate * w.rate);
            double stiffness, gap = 50e-9;
            const double energy = nt_well_jump(&w, speed, &stiffness);
            for (; gap > larger(capture, 0.0) + 1e-12; gap -= 1e-12)
                if (spring + nt_interaction_eval_gap(&plan, &never, &w.place, gap).k <= 0.0)
                    break;
            assert_true(fabs(w.outside - gap) < 2.5e-12);
            const double base = w.outside - force_at(w.outside) / spring - speed * PI / w.rate;
            assert_true(fabs(w.base - base) < 1e-15);
            double bottom = w.outside - 1e-12;
            while (force_at(bottom) < spring * (bottom - base)) /* the sum of both draws it in */
                bottom -= 2e-13;
            const double h = 1e-13, k = (force_at(bottom - h) - force_at(bottom + h)) / (2.0 * h);
            assert_true(fabs(stiffness - larger(0.0, k)) < 0.02 * k);
            const double given = work_between(spring, base, w.outside, bottom) + 0.5 * mass * speed * speed;
            assert_true(fabs(energy / given - 1.0) < 2e-3);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_gap_carries_a_force),   cmocka_unit_test(a_peak_is_where_the_energy_is_gone),
        cmocka_unit_test(a_swing_that_is_pressed), cmocka_unit_test(a_swing_that_strikes_keeps_its_action),
        cmocka_unit_test(what_a_pull_off_leaves),  cmocka_unit_test(a_jump_gives_what_lies_between),
    };
    return cmocka_run_group_tests(tests, make_plan, NULL);
}
