/* SPDX-License-Identifier: BSD-3-Clause
 * The touch step against samples made up here: a stage that goes where it is told, a master held by the test. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/rig.h"
#include "larger.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

#define ONE_TICK 1e-4
enum { FADE = 500 }; /* ticks in 50 ms */

typedef struct rig {
    nt_touch touch;
    nt_touch_state state;
    nt_sample sample;
    nt_command command;
    double last_force, last_stage, fastest_force, fastest_stage; /* largest steps of a tick [N], [m] */
    double noise;                                                /* of the deflection [m] */
    nt_random random;
} rig;

static void set_up(rig *r, nt_mode mode)
{
    const nt_rig paper = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&paper);
    *r = (rig){.random = nt_random_seed(2), .noise = 1e-9};
    assert_int_equal(nt_touch_make(&r->touch, &paper, &settings, mode, NULL), NT_OK);
    r->state = nt_touch_start(&r->touch, 0.0, 0.0, 0.0);
}

/* One tick: the stage stands where it was told to last, the deflection shows its noise. */
static void tick(rig *r)
{
    const double deflection = r->sample.deflection[NT_Z];
    r->sample.stage_position[NT_Z] = r->command.stage_position[NT_Z];
    r->sample.deflection[NT_Z] += r->noise * nt_random_normal(&r->random);
    nt_touch_step(&r->touch, &r->state, &r->sample, &r->command);
    r->sample.deflection[NT_Z] = deflection;
    r->fastest_force = larger(r->fastest_force, fabs(r->command.motor_force[NT_Z] - r->last_force));
    r->fastest_stage = larger(r->fastest_stage, fabs(r->command.stage_position[NT_Z] - r->last_stage));
    r->last_force = r->command.motor_force[NT_Z];
    r->last_stage = r->command.stage_position[NT_Z];
    r->sample.tick++;
}

/* Pressing with 2 N against a scaled force of 1.8 N for half a second: engaged, the motor busy. */
static void press(rig *r)
{
    r->sample.operator_force[NT_Z] = 2.0;
    r->sample.deflection[NT_Z] = 1.8 / r->touch.settings.gains.alpha_f / r->touch.rig.probe.spring_constant;
    for (int i = 0; i < 5000; i++) {
        r->sample.master_position[NT_Z] += 1e-3 * ONE_TICK; /* slower than the stage can go */
        tick(r);
    }
    assert_int_equal(r->command.state, NT_RUN);
    assert_true(r->command.motor_force[NT_Z] < -1.0);
    r->fastest_force = r->fastest_stage = 0.0;
}

static void the_law_of_motor_and_stage_in_run(void **state)
{
    (void)state;
    rig r;
    set_up(&r, NT_MODE_TOUCH);
    press(&r);
    for (int i = 0; i < 5000; i++)
        tick(&r); /* the master stands: all has settled */
    const nt_gains *gains = &r.touch.settings.gains;
    /* Eq. 17 by hand: -1.8 - 2 (1.8 - 2.0) N; the noise of 1 nm makes (1 + K_f) alpha_f k_c 1 nm = 0.074 N */
    assert_true(fabs(r.command.motor_force[NT_Z] + 1.4) < 5 * 0.075);
    assert_true(fabs(r.command.stage_position[NT_Z] - gains->alpha_p * r.sample.master_position[NT_Z]) < 1e-14);
    assert_int_equal(r.command.reasons, 0);
}

static void the_force_fades_in(void **state)
{
    (void)state;
    rig r;
    set_up(&r, NT_MODE_TOUCH);
    r.sample.deflection[NT_Z] = 1.0 / r.touch.settings.gains.alpha_f / r.touch.rig.probe.spring_constant;
    for (int i = 1; i <= 1500; i++) { /* 0.1 s by default: in proportion */
        tick(&r);
        const double share = smaller(1.0, i * ONE_TICK / 0.1);
        assert_true(fabs(r.command.motor_force[NT_Z] + 3.0 * share) < 5 * 0.075);
    }
}

