/* SPDX-License-Identifier: BSD-3-Clause
 * Faults injected into the simulated rig while the operator presses: reaction, time to it, worst force and indentation,
 * single (the table of docs/evidence/safety.md) and in pairs; and hands and walls that try to break the force limit. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "failure_of.h"
#include "fault_cases.h"
#include "internal/random.h"
#include "internal/surface.h"
#include "larger.h"
#include "nanotouch/advanced/random.h"

/* bound: of the force [N]. */
static void check_bounds(const loop *l, const outcome *o, double bound)
{
    const nt_limits *limits = &l->touch.settings.limits;
    assert_true(o->finite);
    assert_true(o->worst_force < bound);
    assert_true(o->worst_indentation >= 0.0);
    assert_true(o->fastest_motor <= limits->motor_rate * l->touch.period * (1.0 + 1e-12));
    assert_true(o->late_motor == 0.0);
    if (o->last >= NT_RETRACT) /* once, and on while force shows or cannot be read */
        assert_true(o->lifted <= limits->retract_speed * o->time + 150e-9);
}

static double bound_of(const loop *l, const fault_case *one, const fault_case *other)
{
    return is_blind_lift(one, other) ? (double)INFINITY : promised(l, 0.0);
}

static void print_reasons(uint32_t reasons)
{
    const char *before = "";
    for (uint32_t bit = 1; nt_reason_name(bit)[0] != 0; bit <<= 1)
        if (reasons & bit) {
            print_message("%s%s", before, nt_reason_name(bit));
            before = ", ";
        }
}

/* Of the fault table. */
static int row_of(const nt_fault *fault)
{
    const int reads = fault->channel == NT_CHANNEL_DEFLECTION || fault->channel == NT_CHANNEL_STAGE_POSITION;
    if (fault->kind == NT_FAULT_GAIN && reads)
        return 38;
    if (fault->kind == NT_FAULT_DRIFT && fault->channel == NT_CHANNEL_DEFLECTION)
        return 39;
    if (fault->kind == NT_FAULT_GAIN && fault->channel == NT_CHANNEL_STAGE && isfinite(fault->duration))
        return 40;
    const int loop_gain = fault->kind == NT_FAULT_GAIN && fault->channel == NT_CHANNEL_MOTOR;
    return loop_gain ? 17 : nt_fault_descriptions(NULL)[fault->kind].row;
}

/* One row of the table; is it as demanded? */
static int print_row(const fault_case *f, const outcome *o)
{
    static const char *const names[] = {"RUN", "HOLD", "RETRACT", "LATCHED"};
    print_message("| %d | %s | %s | ", row_of(&f->fault), f->name, names[o->first]);
    if (o->first != NT_RUN)
        print_message("%d", o->ticks);
    print_message(o->latched ? " | %s | %d" : " | %s | ", names[o->last], o->latched);
    print_message(" | %.0f | %.2f | ", 1e9 * o->worst_force, 1e9 * o->worst_indentation);
    print_reasons(o->reasons);
    const int right =
        o->first == f->first && o->last == f->last && o->ticks <= f->within && (o->reasons & f->reason) == f->reason;
    print_message(right ? " |\n" : " | <- NOT AS DEMANDED\n");
    return right;
}

static void print_head(void)
{
    print_message(
        "| row | fault | first | ticks | then | latched | worst force [nN] | worst indentation [nm] | reasons "
        "|\n|---|---|---|---|---|---|---|---|---|\n");
}

/* Prints the table of docs/evidence/safety.md. */
static void every_fault_has_its_reaction(void **state)
{
    (void)state;
    static loop l;
    int wrong = 0;
    print_head();
    for (int i = 0; i < FAULT_CASES; i++) {
        const fault_case *f = &fault_cases[i];
        outcome o;
        start(&l, f, NULL);
        assert_int_equal(observe(&l, 10000, &o), NT_OK);
        wrong += !print_row(f, &o);
        check_bounds(&l, &o, bound_of(&l, f, NULL));
    }
    assert_int_equal(wrong, 0);
}

