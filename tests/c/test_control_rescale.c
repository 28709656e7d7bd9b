/* SPDX-License-Identifier: BSD-3-Clause
 * Scales that change under the hand: no bump, no energy that nobody has put in. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/control.h"
#include "touch_fixture.h"

static void open_bench(bench *b)
{
    const nt_rig rig = quiet_rig();
    const nt_settings settings = nt_settings_defaults(&rig);
    assert_int_equal(bench_open(b, &rig, &settings, NT_MODE_TOUCH), NT_OK);
}

static nt_scaling times(const bench *b, double position, double force)
{
    const nt_gains *gains = &b->touch.settings.gains;
    return (nt_scaling){position * gains->alpha_p, force * gains->alpha_f};
}

/* Pressed with 1 N, the scales change so that no energy is needed: the stage does not move, the motor's force goes over
 * in the ramp time, and the new scale is what counts from there on. */
static void a_new_scale_makes_no_bump(void **state)
{
    (void)state;
    static const double factors[][2] = {{1.0, 0.5}, {4.0, 1.0}, {2.0, 0.25}, {0.5, 0.4}};
    for (size_t i = 0; i < sizeof factors / sizeof *factors; i++) {
        bench b;
        open_bench(&b);
        bench_run(&b, 1.0, 6.0);
        const double stage = b.command.stage_position[NT_Z];
        b.fastest_motor = b.fastest_stage = 0.0;
        const nt_scaling wanted = times(&b, factors[i][0], factors[i][1]);
        assert_int_equal(nt_touch_rescale(&b.state, &wanted), NT_OK);
        bench_tick(&b);
        assert_true(fabs(b.command.stage_position[NT_Z] - stage) < 1e-12);
        bench_run(&b, 1.0, 12.0);
        /* (1 + K_f) of the force, by one thousandth per period */
        assert_true(b.fastest_motor < 3.0 * 1.5e-3);
        assert_true(fabs(b.state.rescale.now.alpha_p - wanted.alpha_p) < 1e-12 * wanted.alpha_p);
        assert_true(fabs(b.state.rescale.now.alpha_f - wanted.alpha_f) < 1e-12 * wanted.alpha_f);
        assert_true(fabs(wanted.alpha_f * bench_force(&b) - 1.0) < 1e-4); /* f_m = alpha_f f_s */
        const double from = b.command.stage_position[NT_Z], x = b.x;
        bench_run(&b, 1.2, 3.0);
        assert_true(fabs(b.command.stage_position[NT_Z] - from - wanted.alpha_p * (b.x - x)) < 1e-11);
    }
}

/* A change that costs energy waits while the hand stands in contact, and comes in free air. */
static void what_costs_energy_waits_for_it(void **state)
{
    (void)state;
    static const double factors[][2] = {{1.0, 4.0}, {0.25, 1.0}};
    for (int i = 0; i < 2; i++) {
        bench b;
        open_bench(&b);
        bench_run(&b, 1.0, 6.0);
        b.state.rescale.tank = 0.0;
        const nt_scaling wanted = times(&b, factors[i][0], factors[i][1]);
        assert_int_equal(nt_touch_rescale(&b.state, &wanted), NT_OK);
        bench_run(&b, 1.0, 2.0);
        assert_true(b.state.rescale.now.alpha_f < 1.1 * b.touch.settings.gains.alpha_f);
        assert_true(b.state.rescale.now.alpha_p > 0.9 * b.touch.settings.gains.alpha_p);
        b.largest_force = 0.0;
        bench_run(&b, -0.3, 6.0);
        assert_true(bench_force(&b) == 0.0);
        assert_true(fabs(b.state.rescale.now.alpha_p - wanted.alpha_p) < 1e-12 * wanted.alpha_p);
        assert_true(fabs(b.state.rescale.now.alpha_f - wanted.alpha_f) < 1e-12 * wanted.alpha_f);
    }
}

