/* SPDX-License-Identifier: BSD-3-Clause
 * The oracles are closed forms, or dense scans and bisections of the force made here, never the solver itself. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "cantilever_fields.h"
#include "internal/dynamics.h"

enum { BUDGET = 400 };

static nt_probe probe_of(double spring_constant)
{
    nt_probe probe = nt_rig_defaults().probe;
    probe.spring_constant = spring_constant;
    return probe;
}

static double balance(const sphere *s, double spring, double base, double z)
{
    sphere copy = *s;
    return sphere_eval(&copy, z).F - spring * (z - base);
}

/* First zero of the net force downhill from z: scanned in steps of 0.2 pm, then bisected. */
static double first_equilibrium(const sphere *s, double spring, double base, double z)
{
    const double way = balance(s, spring, base, z) > 0.0 ? 1.0 : -1.0;
    double a = z, b = z + way * 2e-13;
    while (way * balance(s, spring, base, b) > 0.0) {
        a = b;
        b += way * 2e-13;
    }
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (a + b);
        if (way * balance(s, spring, base, middle) > 0.0)
            a = middle;
        else
            b = middle;
    }
    return 0.5 * (a + b);
}

/* Spring on spring: z = K z_b / (K + k), exactly, up to k_i/k_c = 1e6. */
static void linear_contact_is_exact(void **state)
{
    (void)state;
    for (double ratio = 1e-3; ratio < 2e6; ratio *= 10.0) {
        const nt_probe probe = probe_of(8.0);
        wall w = {.stiffness = 8.0 * ratio};
        const nt_force_field field = {wall_eval, wall_advance, &w, 1e-10};
        nt_cantilever_state now = nt_cantilever_at(5e-9);
        nt_solve_info info;
        assert_int_equal(nt_cantilever_settle(&now, &probe, &field, -30e-9, &info), NT_OK);
        const double z = -30e-9 / (1.0 + ratio);
        assert_true(fabs(now.tip_height / z - 1.0) < 1e-10); /* z shrinks to 3e-14 m: this is 3e-24 m */
        assert_true(fabs(now.deflection - (z + 30e-9)) < 1e-19);
        assert_true(w.last_commit == now.tip_height && w.commits >= 2);
        assert_true(info.iterations <= 60);
    }
}

static void free_tip_follows_the_base(void **state)
{
    (void)state;
    const nt_probe probe = probe_of(8.0);
    wall w = {.stiffness = 100.0};
    const nt_force_field field = {wall_eval, NULL, &w, 1e-10};
    nt_cantilever_state now = nt_cantilever_at(1e-6);
    nt_solve_info info;
    assert_int_equal(nt_cantilever_settle(&now, &probe, &field, 3e-6, &info), NT_OK);
    assert_true(fabs(now.tip_height - 3e-6) < 1e-21 && fabs(now.deflection) < 1e-21);
    assert_true(info.iterations < BUDGET);
}

/* k_c zeta = F and z_t = z_b + zeta cos(alpha), with a tilt. */
static void tilt_enters_as_documented(void **state)
{
    (void)state;
    nt_probe probe = probe_of(8.0);
    probe.tilt = 0.3;
    wall w = {.stiffness = 20.0};
    const nt_force_field field = {wall_eval, NULL, &w, 1e-10};
    nt_cantilever_state now = nt_cantilever_at(0.0);
    assert_int_equal(nt_cantilever_settle(&now, &probe, &field, -10e-9, NULL), NT_OK);
    assert_true(fabs(8.0 * now.deflection / (-20.0 * now.tip_height) - 1.0) < 1e-12);
    assert_true(fabs(now.tip_height - (-10e-9 + now.deflection * cos(0.3))) < 1e-22);
}

/* The whole loop, in steps, against the scan: jump-in and snap-off happen in the same step, everywhere the same z. */
static void follow(sphere s, double spring, double from, double to, double step)
{
    const nt_probe probe = probe_of(spring);
    const nt_force_field field = sphere_field(&s);
    nt_cantilever_state now = nt_cantilever_at(from);
    double oracle = from;
    for (int turn = 0; turn < 2; turn++) {
        const double end = turn == 0 ? to : from, way = turn == 0 ? -1.0 : 1.0;
        for (double base = turn == 0 ? from : to; way * (end - base) > 0.0; base += way * step) {
            oracle = first_equilibrium(&s, spring, base, oracle);
            assert_int_equal(nt_cantilever_settle(&now, &probe, &field, base, NULL), NT_OK);
            assert_true(fabs(now.tip_height - oracle) < 1e-17);
        }
    }
}

