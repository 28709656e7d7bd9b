/* SPDX-License-Identifier: BSD-3-Clause
 * What is worked out of a rig and its settings once, and the small sums of each period, by their formulas on random
 * numbers: laws, passivity, scales, motor, defaults. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control/motor.h"
#include "control_draws.h"
#include "internal/control.h"
#include "larger.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/touch.h"

#define PI 3.14159265358979323846
#define EXACT 1e-11
enum { DRAWS = 100 };

static double spread(nt_random *random)
{
    return 2.0 * nt_random_uniform(random) - 1.0;
}

static nt_signals drawn_signals(nt_random *random)
{
    return (nt_signals){.period = 1e-4,
                        .master_position = spread(random),
                        .master_speed = spread(random),
                        .smooth_speed = spread(random),
                        .operator_force = spread(random),
                        .smooth_force = spread(random),
                        .slave_force = spread(random),
                        .felt_force = spread(random),
                        .stage_position = spread(random),
                        .stage_speed = spread(random),
                        .target = spread(random),
                        .scaling = {between(random, 0.1, 0.9), between(random, 2.0, 9.0)},
                        .master_damping = between(random, 2.0, 9.0),
                        .gain_factor = between(random, 0.1, 0.9)};
}

static void the_three_laws(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(1);
    for (int i = 0; i < DRAWS; ++i) {
        const nt_signals s = drawn_signals(&random);
        const nt_gains gains = {.force_gain = between(&random, 0.3, 3.0),
                                .velocity_feedforward = between(&random, 0.1, 0.9),
                                .stage_proportional = between(&random, 0.1, 0.9),
                                .stage_derivative = between(&random, 0.1, 0.9)};
        const double r = s.scaling.alpha_f * s.felt_force, K = s.gain_factor * gains.force_gain;
        const double drag = gains.velocity_feedforward * s.master_damping * s.smooth_speed;
        const nt_effort usual = nt_servo_default(NULL, &gains, &s), paper = nt_servo_paper(NULL, &gains, &s);
        const nt_effort blind = nt_servo_impedance(NULL, &gains, &s);
        assert_true(fabs(usual.motor_force - (-r - K * (r - s.smooth_force) + drag)) < 1e-13 * 100.0);
        assert_true(usual.stage == s.target && blind.stage == s.target);
        assert_true(fabs(paper.motor_force - (-r - K * (r - s.operator_force))) < 1e-11);
        assert_true(fabs(blind.motor_force - (drag - s.gain_factor * r)) < 1e-11);
        const double drive = gains.stage_derivative * (s.scaling.alpha_p * s.master_speed - s.stage_speed) +
                             gains.stage_proportional * (s.target - s.stage_position);
        assert_true(fabs(paper.stage - drive) < 1e-12);
    }
}

static void what_the_observer_needs(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(2);
    for (int i = 0; i < DRAWS; ++i) {
        nt_rig rig = drawn_rig(&random);
        const nt_settings settings = drawn_settings(&random, &rig);
        if (i % 2) /* a step finer than the thousandth of the travel that counts at least, or coarser */
            rig.master.resolution = rig.master.travel * between(&random, 2e-3, 1e-2);
        if (i % 3) /* or a read-out of the stage that is coarser still */
            rig.stage.resolution = settings.gains.alpha_p * rig.master.travel * between(&random, 0.02, 0.1);
        rig.master.gauge = i % 5 != 0;
        const double T = 1.0 / settings.gains.rate, step = larger(rig.master.resolution, 1e-3 * rig.master.travel);
        const double filter = 1.0 - exp(-2.0 * PI * 200.0 * T);
        const nt_passivity p = nt_passivity_make(&rig, &settings.gains);
        const double coarsest = larger(step, rig.stage.resolution / settings.gains.alpha_p);
        assert_true(alike(p.dead_zone, rig.master.gauge_range * coarsest, EXACT));
        assert_true(alike(p.due, 0.2 * rig.master.damping * T, EXACT) && p.force_gain == settings.gains.force_gain);
        assert_true(p.damping == rig.master.damping && p.credit == (rig.master.gauge ? 0.0 : rig.master.damping));
        assert_true(alike(p.speed_filter, filter, EXACT) && alike(p.speed_floor, step * filter / T, EXACT));
        const double most = 10.0 * (rig.master.max_force + rig.master.gauge_range) / rig.master.damping;
        assert_true(alike(p.speed_limit, most, EXACT) && alike(p.period, T, EXACT));
    }
}