/* Each fault that stops the coupling: the force is gone after 50 ms, at no time a step beyond the motor's rate. */
static void a_stop_fades_the_force_without_a_step(void **state)
{
    (void)state;
    for (int fault = 0; fault < 4; fault++) {
        rig r;
        set_up(&r, NT_MODE_TOUCH);
        press(&r);
        const double before = r.command.motor_force[NT_Z];
        if (fault == 0)
            r.sample.flags = NT_SAMPLE_EMERGENCY_STOP;
        if (fault == 1)
            r.sample.flags = NT_SAMPLE_LIMIT_SWITCH;
        if (fault == 2)
            r.sample.age = 6.0 * ONE_TICK;
        if (fault == 3)
            r.sample.operator_force[NT_Z] = NAN;
        tick(&r); /* the same tick for 0..2, the second bad sample for 3 */
        assert_int_equal(r.command.state, fault == 0 ? NT_LATCHED : fault == 3 ? NT_HOLD : NT_RETRACT);
        for (int i = 1; i < FADE + 30; i++) {
            const double was = fabs(r.command.motor_force[NT_Z]);
            tick(&r);
            assert_true(r.command.state >= NT_RETRACT);
            assert_true(fabs(r.command.motor_force[NT_Z]) <= smaller(was, fabs(before)));
            if (i > FADE)
                assert_true(r.command.motor_force[NT_Z] == 0.0);
        }
        assert_true(r.fastest_force <= r.touch.settings.limits.motor_rate * ONE_TICK * (1.0 + 1e-12));
        assert_true(r.fastest_force < 0.1); /* far from a step of 1.4 N */
    }
}

static void retract_is_bounded_in_distance_and_speed(void **state)
{
    (void)state;
    rig r;
    set_up(&r, NT_MODE_TOUCH);
    press(&r);
    const double from = r.state.reference, stage = r.command.stage_position[NT_Z];
    r.sample.deflection[NT_Z] = r.touch.settings.limits.force / r.touch.rig.probe.spring_constant + 10e-9;
    tick(&r);
    assert_int_equal(r.command.state, NT_RETRACT); /* the same tick */
    assert_true(r.state.reference < from);
    r.sample.deflection[NT_Z] = 0.0; /* free: no noise hides that */
    r.noise = 0.1e-9;
    for (int i = 0; i < 20000; i++)
        tick(&r);
    const nt_limits *limits = &r.touch.settings.limits;
    assert_true(fabs(from - r.state.reference - limits->retract_distance) < 1e-15);
    assert_true(fabs(stage - r.command.stage_position[NT_Z] - limits->retract_distance) < 2e-9);
    /* the damped stage loop overshoots a change of speed by 4.6 % of it */
    assert_true(r.fastest_stage < 1.05 * limits->retract_speed * ONE_TICK);
    assert_int_equal(r.command.state, NT_RETRACT); /* and stays until armed */
}

static void hold_keeps_z(void **state)
{
    (void)state;
    rig r;
    set_up(&r, NT_MODE_TOUCH);
    press(&r);
    for (int i = 0; i < 2000; i++)
        tick(&r);
    const double stage = r.command.stage_position[NT_Z];
    r.sample.age = 3.0 * ONE_TICK;
    for (int i = 0; i < 1000; i++) {
        r.sample.master_position[NT_Z] += 5e-3 * ONE_TICK; /* the operator moves on, uncoupled */
        tick(&r);
        assert_int_equal(r.command.state, NT_HOLD);
        assert_true(fabs(r.command.stage_position[NT_Z] - stage) < 1e-13);
    }
}

