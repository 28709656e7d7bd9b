/* SPDX-License-Identifier: BSD-3-Clause
 * Harmonic balance beside the time domain: random levers, drives, set points, samples and humidities; both branches. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "internal/balance.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "scan/balance.h"

enum { CASES = 16 };
static nt_plan plan;
static nt_balance_curve curve;

static double between(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

static nt_status make_plan(double radius, double modulus, double humidity)
{
    nt_scene scene = nt_scene_defaults();
    scene.tip.radius = radius;
    scene.sample.youngs_modulus = modulus;
    scene.medium.relative_humidity = humidity;
    const nt_plan_inputs inputs = {.scene = &scene};
    return nt_plan_make(&plan, &inputs, NULL);
}

static nt_tapping lever_of(double stiffness, double quality, const nt_drive *drive)
{
    nt_probe probe = nt_rig_defaults().probe;
    probe.spring_constant = stiffness;
    probe.quality = quality;
    probe.resonance = 300e3;
    nt_tapping t;
    assert_int_equal(nt_tapping_init(&t, &probe, drive, 1e-8, NULL), NT_OK);
    return t;
}

/* Errors of amplitude and peak force over what is told; 0 where one of the two finds no motion. */
static int compare(nt_random *random, int n, double *amplitude, double *force)
{
    const double radius = between(random, 2e-9, 30e-9), modulus = between(random, 1e8, 3e10);
    const double humidity = n % 4 ? 0.0 : 0.3 + 0.4 * nt_random_uniform(random);
    const double k = between(random, 2.0, 60.0), Q = between(random, 20.0, 800.0);
    const double A0 = between(random, 5e-9, 60e-9), share = 0.3 + 0.65 * nt_random_uniform(random);
    const nt_drive drive = {n / 2 % 2, 0.0, A0};
    const nt_tapping t = lever_of(k, Q, &drive);
    if (make_plan(radius, modulus, humidity) != NT_OK)
        return 0;
    const nt_balance balance = {&t, &plan, NULL, 1 + n % NT_HARMONICS_MAX, 0.0};
    const nt_balance_target target = {NT_AIM_AMPLITUDE, share * A0, n / 4 % 2};
    nt_balance_state state;
    nt_balance_value found;
    if (nt_balance_trace(&balance, &curve) != NT_OK ||
        nt_balance_find(&balance, &curve, &target, &state, &found) != NT_OK)
        return 0;
    assert_true(fabs(found.amplitude / (share * A0) - 1.0) < 1e-6);
    nt_tapping_state moment = nt_balance_moment(&balance, &state, &found);
    const nt_tapping_over over = {&plan, NULL, found.base_height};
    nt_tapping_value truth;
    if (nt_tapping_settle(&t, &moment, &over, &truth, NULL) != NT_OK)
        return 0;
    *amplitude = fabs(truth.amplitude - found.amplitude) / found.amplitude_bound;
    *force = fabs(truth.peak_force - found.peak_force) / found.force_bound;
    return 1;
}

static void within_what_is_told(void **state)
{
    (void)state;
    const char *more = getenv("NANOTOUCH_BALANCE_CASES");
    const int cases = more ? atoi(more) : CASES;
    nt_random random = nt_random_seed(20);
    int compared = 0;
    double most = 0.0;
    for (int n = 0; n < cases; n++) {
        double amplitude = 0.0, force = 0.0;
        compared += compare(&random, n, &amplitude, &force);
        most = larger(most, larger(amplitude, force));
    }
    print_message("%d of %d compared, errors up to %.3g of what is told\n", compared, cases, most);
    assert_true(most < 1.0 && compared > cases / 2);
}

/* A soft sticky sample that the tip leaves for a fifth of the period alone: all harmonics are resolved, and no motion
 * is promised within reach of the fold where it ends. */
