/* SPDX-License-Identifier: BSD-3-Clause
 * A fault of one channel leaves the others as they are, and what is derived is as valid as what it is made from. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "control/observe.h"
#include "larger.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

enum { GAP = 37, TICKS = 2000 };
#define SPEED 0.02 /* of the hand [m/s] */

typedef struct bench {
    nt_touch touch;
    nt_touch_state state;
    nt_command command;
    int tick;
} bench;

static bench bench_of(void)
{
    bench b = {.tick = 0};
    nt_rig rig = nt_rig_defaults();
    rig.master.travel = 10.0;
    const nt_settings settings = nt_settings_defaults(&rig);
    assert_int_equal(nt_touch_make(&b.touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    b.state = nt_touch_start(&b.touch, 0.0, 0.0, 0.0);
    return b;
}

/* A hand that goes on at one speed, and presses and feels what changes all the time. */
static nt_sample sample_of(const bench *b)
{
    nt_sample sample = {.tick = (uint64_t)b->tick};
    sample.master_position[NT_Z] = SPEED * b->touch.period * b->tick;
    sample.operator_force[NT_Z] = 0.5 + 0.3 * sin(0.01 * b->tick);
    sample.deflection[NT_Z] = 5e-9 + 1e-9 * sin(0.03 * b->tick);
    sample.stage_position[NT_Z] = 1e-9 * sin(0.02 * b->tick);
    return sample;
}

static void step(bench *b, const nt_sample *sample)
{
    nt_touch_step(&b->touch, &b->state, sample, &b->command);
    ++b->tick;
}

static void same_master(const nt_signals *a, const nt_signals *b)
{
    assert_true(a->master_position == b->master_position && a->master_speed == b->master_speed);
    assert_true(a->smooth_speed == b->smooth_speed);
}

static void same_operator(const nt_signals *a, const nt_signals *b)
{
    assert_true(a->operator_force == b->operator_force && a->smooth_force == b->smooth_force);
}

static void same_slave(const nt_signals *a, const nt_signals *b)
{
    assert_true(a->slave_force == b->slave_force && a->stage_position == b->stage_position);
    assert_true(a->stage_speed == b->stage_speed);
}

enum { MASTER = 1, OPERATOR = 2, SLAVE = 4 };

/* Beside one that nothing happens to: what is not in `lost` stays equal to it, to the last bit. */
static void lose(void (*fault)(nt_sample *sample), int lost)
{
    bench whole = bench_of(), hurt = bench_of();
    for (int i = 0; i < TICKS; ++i) {
        const nt_sample sample = sample_of(&whole);
        nt_sample spoiled = sample;
        const int is_lost = i >= 500 && i < 500 + GAP;
        if (is_lost)
            fault(&spoiled);
        step(&whole, &sample);
        step(&hurt, &spoiled);
        const nt_signals *a = &hurt.state.signals, *b = &whole.state.signals;
        if (!(lost & MASTER) || i < 500)
            same_master(a, b);
        if (!(lost & OPERATOR))
            same_operator(a, b);
        if (!(lost & SLAVE))
            same_slave(a, b);
        assert_true(!is_lost || hurt.command.state != NT_RUN);
        /* of a speed nothing is left while the position is not known */
        assert_true((nt_observe_speed(&hurt.state) == 0.0) == (is_lost && (lost & MASTER)) || i == 0);
        if (i >= 500 + GAP) { /* a constant speed is that again at once: the mean over the gap is, too */
            assert_true(fabs(a->smooth_speed - b->smooth_speed) < 1e-9 * SPEED);
            assert_true(fabs(a->master_speed - SPEED) < 1e-9);
        }
    }
    /* the low-pass of the force is where it would be within what its own time has left of the gap */
    assert_true(fabs(hurt.state.signals.smooth_force - whole.state.signals.smooth_force) < 1e-9);
}

static void lose_master(nt_sample *sample)
{
    sample->master_position[NT_Z] = NAN;
}
static void lose_operator(nt_sample *sample)
{
    sample->operator_force[NT_Z] = NAN;
}
static void lose_deflection(nt_sample *sample)
{
    sample->deflection[NT_Z] = NAN;
}
static void lose_stage(nt_sample *sample)
{
    sample->stage_position[NT_Z] = HUGE_VAL;
}
static void age_master(nt_sample *sample)
{
    sample->master_age = 1.0;
}
static void age_slave(nt_sample *sample)
{
    sample->age = 1.0;
}
static void blame_master(nt_sample *sample)
{
    sample->flags = NT_SAMPLE_INVALID | NT_SAMPLE_MASTER_ALONE;
}
static void blame_slave(nt_sample *sample)
{
    sample->flags = NT_SAMPLE_DEVICE_LOST | NT_SAMPLE_SLAVE_ALONE;
}
static void blame_nobody(nt_sample *sample)
{
    sample->flags = NT_SAMPLE_INVALID;
}

static void a_fault_of_one_channel_leaves_the_others(void **state)
{
    (void)state;
    lose(lose_master, MASTER);
    lose(lose_operator, OPERATOR);
    lose(lose_deflection, SLAVE);
    lose(lose_stage, SLAVE);
    lose(age_master, MASTER | OPERATOR);
    lose(age_slave, SLAVE);
    lose(blame_master, MASTER | OPERATOR);
    lose(blame_slave, SLAVE);
    lose(blame_nobody, MASTER | OPERATOR | SLAVE);
}

/* No energy for a time in which not everything was seen. Of the hand's own: 0.5 N over the way of the gap, 37 um, are
 * 37 uJ, three times the dead zone's store; they would hide an instability, or make one of nothing. */
static void no_energy_is_counted_across_a_gap(void **state)
{
    (void)state;
    bench b = bench_of();
    for (int i = 0; i < 500; ++i) {
        const nt_sample sample = sample_of(&b);
        step(&b, &sample);
    }
    const double before = b.state.passivity.energy;
    for (int i = 0; i < GAP; ++i) {
        nt_sample sample = sample_of(&b);
        sample.master_position[NT_Z] = NAN;
        step(&b, &sample);
    }
    b.tick += 1000; /* and the hand has gone on */
    const nt_sample sample = sample_of(&b);
    step(&b, &sample);
    assert_true(b.state.passivity.energy == before && b.state.passivity.trips == 0);
}

/* What the hand did while it was not seen moves no stage, however long that was. */
static void a_master_that_comes_back_is_indexed_anew(void **state)
{
    (void)state;
    bench b = bench_of();
    for (int i = 0; i < 3000; ++i) {
        nt_sample sample = sample_of(&b);
        sample.deflection[NT_Z] = 1e-10 * sin(1.7 * i);
        sample.stage_position[NT_Z] = b.command.stage_position[NT_Z];
        const double reference = b.state.reference;
        if (i >= 1000 && i < 2000)
            sample.master_age = 1.0;
        step(&b, &sample);
        const double way = b.touch.settings.gains.alpha_p * SPEED * b.touch.period; /* of a period */
        assert_true(fabs(b.state.reference - reference) < 1.001 * way);
    }
    assert_int_equal(b.command.state, NT_RUN);
}

/* A stage of 100 um is never 100 um from where it was told to be, along any axis: that is no number. */
static void a_place_that_cannot_be_is_no_number(void **state)
{
    (void)state;
    const double travel = nt_rig_defaults().stage.travel, off[] = {1.0, -1.0, 1e300, 1.01 * travel, -1.01 * travel};
    for (int axis = NT_X; axis <= NT_Z; ++axis)
        for (int i = 0; i < 5; ++i) {
            bench b = bench_of();
            nt_sample sample = {.tick = 0};
            for (int k = 0; k < 20; ++k) {
                sample.deflection[NT_Z] = 1e-10 * sin(1.7 * k);
                step(&b, &sample);
            }
            assert_int_equal(b.command.state, NT_RUN);
            if (axis != NT_Z) { /* far, but it can be */
                sample.stage_position[axis] = 0.99 * travel;
                step(&b, &sample);
                assert_int_equal(b.command.state, NT_RUN);
            }
            sample.stage_position[axis] = off[i];
            step(&b, &sample);
            assert_int_equal(b.command.state, NT_HOLD);
            assert_true(b.command.reasons & NT_REASON_INVALID);
            assert_int_equal(b.state.supervisor.seen, NT_SEES_ALL & ~NT_SEES_STAGE);
            step(&b, &sample);
            assert_int_equal(b.command.state, NT_RETRACT);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fault_of_one_channel_leaves_the_others),
        cmocka_unit_test(no_energy_is_counted_across_a_gap),
        cmocka_unit_test(a_master_that_comes_back_is_indexed_anew),
        cmocka_unit_test(a_place_that_cannot_be_is_no_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