/* Emergency stop, the operator moves elsewhere, release, arm, go on: no step of the stage, ever. */
static void arming_needs_confirmation_and_is_bumpless(void **state)
{
    (void)state;
    rig r;
    set_up(&r, NT_MODE_TOUCH);
    press(&r);
    r.sample.flags = NT_SAMPLE_EMERGENCY_STOP;
    r.sample.deflection[NT_Z] = 0.0; /* free: no noise hides that */
    r.noise = 0.1e-9;
    for (int i = 0; i < 3000; i++) {
        r.sample.master_position[NT_Z] -= 2e-3 * ONE_TICK;
        tick(&r);
        assert_int_equal(r.command.state, NT_LATCHED);
    }
    assert_int_equal(nt_touch_arm(&r.state, 0), NT_E_STATE);
    assert_int_equal(nt_touch_arm(&r.state, 1), NT_OK);
    tick(&r);
    assert_int_equal(r.command.state, NT_LATCHED); /* still pressed */
    r.sample.flags = 0;
    tick(&r);
    assert_int_equal(r.command.state, NT_LATCHED); /* no recovery by itself */
    assert_int_equal(r.command.reasons, NT_REASON_EMERGENCY_STOP);
    for (int i = 0; i < 3000; i++)
        tick(&r);
    const double stage = r.command.stage_position[NT_Z], master = r.sample.master_position[NT_Z];
    r.fastest_force = r.fastest_stage = 0.0;
    assert_int_equal(nt_touch_arm(&r.state, 1), NT_OK);
    r.sample.deflection[NT_Z] = 0.0;
    tick(&r);
    assert_int_equal(r.command.state, NT_RUN);
    assert_true(fabs(r.command.stage_position[NT_Z] - stage) < 1e-13);
    for (int i = 0; i < 3000; i++) {
        r.sample.master_position[NT_Z] += 1e-3 * ONE_TICK;
        tick(&r);
    }
    const double moved = r.touch.settings.gains.alpha_p * (r.sample.master_position[NT_Z] - master);
    assert_true(fabs(r.command.stage_position[NT_Z] - stage - moved) < 0.02 * moved); /* follows from where it stood */
    assert_true(r.fastest_stage < 1.1 * moved / 3000 && r.fastest_force < 0.4);
    /* RETRACT needs nobody at the rig */
    r.sample.flags = NT_SAMPLE_LIMIT_SWITCH;
    tick(&r);
    assert_int_equal(r.command.state, NT_RETRACT);
    assert_int_equal(nt_touch_arm(&r.state, 0), NT_OK);
}

/* 1e5 ticks of numbers of any kind: the command is always a number inside all limits. */
static void nonsense_never_gets_through(void **state)
{
    (void)state;
    static const double odd[] = {0.0, NAN, HUGE_VAL, -HUGE_VAL, 1e300, -1e300, 1e-300, 1.0, -1e-6};
    for (int mode = NT_MODE_TOUCH; mode <= NT_MODE_TOPOGRAPHY; mode++) {
        rig r;
        set_up(&r, (nt_mode)mode);
        nt_random random = nt_random_seed(17);
        const nt_limits *limits = &r.touch.settings.limits;
        for (int i = 0; i < 100000; i++) {
            double *fields[] = {&r.sample.age,
                                &r.sample.master_position[NT_Z],
                                &r.sample.operator_force[NT_Z],
                                &r.sample.deflection[NT_Z],
                                &r.sample.stage_position[NT_Z],
                                &r.sample.stage_position[NT_X]};
            memset(&r.sample, 0, sizeof r.sample);
            for (int j = 0; j < 6; j++)
                *fields[j] = nt_random_uniform(&random) < 0.1 ? odd[(int)(9 * nt_random_uniform(&random))]
                                                              : 1e-6 * nt_random_normal(&random);
            const double before = r.command.stage_position[NT_Z], force = r.command.motor_force[NT_Z];
            nt_touch_step(&r.touch, &r.state, &r.sample, &r.command);
            assert_true(fabs(r.command.motor_force[NT_Z]) <= limits->motor_force); /* and a number */
            assert_true(fabs(r.command.motor_force[NT_Z] - force) <= limits->motor_rate * ONE_TICK * (1.0 + 1e-12));
            assert_true(fabs(r.command.stage_position[NT_Z]) <= 0.5 * r.touch.rig.stage.travel);
            /* the reference goes 2 nm, the integral 0.6 % of a follow error of 0.1 um, the notch overshoots by 5 % */
            assert_true(fabs(r.command.stage_position[NT_Z] - before) < 1.1 * (2e-9 + 0.6e-9));
            if (i % 50 == 0)
                assert_int_equal(nt_touch_arm(&r.state, 1), NT_OK);
        }
    }
}

