/* SPDX-License-Identifier: BSD-3-Clause
 * The limit of the z loop beside the loop itself, stepped by Runge-Kutta within each tick: stage, slow flow and lock-in
 * amplifier, drawn at random, stages beyond half the rate among them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "larger.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/material.h"
#include "scan/flow.h"
#include "scan/loop.h"

enum { CASES = 12, PARTS = 24, TICKS = 12000, ANSWERS_AT_A_FLAT = 5 };

/* All parts of a loop. */
typedef struct rig {
    nt_tapping lever;
    nt_zloop zloop;
    nt_tap_answer at;
    double wn, q; /* of the stage */
} rig;

static double between(nt_random *random, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(random));
}

/* A lever that is repelled: the harder the sample, the more its amplitude follows the height. */
static rig draw(nt_random *random, int phase)
{
    const double A0 = 20e-9, Q = between(random, 30.0, 600.0), set = 0.4 + 0.4 * nt_random_uniform(random);
    const double D = A0 / Q, stiff = between(random, 0.05, 5.0);
    rig made = {.lever = {.ratio = 1.0,
                          .rate = 2.0 * NT_PI * between(random, 60e3, 400e3),
                          .quality = Q,
                          .cosine = 1.0,
                          .strength = D,
                          .free_amplitude = A0},
                .zloop = nt_scan_defaults().zloop,
                .wn = 2.0 * NT_PI * between(random, 1e3, 45e3),
                .q = between(random, 1.0, 12.0)};
    made.zloop.mode = phase ? NT_ZLOOP_PHASE : NT_ZLOOP_TAPPING;
    made.zloop.lock_in = between(random, 2e-6, 1e-3);
    made.at = (nt_tap_answer){.amplitude = set * A0,
                              .sine = set * D,
                              .cosine = D * sqrt(1.0 - set * set),
                              .force_height = -stiff,
                              .force_swing = 0.98 * stiff};
    return made;
}

static double complex integral_and_stage(const void *context, double theta)
{
    const rig *r = context;
    const double T = 1.0 / r->zloop.rate;
    const nt_lti model = {
        .order = 2, .a = {{0.0, T}, {-r->wn * r->wn * T, -r->wn / r->q * T}}, .b = {0.0, r->wn * r->wn * T}};
    nt_lti s;
    assert_int_equal(nt_lti_discretise(&model, 1.0, &s), NT_OK);
    const double complex z = nt_complex(cos(theta), sin(theta)), a = z - s.a[0][0], d = z - s.a[1][1];
    return T / (z - 1.0) * (d * s.b[0] + s.a[0][1] * s.b[1]) / (a * d - s.a[0][1] * s.a[1][0]);
}

/* What moves within a tick: the stage's place and speed; the changes of A and phi. */
typedef struct moving {
    double x, v, a, p;
} moving;

/* Equations of tapping.h about the motion, and the free lever, whose amplitude follows the height alone. */
static moving rate_of(const rig *r, const moving *m, double command, double base, int is_free)
{
    const nt_tap_answer *at = &r->at;
    const double w0 = r->lever.rate, Q = r->lever.quality;
    moving rate = {.x = m->v, .v = r->wn * r->wn * (command - m->x) - r->wn / r->q * m->v};
    rate.a = 0.5 * w0 * (-(1.0 / Q + at->loss_swing) * m->a + at->cosine * m->p - at->loss_height * base);
    rate.p = 0.5 * w0 / at->amplitude * (-at->force_swing * m->a - at->sine * m->p - at->force_height * base);
    if (is_free) {
        rate.a = 0.5 * w0 / Q * (base - m->a);
        rate.p = 0.0;
    }
    return rate;
}

static moving along(const moving *from, const moving *rate, double t)
{
    return (moving){from->x + t * rate->x, from->v + t * rate->v, from->a + t * rate->a, from->p + t * rate->p};
}

static void go_on(const rig *r, moving *m, double command, double base, int is_free, double t)
{
    const moving k1 = rate_of(r, m, command, base, is_free), m2 = along(m, &k1, 0.5 * t);
    const moving k2 = rate_of(r, &m2, command, base, is_free), m3 = along(m, &k2, 0.5 * t);
    const moving k3 = rate_of(r, &m3, command, base, is_free), m4 = along(m, &k3, t);
    const moving k4 = rate_of(r, &m4, command, base, is_free);
    const moving mean = {(k1.x + 2.0 * (k2.x + k3.x) + k4.x) / 6.0, (k1.v + 2.0 * (k2.v + k3.v) + k4.v) / 6.0,
                         (k1.a + 2.0 * (k2.a + k3.a) + k4.a) / 6.0, (k1.p + 2.0 * (k2.p + k3.p) + k4.p) / 6.0};
    *m = along(m, &mean, t);
}

