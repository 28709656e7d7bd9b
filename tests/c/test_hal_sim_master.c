/* SPDX-License-Identifier: BSD-3-Clause
 * The simulated master by itself: what holds it, how often it is read, what it says of itself, and that it knows
 * nothing of the slave. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "hal/sim/sim.h"
#include "nanotouch/advanced/sim.h"

#define T 1e-4
static nt_plan plan;

static int make_plan(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    const nt_plan_inputs inputs = {.scene = &scene};
    return nt_plan_make(&plan, &inputs, NULL) != NT_OK;
}

static nt_rig exact_rig(void)
{
    nt_rig rig = nt_rig_defaults();
    rig.master.resolution = rig.master.gauge_noise = rig.master.gauge_resolution = 0.0;
    return rig;
}

static nt_sim_master master_of(const nt_rig *rig)
{
    const nt_sim_setup setup = {
        .plan = &plan, .rig = rig, .period = T, .clearance = 50e-9, .seed = 3, .master_position = 1e-3};
    nt_sim_master master;
    assert_int_equal(nt_sim_master_init(&master, &setup), NT_OK);
    return master;
}

static nt_reading tick(nt_sim_master *master, double motor_force)
{
    nt_reading reading = {0};
    const nt_action action = {.size = sizeof action, .target = {[NT_Z] = motor_force}};
    assert_int_equal(nt_sim_master_read(master, &reading), NT_OK);
    assert_int_equal(nt_sim_master_write(master, &action), NT_OK);
    return reading;
}

/* Straight to its place from where the arm was, whatever the motor does; then it stays. */
static void a_hand_that_holds_moves_the_arm(void **state)
{
    (void)state;
    nt_rig rig = exact_rig();
    rig.master.axes = 3.0;
    nt_sim_master master = master_of(&rig);
    for (int i = 0; i < 500; i++)
        (void)tick(&master, 2.0); /* it has gone somewhere */
    const double from = tick(&master, 2.0).position[NT_Z];
    const double start = master.arm[NT_Z].position;
    assert_true(from > 1e-3);
    const nt_hand_target target = {.position = {1e-4, -2e-4, 3e-3}, .holds = 1, .duration = 1000 * T};
    nt_sim_aim_hand(&master, &target);
    for (int i = 0; i <= 1200; i++) {
        const double share = i < 1000 ? i / 1000.0 : 1.0;
        const nt_reading reading = tick(&master, i % 2 ? 5.0 : -5.0);
        assert_true(fabs(reading.position[NT_Z] - (start + share * (3e-3 - start))) < 1e-15);
        assert_true(fabs(reading.position[NT_X] - share * 1e-4) < 1e-16);
        assert_true(fabs(reading.position[NT_Y] + share * 2e-4) < 1e-16);
    }
    const nt_hand_target lets_go = {.holds = 0};
    nt_sim_aim_hand(&master, &lets_go);
    for (int i = 0; i < 1000; i++)
        (void)tick(&master, -1.0);
    assert_true(tick(&master, -1.0).position[NT_Z] < 3e-3 - 1e-4); /* the motor moves it again */
}

static void a_hand_cannot_leave_the_travel(void **state)
{
    (void)state;
    const nt_rig rig = exact_rig();
    nt_sim_master master = master_of(&rig);
    const nt_hand_target target = {.position = {[NT_Z] = 1.0}, .holds = 1};
    nt_sim_aim_hand(&master, &target);
    (void)tick(&master, 0.0);
    assert_true(tick(&master, 0.0).position[NT_Z] == 0.5 * rig.master.travel);
}

/* A mouse of 125 Hz on a loop of 10 kHz: a new reading in each 80th tick, held in between, its time that of the
 * measurement. */
static void it_is_read_at_its_own_rate(void **state)
{
    (void)state;
    nt_rig rig = exact_rig();
    rig.master.rate = 125.0;
    nt_sim_master master = master_of(&rig);
    nt_reading last = {0};
    for (int i = 0; i < 800; i++) {
        const nt_reading reading = tick(&master, 1.0);
        assert_int_equal(reading.time, llround(i / 80 * 80 * T * 1e9));
        assert_int_equal(reading.sequence != last.sequence, i % 80 == 0);
        if (i % 80 != 0)
            assert_true(reading.position[NT_Z] == last.position[NT_Z] && reading.felt[NT_Z] == last.felt[NT_Z]);
        else
            assert_true(reading.sequence > last.sequence && reading.position[NT_Z] != last.position[NT_Z]);
        last = reading;
    }
}

static void it_says_what_it_can_do(void **state)
{
    (void)state;
    nt_rig rig = exact_rig();
    for (int kind = 0; kind < 4; kind++) {
        rig.master.gauge = kind & 1;
        rig.master.motor = kind >> 1;
        rig.master.axes = kind == 3 ? 3.0 : 1.0;
        rig.master.rate = kind == 3 ? 500.0 : 0.0;
        nt_sim_master master = master_of(&rig);
        const nt_hal_choice choice = {nt_sim_master_backend(), &master};
        nt_hal hal;
        assert_int_equal(nt_hal_open(&hal, NT_HALF_MASTER, &choice, NULL, NULL), NT_OK);
        assert_int_equal(hal.capabilities.can, (kind & 1 ? NT_CAN_FEEL : 0u) | (kind >> 1 ? NT_CAN_PUSH : 0u));
        assert_int_equal(hal.capabilities.axes, kind == 3 ? 3 : 1);
        assert_true(hal.capabilities.period == (kind == 3 ? 1.0 / 500.0 : 0.0));
        nt_hal_close(&hal);
        assert_int_equal(nt_hal_open(&hal, NT_HALF_SLAVE, &choice, NULL, NULL), NT_E_UNSUPPORTED);
    }
}

/* Alone it reads what it reads beside a slave, its noise too. */
static void the_slave_takes_no_part(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    const nt_sim_setup setup = {
        .plan = &plan, .rig = &rig, .period = T, .clearance = 50e-9, .seed = 3, .master_position = 1e-3};
    nt_sim_master alone = master_of(&rig);
    nt_sim both;
    assert_int_equal(nt_sim_init(&both, &setup), NT_OK);
    for (int i = 0; i < 2000; i++) {
        const double force = sin(0.01 * i);
        const nt_command command = {.motor_force = {[NT_Z] = force}, .stage_position = {[NT_Z] = 50e-11 * i}};
        nt_sample sample;
        assert_int_equal(nt_sim_read(&both, &sample), NT_OK);
        assert_int_equal(nt_sim_write(&both, &command), NT_OK);
        const nt_reading reading = tick(&alone, force);
        assert_true(reading.position[NT_Z] == sample.master_position[NT_Z]);
        assert_true(reading.felt[NT_Z] == sample.operator_force[NT_Z]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hand_that_holds_moves_the_arm), cmocka_unit_test(a_hand_cannot_leave_the_travel),
        cmocka_unit_test(it_is_read_at_its_own_rate),      cmocka_unit_test(it_says_what_it_can_do),
        cmocka_unit_test(the_slave_takes_no_part),
    };
    return cmocka_run_group_tests(tests, make_plan, NULL);
}