/* Energy of a port that is read at both ends of a period; of one that was held, by its force alone and b v. */
static void energy_is_counted_in_trapezes(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(3);
    const double credits[] = {0.0, 7.0};
    for (int i = 0; i < 2; ++i) {
        const nt_passivity p = {.dead_zone = 40.0,
                                .due = 0.3,
                                .force_gain = 2.0,
                                .damping = 7.0,
                                .credit = credits[i],
                                .speed_filter = 0.4,
                                .speed_floor = 0.2,
                                .speed_limit = 1.5,
                                .period = 0.5};
        nt_passivity_state s = {.gain = 0.6};
        double energy = 0.0, speed = 0.0;
        for (int k = 0; k < 300; ++k) {
            const nt_port hand = {spread(&random), spread(&random)}, tip = {spread(&random), spread(&random)};
            const nt_port h = s.last_hand, t = s.last_tip;
            const double v = (hand.position - h.position) / 0.5;
            speed += 0.4 * (larger(-1.5, smaller(1.5, v)) - speed);
            const double due = 0.3 * larger(0.0, speed * speed - 0.04) / (1.0 + 0.6 * 2.0);
            const double in = credits[i] > 0.0 ? (hand.force + 7.0 * speed) * (hand.position - h.position)
                                               : 0.5 * (hand.force + h.force) * (hand.position - h.position);
            const double out = 0.5 * (tip.force + t.force) * (tip.position - t.position);
            energy = smaller(energy + in - out - due, NT_PASSIVITY_STORE * 40.0);
            assert_true(nt_passivity_step(&p, &s, &hand, &tip) == 0.6);
            assert_true(fabs(s.energy - energy) < 1e-11 && fabs(s.speed - speed) < 1e-12);
            assert_true(s.last_hand.force == hand.force && s.last_tip.position == tip.position);
            assert_true(s.trips == 0u && energy > -40.0);
        }
    }
}

/* At -dead_zone nothing happens, beyond it the gain goes by a fifth down to 0.05, then damping comes by fifths. */
static void gain_goes_before_damping_comes(void **state)
{
    (void)state;
    const nt_passivity p = {
        .dead_zone = 1.0, .damping = 7.0, .speed_filter = 1.0, .speed_floor = 1e-3, .period = 1.0, .speed_limit = 10.0};
    nt_passivity_state s = {.gain = 1.0};
    nt_port hand = {0.0, 0.0}, tip = {1.0, 0.0};
    s.last_tip.force = 1.0;
    tip.position += 1.0;
    nt_passivity_step(&p, &s, &hand, &tip); /* 1 J out: just the dead zone */
    assert_true(s.energy == -1.0 && s.gain == 1.0 && s.trips == 0u);
    double gain = 1.0, damping = 0.0;
    for (uint32_t k = 1; k < 25; ++k) {
        tip.position += 1.5;
        nt_passivity_step(&p, &s, &hand, &tip);
        if (gain >= 0.05)
            gain *= 0.8;
        else
            damping = smaller(1.0, damping + 0.2);
        assert_true(s.energy == 0.0 && s.trips == k);
        assert_true(fabs(s.gain - gain) < 1e-15 && fabs(s.damping - damping) < 1e-15);
        assert_int_equal(nt_passivity_is_exhausted(&s), gain < 0.05 && damping >= 1.0 - 1e-15);
    }
    assert_true(s.damping == 1.0 && nt_passivity_is_exhausted(&s));
    s.gain = 0.05;
    assert_false(nt_passivity_is_exhausted(&s));
    tip.position += 1.5;
    nt_passivity_step(&p, &s, &hand, &tip); /* 0.05 is still a gain */
    assert_true(s.gain == 0.05 * 0.8 && s.damping == 1.0);
    s.damping = 0.5;
    s.speed = 1e-3; /* one step of the sensor is no motion */
    assert_true(nt_passivity_damping_force(&p, &s) == 0.0);
    s.speed = -0.3;
    assert_true(fabs(nt_passivity_damping_force(&p, &s) - 0.5 * 7.0 * 0.3) < 1e-15);
}

