/* SPDX-License-Identifier: BSD-3-Clause
 * The observer on a master and an ideal stage of its own (docs/control.md): m x'' + b x' = tau + f_m exactly under a
 * hold, f_s = k max(0, alpha_p x - s), d periods of delay, forces and positions as sensors give them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/control.h"
#include "larger.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

/* In the operator's scale, so that alpha_p = alpha_f = 1. */
typedef struct loop {
    double T;                   /* [s] */
    double K_f;                 /* [-] */
    double k_r;                 /* alpha_f alpha_p k_eff [N/m] */
    int d;                      /* [periods] */
    double finger;              /* mass rigidly coupled to the sensor [kg] */
    int watched;                /* may the observer take gain away? */
    int blind;                  /* no gauge: the impedance law */
    double relief, relief_rate; /* the surface moves under the tip [m], [Hz] */
} loop;

typedef struct outcome {
    double ripple;          /* peak to peak of the master in the last quarter [m] */
    double largest_ripple;  /* of the motor force in any quarter but the first [N] */
    double hand_energy_low; /* least of the energy that the hand's port alone has seen [J] */
    double gain;
    uint32_t trips;
} outcome;

static const double m = 0.1, b = 100.0, hand_force = 1.0;

/* The paper's sensors: 0.04 mm and 0.02 N of the master; 1 nm of the stage, which is 0.05 mm at alpha_p = 2e-5. */
static nt_passivity passivity_of(double T, double K_f, int blind)
{
    nt_rig rig = nt_rig_defaults();
    rig.master.gauge = !blind;
    const nt_gains gains = {.rate = 1.0 / T, .force_gain = K_f, .alpha_p = 2e-5};
    return nt_passivity_make(&rig, &gains);
}

static double quantised(double value, double step)
{
    return step * round(value / step);
}

static outcome run(const loop *p, double time)
{
    const double M = m + p->finger, a = exp(-b * p->T / M), P = M / b * (1.0 - a),
                 Q = p->T / b - M / (b * b) * (1.0 - a);
    const nt_passivity passivity = passivity_of(p->T, p->K_f, p->blind);
    nt_passivity_state state = {.gain = 1.0};
    nt_random random = nt_random_seed(9);
    double x = 0.0, v = 0.0, tau[3] = {0.0, 0.0, 0.0}, low = HUGE_VAL, high = -HUGE_VAL;
    double energy = 0.0, last_x = 0.0, last_f = 0.0, gain = 1.0, f_m = 0.0;
    outcome found = {0};
    const long ticks = lround(time / p->T);
    for (long k = 0; k < ticks; k++) {
        const double t = (double)k * p->T, surface = 1e-3 + p->relief * sin(6.2831853 * p->relief_rate * t);
        const double f_s = p->k_r * larger(0.0, x - surface);
        const double push = t < 0.2 ? 5.0 * hand_force * t : hand_force;
        const double acting = tau[(k + 3 - p->d) % 3]; /* what the motor does now */
        f_m = push - p->finger / M * (acting + push - b * v);
        const double f_read = quantised(f_m + 0.0033 * nt_random_normal(&random), 0.02);
        const double s_read = f_s + 0.04 * nt_random_normal(&random), x_read = quantised(x, 4e-5);
        const double seen = p->blind ? -tau[(k + 2 - p->d) % 3] : f_read;
        const nt_port hand = {seen, x_read}, tip = {s_read, quantised(x, 5e-5)};
        const double factor = nt_passivity_step(&passivity, &state, &hand, &tip);
        gain = p->watched ? factor : 1.0;
        const double wanted = p->blind ? -gain * s_read : -s_read - gain * p->K_f * (s_read - f_read);
        tau[k % 3] = smaller(larger(wanted, -100.0), 100.0);
        const double force = tau[(k + 3 - p->d) % 3] + push;
        x += P * v + Q * force;
        v = a * v + (1.0 - a) / b * force;
        energy += 0.5 * (f_read + last_f) * (x_read - last_x);
        found.hand_energy_low = smaller(found.hand_energy_low, energy);
        last_x = x_read, last_f = f_read;
        if (4 * k > 3 * ticks)
            low = smaller(low, x), high = larger(high, x);
    }
    found.ripple = high - low;
    found.gain = state.gain;
    found.trips = state.trips;
    return found;
}

/* kappa = (1 + K_f) k_r below half of its limit (docs/control.md: 239 kN/m at 1 ms, 80 kN/m with one period of delay,
 * ...) and free motion with all K_f; with sensor noise and steps. */
