/* SPDX-License-Identifier: BSD-3-Clause
 * Tapping in the time domain: against closed forms of the free lever and of small indentations (Hertz), balances of
 * energy and virial over all harmonics, and the losses that a meniscus says it has. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "nanotouch/advanced/random.h"
#include "nanotouch/advanced/tapping.h"
#include "nanotouch/material.h"

static nt_plan plan;

static void make_plan(const nt_scene *scene)
{
    const nt_plan_inputs inputs = {.scene = scene};
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
}

/* A tip of 10 nm on 1 GPa that nothing attracts: Hertz. */
static nt_scene bare(void)
{
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = 10e-9;
    scene.sample.youngs_modulus = 1e9;
    scene.medium.relative_humidity = scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
    return scene;
}

static nt_probe lever(double k, double quality)
{
    nt_probe probe = nt_rig_defaults().probe;
    probe.spring_constant = k;
    probe.quality = quality;
    probe.resonance = 300e3;
    return probe;
}

static nt_tapping made(const nt_probe *probe, nt_drive drive)
{
    nt_tapping tapping;
    assert_int_equal(nt_tapping_init(&tapping, probe, &drive, 1e-9, NULL), NT_OK);
    return tapping;
}

/* Far away the free swing is the motion: amplitude and lag of the driven oscillator, tip and base apart. 1e-8: the
 * tolerance of the steps, ten times. */
static void free_swing(void **state)
{
    (void)state;
    const nt_scene scene = bare();
    make_plan(&scene);
    for (int at_base = 0; at_base < 2; at_base++)
        for (double quality = 10.0; quality < 2000.0; quality *= 5.0)
            for (double ratio = 0.5; ratio < 1.6; ratio += 0.25) {
                const nt_probe probe = lever(40.0, quality);
                const nt_tapping t = made(&probe, (nt_drive){at_base, ratio * probe.resonance, 20e-9});
                const nt_tapping_over over = {&plan, NULL, 1e-6};
                nt_tapping_state s = nt_tapping_free(&t);
                nt_tapping_value v;
                assert_int_equal(nt_tapping_run(&t, &s, &over, 3, &v), NT_OK);
                assert_true(fabs(v.amplitude / 20e-9 - 1.0) < 1e-8);
                /* q/D = 1/(1 - r^2 + i r/Q); of the base, less 1: (r^2 - i r/Q) q/D */
                double lag = atan2(ratio / quality, 1.0 - ratio * ratio);
                if (at_base)
                    lag += atan2(1.0 / quality, ratio);
                assert_true(fabs(remainder(v.phase - lag, 2.0 * NT_PI)) < 1e-8);
                assert_true(v.change < 1e-8 && v.energy_error < 1e-7 + 2e-9 * quality && v.virial_error < 1e-8);
                assert_true(v.peak_force == 0.0 && v.contact_time == 0.0);
            }
}

/* Hertz, small indentation: delta^2 = (16/3) sqrt(A/2) k A0 cos(phi)/(2 Q)/C, F = C delta^1.5, C = 4/3 E* sqrt(R). The
 * closed form takes the turning tip for a parabola and F z for F A: 0.3 .. 3 % (NEXT of its authors), 2.5 % here. */
static void small_indentation(void **state)
{
    (void)state;
    const nt_scene scene = bare();
    make_plan(&scene);
    const double C = 4.0 / 3.0 * plan.contact.effective_modulus * sqrt(plan.contact.radius), A0 = 20e-9;
    const nt_probe probe = lever(40.0, 400.0);
    const nt_tapping t = made(&probe, (nt_drive){.at = 0.0, .free_amplitude = A0});
    for (double share = 0.95; share > 0.5; share -= 0.15) {
        const nt_tapping_over over = {&plan, NULL, share * A0};
        nt_tapping_state s = nt_tapping_free(&t);
        nt_tapping_value v;
        assert_int_equal(nt_tapping_settle(&t, &s, &over, &v, NULL), NT_OK);
        const double square = 16.0 / 3.0 * sqrt(0.5 * v.amplitude) * 40.0 * A0 * cos(v.phase) / 800.0 / C;
        assert_true(fabs(v.peak_force / (C * pow(square, 0.75)) - 1.0) < 0.025);
        assert_true(fabs(-v.lowest_gap / sqrt(square) - 1.0) < 0.025);
        assert_true(fabs(v.peak_force / (C * pow(-v.lowest_gap, 1.5)) - 1.0) < 1e-7); /* the law, at the lowest point */
        /* nothing lost: sin(phi) = A/A0 but for harmonics, (mean/A)^2 and less */
        assert_true(fabs(sin(v.phase) - v.amplitude / A0) < 1e-5);
        assert_true(fabs(v.tip_loss) < 1e-5 * v.medium_loss);
    }
}