static void what_scales_may_change_by(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(4);
    for (int i = 0; i < DRAWS; ++i) {
        const nt_rig rig = drawn_rig(&random);
        nt_settings settings = drawn_settings(&random, &rig);
        settings.gains.alpha_f_approach = between(&random, 0.2, 5.0);
        settings.gains.velocity_feedforward = between(&random, 0.1, 0.7);
        settings.gains.ramp_time = i % 3 ? between(&random, 1e-3, 3.0) : 0.0;
        settings.gains.rate = i % 2 ? settings.gains.rate : between(&random, 10.0, 200.0);
        const double T = 1.0 / settings.gains.rate, ramp = settings.gains.ramp_time;
        const nt_rescale r = nt_rescale_make(&rig, &settings);
        assert_true(alike(r.share, smaller(0.5, T / larger(ramp, T)), EXACT));
        const double volts = sqrt(pow(rig.probe.noise, 2.0) + pow(1.001 * rig.probe.resolution, 2.0));
        assert_true(alike(r.threshold, rig.probe.spring_constant * rig.probe.sensitivity * volts, EXACT));
        assert_true(r.spring_constant == rig.probe.spring_constant);
        const double b = rig.master.damping * (1.0 - settings.gains.velocity_feedforward);
        assert_true(alike(r.income, 0.5 * b * T / (1.0 + settings.gains.force_gain), EXACT));
        assert_true(alike(r.capacity, 0.05 * rig.master.gauge_range * rig.master.travel, EXACT));
        assert_true(r.factors[NT_REGION_APPROACH] == settings.gains.alpha_f_approach);
        assert_true(r.factors[NT_REGION_INDENT] == 1.0);
        assert_true(r.factors[NT_REGION_RETRACT] == settings.gains.alpha_f_retract);
    }
}

/* gamma = alpha_f/alpha_p times the work done on the contact, or the lever's own energy if that is more, is what a
 * rise costs. */
static void a_rise_of_the_scale_is_paid_for(void **state)
{
    (void)state;
    const nt_rescale r = {.share = 0.01,
                          .threshold = 1e-8,
                          .spring_constant = 2.0,
                          .income = 1e-3,
                          .capacity = 4e-3,
                          .factors = {3.0, 1.0, 1.0}};
    const nt_scaling scaling = {1e-4, 1e6};
    nt_rescale_state s = nt_rescale_start(&r, &scaling);
    assert_true(s.now.alpha_f == 3e6 && s.wanted.alpha_f == 1e6 && s.tank == 0.0);
    nt_rescale_step(&r, &s, 1e-8, 5e-9, 0.0); /* of the threshold: free, and nothing is held */
    assert_true(s.work == 0.0 && s.region == NT_REGION_APPROACH && s.last_position == 5e-9 && s.now.alpha_f == 3e6);
    s.now.alpha_f = 1e6;
    nt_rescale_step(&r, &s, 2e-6, 15e-9, 0.5); /* 2 uN over 10 nm; the tank takes 1e-3 v^2 */
    assert_true(fabs(s.work - 2e-14) < 1e-28 && fabs(s.tank - 2.5e-4) < 1e-18 && s.region == NT_REGION_INDENT);
    nt_rescale_step(&r, &s, 2e-6, 5e-9, 5.0);
    assert_true(fabs(s.work) < 1e-28 && s.tank == 4e-3); /* full */
    s.wanted.alpha_f = 2e6; /* 1 % up: what the lever holds is 2e-6^2/4 = 1e-12 J, and 1e10 * 0.01 times that is due */
    nt_rescale_step(&r, &s, 2e-6, 5e-9, 0.0);
    assert_true(s.now.alpha_f == 1e6 * 1.01 && fabs(s.tank - (4e-3 - 1e-4)) < 1e-12);
    s.tank = 1e-6;
    nt_rescale_step(&r, &s, 2e-6, 5e-9, 0.0);
    assert_true(s.now.alpha_f == 1e6 * 1.01 && s.tank == 1e-6); /* too dear */
    s.wanted.alpha_f = 0.5e6;                                   /* down is free, and gives nothing back */
    nt_rescale_step(&r, &s, 2e-6, 5e-9, 0.0);
    assert_true(fabs(s.now.alpha_f - 1e6 * 1.01 * 0.99) < 1e-6 && s.tank == 1e-6);
    s.wanted = (nt_scaling){1e-4 * 0.995, s.now.alpha_f}; /* alpha_p falls by less than a share: gamma rises */
    s.tank = 4e-3;
    const double gamma = s.now.alpha_f / s.now.alpha_p, after = s.now.alpha_f / (1e-4 * 0.995);
    nt_rescale_step(&r, &s, 2e-6, 5e-9, 0.0);
    assert_true(s.now.alpha_p == 1e-4 * 0.995 && fabs(s.tank - (4e-3 - (after - gamma) * 1e-12)) < 1e-15);
    s.wanted.alpha_f *= 1.005; /* the work counts where it is more than the lever's energy */
    s.work = 3e-12;
    s.tank = 4e-3;
    const double rise = s.now.alpha_f * 0.005 / s.now.alpha_p;
    nt_rescale_step(&r, &s, 2e-6, 5e-9, 0.0);
    assert_true(fabs(s.tank - (4e-3 - rise * 3e-12)) < 1e-13);
}