/* Step and state are plain numbers: a copy does the same to the last bit. */
static void a_copied_state_gives_the_same_commands(void **state)
{
    (void)state;
    rig r;
    set_up(&r, NT_MODE_TOUCH);
    press(&r);
    rig copy = r;
    for (int i = 0; i < 2000; i++) {
        r.sample.master_position[NT_Z] = copy.sample.master_position[NT_Z] = 1e-4 * sin(0.01 * i);
        tick(&r);
        tick(&copy);
        assert_memory_equal(&r.command, &copy.command, sizeof r.command);
    }
}

static void lateral_motion_is_straight_and_limited(void **state)
{
    (void)state;
    rig r;
    set_up(&r, NT_MODE_TOUCH);
    const double *at = r.command.stage_position;
    assert_int_equal(nt_touch_aim(&r.touch, &r.state, 3e-6, 4e-6, 1.0), NT_OK); /* 5 um/s */
    for (int i = 1; i <= 12000; i++) {
        tick(&r);
        const double share = smaller(1.0, i * ONE_TICK);
        assert_true(fabs(at[NT_X] - 3e-6 * share) < 1e-15 && fabs(at[NT_Y] - 4e-6 * share) < 1e-15);
    }
    assert_int_equal(nt_touch_aim(&r.touch, &r.state, 27e-6, 36e-6, 0.0), NT_OK); /* at once: no, 20 um/s */
    for (int i = 0; i < 10000; i++) {
        const double x = at[NT_X], y = at[NT_Y];
        tick(&r);
        assert_true(hypot(at[NT_X] - x, at[NT_Y] - y) <= 20e-6 * ONE_TICK * (1.0 + 1e-9));
    }
    r.sample.flags = NT_SAMPLE_LIMIT_SWITCH; /* half-way: stops, and stays when armed */
    tick(&r);
    const double stopped_x = r.command.stage_position[NT_X], stopped = r.command.stage_position[NT_Y];
    r.sample.flags = 0;
    assert_int_equal(nt_touch_arm(&r.state, 0), NT_OK);
    for (int i = 0; i < 1000; i++)
        tick(&r);
    assert_int_equal(r.command.state, NT_RUN);
    assert_true(at[NT_X] == stopped_x && at[NT_Y] == stopped && stopped < 25e-6);
    assert_int_equal(nt_touch_aim(&r.touch, &r.state, NAN, 0.0, 0.0), NT_E_NOT_FINITE);
    assert_int_equal(nt_touch_aim(&r.touch, &r.state, 0.0, 0.0, HUGE_VAL), NT_E_NOT_FINITE);
    assert_int_equal(nt_touch_aim(&r.touch, &r.state, 0.0, 0.0, -1.0), NT_E_RANGE);
}

/* A stage that is asked for more than its limits goes at its limit and says so; that is no fault. */
static void commands_are_limited_and_flagged(void **state)
{
    (void)state;
    rig r;
    set_up(&r, NT_MODE_TOUCH);
    r.sample.master_position[NT_Z] = 5e-3; /* 0.1 um at once */
    tick(&r);
    assert_int_equal(r.command.state, NT_RUN);
    assert_int_equal(r.command.reasons, NT_REASON_COMMAND_LIMITED);
    assert_true(fabs(r.state.reference - 20e-6 * ONE_TICK) < 1e-20);
    for (int i = 0; i < 100; i++)
        tick(&r);
    assert_int_equal(r.command.reasons, 0);
    r.sample.operator_force[NT_Z] = 5.0; /* the gauge at its range */
    tick(&r);
    assert_int_equal(r.command.state, NT_RUN);
    assert_int_equal(r.command.reasons, NT_REASON_OPERATOR_CLIPPED);
}

