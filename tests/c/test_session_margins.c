/* SPDX-License-Identifier: BSD-3-Clause
 * The complete simulated loop (touch step, stage, master, probe, contact) against rule R1 and the passivity observer.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "larger.h"
#include "loop_fixture.h"
#include "nanotouch/advanced/random.h"

/* No noise, no steps, strong actuators, a hard sample without adhesion: what is left is the linear loop. */
static nt_session_setup ideal_setup(double rate, double delay)
{
    nt_session_setup setup = nt_session_defaults();
    nt_rig *rig = &setup.rig;
    rig->probe.noise = rig->probe.resolution = rig->stage.resolution = rig->stage.command_resolution = 0.0;
    rig->master.resolution = rig->master.gauge_noise = rig->master.gauge_resolution = 0.0;
    rig->probe.temperature = 0.0;
    rig->master.max_force = 1000.0;
    rig->stage.max_speed = 1.0;
    setup.scene.medium.relative_humidity = 0.0;
    setup.scene.adhesion.work_of_adhesion = setup.scene.adhesion.hamaker_constant = 0.0;
    setup.scene.tip.youngs_modulus = setup.scene.sample.youngs_modulus = 1e13;
    setup.scene.tip.radius = 100e-9;
    setup.clearance = 5e-9;
    setup.settings = nt_settings_defaults(rig);
    setup.settings.gains.rate = rate;
    setup.settings.gains.delay = delay;
    setup.settings.limits.motor_rate = 1e9;
    setup.settings.limits.motor_power = 1e6;
    setup.settings.limits.stage_speed = 1.0;
    setup.probe_model = NT_PROBE_QUASI_STATIC;
    return setup;
}

/* The force gain of the law, with the observer's hands tied. */
static void tick_with_gain(loop *l, double force_gain)
{
    l->touch.settings.gains.force_gain = force_gain;
    l->touch.passivity.due = 0.0;
    l->state.passivity.energy = 1.0;
    l->state.passivity.gain = 1.0;
    assert_int_equal(loop_tick(l, NULL, NULL), NT_OK);
}

/* Peak to peak of the tip's force over some periods of the master. */
static double ripple(loop *l, double force_gain, double time)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (double t = 0.0; t < time; t += l->touch.period) {
        tick_with_gain(l, force_gain);
        low = smaller(low, l->sim.slave.truth.tip_force[NT_Z]);
        high = larger(high, l->sim.slave.truth.tip_force[NT_Z]);
    }
    return high - low;
}

/* Pressed at 3 N, then a kick of 0.03 N: does the answer die away? The force stays far from 0, where the loop is not
 * linear. */
static int is_stable(const loop *pressed, double force_gain)
{
    static loop l;
    l = *pressed;
    l.sim.slave.plan = &l.plan;
    for (double t = 0.0; t < 0.1; t += l.touch.period) /* the force gain fades over, no kick of its own */
        tick_with_gain(&l, 2.0 + (force_gain - 2.0) * t / 0.1);
    loop_push(&l, 3.03, 0.0);
    const double first = ripple(&l, force_gain, 0.1);
    ripple(&l, force_gain, 0.2);
    const double last = ripple(&l, force_gain, 0.1); /* grown beyond the linear range it may no longer grow */
    return last < first && last * l.touch.settings.gains.alpha_f < 1.0 && l.command.state == NT_RUN;
}

/* The exact limit is that of the simulated loop, and R1 is below it, at every rate, delay and damping, and not
 * foolishly far below: the damped stage and the integral action make it up to 35 %. */
