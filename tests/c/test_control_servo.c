/* SPDX-License-Identifier: BSD-3-Clause
 * The laws alone, and in a small exact loop: a master under a hold, a stage that follows, a spring. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/control.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/control.h"

static const nt_signals still = {.master_damping = 100.0, .scaling = {2e-5, 3e6}, .gain_factor = 1.0};

/* tau + f_m = (1 + K_f)(f_m - alpha_f f_s): at rest, and only there, f_m = alpha_f f_s, whatever K_f (erratum E16). */
static void rest_means_scaled_forces_agree(void **state)
{
    (void)state;
    static const nt_control_law laws[] = {nt_servo_default, nt_servo_paper};
    nt_random random = nt_random_seed(1);
    for (int i = 0; i < 1000; i++) {
        const nt_gains gains = {.force_gain = 100.0 * nt_random_uniform(&random)};
        nt_signals s = still;
        s.scaling.alpha_f = pow(10.0, 3.0 + 5.0 * nt_random_uniform(&random));
        s.operator_force = s.smooth_force = 5.0 * (2.0 * nt_random_uniform(&random) - 1.0);
        s.felt_force = s.operator_force / s.scaling.alpha_f;
        assert_true(fabs(laws[i % 2](NULL, &gains, &s).motor_force + s.operator_force) < 1e-12);
        s.felt_force *= 1.1; /* off balance: the difference, amplified by 1 + K_f */
        const double difference = s.operator_force - s.scaling.alpha_f * s.felt_force;
        const double net = laws[i % 2](NULL, &gains, &s).motor_force + s.operator_force;
        assert_true(fabs(net - (1.0 + gains.force_gain) * difference) < 1e-12);
        /* the passivity observer takes K_f away, never the reflected force */
        s.gain_factor = 0.0;
        assert_true(fabs(laws[i % 2](NULL, &gains, &s).motor_force + s.scaling.alpha_f * s.felt_force) < 1e-12);
    }
}

/* Eq. 17 by hand, every signal different. */
static void the_papers_law_is_eq_17(void **state)
{
    (void)state;
    const nt_gains gains = {
        .force_gain = 10.0, .stage_proportional = 7.0, .stage_derivative = 1e-3, .velocity_feedforward = 0.5};
    const nt_signals s = {.master_position = 1e-3,
                          .master_speed = 2e-3,
                          .smooth_speed = 9.0,
                          .operator_force = 1.5,
                          .smooth_force = 9.0,
                          .slave_force = 9.0,
                          .felt_force = 0.4e-6,
                          .stage_position = 13e-9,
                          .stage_speed = 17e-9,
                          .target = 15e-9,
                          .scaling = {15e-6, 4e6},
                          .master_damping = 100.0,
                          .gain_factor = 1.0};
    const nt_effort effort = nt_servo_paper(NULL, &gains, &s);
    assert_true(fabs(effort.motor_force - (-1.6 - 10.0 * (1.6 - 1.5))) < 1e-12);
    assert_true(fabs(effort.stage - (1e-3 * (15e-6 * 2e-3 - 17e-9) + 7.0 * (15e-9 - 13e-9))) < 1e-20);
    assert_true(nt_servo_default(NULL, &gains, &s).stage == s.target);
}

static void feed_forward_takes_its_share_of_the_drag(void **state)
{
    (void)state;
    const nt_gains gains = {.velocity_feedforward = 0.8};
    nt_signals s = still;
    s.smooth_speed = 5e-3;
    assert_true(fabs(nt_servo_default(NULL, &gains, &s).motor_force - 0.4) < 1e-12);
    assert_true(fabs(nt_servo_impedance(NULL, &gains, &s).motor_force - 0.4) < 1e-12);
}

static void impedance_reflects_and_asks_no_hand(void **state)
{
    (void)state;
    const nt_gains gains = {.force_gain = 10.0};
    nt_signals s = still;
    s.felt_force = 1e-6;
    s.operator_force = s.smooth_force = NAN;
    assert_true(nt_servo_impedance(NULL, &gains, &s).motor_force == -3.0);
    s.gain_factor = 0.5; /* backs off in what is reflected: there is nothing else */
    assert_true(nt_servo_impedance(NULL, &gains, &s).motor_force == -1.5);
}

typedef struct loop {
    nt_control_law law;
    nt_gains gains;
    double k_r; /* the contact at the operator's scale [N/m] */
    double x, v, tau;
} loop;

/* m = 0.1 kg, b = 100 N s/m, exactly under the hold of a period; the stage is where it shall be; touch at x = 0. */
static void advance(loop *l, double push, int ticks)
{
    const double T = 1.0 / l->gains.rate, m = 0.1, b = 100.0, a = exp(-b * T / m);
    for (int i = 0; i < ticks; i++) {
        const double force = l->tau + push;
        const double reached = l->x + m / b * (1.0 - a) * l->v + (T / b - m / (b * b) * (1.0 - a)) * force;
        const double speed = a * l->v + (1.0 - a) / b * force;
        nt_signals s = still;
        s.period = T;
        s.master_speed = s.smooth_speed = (reached - l->x) / T;
        s.operator_force = s.smooth_force = push;
        s.felt_force = l->k_r * reached / s.scaling.alpha_f;
        l->x = reached, l->v = speed;
        l->tau = l->law(NULL, &l->gains, &s).motor_force;
    }
}