/* By what the loop grows in the last half of its ticks, K_I given; answer: as nt_tap_loop_make orders them. */
static double growth(const rig *r, int answer, double K)
{
    const double T = 1.0 / r->zloop.rate, share = -expm1(-T / r->zloop.lock_in);
    const double moment = answer == 0 || answer % 2 ? 1.0 : 1.0 - 0.5 / nt_flow_steps(&r->lever, T);
    const double scale = r->lever.free_amplitude * r->at.cosine / r->lever.strength;
    moving now = {.x = 1.0};
    double command = 0.0, measured = 0.0, most[2] = {0.0, 0.0};
    for (int n = 0; n < TICKS; n++) {
        const double base = now.x;
        double reading = base;
        if (answer > 0) {
            moving until = now; /* the moment of the reading */
            for (int i = 0; i < PARTS; i++)
                go_on(r, &until, command, base, answer < 3, moment * T / PARTS);
            reading = answer >= 3 && r->zloop.mode == NT_ZLOOP_PHASE ? scale * until.p : until.a;
        }
        for (int i = 0; i < PARTS; i++)
            go_on(r, &now, command, base, answer < 3, T / PARTS);
        measured += share * (reading - measured);
        command -= K * T * measured;
        if (n >= TICKS / 2)
            most[n >= 3 * TICKS / 4] = larger(most[n >= 3 * TICKS / 4], fabs(command));
        if (!(fabs(command) < 1e100))
            return HUGE_VAL;
    }
    return most[1] / most[0];
}

static void the_limit_is_that_of_the_loop(void **state)
{
    (void)state;
    for (int n = 0; n < CASES; n++) {
        nt_random random = nt_random_seed((uint64_t)n);
        const rig r = draw(&random, n % 2);
        const nt_tap_answer answers[NT_TAP_ANSWERS] = {r.at};
        const nt_tap_loop all = nt_tap_loop_make(&r.lever, &r.zloop, answers);
        assert_true(all.count > ANSWERS_AT_A_FLAT && all.at_set_point == 3);
        const int answer = n % ANSWERS_AT_A_FLAT;
        nt_tap_loop one = all;
        one.count = 1;
        one.answer[0] = all.answer[answer];
        const double turn = r.wn / r.zloop.rate;
        const nt_open_loop loop = {&one,      integral_and_stage, &r, 1e-6, smaller(turn, fabs(2.0 * NT_PI - turn)),
                                   turn / r.q};
        const double K = nt_open_loop_limits(&loop, 0.25 * NT_PI).rings;
        const double below = growth(&r, answer, 0.97 * K), above = growth(&r, answer, 1.03 * K);
        print_message("case %d, answer %d: K_I %.4g 1/s, %.3g below, %.3g above\n", n, answer, K, below, above);
        assert_true(below < 1.0 && above > 1.0);
    }
}

/* The K_I with a phase margin has that margin, and no less than the gain of 1 beyond it. */
static void the_phase_is_that_of_the_gain(void **state)
{
    (void)state;
    for (int n = 0; n < CASES; n++) {
        nt_random random = nt_random_seed((uint64_t)n);
        const rig r = draw(&random, n % 2);
        const nt_tap_answer answers[NT_TAP_ANSWERS] = {r.at};
        const nt_tap_loop tap = nt_tap_loop_make(&r.lever, &r.zloop, answers);
        const double turn = r.wn / r.zloop.rate;
        const nt_open_loop loop = {&tap,      integral_and_stage, &r, 1e-6, smaller(turn, fabs(2.0 * NT_PI - turn)),
                                   turn / r.q};
        const nt_loop_limits limits = nt_open_loop_limits(&loop, 0.25 * NT_PI);
        assert_true(limits.phase > 0.0 && limits.phase <= limits.rings);
        const nt_loop_phase found = nt_open_loop_phase(&loop, 0.999 * limits.phase);
        assert_true(found.margin > 0.25 * NT_PI - 0.02 && found.angle > 0.0);
        assert_true(nt_open_loop_phase(&loop, 1.05 * limits.phase).margin < 0.25 * NT_PI);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_limit_is_that_of_the_loop),
        cmocka_unit_test(the_phase_is_that_of_the_gain),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