/* The bound of each is that of its failure, where it is one. */
static void every_fault_found_later_has_its_reaction(void **state)
{
    (void)state;
    static loop l;
    int wrong = 0;
    print_head();
    for (int i = 0; i < LATER_CASES; i++) {
        const fault_case *f = &later_cases[i];
        const nt_failure failure = failure_of(f->fault.kind, f->fault.channel);
        outcome o;
        start(&l, f, NULL);
        assert_int_equal(observe(&l, 10000, &o), NT_OK);
        wrong += !print_row(f, &o);
        const nt_guarantee g = promise(&l, 0.0);
        check_bounds(&l, &o, g.force + (failure < NT_FAILURES ? g.failure[failure] : 0.0));
    }
    assert_int_equal(wrong, 0);
}

/* Does one fault keep the other from being seen? */
static int hides(const nt_fault *one, const nt_fault *other)
{
    const int sensor = other->channel <= NT_CHANNEL_OPERATOR_FORCE, clock = other->kind == NT_FAULT_CLOCK;
    if (one->kind == NT_FAULT_STALE || one->kind == NT_FAULT_CLOCK)
        return clock || (sensor && one->kind == NT_FAULT_STALE);
    return sensor && one->channel == other->channel; /* what the later one makes of the reading */
}

/* What shows at once shows whatever else fails. */
static void check_reactions(const fault_case *one, const fault_case *other, const outcome *o)
{
    const fault_case *const pair[] = {one, other};
    for (int k = 0; k < 2; k++) {
        if (pair[k]->within != 1 || hides(&pair[1 - k]->fault, &pair[k]->fault))
            continue;
        const nt_state least =
            pair[k]->first == NT_LATCHED ? NT_LATCHED : NT_HOLD; /* of a bad sample nothing is used */
        if (o->first < least || o->ticks != 1)
            fail_msg("%s and %s: %d after %d ticks", pair[k]->name, pair[1 - k]->name, (int)o->first, o->ticks);
        if (pair[k]->last >= NT_RETRACT)
            assert_true(o->last >= pair[k]->last);
    }
}

/* All pairs: as bad as the worse of the two, unless one of them keeps the other from showing; the bounds always. */
static void every_pair_of_faults_keeps_the_bounds(void **state)
{
    (void)state;
    static loop l;
    outcome worst = {0}, blind = {0};
    int pairs = 0;
    for (int i = 0; i < FAULT_CASES; i++)
        for (int j = 0; j < i; j++) {
            if (is_slow(&fault_cases[i]) || is_slow(&fault_cases[j]))
                continue;
            outcome o;
            start(&l, &fault_cases[i], &fault_cases[j]);
            assert_int_equal(observe(&l, 3000, &o), NT_OK);
            check_bounds(&l, &o, bound_of(&l, &fault_cases[i], &fault_cases[j]));
            check_reactions(&fault_cases[i], &fault_cases[j], &o);
            outcome *kept = is_blind_lift(&fault_cases[i], &fault_cases[j]) ? &blind : &worst;
            pairs++;
            kept->worst_force = larger(kept->worst_force, o.worst_force);
            kept->worst_indentation = larger(kept->worst_indentation, o.worst_indentation);
        }
    print_message("%d pairs, limit %.0f nN: worst force %.0f nN, worst indentation %.2f nm; a lift the wrong way that "
                  "nobody sees "
                  "%.0f nN, %.2f nm\n",
                  pairs, 1e9 * pressed.touch.settings.limits.force, 1e9 * worst.worst_force,
                  1e9 * worst.worst_indentation, 1e9 * blind.worst_force, 1e9 * blind.worst_indentation);
    assert_true(worst.worst_force < blind.worst_force && worst.worst_indentation < blind.worst_indentation);
}

/* A stage that turns at any time of a touch, and a stop of another kind at any time after: at what force the lift in
 * the wrong direction ends. The stop comes where it hurts most: before the stage has shown anything. */