static void hysteresis_loop_agrees_with_a_dense_scan(void **state)
{
    (void)state;
    follow(silicon, 8.0, 8e-9, -4e-9, 0.037e-9);
    follow(silicon, 0.5, 12e-9, -10e-9, 0.41e-9);
    follow(silicon, 2000.0, 3e-9, -1e-9, 0.0113e-9); /* stiff: no jump at all */
}

/* At the approach fold K = -k: z = (2 A / K)^(1/3), z_b = z + A / (K z^2). The tip stands just before and is in contact
 * just after; the return fold is where the attraction is largest, at a0: z_b = a0 + A / (K a0^2). */
static void folds_are_where_the_springs_are_equal(void **state)
{
    (void)state;
    for (double spring = 0.1; spring < 50.0; spring *= 3.0) {
        sphere s = silicon;
        const nt_probe probe = probe_of(spring);
        const nt_force_field field = sphere_field(&s);
        const double z_in = cbrt(2.0 * s.adhesion / spring);
        const double base_in = z_in + s.adhesion / (spring * z_in * z_in);
        const double base_out = s.a0 + s.adhesion / (spring * s.a0 * s.a0);
        nt_cantilever_state now = nt_cantilever_at(base_in + 1e-9);
        for (double above = 1e-9; above > 1e-15; above *= 0.5) { /* to within 1 fm */
            assert_int_equal(nt_cantilever_settle(&now, &probe, &field, base_in + above, NULL), NT_OK);
            assert_true(now.tip_height > z_in);
        }
        assert_int_equal(nt_cantilever_settle(&now, &probe, &field, base_in - 1e-15, NULL), NT_OK);
        assert_true(now.tip_height < s.a0);
        for (double below = 1e-9; below > 1e-15; below *= 0.5) {
            assert_int_equal(nt_cantilever_settle(&now, &probe, &field, base_out - below, NULL), NT_OK);
            assert_true(now.tip_height < s.a0);
        }
        assert_int_equal(nt_cantilever_settle(&now, &probe, &field, base_out + 1e-15, NULL), NT_OK);
        assert_true(now.tip_height > z_in);
    }
}

/* A bridge that forms on touching and breaks later: the force jumps both ways, and the history decides. */
static void bridge_forms_and_breaks_with_its_history(void **state)
{
    (void)state;
    const nt_probe probe = probe_of(8.0);
    bridge b = {.pull = 20e-9, .make = 1e-9, .reach = 6e-9};
    const nt_force_field field = {bridge_eval, bridge_advance, &b, 0.2e-9};
    nt_cantilever_state now = nt_cantilever_at(20e-9);
    double base = 20e-9;
    for (; base > 1.05e-9; base -= 0.1e-9) {
        assert_int_equal(nt_cantilever_settle(&now, &probe, &field, base, NULL), NT_OK);
        assert_true(fabs(now.deflection) < 1e-18 && !b.made);
    }
    for (; base > 0.5e-9; base -= 0.1e-9)
        assert_int_equal(nt_cantilever_settle(&now, &probe, &field, base, NULL), NT_OK);
    assert_true(b.made && now.tip_height < 0.0); /* pulled in: 8 (z - z_b) = -20 nN - 1000 z */
    base += 0.1e-9;                              /* the last base that was set */
    assert_true(fabs(now.tip_height - (8.0 * base - 20e-9) / 1008.0) < 1e-19);
    for (; base < 8.4e-9; base += 0.1e-9) { /* breaks at z_b = 6 nm + 20 nN / (8 N/m) = 8.5 nm */
        assert_int_equal(nt_cantilever_settle(&now, &probe, &field, base, NULL), NT_OK);
        assert_true(b.made && now.deflection < 0.0);
    }
    assert_int_equal(nt_cantilever_settle(&now, &probe, &field, 8.6e-9, NULL), NT_OK);
    assert_true(!b.made && fabs(now.deflection) < 1e-18);
}

/* A long way in one call ends where many small steps end. */
static void long_way_equals_many_steps(void **state)
{
    (void)state;
    for (double to = -5e-9; to < 300e-9; to += 7.3e-9) {
        sphere s = silicon;
        const nt_probe probe = probe_of(8.0);
        const nt_force_field field = sphere_field(&s);
        nt_cantilever_state once = nt_cantilever_at(500e-9);
        nt_solve_info info;
        assert_int_equal(nt_cantilever_settle(&once, &probe, &field, to, &info), NT_OK);
        assert_true(fabs(once.tip_height - first_equilibrium(&s, 8.0, to, 500e-9)) < 1e-17);
        assert_true(info.iterations < BUDGET / 2);
    }
}