/* Whatever the lever and the scene, and long before it has settled: energy to 1e-6 of what is driven, virial to 1e-8.
 * The steps' tolerance is 1e-9 of A0 some 40 times a period, times Q/pi for what the drive puts in. */
static void balances_hold(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(7);
    int touched = 0;
    for (int n = 0; n < 40; n++) {
        nt_scene scene = nt_scene_defaults();
        scene.tip.radius = 1e-9 * pow(10.0, 0.5 + nt_random_uniform(&random));
        scene.sample.youngs_modulus = 1e9 * pow(10.0, 2.0 * nt_random_uniform(&random));
        scene.medium.relative_humidity = n % 2 ? 0.0 : 0.3 + 0.3 * nt_random_uniform(&random);
        make_plan(&scene);
        nt_probe probe =
            lever(pow(10.0, 0.3 + 1.5 * nt_random_uniform(&random)), 20.0 + 400.0 * nt_random_uniform(&random));
        probe.tilt = 0.2 * (n % 3);
        probe.contact_viscosity = n % 5 ? 0.0 : 20.0;
        const double A0 = 1e-9 * (5.0 + 60.0 * nt_random_uniform(&random));
        const nt_tapping t = made(&probe, (nt_drive){n % 2, 0.0, A0});
        const nt_tapping_over over = {&plan, NULL, A0 * (0.3 + 0.8 * nt_random_uniform(&random))};
        nt_tapping_state s = nt_tapping_free(&t);
        nt_tapping_value v;
        assert_int_equal(nt_tapping_run(&t, &s, &over, 60, &v), NT_OK);
        assert_true(v.energy_error < 1e-6);
        assert_true(v.virial_error < 1e-8);
        touched += v.contact_time > 0.0;
    }
    assert_true(touched > 25);
}

/* A meniscus that forms and breaks in each period: minus the closed integral of F dq is the loss that the law names.
 * A jump is crossed by a step whose error is at the tolerance; where in that step is a matter of rounding. Of 60
 * amplitudes that differ by 1e-11 half were within 2.7e-5, nine in ten within 1.1e-4, and all within 4e-4. */
static void a_loop_has_its_area(void **state)
{
    (void)state;
    enum { RUNS = 10 };
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = 10e-9;
    make_plan(&scene);
    assert_true(plan.capture_energy + plan.release_energy > 1e-19);
    const nt_probe probe = lever(40.0, 400.0);
    int near = 0;
    for (int n = 0; n < RUNS; n++) {
        const nt_tapping t = made(&probe, (nt_drive){n % 2, 0.0, 20e-9});
        const nt_tapping_over over = {&plan, NULL, 14e-9 * (1.0 + 1e-11 * n)};
        nt_tapping_state s = nt_tapping_free(&t);
        nt_tapping_value v;
        assert_int_equal(nt_tapping_settle(&t, &s, &over, &v, NULL), NT_OK);
        assert_true(fabs(v.tip_loss / v.jump_loss - 1.0) < 1e-3);
        near += fabs(v.tip_loss / v.jump_loss - 1.0) < 1e-4;
        assert_true(fabs(v.jump_loss / (plan.capture_energy + plan.release_energy) - 1.0) < 1e-9);
        /* what the drive gives is what medium and contact take */
        assert_true(fabs(v.drive_work / (v.medium_loss + v.tip_loss) - 1.0) < 1e-5);
    }
    assert_true(near > RUNS / 2);
}