static void a_lift_the_wrong_way_is_given_up(void **state)
{
    (void)state;
    static loop l;
    static const fault_case turned = {"", CASE(GAIN, STAGE, FOREVER, -1.0), NT_HOLD, 0, NT_LATCHED, 0};
    double most = 0.0;
    int slowest = 0;
    for (int stop = 0; stop < 300; stop += 10)
        for (int kind = 0; kind < 3; kind++) {
            start(&l, &turned, NULL);
            const double began = (double)(l.sim.slave.link.tick + (uint64_t)stop) * l.sim.slave.link.period;
            nt_fault fault = {NT_FAULT_EMERGENCY_STOP, NT_CHANNEL_RIG, began, FOREVER, 0.0};
            if (kind > 0) /* no stage position, and nothing but the stage position, to tell by */
                fault = (nt_fault){NT_FAULT_NAN, kind == 1 ? NT_CHANNEL_STAGE_POSITION : NT_CHANNEL_DEFLECTION, began,
                                   FOREVER, 0.0};
            assert_int_equal(nt_sim_inject(&l.sim, &fault), NT_OK);
            double before = 0.0, worst = 0.0;
            int moved = 0;
            for (int i = 0; i < 3000; i++) {
                const double reference = l.state.reference;
                move_hand(&l, i);
                assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
                before = i < stop ? larger(before, l.sim.slave.truth.tip_force[NT_Z]) : before;
                worst = larger(worst, l.sim.slave.truth.tip_force[NT_Z]);
                moved = l.state.reference != reference ? i - stop : moved;
            }
            assert_int_equal(l.command.state, NT_LATCHED);
            assert_true(l.command.reasons & NT_REASON_FOLLOW);
            most = larger(most, worst - larger(before, 974e-9));
            slowest = moved > slowest ? moved : slowest;
        }
    const nt_supervisor *supervisor = &l.touch.supervisor;
    const double lag = l.touch.period / supervisor->stage_share;
    const double way = supervisor->stage_slack + l.touch.settings.limits.retract_speed * (lag + 3.0 * l.touch.period);
    const double seen = supervisor->free_force + 1e-9 * supervisor->spring_constant;
    const double bound = supervisor->spring_constant * way + seen + promise(&l, 0.0).ringing;
    print_message("lifted the wrong way: %d ticks and %.0f nN at most, %.0f nN are allowed\n", slowest, 1e9 * most,
                  1e9 * bound);
    assert_true(most < bound);
}

/* At half of alpha_f, for the force of a hand to reach the limit; pressed with this for as long. */
static void press_softly(loop *begun, double force, int ticks)
{
    nt_session_setup setup = nt_session_defaults();
    setup.settings = nt_settings_defaults(&setup.rig); /* it may press as hard as the rig can */
    setup.clearance = 20e-9;
    setup.settings.gains.alpha_f *= 0.5;
    assert_int_equal(loop_open(begun, &setup), NT_OK);
    loop_push(begun, force * setup.settings.gains.alpha_f, 0.5);
    for (int i = 0; i < ticks; i++)
        assert_int_equal(loop_tick(begun, NULL, NULL), NT_OK);
}

/* Pressed at 0.98 of the limit, the stage turns, and the hand draws back: which presses. */
static void a_turned_stage_keeps_the_guarantee(void **state)
{
    (void)state;
    static loop l, begun;
    const double limit = pressed.touch.settings.limits.force;
    press_softly(&begun, 0.98 * limit, 30000);
    double worst = 0.0;
    for (int hand = 0; hand < 20; hand++) {
        l = begun;
        l.sim.slave.plan = &begun.plan;
        const nt_fault turned = {NT_FAULT_GAIN, NT_CHANNEL_STAGE, 0.0, FOREVER, -1.0};
        assert_int_equal(nt_sim_inject(&l.sim, &turned), NT_OK);
        loop_push(&l, hand % 5, 0.005 * pow(4.0, hand / 5));
        for (int i = 0; i < 3000; i++) {
            assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
            worst = larger(worst, l.sim.slave.truth.tip_force[NT_Z]);
        }
        assert_true(hand % 5 == 4 || l.command.state == NT_LATCHED);
    }
    print_message("turned at 0.98 of the limit: worst force %.0f nN, bound %.0f nN\n", 1e9 * worst,
                  1e9 * promised(&l, 0.0));
    assert_true(worst > limit && worst < promised(&l, 0.0));
}

