/* SPDX-License-Identifier: BSD-3-Clause
 * The slow flow beside the time domain, over random levers, drives, samples and humidities. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "internal/tapping.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/advanced/tapping.h"
#include "nanotouch/material.h"
#include "scan/flow.h"

enum { CASES = 24 };
static nt_plan plan;

static double between(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

/* One random case, both from the motion that the time domain has settled to. 0 where one of them does not settle; -1
 * where the slow flow leaves for the other motion, since the one that it began with ends at another height. */
static int compare(nt_random *random, int n, double *amplitude_error, double *force_error)
{
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = between(random, 2e-9, 30e-9);
    scene.sample.youngs_modulus = between(random, 1e8, 3e10);
    scene.medium.relative_humidity = n % 2 ? 0.0 : 0.3 + 0.4 * nt_random_uniform(random);
    const nt_plan_inputs inputs = {.scene = &scene};
    if (nt_plan_make(&plan, &inputs, NULL) != NT_OK)
        return 0;
    nt_probe probe = nt_rig_defaults().probe;
    probe.spring_constant = between(random, 2.0, 60.0);
    probe.quality = between(random, 50.0, 800.0);
    probe.resonance = 300e3;
    const double A0 = between(random, 5e-9, 60e-9), share = 0.5 + 0.45 * nt_random_uniform(random);
    const nt_drive drive = {n / 2 % 2, 0.0, A0};
    nt_tapping t;
    assert_int_equal(nt_tapping_init(&t, &probe, &drive, 1e-8, NULL), NT_OK);
    const nt_tapping_over over = {&plan, NULL, share * A0};
    nt_tapping_state s = nt_tapping_free(&t);
    nt_tapping_value v;
    if (nt_tapping_settle(&t, &s, &over, &v, NULL) != NT_OK)
        return 0;
    nt_flow_state f = {s.position - v.mean, -s.speed / t.ratio, v.mean, s.contact.attached};
    nt_flow_value w;
    if (nt_flow_settle(&t, &f, &over, &w, NULL) != NT_OK)
        return 0;
    if (fabs(w.phase - v.phase) > 0.5)
        return -1;
    *amplitude_error = fabs(w.amplitude - v.amplitude) / A0 * probe.quality;
    const double scale = larger(fabs(v.peak_force), plan.pull_off_force);
    *force_error = v.contact_time > 0.0 ? fabs(w.peak_force - v.peak_force) / scale : 0.0;
    return 1;
}

/* Amplitude within 2 A0/Q, peak force within 15 % of the larger of itself and the pull-off. */
static void agrees_with_the_time_domain(void **state)
{
    (void)state;
    const char *more = getenv("NANOTOUCH_FLOW_CASES");
    const int cases = more ? atoi(more) : CASES;
    nt_random random = nt_random_seed(20);
    double worst_amplitude = 0.0, worst_force = 0.0;
    int compared = 0, outside = 0, left = 0;
    for (int n = 0; n < cases; n++) {
        double amplitude = 0.0, force = 0.0;
        const int found = compare(&random, n, &amplitude, &force);
        left += found < 0;
        if (found <= 0)
            continue;
        compared++;
        outside += !(amplitude < 2.0 && force < 0.15);
        worst_amplitude = larger(worst_amplitude, amplitude);
        worst_force = larger(worst_force, force);
        if (more && !(amplitude < 2.0 && force < 0.15))
            print_message("case %d: amplitude %.3g A0/Q, force %.3g\n", n, amplitude, force);
    }
    print_message("%d of %d compared, amplitude within %.3g A0/Q, peak force within %.3g, %d outside\n", compared,
                  cases, worst_amplitude, worst_force, outside);
    assert_int_equal(outside, 0);
    assert_true(compared > cases / 2 && left <= 1 + cases / 50);
}

/* No force: the free swing stays, tip and base; from rest it grows as 1 - exp(-w0 t/2 Q). */
static void a_free_lever(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    scene.medium.relative_humidity = scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0;
    const nt_plan_inputs inputs = {.scene = &scene};
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
    const nt_probe probe = nt_rig_defaults().probe;
    for (int at_base = 0; at_base < 2; at_base++) {
        const nt_drive drive = {at_base, 1.001 * probe.resonance, 20e-9};
        nt_tapping t;
        assert_int_equal(nt_tapping_init(&t, &probe, &drive, 1e-9, NULL), NT_OK);
        const nt_tapping_over over = {&plan, NULL, 1e-6};
        nt_flow_state f = nt_flow_free(&t);
        const nt_flow_value v = nt_flow_step(&t, &f, &over, 1e-3);
        assert_true(fabs(v.amplitude / 20e-9 - 1.0) < 1e-12 && v.peak_force == 0.0 && v.tip_loss == 0.0);
    }
    nt_tapping t;
    const nt_drive drive = {0.0, 0.0, 20e-9};
    assert_int_equal(nt_tapping_init(&t, &probe, &drive, 1e-9, NULL), NT_OK);
    nt_flow_state f = {.imaginary = -1e-12};
    const nt_tapping_over over = {&plan, NULL, 1e-6};
    const double time = 2.0 * t.quality / t.rate;
    for (int i = 0; i < 10; i++)
        nt_flow_step(&t, &f, &over, 0.1 * time);
    assert_true(fabs(hypot(f.real, f.imaginary) / 20e-9 - (1.0 - exp(-1.0))) < 1e-4);
}

/* Through a table as by the averages themselves: a lever that is lowered onto the surface and lifted again, 100 times
 * slower than it settles. They part where it leaves one motion for the other, dry in 44 steps, and by less than half of
 * A0/Q where a lever takes a meniscus in every fifth step or so: not in the same one. That is 559 of 20000 steps. */
static void a_table_changes_nothing(void **state)
{
    (void)state;
    nt_scene scene = nt_scene_defaults();
    for (int wet = 0; wet < 2; wet++) {
        scene.medium.relative_humidity = wet ? 0.5 : 0.0;
        const nt_plan_inputs inputs = {.scene = &scene};
        assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
        const nt_probe probe = nt_rig_defaults().probe;
        const nt_drive drive = nt_drive_defaults();
        nt_tapping t;
        assert_int_equal(nt_tapping_init(&t, &probe, &drive, 1e-9, NULL), NT_OK);
        nt_flow_state one = nt_flow_free(&t), other = one;
        nt_flow_table table = {0};
        const int steps = 20000;
        int apart = 0, far = 0;
        for (int i = 0; i < steps; i++) {
            const nt_tapping_over over = {&plan, NULL, 25e-9 - 20e-9 * sin(NT_PI * i / steps)};
            const nt_flow_value by_itself = nt_flow_step(&t, &one, &over, 2e-5);
            const nt_flow_value in_cell = nt_flow_step_in(&t, &other, &over, 2e-5, &table);
            const double off = fabs(in_cell.amplitude - by_itself.amplitude) * probe.quality / 20e-9;
            apart += off > 0.1 || fabs(in_cell.peak_force - by_itself.peak_force) > 0.1 * plan.pull_off_force;
            far += off > 0.5;
        }
        assert_true(apart < (wet ? steps / 25 : steps / 100));
        assert_true(far < (wet ? 1 : steps / 200));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_free_lever),
        cmocka_unit_test(a_table_changes_nothing),
        cmocka_unit_test(agrees_with_the_time_domain),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