/* On a spring of 4 N/m the height servo comes to the set force and keeps it when the surface rises; the master is drawn
 * to the height. */
static void topography_holds_the_set_force(void **state)
{
    (void)state;
    rig r;
    set_up(&r, NT_MODE_TOPOGRAPHY);
    const nt_gains *gains = &r.touch.settings.gains;
    double surface = 50e-9; /* in stage travel */
    for (int i = 0; i < 40000; i++) {
        if (i > 20000)
            surface = 50e-9 - 30e-9 * smaller(1.0, (i - 20000) * ONE_TICK);
        /* probe 8 N/m in series with the sample's 4 N/m: deflection is a third of the approach */
        r.sample.deflection[NT_Z] = larger(0.0, r.command.stage_position[NT_Z] - surface) / 3.0;
        tick(&r);
        if ((i > 15000 && i < 20000) || i > 38000)
            assert_true(fabs(r.touch.rig.probe.spring_constant * r.sample.deflection[NT_Z] - gains->set_point) <
                        0.02 * gains->set_point);
    }
    assert_int_equal(r.command.state, NT_RUN);
    const double height = r.state.reference / gains->alpha_p;
    assert_true(fabs(r.command.motor_force[NT_Z] - smaller(5.0, 3000.0 * (height - r.sample.master_position[NT_Z]))) <
                0.01);
}

static void what_the_rig_cannot_keep_is_refused(void **state)
{
    (void)state;
    const nt_rig paper = nt_rig_defaults();
    const nt_settings good = nt_settings_defaults(&paper);
    nt_touch touch = {.period = 42.0};
    nt_problem problem = {0};
    nt_settings bad = good;
    bad.limits.force = 1.01 * paper.probe.spring_constant * nt_probe_deflection_range(&paper.probe);
    assert_int_equal(nt_touch_make(&touch, &paper, &bad, NT_MODE_TOUCH, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "limits.force");
    bad = good;
    bad.limits.motor_force = 5.001;
    assert_int_equal(nt_touch_make(&touch, &paper, &bad, NT_MODE_TOUCH, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "limits.motor_force");
    bad = good;
    bad.limits.stage_speed = 1.01 * paper.stage.max_speed;
    assert_int_equal(nt_touch_make(&touch, &paper, &bad, NT_MODE_TOUCH, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "limits.stage_speed");
    nt_rig broken = paper;
    broken.probe.spring_constant = 0.0;
    assert_int_equal(nt_touch_make(&touch, &broken, &good, NT_MODE_TOUCH, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "probe.spring_constant");
    assert_int_equal(nt_touch_make(&touch, &paper, &good, (nt_mode)7, &problem), NT_E_ARGUMENT);
    assert_true(touch.period == 42.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_law_of_motor_and_stage_in_run),
        cmocka_unit_test(the_force_fades_in),
        cmocka_unit_test(a_stop_fades_the_force_without_a_step),
        cmocka_unit_test(retract_is_bounded_in_distance_and_speed),
        cmocka_unit_test(hold_keeps_z),
        cmocka_unit_test(arming_needs_confirmation_and_is_bumpless),
        cmocka_unit_test(nonsense_never_gets_through),
        cmocka_unit_test(a_copied_state_gives_the_same_commands),
        cmocka_unit_test(lateral_motion_is_straight_and_limited),
        cmocka_unit_test(commands_are_limited_and_flagged),
        cmocka_unit_test(topography_holds_the_set_force),
        cmocka_unit_test(what_the_rig_cannot_keep_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