/* From 30 nm in one call: the walk's long steps must not carry the tip through the outer layers to the wall. */
static void layers_are_met_from_outside(void **state)
{
    (void)state;
    for (double layers = 2e-10; layers < 1e-7; layers *= 1.3) {
        sphere s = silicon;
        s.layers = layers;
        s.adhesion *= 0.1;
        const nt_probe probe = probe_of(0.5);
        nt_force_field field = sphere_field(&s);
        field.length = 1e-9 / LAYERS_PER_NM / 6.3; /* one radian of the oscillation */
        for (double base = -3e-9; base < 2e-9; base += 0.31e-9) {
            nt_cantilever_state now = nt_cantilever_at(30e-9);
            assert_int_equal(nt_cantilever_settle(&now, &probe, &field, base, NULL), NT_OK);
            assert_true(fabs(now.tip_height - first_equilibrium(&s, 0.5, base, 30e-9)) < 1e-16);
        }
    }
}

/* Random springs, samples and moves, with up to a dozen equilibria to choose from: the first one downhill, always. */
static void random_moves_land_at_the_first_equilibrium(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(2026);
    int moves = 0, jumps = 0;
    for (int run = 0; run < 200; run++) {
        sphere s = silicon;
        s.adhesion *= pow(10.0, 2.0 * nt_random_uniform(&random) - 1.0);
        s.hertz *= pow(10.0, 3.0 * nt_random_uniform(&random) - 3.0);
        s.layers = run % 2 == 0 ? 0.0 : pow(10.0, -10.0 + 2.0 * nt_random_uniform(&random));
        const nt_probe probe = probe_of(pow(10.0, 3.0 * nt_random_uniform(&random) - 1.0));
        nt_force_field field = sphere_field(&s);
        if (s.layers > 0.0)
            field.length = 1e-9 / LAYERS_PER_NM / 6.3; /* one radian of the oscillation */
        nt_cantilever_state now = nt_cantilever_at(5e-9);
        double base = 5e-9;
        for (int k = 0; k < 40; k++, moves++) {
            base += (nt_random_uniform(&random) - 0.5) * 4e-9;
            base = base > 6e-9 ? 6e-9 : base < -3e-9 ? -3e-9 : base;
            const double before = now.tip_height;
            assert_int_equal(nt_cantilever_settle(&now, &probe, &field, base, NULL), NT_OK);
            const double oracle = first_equilibrium(&s, probe.spring_constant, base, before);
            assert_true(fabs(now.tip_height - oracle) < 1e-16); /* of the oracle's bisection where the slope is weak */
            jumps += fabs(now.tip_height - before) > 1e-9;
        }
    }
    assert_true(jumps > 500);
}

/* Approach from 50 nm to 20 nm below and back, jumps included, in ticks of 0.01 nm (0.1 um/s at 10 kHz) to 1 nm. */
static void usual_tick_takes_few_evaluations(void **state)
{
    (void)state;
    static const double ticks[] = {0.01e-9, 0.1e-9, 1e-9}, allowed[] = {2.5, 4.0, 6.0};
    for (int t = 0; t < 3; t++) {
        sphere s = silicon;
        const nt_probe probe = probe_of(8.0);
        const nt_force_field field = sphere_field(&s);
        nt_cantilever_state now = nt_cantilever_at(50e-9);
        const int n = (int)(70e-9 / ticks[t]);
        int most = 0;
        for (int k = 0; k < 2 * n; k++) {
            const double base = 50e-9 - (k < n ? k : 2 * n - k) * ticks[t];
            nt_solve_info info;
            assert_int_equal(nt_cantilever_settle(&now, &probe, &field, base, &info), NT_OK);
            most = info.iterations > most ? info.iterations : most;
        }
        const double mean = (double)s.evaluations / (2 * n);
        print_message("tick of %g nm: %.2f evaluations, %d at most\n", ticks[t] * 1e9, mean, most);
        assert_true(mean < allowed[t]);
        assert_true(most < 60); /* in a jump */
    }
}

/* A branch that ends with a vertical tangent, k = -infinity, as JKR's does; the tip starts exactly on its end. */
static nt_law_value branch_eval(void *context, double z)
{
    const double end = *(const double *)context, depth = end - z;
    if (depth < 0.0)
        return (nt_law_value){.F = 0.0};
    return (nt_law_value){.F = -1e-4 * sqrt(depth) + 100.0 * depth, .k = -0.5e-4 / sqrt(depth) + 100.0};
}