static void never_trips_on_the_stable_set(void **state)
{
    (void)state;
    static const loop stable[] = {
        {.T = 3e-3, .K_f = 2, .k_r = 2e3, .d = 1},
        {.T = 1e-3, .K_f = 2, .k_r = 10e3, .d = 1},
        {.T = 1e-3, .K_f = 10, .k_r = 10e3, .d = 0},
        {.T = 1e-3, .K_f = 100, .k_r = 250, .d = 1},
        {.T = 1e-4, .K_f = 2, .k_r = 64e3, .d = 1},
        {.T = 1e-4, .K_f = 10, .k_r = 20e3, .d = 1},
        {.T = 1e-4, .K_f = 100, .k_r = 1.8e3, .d = 1},
        {.T = 1e-4, .K_f = 10, .k_r = 500, .d = 2},
        {.T = 1e-4, .K_f = 0, .k_r = 500, .d = 1},
        {.T = 20e-6, .K_f = 2, .k_r = 500, .d = 1},
        {.T = 1e-3, .K_f = 0.5, .k_r = 500, .d = 1, .finger = 0.1},
        {.T = 1e-4, .K_f = 3, .k_r = 0, .d = 0, .finger = 0.02},
        {.T = 3e-3, .k_r = 10e3, .d = 1, .blind = 1},
        {.T = 1e-3, .k_r = 30e3, .d = 1, .blind = 1},
        {.T = 1e-4, .k_r = 2e3, .d = 1, .blind = 1},
        {.T = 1e-4, .k_r = 200e3, .d = 1, .blind = 1},
        {.T = 1e-4, .k_r = 0, .d = 1, .blind = 1},
    };
    for (size_t i = 0; i < sizeof stable / sizeof *stable; i++) {
        const outcome found = run(&stable[i], 4.0);
        assert_int_equal(found.trips, 0);
        assert_true(found.gain == 1.0);
    }
}

/* Above the limits: R1 by rate, delay, gain; R3 by a finger that sits rigidly on the sensor, K_f > 1 + m/m_h. The
 * ripple falls to a fifth, or to four steps of the master's sensor: below that no speed, and so no energy due, can be
 * told. */
static void always_trips_on_the_unstable_set_and_calms_it(void **state)
{
    (void)state;
    static const loop unstable[] = {
        {.T = 3e-3, .K_f = 10, .k_r = 5e3, .d = 1},
        {.T = 1e-3, .K_f = 2, .k_r = 64e3, .d = 1},
        {.T = 3e-3, .K_f = 100, .k_r = 1.8e3, .d = 0},
        {.T = 1e-3, .K_f = 10, .k_r = 30e3, .d = 0},
        {.T = 1e-4, .K_f = 100, .k_r = 8e3, .d = 1},
        {.T = 0.5e-3, .K_f = 20, .k_r = 10e3, .d = 1},
        {.T = 1e-3, .K_f = 4, .k_r = 500, .d = 0, .finger = 0.1},
        {.T = 1e-4, .K_f = 10, .k_r = 500, .d = 0, .finger = 0.1},
        {.T = 10e-3, .k_r = 20e3, .d = 1, .blind = 1},
        {.T = 20e-3, .k_r = 10e3, .d = 1, .blind = 1},
        {.T = 10e-3, .k_r = 14e3, .d = 2, .blind = 1},
    };
    for (size_t i = 0; i < sizeof unstable / sizeof *unstable; i++) {
        loop watched = unstable[i];
        watched.watched = 1;
        const outcome alone = run(&unstable[i], 4.0), calmed = run(&watched, 4.0);
        print_message("T %.1f ms, K_f %3.0f, k_r %5.0f N/m, d %d, m_h %.2f kg: ripple %8.5f mm -> %.5f mm, gain %.3f\n",
                      1e3 * watched.T, watched.K_f, watched.k_r, watched.d, watched.finger, 1e3 * alone.ripple,
                      1e3 * calmed.ripple, calmed.gain);
        assert_true(alone.trips > 0 && calmed.trips > 0);
        assert_true(calmed.ripple < larger(0.2 * alone.ripple, 4.0 * 4e-5) && calmed.ripple < 0.6 * alone.ripple);
        assert_true(calmed.gain < 1.0 && calmed.gain > 0.0);
    }
}

/* A surface that moves the hand gives energy to it. That trips nothing, though the hand's port alone sees more of it
 * than the dead zone. */
/* When no gain is left and it still trips, damping comes, a fifth at a time, and at last nothing is left. */
static void damping_comes_after_the_gain(void **state)
{
    (void)state;
    const nt_passivity passivity = {
        .dead_zone = 1e-6, .period = 1e-3, .damping = 100.0, .speed_filter = 1.0, .speed_limit = 10.0};
    nt_passivity_state s = {.gain = 1.0};
    nt_port hand = {1.0, 0.0};
    const nt_port tip = {0.0, 0.0};
    s.last_hand = hand;
    int trips = 0;
    while (!nt_passivity_is_exhausted(&s)) {
        hand.position -= 1e-3; /* 1 mJ out */
        const double gain = s.gain, damping = s.damping;
        nt_passivity_step(&passivity, &s, &hand, &tip);
        assert_true(gain >= 0.05 ? s.damping == 0.0 && s.gain == 0.8 * gain : s.damping > damping && s.gain == gain);
        trips++;
    }
    assert_int_equal(trips, 14 + 5); /* 0.8^14 = 0.044 */
    assert_true(s.damping == 1.0);
    assert_true(fabs(nt_passivity_damping_force(&passivity, &s) - 100.0) < 1e-9); /* at -1 m/s: against the motion */
}