/* 1 000 sets of gains inside half of R1 (here D = T/2 + T, the stage being ideal): at rest f_m = alpha_f f_s. */
static void a_thousand_gain_sets_come_to_rest_at_the_scaled_force(void **state)
{
    (void)state;
    static const nt_control_law laws[] = {nt_servo_default, nt_servo_paper, nt_servo_impedance};
    nt_random random = nt_random_seed(2);
    double worst = 0.0;
    for (int i = 0; i < 1000; i++) {
        loop l = {.law = laws[i % 3]};
        l.gains.rate = 1e3 * pow(20.0, nt_random_uniform(&random));
        l.gains.force_gain = 100.0 * nt_random_uniform(&random);
        l.gains.velocity_feedforward = i % 3 == 1 ? 0.0 : 0.8 * nt_random_uniform(&random);
        const double K_f = i % 3 == 2 ? 0.0 : l.gains.force_gain,
                     damping = 100.0 * (1.0 - l.gains.velocity_feedforward);
        const double limit = damping / (1.5 / l.gains.rate) / (1.0 + K_f);
        l.k_r = limit * (0.02 + 0.48 * nt_random_uniform(&random));
        const double push = 0.1 + 4.9 * nt_random_uniform(&random);
        const double slowest = 100.0 / ((1.0 + K_f) * l.k_r); /* b over kappa [s] */
        advance(&l, push, (int)(l.gains.rate * (20.0 * slowest + 0.3)));
        worst = larger(worst, fabs(l.k_r * l.x - push) / push);
    }
    print_message("f_m = alpha_f f_s within %.1e of f_m\n", worst);
    assert_true(worst < 1e-6);
}

static void a_shape_is_what_the_rules_need(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    settings.gains.velocity_feedforward = 0.6;
    settings.gains.force_gain = 5.0;
    settings.gains.alpha_f_retract = 3.0;
    nt_servo_equivalent equivalent = nt_servo_equivalent_of(&rig, &settings, 100.0);
    assert_true(equivalent.gains.force_gain == 5.0 && fabs(equivalent.rig.master.damping - 40.0) < 1e-12);
    assert_true(equivalent.gains.alpha_f == 3.0 * settings.gains.alpha_f && equivalent.contact_stiffness == 100.0);
    settings.control.choice = NT_CONTROL_IMPEDANCE;
    equivalent = nt_servo_equivalent_of(&rig, &settings, 100.0);
    assert_true(equivalent.gains.force_gain == 0.0 && fabs(equivalent.rig.master.damping - 40.0) < 1e-12);
    settings.control.choice = NT_CONTROL_PAPER; /* has no feed-forward and no notch */
    equivalent = nt_servo_equivalent_of(&rig, &settings, 100.0);
    assert_true(equivalent.rig.master.damping == 100.0 && equivalent.gains.stage_damping == 0.5 / rig.stage.quality);
}

/* Springs in series: the contact at the operator's scale and the coupling. */
static void a_coupling_softens_every_contact(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    settings.gains.coupling_stiffness = 300.0;
    const double scale = settings.gains.alpha_f * settings.gains.alpha_p, k_c = rig.probe.spring_constant;
    for (double k = 0.1; k < 1e6; k *= 10.0) {
        const double softened = nt_servo_equivalent_of(&rig, &settings, k).contact_stiffness;
        const double rigid = scale / (1.0 / k + 1.0 / k_c), felt = scale / (1.0 / softened + 1.0 / k_c);
        assert_true(fabs(1.0 / felt - (1.0 / rigid + 1.0 / 300.0)) < 1e-9 / felt);
        assert_true(felt < 300.0);
    }
    const double felt = scale / (1.0 / nt_servo_equivalent_of(&rig, &settings, INFINITY).contact_stiffness + 1.0 / k_c);
    assert_true(fabs(1.0 / felt - (1.0 / (scale * k_c) + 1.0 / 300.0)) < 1e-9 / felt);
}

/* The stage of Eq. 17 (450 Hz, Q = 20): the largest K_p without K_v, as eigenvalues of the sampled loop give it, and
 * that a delay of one period costs most of it. */
static void the_papers_stage_has_its_own_limit(void **state)
{
    (void)state;
    static const struct {
        double period, delay, most, tolerance;
    } cases[] = {{3e-3, 0.0, 0.30, 0.01}, {1e-3, 0.0, 0.07, 0.02}, {0.1e-3, 1.0, 0.1, 0.1}};
    const nt_rig rig = nt_rig_defaults();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        nt_settings settings = nt_settings_defaults(&rig);
        settings.control.choice = NT_CONTROL_PAPER;
        settings.gains.rate = 1.0 / cases[i].period;
        settings.gains.delay = cases[i].delay;
        settings.gains.stage_proportional = 1.0;
        const double found = nt_servo_stage_margin(&rig, &settings);
        print_message("T %.1f ms, d %.0f: K_p < %.3f\n", 1e3 * cases[i].period, cases[i].delay, found);
        assert_true(fabs(found - cases[i].most) < cases[i].tolerance);
        settings.gains.stage_proportional = 10.0;
        assert_true(fabs(nt_servo_stage_margin(&rig, &settings) - 0.1 * found) < 0.003 * found);
    }
    nt_settings settings = nt_settings_defaults(&rig);
    assert_true(isinf(nt_servo_stage_margin(&rig, &settings)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rest_means_scaled_forces_agree),
        cmocka_unit_test(the_papers_law_is_eq_17),
        cmocka_unit_test(feed_forward_takes_its_share_of_the_drag),
        cmocka_unit_test(impedance_reflects_and_asks_no_hand),
        cmocka_unit_test(a_thousand_gain_sets_come_to_rest_at_the_scaled_force),
        cmocka_unit_test(a_shape_is_what_the_rules_need),
        cmocka_unit_test(a_coupling_softens_every_contact),
        cmocka_unit_test(the_papers_stage_has_its_own_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