static void soft_sample_near_a_fold(void **state)
{
    (void)state;
    assert_int_equal(make_plan(28.6e-9, 126e6, 0.0), NT_OK);
    const nt_drive drive = {NT_DRIVE_BASE, 0.0, 15.85e-9};
    const nt_tapping t = lever_of(53.17, 31.46, &drive);
    nt_balance balance = {&t, &plan, NULL, 1, 0.0};
    const nt_balance_target target = {NT_AIM_AMPLITUDE, 0.5116 * 15.85e-9, 1};
    nt_balance_state at;
    nt_balance_value found;
    nt_tapping_value truth;
    assert_int_equal(nt_balance_trace(&balance, &curve), NT_OK);
    assert_int_equal(nt_balance_find(&balance, &curve, &target, &at, &found), NT_OK);
    assert_true(isinf(found.amplitude_bound) && isinf(found.force_bound));
    balance.harmonics = NT_HARMONICS_MAX;
    assert_int_equal(nt_balance_find(&balance, &curve, &target, &at, &found), NT_OK);
    nt_tapping_state moment = nt_balance_moment(&balance, &at, &found);
    const nt_tapping_over over = {&plan, NULL, found.base_height};
    assert_int_equal(nt_tapping_settle(&t, &moment, &over, &truth, NULL), NT_OK);
    assert_true(found.harmonics == NT_HARMONICS_MAX && found.force_bound < 1e-3 * truth.peak_force);
    assert_true(fabs(found.peak_force - truth.peak_force) < 2e-4 * truth.peak_force);
    assert_true(fabs(found.amplitude - truth.amplitude) < found.amplitude_bound);
}

/* A soft sample that lets go only just before the top of the way: with one harmonic it is not known whether it does. */
static void a_contact_that_may_hold_for_good(void **state)
{
    (void)state;
    assert_int_equal(make_plan(6.407e-9, 256.7e6, 0.0), NT_OK);
    const nt_drive drive = {NT_DRIVE_TIP, 0.0, 9.0547e-9};
    const nt_tapping t = lever_of(39.834, 20.3415, &drive);
    nt_balance balance = {&t, &plan, NULL, 1, 0.0};
    const nt_balance_target target = {NT_AIM_AMPLITUDE, 0.597754 * 9.0547e-9, 0};
    nt_balance_state at;
    nt_balance_value found;
    assert_int_equal(nt_balance_trace(&balance, &curve), NT_OK);
    assert_int_equal(nt_balance_find(&balance, &curve, &target, &at, &found), NT_OK);
    assert_true(isinf(found.amplitude_bound) && found.contact_time > 0.8);
    balance.harmonics = 4;
    assert_int_equal(nt_balance_find(&balance, &curve, &target, &at, &found), NT_OK);
    assert_true(found.force_bound < 1e-3 * found.peak_force);
}

/* A contact 100 times as stiff as the lever lasts a twentieth of the period: each harmonic lifts the lowest point by as
 * much as the tip is in. The time domain settles with an error that such a contact amplifies. */
static void stiff_contact_of_a_soft_lever(void **state)
{
    (void)state;
    assert_int_equal(make_plan(20e-9, 130e9, 0.0), NT_OK);
    const nt_drive drive = {NT_DRIVE_BASE, 0.0, 20e-9};
    nt_tapping t = lever_of(8.0, 100.0, &drive);
    nt_balance balance = {&t, &plan, NULL, 1, 0.0};
    const nt_balance_target target = {NT_AIM_AMPLITUDE, 14e-9, 0};
    assert_int_equal(nt_balance_trace(&balance, &curve), NT_OK);
    const int harmonics[] = {2, 5, 12, 24};
    for (int i = 0; i < 4; i++) {
        nt_balance_state at;
        nt_balance_value found;
        nt_tapping_value truth;
        balance.harmonics = harmonics[i];
        assert_int_equal(nt_balance_find(&balance, &curve, &target, &at, &found), NT_OK);
        assert_int_equal(found.harmonics, harmonics[i]);
        for (t.tolerance = 1e-8; t.tolerance > 0.5e-9; t.tolerance *= 0.1) {
            nt_tapping_state moment = nt_balance_moment(&balance, &at, &found);
            const nt_tapping_over over = {&plan, NULL, found.base_height};
            assert_int_equal(nt_tapping_settle(&t, &moment, &over, &truth, NULL), NT_OK);
            assert_true(fabs(found.peak_force - truth.peak_force) < found.force_bound);
            assert_true(fabs(found.amplitude - truth.amplitude) < found.amplitude_bound);
        }
        assert_true(i < 3 || found.force_bound < 0.03 * truth.peak_force);
    }
}

/* A jump on each tap, some 15 pm deep: deviations change sign and grow fivefold from period to period, faster than
 * averages over a period can tell. The lever does not stay, and no motion is told. */
