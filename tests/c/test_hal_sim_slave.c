/* SPDX-License-Identifier: BSD-3-Clause
 * The simulated slave by itself: the same readings as beside a master, on the clock of whoever opens it, and what it
 * says of itself. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/rig.h"
#include "hal/sim/sim.h"
#include "nanotouch/advanced/sim.h"

#define T 1e-4
static nt_plan plan;
static nt_rig rig;

static int make_plan(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    const nt_plan_inputs inputs = {.scene = &scene};
    rig = nt_rig_defaults();
    return nt_plan_make(&plan, &inputs, NULL) != NT_OK;
}

static nt_sim_setup setup_of(uint64_t seed)
{
    return (nt_sim_setup){.plan = &plan, .rig = &rig, .period = T, .clearance = 20e-9, .seed = seed};
}

static void the_master_takes_no_part(void **state)
{
    (void)state;
    const nt_sim_setup setup = setup_of(5);
    nt_sim_slave alone;
    nt_sim both;
    assert_int_equal(nt_sim_slave_init(&alone, &setup), NT_OK);
    assert_int_equal(nt_sim_init(&both, &setup), NT_OK);
    int touched = 0;
    for (int i = 0; i < 4000; i++) {
        const nt_command command = {.motor_force = {[NT_Z] = cos(0.02 * i)},
                                    .stage_position = {1e-12 * i, -2e-12 * i, 60e-9 * sin(0.0008 * i)}};
        nt_action action = {.size = sizeof action};
        for (int k = 0; k < NT_AXES; k++)
            action.target[k] = command.stage_position[k];
        nt_sample sample;
        nt_reading reading = {0};
        assert_int_equal(nt_sim_read(&both, &sample), NT_OK);
        assert_int_equal(nt_sim_slave_read(&alone, &reading), NT_OK);
        for (int k = 0; k < NT_AXES; k++) {
            assert_true(reading.position[k] == sample.stage_position[k]);
            assert_true(k == NT_Z ? reading.felt[k] == sample.deflection[k]
                                  : isnan(reading.felt[k]) && isnan(sample.deflection[k]));
        }
        assert_int_equal(nt_sim_write(&both, &command), NT_OK);
        assert_int_equal(nt_sim_slave_write(&alone, &action), NT_OK);
        touched |= alone.truth.contact_radius > 0.0;
    }
    assert_true(touched);
}

static int64_t host_now(const nt_host *host)
{
    return *(const int64_t *)host->context;
}

static void it_stamps_by_its_hosts_clock(void **state)
{
    (void)state;
    const nt_sim_setup setup = setup_of(1);
    int64_t now = 123456789;
    const nt_host host = {sizeof host, NT_HAL_API_VERSION, host_now, NULL, &now};
    nt_sim_slave slave;
    assert_int_equal(nt_sim_slave_init(&slave, &setup), NT_OK);
    const nt_hal_choice choice = {nt_sim_slave_backend(), &slave};
    nt_hal hal;
    assert_int_equal(nt_hal_open(&hal, NT_HALF_SLAVE, &choice, &host, NULL), NT_OK);
    assert_int_equal(hal.capabilities.can, NT_CAN_FEEL);
    assert_int_equal(hal.capabilities.axes, NT_AXES);
    uint64_t last = 0;
    for (int i = 0; i < 10; i++, now += 777) {
        assert_int_equal(nt_hal_read(&hal), NT_OK);
        assert_int_equal(hal.reading.time, now);
        assert_true(hal.reading.sequence > last);
        last = hal.reading.sequence;
        const nt_action action = {.size = sizeof action};
        assert_int_equal(nt_hal_write(&hal, &action), NT_OK);
    }
    nt_hal_close(&hal);
}

/* No time passes for what is not a number. */
static void an_action_that_is_not_a_number_is_refused(void **state)
{
    (void)state;
    const nt_sim_setup setup = setup_of(1);
    nt_sim_slave slave;
    assert_int_equal(nt_sim_slave_init(&slave, &setup), NT_OK);
    for (int i = 0; i < NT_AXES; i++) {
        nt_action action = {.size = sizeof action};
        action.target[i] = i ? (double)NAN : HUGE_VAL;
        assert_int_equal(nt_sim_slave_write(&slave, &action), NT_E_NOT_FINITE);
        assert_int_equal(slave.link.tick, 0);
    }
}

/* Deflection as read with this fault, pressed as far as the stage goes: far beyond the range. */
static nt_reading press_with(const nt_fault *fault, double *truth)
{
    nt_faults faults = {.count = 0};
    nt_sim_setup setup = setup_of(3);
    setup.faults = &faults;
    assert_int_equal(nt_faults_add(&faults, fault), NT_OK);
    nt_sim_slave slave;
    assert_int_equal(nt_sim_slave_init(&slave, &setup), NT_OK);
    const nt_action action = {.size = sizeof action, .target[NT_Z] = 4e-6};
    nt_reading reading = {0};
    for (int i = 0; i < 4000; i++) {
        assert_int_equal(nt_sim_slave_read(&slave, &reading), NT_OK);
        *truth = slave.cantilever.deflection;
        assert_int_equal(nt_sim_slave_write(&slave, &action), NT_OK);
    }
    return reading;
}

/* What an amplifier or a zero does comes before the converter, which clips what it is given: a reading at the end of
 * its range is not led away from it, and a lost gain is read beyond it. */
static void faults_of_a_signal_are_clipped_too(void **state)
{
    (void)state;
    const double range = nt_probe_deflection_range(&rig.probe);
    const nt_fault faults[] = {{NT_FAULT_DRIFT, NT_CHANNEL_DEFLECTION, 0.0, HUGE_VAL, -0.1 * range},
                               {NT_FAULT_SLIP, NT_CHANNEL_DEFLECTION, 0.0, HUGE_VAL, -0.1 * range},
                               {NT_FAULT_GAIN, NT_CHANNEL_DEFLECTION, 0.0, HUGE_VAL, 0.5}};
    double truth = 0.0;
    for (int i = 0; i < 3; i++) {
        assert_true(press_with(&faults[i], &truth).felt[NT_Z] == range);
        assert_true(truth > 3.0 * range);
    }
    const nt_fault lost = {NT_FAULT_GAIN, NT_CHANNEL_DEFLECTION, 0.0, HUGE_VAL, 0.05};
    const double read = press_with(&lost, &truth).felt[NT_Z];
    assert_true(fabs(read - 0.05 * truth) < rig.probe.sensitivity * (rig.probe.noise + rig.probe.resolution));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_master_takes_no_part),
        cmocka_unit_test(it_stamps_by_its_hosts_clock),
        cmocka_unit_test(an_action_that_is_not_a_number_is_refused),
        cmocka_unit_test(faults_of_a_signal_are_clipped_too),
    };
    return cmocka_run_group_tests(tests, make_plan, NULL);
}