static void topography_does_not_trip_it(void **state)
{
    (void)state;
    for (double rate = 0.5; rate < 20.0; rate *= 2.0) {
        const loop moving = {.T = 1e-4, .K_f = 2, .k_r = 2e3, .d = 1, .relief = 2e-3, .relief_rate = rate};
        const outcome found = run(&moving, 4.0);
        assert_int_equal(found.trips, 0);
        if (rate < 4.0)
            assert_true(found.hand_energy_low < -3.0 * passivity_of(1e-4, 2.0, 0).dead_zone);
    }
}

/* Slower than one step of the master nothing is due, and the energy is the work of the two ports, by trapezoids. */
static void energy_is_the_work_of_both_ports(void **state)
{
    (void)state;
    const nt_passivity passivity = {.dead_zone = 1.0,
                                    .due = 0.2 * b * 1e-3,
                                    .speed_filter = 1.0,
                                    .speed_floor = 1.0,
                                    .speed_limit = 10.0,
                                    .period = 1e-3};
    nt_passivity_state s = {.gain = 1.0};
    const nt_port hand = {2.0, 0.9e-3}, tip = {1.0, 0.5e-3};
    assert_true(nt_passivity_step(&passivity, &s, &hand, &tip) == 1.0);
    assert_true(fabs(s.energy - (0.9e-3 - 0.25e-3)) < 1e-18);
    assert_true(s.last_hand.force == 2.0 && s.last_tip.position == 0.5e-3);
    /* faster: 0.2 b v^2 T/(1 + K_f) less */
    nt_passivity_state quick = {.gain = 1.0};
    const nt_passivity strict = {.dead_zone = 1.0,
                                 .due = 0.2 * b * 1e-3,
                                 .force_gain = 3.0,
                                 .speed_filter = 1.0,
                                 .speed_limit = 10.0,
                                 .period = 1e-3};
    nt_passivity_step(&strict, &quick, &hand, &tip);
    assert_true(fabs(s.energy - quick.energy - 0.2 * b * 0.9 * 0.9 * 1e-3 / 4.0) < 1e-15);
}

/* What has been swallowed for hours must not pay for what is made now. */
static void the_store_is_bounded(void **state)
{
    (void)state;
    const nt_passivity passivity = {.dead_zone = 1e-3, .speed_floor = 1e3, .period = 1e-3};
    nt_passivity_state s = {.gain = 1.0};
    nt_port hand = {1.0, 0.0};
    const nt_port tip = {0.0, 0.0};
    s.last_hand = hand;
    for (int i = 0; i < 100000; i++) {
        hand.position += 1e-3;
        nt_passivity_step(&passivity, &s, &hand, &tip);
        assert_true(s.energy <= NT_PASSIVITY_STORE * 1e-3);
    }
    int steps = 0;
    while (s.trips == 0 && steps++ < 1000) { /* 1 mJ out per step: the store and the dead zone, no more */
        hand.position -= 1e-3;
        nt_passivity_step(&passivity, &s, &hand, &tip);
    }
    assert_true(steps >= 10 && steps <= 13);
    assert_true(s.gain == 0.8 && s.energy == 0.0);
}

/* A step of any sensor at full force must not look like energy; sensors without steps still have a dead zone. */
static void the_dead_zone_covers_the_steps(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    const nt_gains gains = {.rate = 10e3, .force_gain = 2.0, .alpha_p = 2e-5};
    assert_true(nt_passivity_make(&rig, &gains).dead_zone >= 5.0 * 5e-5 * (1.0 - 1e-12)); /* 1 nm of the stage */
    rig.stage.resolution = 10e-9;
    assert_true(nt_passivity_make(&rig, &gains).dead_zone >= 5.0 * 5e-4 * (1.0 - 1e-12));
    rig.stage.resolution = rig.master.resolution = 0.0;
    assert_true(nt_passivity_make(&rig, &gains).dead_zone > 0.0 && nt_passivity_make(&rig, &gains).speed_floor > 0.0);
}

/* One wrong reading of the master, from end to end and back under full force, costs one step of the gain at most. */
static void a_wrong_reading_is_not_an_instability(void **state)
{
    (void)state;
    const nt_passivity passivity = passivity_of(1e-4, 2.0, 0);
    nt_passivity_state s = {.gain = 1.0};
    const nt_port tip = {1.5, 0.0};
    for (int i = 0; i < 10000; i++) {
        const nt_port hand = {1.5, i == 5000 ? 0.02 : 0.0};
        nt_passivity_step(&passivity, &s, &hand, &tip);
    }
    assert_true(s.trips <= 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(never_trips_on_the_stable_set),
        cmocka_unit_test(always_trips_on_the_unstable_set_and_calms_it),
        cmocka_unit_test(damping_comes_after_the_gain),
        cmocka_unit_test(topography_does_not_trip_it),
        cmocka_unit_test(energy_is_the_work_of_both_ports),
        cmocka_unit_test(the_store_is_bounded),
        cmocka_unit_test(the_dead_zone_covers_the_steps),
        cmocka_unit_test(a_wrong_reading_is_not_an_instability),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