static void branch_may_end_with_a_vertical_tangent(void **state)
{
    (void)state;
    double end = 1e-9;
    const nt_probe probe = probe_of(8.0);
    const nt_force_field field = {branch_eval, NULL, &end, 1e-10};
    nt_cantilever_state now = nt_cantilever_at(end);
    assert_int_equal(nt_cantilever_settle(&now, &probe, &field, end - 1e-12, NULL), NT_OK);
    /* 108 d - 1e-4 sqrt(d) - 8e-12 = 0 in d = end - z: a quadratic in its root. */
    const double root = (1e-4 + sqrt(1e-8 + 4.0 * 108.0 * 8e-12)) / 216.0;
    assert_true(fabs((end - now.tip_height) / (root * root) - 1.0) < 1e-9);
    now = nt_cantilever_at(end);
    assert_int_equal(nt_cantilever_settle(&now, &probe, &field, end + 1e-9, NULL), NT_OK);
    assert_true(fabs(now.tip_height - (end + 1e-9)) < 1e-21);
}

static nt_law_value nan_eval(void *context, double z)
{
    (void)context;
    return (nt_law_value){.F = z < 1e-9 ? (double)NAN : 0.0};
}

static void nan_is_reported(void **state)
{
    (void)state;
    const nt_probe probe = probe_of(8.0);
    const nt_force_field field = {nan_eval, NULL, NULL, 1e-10};
    nt_cantilever_state now = nt_cantilever_at(5e-9);
    assert_int_equal(nt_cantilever_settle(&now, &probe, &field, 0.0, NULL), NT_E_NOT_FINITE);
    assert_true(now.tip_height >= 1e-9 && now.tip_height <= 5e-9); /* where the field was last known */
    assert_int_equal(nt_cantilever_settle(&now, &probe, &field, (double)NAN, NULL), NT_E_NOT_FINITE);
    assert_true(isfinite(now.tip_height));
}

/* Ripples of one field length all the way down: each has to be looked at, and there are 1e5 of them. */
static nt_law_value rough_eval(void *context, double z)
{
    ++*(int *)context;
    return (nt_law_value){.F = -1e-9 * (1.0 + 0.5 * sin(z * 1e11)), .k = 50.0 * cos(z * 1e11)};
}

static void work_is_bounded(void **state)
{
    (void)state;
    const nt_probe probe = probe_of(1e-3);
    int calls = 0;
    nt_force_field field = {rough_eval, NULL, &calls, 1e-11};
    nt_cantilever_state now = nt_cantilever_at(0.0);
    assert_int_equal(nt_cantilever_settle(&now, &probe, &field, -1e-6, NULL), NT_E_NO_CONVERGENCE);
    assert_true(calls <= BUDGET + 1);
    assert_true(now.tip_height < 0.0 && isfinite(now.deflection));
}

static void refuses_nonsense(void **state)
{
    (void)state;
    wall w = {.stiffness = 1.0};
    nt_force_field field = {wall_eval, NULL, &w, 0.0};
    nt_cantilever_state now = nt_cantilever_at(0.0);
    nt_probe probe = probe_of(8.0);
    assert_int_equal(nt_cantilever_settle(&now, &probe, &field, 0.0, NULL), NT_E_ARGUMENT);
    field.length = 1e-10;
    probe.spring_constant = 0.0;
    assert_int_equal(nt_cantilever_settle(&now, &probe, &field, 0.0, NULL), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_contact_is_exact),
        cmocka_unit_test(free_tip_follows_the_base),
        cmocka_unit_test(tilt_enters_as_documented),
        cmocka_unit_test(hysteresis_loop_agrees_with_a_dense_scan),
        cmocka_unit_test(folds_are_where_the_springs_are_equal),
        cmocka_unit_test(bridge_forms_and_breaks_with_its_history),
        cmocka_unit_test(long_way_equals_many_steps),
        cmocka_unit_test(layers_are_met_from_outside),
        cmocka_unit_test(random_moves_land_at_the_first_equilibrium),
        cmocka_unit_test(usual_tick_takes_few_evaluations),
        cmocka_unit_test(branch_may_end_with_a_vertical_tangent),
        cmocka_unit_test(nan_is_reported),
        cmocka_unit_test(work_is_bounded),
        cmocka_unit_test(refuses_nonsense),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