static void deviations_that_alternate(void **state)
{
    (void)state;
    assert_int_equal(make_plan(6.4666e-9, 2.6345e9, 0.0), NT_OK);
    const nt_drive drive = {NT_DRIVE_BASE, 0.0, 6.9145e-9};
    const nt_tapping t = lever_of(2.6354, 23.4695, &drive);
    const nt_balance balance = {&t, &plan, NULL, 16, 0.0};
    const nt_balance_target target = {NT_AIM_AMPLITUDE, 0.3272 * 6.9145e-9, 0};
    nt_balance_state at;
    nt_balance_value found;
    assert_int_equal(nt_balance_trace(&balance, &curve), NT_OK);
    if (nt_balance_find(&balance, &curve, &target, &at, &found) == NT_OK)
        assert_true(isinf(found.amplitude_bound));
}

/* A dry hard sample: an attractive motion and a repulsive one at the same heights, and an unstable one between. The
 * time domain stays in each of the two from where it is told to begin. */
static void both_motions_and_one_between(void **state)
{
    (void)state;
    assert_int_equal(make_plan(10e-9, 10e9, 0.0), NT_OK);
    const nt_drive drive = {NT_DRIVE_TIP, 0.0, 10e-9};
    const nt_tapping t = lever_of(40.0, 400.0, &drive);
    const nt_balance balance = {&t, &plan, NULL, 8, 0.0};
    assert_int_equal(nt_balance_trace(&balance, &curve), NT_OK);
    double low = 0.0, high = 1.0; /* heights of the unstable part */
    for (int i = 0; i < curve.count; i++)
        if (!curve.at[i].stable && curve.at[i].swing > 0.5 * 10e-9) {
            high = high == 1.0 ? curve.at[i].base_height : smaller(high, curve.at[i].base_height);
            low = larger(low, curve.at[i].base_height);
        }
    assert_true(low > high); /* it ends above where it begins */
    nt_balance_target target = {NT_AIM_HEIGHT, 0.5 * (low + high), 0};
    const nt_tapping_over over = {&plan, NULL, target.value};
    double phase[2];
    for (int lifted = 0; lifted < 2; lifted++) {
        nt_balance_state at;
        nt_balance_value found;
        nt_tapping_value truth;
        target.lifted = lifted;
        assert_int_equal(nt_balance_find(&balance, &curve, &target, &at, &found), NT_OK);
        nt_tapping_state moment = nt_balance_moment(&balance, &at, &found);
        assert_int_equal(nt_tapping_settle(&t, &moment, &over, &truth, NULL), NT_OK);
        assert_true(fabs(truth.phase - found.phase) < 1e-3);
        assert_true(fabs(truth.tip_loss - found.tip_loss) < 1e-3 * truth.drive_work);
        phase[lifted] = found.phase;
    }
    assert_true(phase[0] > 1.58 && phase[1] < 1.56);
}

/* Too few harmonics, too many, and more than the free lever has. */
static void wrong_inputs(void **state)
{
    (void)state;
    assert_int_equal(make_plan(10e-9, 10e9, 0.0), NT_OK);
    const nt_drive drive = nt_drive_defaults();
    const nt_tapping t = lever_of(40.0, 400.0, &drive);
    nt_balance balance = {&t, &plan, NULL, 0, 0.0};
    assert_int_equal(nt_balance_trace(&balance, &curve), NT_E_ARGUMENT);
    balance.harmonics = NT_HARMONICS_MAX + 1;
    assert_int_equal(nt_balance_trace(&balance, &curve), NT_E_ARGUMENT);
    balance.harmonics = 1;
    assert_int_equal(nt_balance_trace(&balance, &curve), NT_OK);
    const nt_balance_target beyond = {NT_AIM_AMPLITUDE, 30e-9, 0};
    nt_balance_state at;
    nt_balance_value found;
    assert_int_equal(nt_balance_find(&balance, &curve, &beyond, &at, &found), NT_E_NO_CONVERGENCE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(within_what_is_told),
        cmocka_unit_test(soft_sample_near_a_fold),
        cmocka_unit_test(a_contact_that_may_hold_for_good),
        cmocka_unit_test(stiff_contact_of_a_soft_lever),
        cmocka_unit_test(deviations_that_alternate),
        cmocka_unit_test(both_motions_and_one_between),
        cmocka_unit_test(wrong_inputs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