/* A motor that gives far more than it is told, over 20 s: either the observer holds, or the master swings by less than
 * three of its steps, which no observer tells from standing. The sample feels neither. */
static void too_much_motor_does_not_reach_the_sample(void **state)
{
    (void)state;
    static const double gains[] = {10.0, 30.0, 60.0, 100.0, 150.0, 300.0, 1000.0};
    static loop l;
    const loop *const begun[] = {&pressed_slow, &pressed};
    print_message(
        "| rate [kHz] | motor x | held after [s] | swing of the master [mm] | of the tip [nN] | worst force [nN] |\n"
        "|---|---|---|---|---|---|\n");
    for (int i = 0; i < 14; i++) {
        const loop *from = begun[i / 7];
        l = *from;
        l.sim.slave.plan = &from->plan;
        const nt_fault fault = {NT_FAULT_GAIN, NT_CHANNEL_MOTOR, 0.0, FOREVER, gains[i % 7]};
        assert_int_equal(nt_sim_inject(&l.sim, &fault), NT_OK);
        const int second = (int)round(1.0 / l.touch.period);
        double worst = 0.0, low = INFINITY, high = -INFINITY, least = INFINITY, most = -INFINITY;
        int held = 0;
        for (int tick = 0; tick < 20 * second; tick++) {
            move_hand(&l, tick * 10000 / second);
            assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
            held = held == 0 && l.command.state != NT_RUN ? tick : held;
            worst = larger(worst, fabs(l.sim.slave.truth.tip_force[NT_Z]));
            if (tick < 18 * second)
                continue;
            low = smaller(low, l.sim.master.arm[NT_Z].position), high = larger(high, l.sim.master.arm[NT_Z].position);
            least = smaller(least, l.sim.slave.truth.tip_force[NT_Z]),
            most = larger(most, l.sim.slave.truth.tip_force[NT_Z]);
        }
        print_message("| %.0f | %.0f | ", 1e-3 / l.touch.period, gains[i % 7]);
        if (held)
            print_message("%.2f", held * l.touch.period);
        print_message(" | %.3f | %.1f | %.0f |\n", 1e3 * (high - low), 1e9 * (most - least), 1e9 * worst);
        assert_true(held || high - low < 3.0 * l.touch.rig.master.resolution);
        const double limit = 0.5 * l.touch.settings.limits.force;
        assert_true(l.command.state <= NT_HOLD && worst < limit && most - least < limit);
    }
}

/* 60 adversarial hands, any force within +-5 N at any time, 2 s each, which is 3 uN at this alpha_f: the force on the
 * sample stays below the limit and what the stage can go until a reaction shows: the loop's delay; and the noise of the
 * reading. */