/* The same motion by far smaller steps; and the same bits from a copy of the state. */
static void steps_do_not_matter(void **state)
{
    (void)state;
    const nt_scene scene = bare();
    make_plan(&scene);
    const nt_probe probe = lever(10.0, 100.0);
    const nt_drive drive = {1.0, 0.0, 15e-9};
    nt_tapping coarse = made(&probe, drive), fine;
    assert_int_equal(nt_tapping_init(&fine, &probe, &drive, 1e-12, NULL), NT_OK);
    const nt_tapping_over over = {&plan, NULL, 10e-9};
    nt_tapping_state a = nt_tapping_free(&coarse), b = a, copy = a;
    nt_tapping_value va, vb, again;
    assert_int_equal(nt_tapping_run(&coarse, &a, &over, 50, &va), NT_OK);
    assert_int_equal(nt_tapping_run(&fine, &b, &over, 50, &vb), NT_OK);
    assert_int_equal(nt_tapping_run(&coarse, &copy, &over, 50, &again), NT_OK);
    assert_true(hypot(a.position - b.position, a.speed - b.speed) < 1e-6 * 15e-9);
    assert_true(fabs(va.peak_force / vb.peak_force - 1.0) < 1e-6);
    assert_memory_equal(&va, &again, sizeof va);
}

/* Silicon in dry air, 8 nm: lowered slowly the lever stays attractive, lifted from a hard tap it stays repulsive. One
 * harmonic: <F q> = -(k A A0/2Q) cos(phi) and sin(phi) = A/A0, within 2e-3 here. */
static void two_motions_coexist(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = 10e-9;
    scene.medium.relative_humidity = 0.0;
    make_plan(&scene);
    static const double paths[2][4] = {{1.0, 0.98, 0.96, 0.94}, {0.5, 0.5, 0.92, 0.94}};
    const double A0 = 8e-9;
    const nt_probe probe = lever(40.0, 400.0);
    const nt_tapping t = made(&probe, (nt_drive){.at = 0.0, .free_amplitude = A0});
    nt_tapping_value v[2];
    for (int i = 0; i < 2; i++) {
        nt_tapping_state s = nt_tapping_free(&t);
        for (int j = 0; j < 4; j++) {
            const nt_tapping_over over = {&plan, NULL, paths[i][j] * A0};
            const nt_status status = nt_tapping_settle(&t, &s, &over, &v[i], NULL);
            assert_true(status == NT_OK || (status == NT_E_NO_CONVERGENCE && j < 3));
        }
        assert_true(fabs(v[i].virial / (-40.0 * v[i].amplitude * A0 * cos(v[i].phase) / 800.0) - 1.0) < 2e-3);
        assert_true(fabs(sin(v[i].phase) - v[i].amplitude / A0) < 1e-3);
    }
    assert_true(v[0].phase > 1.8 && v[0].contact_time == 0.0 && v[0].virial > 0.0);
    assert_true(v[1].phase < 1.4 && v[1].contact_time > 0.0 && v[1].virial < 0.0);
}

static void refusals(void **state)
{
    (void)state;
    const nt_scene scene = bare();
    make_plan(&scene);
    nt_tapping t;
    nt_problem problem;
    nt_probe probe = lever(40.0, 9.0);
    nt_drive drive = nt_drive_defaults();
    assert_int_equal(nt_tapping_init(&t, &probe, &drive, 1e-9, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "probe.quality");
    probe.quality = 100.0;
    drive.frequency = 4.0 * probe.resonance;
    assert_int_equal(nt_tapping_init(&t, &probe, &drive, 1e-9, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "drive.frequency");
    drive = nt_drive_defaults();
    drive.free_amplitude = NAN;
    assert_int_equal(nt_tapping_init(&t, &probe, &drive, 1e-9, &problem), NT_E_NOT_FINITE);
    assert_string_equal(problem.field, "drive.free_amplitude");
    drive = nt_drive_defaults();
    assert_int_equal(nt_tapping_init(&t, &probe, &drive, 0.0, &problem), NT_E_RANGE);
    t = made(&probe, drive);
    nt_tapping_state s = nt_tapping_free(&t);
    const nt_tapping_state before = s;
    nt_tapping_value v;
    const nt_tapping_over nowhere = {&plan, NULL, NAN}, over = {&plan, NULL, 1e-8};
    assert_int_equal(nt_tapping_run(&t, &s, &nowhere, 1, &v), NT_E_NOT_FINITE);
    assert_int_equal(nt_tapping_run(&t, &s, &over, 0, &v), NT_E_ARGUMENT);
    assert_memory_equal(&s, &before, sizeof s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_swing),
        cmocka_unit_test(small_indentation),
        cmocka_unit_test(balances_hold),
        cmocka_unit_test(a_loop_has_its_area),
        cmocka_unit_test(two_motions_coexist),
        cmocka_unit_test(steps_do_not_matter),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