/* The hand goes to a force, slowly. */
static void go_to(bench *b, double push, double time)
{
    const double from = b->push;
    for (double t = 0.0; t < time; t += b->touch.period) {
        b->push = from + (push - from) * t / time;
        bench_tick(b);
    }
}

/* The hand yields to nothing: it pushes as hard as it is pushed. */
static void stand(bench *b, double time)
{
    for (double t = 0.0; t < time; t += b->touch.period) {
        b->push = b->state.rescale.now.alpha_f * bench_force(b);
        bench_tick(b);
    }
}

/* Press to 1 N, raise alpha_f by four while the hand stands, let the contact push it out, lower alpha_f: what the hand
 * has given in all [J]. */
static double round_of_the_hand(bench *b)
{
    const nt_scaling more = times(b, 1.0, 4.0), less = times(b, 1.0, 1.0);
    bench_run(b, 0.05, 3.0);
    const double before = b->hand_energy;
    go_to(b, 1.0, 1.0);
    stand(b, 0.2);
    assert_int_equal(nt_touch_rescale(&b->state, &more), NT_OK);
    stand(b, 0.5);
    go_to(b, 0.2, 2.0);
    assert_int_equal(nt_touch_rescale(&b->state, &less), NT_OK);
    stand(b, 0.5);
    bench_run(b, 0.05, 3.0);
    return b->hand_energy - before;
}

/* Without the tank the hand would gain in every round. */
static void nobody_gains_energy_from_a_change(void **state)
{
    (void)state;
    for (int paid = 0; paid < 2; paid++) {
        bench b;
        open_bench(&b);
        if (!paid)
            b.touch.rescale.capacity = b.touch.rescale.income = 1e9;
        bench_run(&b, 0.05, 30.0);
        for (int i = 0; i < 3; i++) {
            const double given = round_of_the_hand(&b);
            print_message("%s tank: the hand gives %.2f mJ in a round\n", paid ? "with the" : "without a", 1e3 * given);
            assert_true(paid ? given > 0.0 : given < -1e-3);
        }
        assert_int_equal(b.command.state, NT_RUN);
    }
}

/* Approach, indentation and retraction by the force's sign and history. */
static void regions_follow_the_force(void **state)
{
    (void)state;
    const nt_rescale rescale = {.share = 1.0, .threshold = 1e-9, .spring_constant = 8.0, .factors = {3.0, 1.0, 2.0}};
    const nt_scaling scaling = {2e-5, 3e6};
    nt_rescale_state s = nt_rescale_start(&rescale, &scaling);
    assert_true(s.now.alpha_f == 9e6);
    static const struct {
        double force;
        nt_region region;
    } course[] = {{-5e-9, NT_REGION_APPROACH}, {0.0, NT_REGION_APPROACH},  {5e-9, NT_REGION_INDENT},
                  {0.0, NT_REGION_INDENT},     {-5e-9, NT_REGION_RETRACT}, {5e-9, NT_REGION_INDENT},
                  {-5e-9, NT_REGION_RETRACT},  {0.0, NT_REGION_APPROACH}};
    for (size_t i = 0; i < sizeof course / sizeof *course; i++) {
        nt_rescale_step(&rescale, &s, course[i].force, 0.0, 1e9);
        assert_int_equal(s.region, course[i].region);
    }
}

static void nonsense_is_refused(void **state)
{
    (void)state;
    bench b;
    open_bench(&b);
    const nt_scaling bad[] = {{NAN, 1.0}, {1.0, HUGE_VAL}, {0.0, 1.0}, {1.0, -1.0}};
    for (int i = 0; i < 4; i++)
        assert_int_equal(nt_touch_rescale(&b.state, &bad[i]), i < 2 ? NT_E_NOT_FINITE : NT_E_RANGE);
    assert_true(b.state.rescale.wanted.alpha_f == b.touch.settings.gains.alpha_f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_scale_makes_no_bump),
        cmocka_unit_test(what_costs_energy_waits_for_it),
        cmocka_unit_test(nobody_gains_energy_from_a_change),
        cmocka_unit_test(regions_follow_the_force),
        cmocka_unit_test(nonsense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