static void no_hand_can_break_the_force_limit(void **state)
{
    (void)state;
    static loop l, begun;
    press_softly(&begun, 1.0 / (0.5 * pressed.touch.settings.gains.alpha_f), 10000);
    nt_random random = nt_random_seed(33);
    double worst = 0.0;
    int stopped = 0;
    const nt_limits *limits = &begun.touch.settings.limits;
    const double bound = promised(&begun, 0.0);
    for (int n = 0; n < 60; n++) {
        l = begun;
        l.sim.slave.plan = &begun.plan;
        for (uint32_t stream = 0; stream < NT_SIM_NOISES; ++stream)
            l.sim.master.link.noise[stream] = l.sim.slave.link.noise[stream] = nt_noise_of((uint64_t)n, stream);
        for (int i = 0; i < 20000; i++) {
            if (nt_random_uniform(&random) < 0.003)
                loop_push(&l, 10.0 * nt_random_uniform(&random) - 5.0 + (n % 2 ? 2.0 : 0.0),
                          0.05 * nt_random_uniform(&random));
            assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
            worst = larger(worst, l.sim.slave.truth.tip_force[NT_Z]);
            stopped += l.command.state == NT_RETRACT && i % 1000 == 0 && nt_touch_arm(&l.state, 0) == NT_OK;
        }
        assert_int_equal(l.state.passivity.trips, 0); /* rough, but stable: the observer knows */
    }
    print_message("worst force %.1f nN, limit %.1f nN, bound %.1f nN; %d times stopped\n", 1e9 * worst,
                  1e9 * limits->force, 1e9 * bound, stopped);
    assert_true(worst < bound);
    assert_true(stopped > 0 && worst > 0.9 * limits->force); /* they did try */
}

enum { N = 96 };

/* Pressed at nine tenths of the limit and driven sideways, as fast as allowed, against a wall of 300 nm. */
static void a_wall_does_not_break_the_force_limit(void **state)
{
    (void)state;
    static double heights[N * N], coefficients[N * N];
    static loop l;
    nt_surface surface;
    for (int i = 0; i < N * N; i++)
        heights[i] = 150e-9 * (1.0 + tanh((i % N - 48) / 2.0));
    const nt_height_map map = {heights, N, N, 20e-9, 20e-9};
    assert_int_equal(nt_surface_init(&surface, &map, coefficients), NT_OK);
    double slope = 0.0;
    for (double x = 0.0; x < 1.9e-6; x += 1e-9)
        slope = larger(slope, nt_surface_eval(&surface, x, 0.3e-6).zx);
    nt_session_setup setup = nt_session_defaults();
    setup.settings = nt_settings_defaults(&setup.rig); /* it may press as hard as the rig can */
    setup.surface = &surface;
    setup.x = setup.y = 0.3e-6;
    setup.clearance = 20e-9;
    setup.settings.gains.alpha_f *= 0.5;
    assert_int_equal(loop_open(&l, &setup), NT_OK);
    const nt_limits *limits = &l.touch.settings.limits;
    loop_push(&l, 0.9 * limits->force * setup.settings.gains.alpha_f, 0.5);
    for (int i = 0; i < 30000; i++)
        assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
    assert_int_equal(l.command.state, NT_RUN);
    assert_int_equal(nt_touch_aim(&l.touch, &l.state, 1.7e-6, 0.3e-6, 0.0), NT_OK);
    double worst = 0.0;
    for (int i = 0; i < 3000; i++) {
        assert_int_equal(loop_tick(&l, NULL, NULL), NT_OK);
        worst = larger(worst, l.sim.slave.truth.tip_force[NT_Z]);
    }
    const double bound = promised(&l, slope);
    print_message("slope %.1f: worst force %.0f nN, limit %.0f nN, bound %.0f nN\n", slope, 1e9 * worst,
                  1e9 * limits->force, 1e9 * bound);
    assert_true(worst > limits->force && worst < bound);
    assert_int_equal(l.command.state, NT_RETRACT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_fault_has_its_reaction),
        cmocka_unit_test(every_fault_found_later_has_its_reaction),
        cmocka_unit_test(every_pair_of_faults_keeps_the_bounds),
        cmocka_unit_test(a_lift_the_wrong_way_is_given_up),
        cmocka_unit_test(a_turned_stage_keeps_the_guarantee),
        cmocka_unit_test(too_much_motor_does_not_reach_the_sample),
        cmocka_unit_test(no_hand_can_break_the_force_limit),
        cmocka_unit_test(a_wall_does_not_break_the_force_limit),
    };
    return cmocka_run_group_tests(tests, press, NULL);
}