static void regions_at_the_threshold(void **state)
{
    (void)state;
    const nt_rescale r = {.share = 1.0, .threshold = 1.0, .spring_constant = 2.0, .factors = {1.0, 1.0, 1.0}};
    const nt_scaling scaling = {1.0, 1.0};
    const struct {
        nt_region from;
        double force;
        nt_region to;
    } cases[] = {
        {NT_REGION_APPROACH, 1.0, NT_REGION_APPROACH},      {NT_REGION_APPROACH, 1.0 + 1e-9, NT_REGION_INDENT},
        {NT_REGION_APPROACH, -2.0, NT_REGION_APPROACH},     {NT_REGION_INDENT, -1.0, NT_REGION_INDENT},
        {NT_REGION_INDENT, -1.0 - 1e-9, NT_REGION_RETRACT}, {NT_REGION_RETRACT, -2.0, NT_REGION_RETRACT},
        {NT_REGION_RETRACT, 0.0, NT_REGION_APPROACH},       {NT_REGION_RETRACT, -1.0, NT_REGION_APPROACH},
        {NT_REGION_RETRACT, 2.0, NT_REGION_INDENT},         {NT_REGION_INDENT, 0.0, NT_REGION_INDENT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        nt_rescale_state s = nt_rescale_start(&r, &scaling);
        s.region = cases[i].from;
        s.work = 1.0;
        nt_rescale_step(&r, &s, cases[i].force, 0.0, 0.0);
        assert_int_equal(s.region, cases[i].to);
        assert_true((s.work == 0.0) == (fabs(cases[i].force) <= 1.0));
    }
}

static void the_motors_limits(void **state)
{
    (void)state;
    const nt_limits limits = {.motor_force = 5.0, .motor_power = 2.0};
    assert_true(nt_motor_limit(&limits, 0.1, 1.0, 3.0, 0.0) == 1.1 &&
                nt_motor_limit(&limits, 0.1, 1.0, -3.0, 0.0) == 0.9);
    assert_true(nt_motor_limit(&limits, 100.0, 0.0, 4.0, 0.5) == 4.0); /* 2 W, no more */
    assert_true(nt_motor_limit(&limits, 100.0, 0.0, 4.0, 1.0) == 2.0);
    assert_true(nt_motor_limit(&limits, 100.0, 0.0, -4.0, -1.0) == -2.0);
    assert_true(nt_motor_limit(&limits, 100.0, 0.0, -4.0, 1.0) == -4.0); /* a brake has no limit */
    assert_true(nt_motor_limit(&limits, 100.0, 0.0, 40.0, 0.0) == 5.0 &&
                nt_motor_limit(&limits, 100.0, 0.0, -40.0, 0.0) == -5.0);
}

static void what_the_hand_is_promised(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(5);
    for (int i = 0; i < DRAWS; ++i) {
        nt_rig rig = drawn_rig(&random);
        nt_settings settings = drawn_settings(&random, &rig);
        rig.master.motor = i % 7 != 0;
        rig.master.axes = i % 2 ? 3.0 : 1.0;
        settings.limits.motor_force = between(&random, 0.01, 10.0);
        settings.limits.motor_rate = between(&random, 50.0, 5000.0);
        const double F = rig.master.motor ? settings.limits.motor_force : 0.0, m = smaller(0.1, rig.master.mass);
        const double v = rig.master.max_speed, all = i % 2 ? sqrt(3.0) * F : F;
        const double speed = 0.5 * (v + sqrt(v * v + 2e-3 / m)), product = 2e-3 / speed;
        const double delay = settings.gains.delay / settings.gains.rate + rig.converters.dac_latency;
        double fade = all > 0.0 ? smaller(0.05, product / all) : 0.05;
        fade = larger(fade, F / settings.limits.motor_rate);
        const double J = all * (0.5 * fade + delay);
        const nt_motor_bound found = nt_motor_bound_compute(&rig, &settings);
        assert_true(alike(found.force, all, EXACT) && alike(found.speed, speed, EXACT));
        assert_true(alike(found.fade_product, product, EXACT) && alike(found.fade_time, fade, EXACT));
        assert_true(alike(found.delay, delay, EXACT) && alike(found.energy, J * v + J * J / (2.0 * m), EXACT));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_three_laws),
        cmocka_unit_test(what_the_observer_needs),
        cmocka_unit_test(energy_is_counted_in_trapezes),
        cmocka_unit_test(gain_goes_before_damping_comes),
        cmocka_unit_test(what_scales_may_change_by),
        cmocka_unit_test(a_rise_of_the_scale_is_paid_for),
        cmocka_unit_test(regions_at_the_threshold),
        cmocka_unit_test(the_motors_limits),
        cmocka_unit_test(what_the_hand_is_promised),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