static void r1_is_on_the_safe_side_of_the_simulated_limit(void **state)
{
    (void)state;
    static const double cases[][3] = {{10e3, 1, 0.7}, {10e3, 0, 0.7}, {10e3, 3, 0.7}, {5e3, 1, 0.7},  {2e3, 1, 0.7},
                                      {1e3, 1, 0.7},  {1e3, 0, 0.7},  {50e3, 1, 0.7}, {10e3, 1, 0.4}, {10e3, 1, 1.0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static loop l;
        nt_session_setup setup = ideal_setup(cases[i][0], cases[i][1]);
        setup.settings.gains.stage_damping = cases[i][2];
        assert_int_equal(loop_open(&l, &setup), NT_OK);
        loop_push(&l, 3.0, 0.3);
        for (double t = 0.0; t < 1.0; t += l.touch.period)
            tick_with_gain(&l, 2.0);
        assert_true(fabs(l.sim.slave.truth.tip_force[NT_Z] * setup.settings.gains.alpha_f - 3.0) < 1e-3);
        double low = 2.0, high = 4000.0;
        assert_true(is_stable(&l, low) && !is_stable(&l, high));
        while (high - low > 2e-3 * low) {
            const double middle = 0.5 * (low + high);
            *(is_stable(&l, middle) ? &low : &high) = middle;
        }
        const double force = l.sim.slave.truth.tip_force[NT_Z], E = 5e12 / (1.0 - 0.35 * 0.35), R = 100e-9;
        const double k = cbrt(6.0 * E * E * R * force); /* Hertz */
        nt_gains gains = setup.settings.gains;
        gains.force_gain = low;
        const nt_margins margins = nt_margins_compute(&setup.rig, &gains, k);
        print_message(
            "%5.0f Hz, d = %.0f, zeta %.1f: limit %.4g N/m in simulation, exact %.4g, R1 %.4g, %.0f %% below\n",
            gains.rate, gains.delay, gains.stage_damping, margins.loop_stiffness, margins.exact_limit,
            margins.stability_limit, 100.0 * (1.0 - margins.margin));
        assert_true(margins.margin < 1.0 && margins.margin > 0.6);
        assert_true(fabs(margins.loop_stiffness / margins.exact_limit - 1.0) < 0.01); /* asked for: 1 % at five rates */
    }
}

/* What is armed is stable: random rigs and gains at a margin of 1.5, with all noise and steps, pressed; nothing trips.
 */
static void a_margin_of_one_and_a_half_is_calm(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(21);
    for (int i = 0; i < 12; i++) {
        static loop l;
        nt_session_setup setup = nt_session_defaults();
        setup.settings = nt_settings_defaults(&setup.rig); /* it may press as hard as the rig can */
        nt_gains *gains = &setup.settings.gains;
        gains->rate = 1e3 * (1.0 + floor(12.0 * nt_random_uniform(&random)));
        gains->delay = floor(3.0 * nt_random_uniform(&random));
        setup.clearance = 20e-9;
        setup.seed = (uint64_t)i;
        assert_int_equal(loop_open(&l, &setup), NT_OK);
        const double margin = nt_margins_compute(&setup.rig, gains, l.plan.maximum_stiffness).margin;
        gains->force_gain = (1.0 + gains->force_gain) * margin / 1.5 - 1.0; /* just so */
        if (gains->force_gain > 30.0) { /* R5: its noise at the motor alone is above 0.5 N */
            gains->force_gain = 30.0;
        }
        setup.minimum_margin = 1.5 - 1e-9;
        const double promised = session_promise(&setup).force;
        assert_int_equal(loop_open(&l, &setup), NT_OK);
        loop_push(&l, 1.5, 0.5);
        for (double t = 0.0; t < 5.0; t += l.touch.period) {
            assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
            assert_int_equal(l.command.state, NT_RUN);
            assert_true(fabs(l.sim.slave.truth.tip_force[NT_Z]) < promised);
        }
        assert_int_equal(l.state.passivity.trips, 0);
        assert_true(l.state.passivity.gain == 1.0);
    }
}

/* A loop armed below a margin of 1: its settings, the step in which the master is read [m], and whether the passivity
 * observer watches it. */
typedef struct brave_loop {
    double rate, delay, force_gain, resolution;
    int watched;
} brave_loop;

/* The largest speed of the master in the last two of twenty seconds; 0 where the supervisor holds [m/s]. */
static double speed_in_the_end(const brave_loop *brave)
{
    static loop l;
    nt_session_setup setup = nt_session_defaults();
    setup.settings = nt_settings_defaults(&setup.rig); /* it may press as hard as the rig can */
    setup.settings.gains.rate = brave->rate;
    setup.settings.gains.delay = brave->delay;
    setup.settings.gains.force_gain = brave->force_gain;
    setup.clearance = 20e-9;
    setup.rig.master.resolution = brave->resolution;
    assert_int_equal(loop_open(&l, &setup), NT_OK);
    const nt_margins margins = nt_margins_compute(&setup.rig, &setup.settings.gains, l.plan.maximum_stiffness);
    assert_true(margins.margin < 0.7);
    if (!brave->watched)
        l.touch.passivity.dead_zone = HUGE_VAL;
    loop_push(&l, 1.5, 0.5);
    double worst = 0.0;
    for (double t = 0.0; t < 20.0; t += l.touch.period) {
        assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
        if (t > 18.0 && l.command.state != NT_HOLD)
            worst = larger(worst, fabs(l.sim.master.arm[NT_Z].speed));
    }
    assert_true(brave->watched == (l.state.passivity.trips > 0 && l.state.passivity.gain < 1.0));
    print_message("%4.0f Hz, d = %.0f, K_f %3.0f, margin %.2f, %s: speed of the master %.4f m/s, gain %.2f\n",
                  brave->rate, brave->delay, brave->force_gain, margins.margin,
                  brave->watched ? "watched" : "not watched", worst, l.state.passivity.gain);
    return worst;
}

/* Armed in spite of a margin below 1: the observer takes gain away until it is calm, or the supervisor holds. Three
 * tenths at most are left of the limit cycle that runs where nobody watches (0.26 in 64 runs with seeds 1 to 16) where
 * the master is read finely; its own steps keep up a step a period beside it. */
static void what_is_unstable_is_calmed_or_held(void **state)
{
    (void)state;
    static const double cases[][3] = {{1e3, 1, 150}, {1e3, 3, 60}, {333, 1, 40}, {2e3, 2, 150}};
    const double resolution = nt_session_defaults().rig.master.resolution;
    for (int i = 0; i < 4; i++) {
        const double *c = cases[i];
        const double wild = speed_in_the_end(&(brave_loop){c[0], c[1], c[2], 1e-9, 0});
        const double fine = speed_in_the_end(&(brave_loop){c[0], c[1], c[2], 1e-9, 1});
        const double coarse = speed_in_the_end(&(brave_loop){c[0], c[1], c[2], resolution, 1});
        assert_true(fine < 0.3 * wild);
        assert_true(coarse < fine + resolution * c[0]);
    }
}

/* Topography on a hard flat: the force's ripple in the last of four seconds, relative to the set force. */
static double topography_ripple(const nt_session_setup *setup)
{
    static loop l;
    double low = HUGE_VAL, high = -HUGE_VAL;
    assert_int_equal(loop_open(&l, setup), NT_OK);
    for (double t = 0.0; t < 4.0; t += l.touch.period) {
        assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
        if (t > 3.0) {
            low = smaller(low, l.sim.slave.truth.tip_force[NT_Z]);
            high = larger(high, l.sim.slave.truth.tip_force[NT_Z]);
        }
    }
    return (high - low) / setup->settings.gains.set_point;
}

/* An integrator g behind a lag L turns over between g L = 1, which is refused, and 2; a margin of 1.5 is calm. */
static void the_height_servo_has_its_margin(void **state)
{
    (void)state;
    for (double rate = 1e3; rate < 20e3; rate *= sqrt(10.0)) {
        nt_session_setup setup = ideal_setup(rate, 1.0);
        nt_gains *gains = &setup.settings.gains;
        setup.mode = NT_MODE_TOPOGRAPHY;
        const double found = nt_margins_compute(&setup.rig, gains, (double)INFINITY).height_margin;
        const double gain = gains->height_gain * found; /* at a margin of 1 */
        gains->height_gain = gain / 1.5;
        assert_true(fabs(nt_margins_compute(&setup.rig, gains, (double)INFINITY).height_margin - 1.5) < 1e-9);
        const double calm = topography_ripple(&setup);
        gains->height_gain = 2.5 * gain;
        const double wild = topography_ripple(&setup);
        print_message("%5.0f Hz: ripple %.2g of the set force at margin 1.5, %.2g at 0.4\n", rate, calm, wild);
        assert_true(calm < 1e-3 && wild > 0.1);
        nt_session *session = NULL;
        nt_problem problem = {0};
        assert_int_equal(nt_session_open(&session, &setup, &problem), NT_E_RANGE);
        assert_string_equal(problem.field, "stability margin (height servo)");
    }
}

enum { N = 64 };

/* Dragged over hills of 20 nm a steady hand is lifted and lowered: energy comes from the surface, no trip. */
static void topography_trips_nothing(void **state)
{
    (void)state;
    static double heights[N * N], coefficients[N * N];
    nt_surface surface;
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            heights[j * N + i] = 10e-9 * sin(0.4 * i) + 5e-9 * sin(0.9 * i + 0.1 * j);
    const nt_height_map map = {heights, N, N, 40e-9, 40e-9};
    assert_int_equal(nt_surface_init(&surface, &map, coefficients), NT_OK);
    static loop l;
    nt_session_setup setup = nt_session_defaults();
    setup.settings = nt_settings_defaults(&setup.rig); /* it may press as hard as the rig can */
    setup.surface = &surface;
    setup.x = setup.y = 0.2e-6;
    setup.clearance = 20e-9;
    setup.settings.gains.force_gain = 10.0;
    assert_int_equal(loop_open(&l, &setup), NT_OK);
    loop_push(&l, 1.0, 0.3);
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (int i = 0; i < 120000; i++) {
        if (i == 20000)
            assert_int_equal(nt_touch_aim(&l.touch, &l.state, 2.3e-6, 0.6e-6, 2.0), NT_OK);
        if (i == 60000)
            assert_int_equal(nt_touch_aim(&l.touch, &l.state, 0.2e-6, 0.2e-6, 0.5), NT_OK);
        assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
        assert_int_equal(l.command.state, NT_RUN);
        if (i > 20000) {
            lowest = smaller(lowest, l.sim.master.arm[NT_Z].position);
            highest = larger(highest, l.sim.master.arm[NT_Z].position);
        }
    }
    assert_true(highest - lowest > 0.8 * 20e-9 / setup.settings.gains.alpha_p); /* the hand has felt the hills */
    assert_int_equal(l.state.passivity.trips, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(r1_is_on_the_safe_side_of_the_simulated_limit),
        cmocka_unit_test(a_margin_of_one_and_a_half_is_calm),
        cmocka_unit_test(what_is_unstable_is_calmed_or_held),
        cmocka_unit_test(the_height_servo_has_its_margin),
        cmocka_unit_test(topography_trips_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
