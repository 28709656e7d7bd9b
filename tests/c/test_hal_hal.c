/* SPDX-License-Identifier: BSD-3-Clause
 * One half of a rig behind a backend that writes down what it is asked, and two halves as one sample. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "device_fixture.h"
#include "hal/hal.h"

static void calls_come_in_their_order(void **state)
{
    (void)state;
    const nt_backend backend = backend_of(NT_HALF_SLAVE);
    device d = {.next = reading_of(1)};
    nt_hal hal;
    assert_int_equal(open_half(&hal, &backend, &d), NT_OK);
    const nt_configuration configuration = {
        .size = sizeof configuration, .period = 1e-4, .lift = 1e-6, .option = "/dev/null"};
    assert_int_equal(nt_hal_configure(&hal, &configuration, NULL), NT_OK);
    assert_true(d.told_first.period == 1e-4 && d.told_first.lift == 1e-6);
    assert_string_equal(d.told_first.option, "/dev/null");
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    assert_int_equal(d.size, sizeof(nt_reading));
    const nt_action action = {.size = sizeof action, .tick = 7, .target = {1.0, 2.0, 3.0}};
    assert_int_equal(nt_hal_write(&hal, &action), NT_OK);
    assert_memory_equal(&d.told, &action, sizeof action);
    nt_hal_disarm(&hal);
    nt_hal_disarm(&hal); /* not armed any more */
    nt_hal_close(&hal);
    nt_hal_close(&hal);
    nt_hal_close(NULL);
    assert_string_equal(d.calls, "odcarwDC");
    assert_int_equal(nt_hal_read(&hal), NT_E_STATE);
    assert_int_equal(nt_hal_write(&hal, &action), NT_E_STATE);
    assert_int_equal(nt_hal_configure(&hal, &configuration, NULL), NT_E_STATE);
    assert_int_equal(nt_hal_arm(&hal), NT_E_STATE);
}

static void close_disarms_what_is_armed(void **state)
{
    (void)state;
    const nt_backend backend = backend_of(NT_HALF_MASTER);
    device d = {0};
    nt_hal hal;
    assert_int_equal(open_half(&hal, &backend, &d), NT_OK);
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
    nt_hal_close(&hal);
    assert_string_equal(d.calls, "odaDC");
    d = (device){.arms = NT_E_DEVICE};
    assert_int_equal(open_half(&hal, &backend, &d), NT_OK);
    assert_int_equal(nt_hal_arm(&hal), NT_E_DEVICE);
    nt_hal_close(&hal); /* what was not armed is closed, not disarmed */
    assert_string_equal(d.calls, "odaC");
}

static void a_failed_open_is_closed(void **state)
{
    (void)state;
    const nt_backend backend = backend_of(NT_HALF_MASTER);
    nt_hal hal = {.is_armed = 42};
    device d = {.opens = NT_E_DEVICE};
    const nt_hal_choice choice = {&backend, &d};
    nt_problem problem = {0};
    assert_int_equal(nt_hal_open(&hal, NT_HALF_MASTER, &choice, NULL, &problem), NT_E_DEVICE);
    assert_string_equal(problem.field, "no such line");
    assert_string_equal(d.calls, "oC");
    d = (device){.describes = NT_E_UNSUPPORTED};
    assert_int_equal(open_half(&hal, &backend, &d), NT_E_UNSUPPORTED);
    assert_string_equal(d.calls, "odC");
    assert_int_equal(hal.is_armed, 42); /* untouched */
    d = (device){.configures = NT_E_RANGE};
    assert_int_equal(open_half(&hal, &backend, &d), NT_OK);
    const nt_configuration configuration = {.size = sizeof configuration};
    assert_int_equal(nt_hal_configure(&hal, &configuration, NULL), NT_E_RANGE);
    nt_hal_close(&hal);
    assert_string_equal(d.calls, "odcC");
}

static void incomplete_or_foreign_backends_are_refused(void **state)
{
    (void)state;
    device d = {0};
    nt_hal hal;
    const nt_backend good = backend_of(NT_HALF_MASTER);
    nt_backend broken = good;
    const nt_hal_choice none = {NULL, &d}, other = {&good, &d};
    assert_int_equal(nt_hal_open(&hal, NT_HALF_MASTER, &none, NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_hal_open(&hal, NT_HALF_SLAVE, &other, NULL, NULL), NT_E_UNSUPPORTED);
    broken.read = NULL;
    assert_int_equal(open_half(&hal, &broken, &d), NT_E_ARGUMENT);
    broken = good;
    broken.write = NULL;
    assert_int_equal(open_half(&hal, &broken, &d), NT_E_ARGUMENT);
    broken = good;
    broken.version++;
    assert_int_equal(open_half(&hal, &broken, &d), NT_E_UNSUPPORTED);
    broken = good;
    broken.size -= 8;
    assert_int_equal(open_half(&hal, &broken, &d), NT_E_UNSUPPORTED);
    assert_string_equal(d.calls, ""); /* none of them was called */
}

static void read_and_write_are_all_that_is_needed(void **state)
{
    (void)state;
    device d = {.next = reading_of(1)};
    const nt_backend least = {.size = sizeof least,
                              .version = NT_HAL_API_VERSION,
                              .name = "least",
                              .half = NT_HALF_SLAVE,
                              .read = read_device,
                              .write = write_device,
                              .context = &d};
    nt_hal hal;
    assert_int_equal(open_half(&hal, &least, NULL), NT_OK); /* the backend's own context */
    assert_int_equal(hal.capabilities.axes, 1);
    assert_int_equal(hal.capabilities.can, NT_CAN_FEEL | NT_CAN_PUSH);
    const nt_configuration configuration = {.size = sizeof configuration};
    assert_int_equal(nt_hal_configure(&hal, &configuration, NULL), NT_OK);
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    nt_hal_close(&hal);
    assert_string_equal(d.calls, "r");
}

static void what_a_half_says_of_itself_is_checked(void **state)
{
    (void)state;
    static const nt_channel_row row = {.name = "x", .unit = "m", .minimum = -1.0, .maximum = 1.0, .safe = (double)NAN};
    const nt_backend backend = backend_of(NT_HALF_MASTER);
    const nt_capabilities good = {
        .size = sizeof good, .can = NT_CAN_PUSH, .axes = 3, .rows = 1, .channels = &row, .period = 8e-3};
    struct {
        nt_capabilities says;
        const char *field;
    } cases[6];
    for (int i = 0; i < 6; i++)
        cases[i].says = good;
    cases[0].says.axes = 0, cases[0].field = "capabilities.axes";
    cases[1].says.axes = 4, cases[1].field = "capabilities.axes";
    cases[2].says.period = -1e-3, cases[2].field = "capabilities.period";
    cases[3].says.period = (double)NAN, cases[3].field = "capabilities.period";
    cases[4].says.period = 1.1, cases[4].field = "capabilities.period";
    cases[5].says.channels = NULL, cases[5].field = "capabilities.rows";
    for (int i = 0; i < 6; i++) {
        device d = {.describes_itself = 1, .says = cases[i].says};
        const nt_hal_choice choice = {&backend, &d};
        nt_hal hal;
        nt_problem problem = {0};
        const nt_status expected = isnan(d.says.period) ? NT_E_NOT_FINITE : NT_E_RANGE;
        assert_int_equal(nt_hal_open(&hal, NT_HALF_MASTER, &choice, NULL, &problem), expected);
        assert_string_equal(problem.field, cases[i].field);
        assert_string_equal(d.calls, "odC");
    }
    device d = {.describes_itself = 1, .says = good};
    nt_hal hal;
    assert_int_equal(open_half(&hal, &backend, &d), NT_OK);
    assert_memory_equal(&hal.capabilities, &good, sizeof good);
    nt_hal_close(&hal);
}

static void expect_number(const nt_hal *hal, double at)
{
    for (int i = 0; i < NT_AXES; i++) {
        assert_true(hal->reading.position[i] == (i + 1) * at);
        assert_true(hal->reading.felt[i] == (i + 4) * at);
    }
    assert_int_equal(hal->reading.flags, 0);
}

static void expect_nothing(const nt_hal *hal, uint32_t flags)
{
    for (int i = 0; i < NT_AXES; i++)
        assert_true(isnan(hal->reading.position[i]) && isnan(hal->reading.felt[i]));
    assert_int_equal(hal->reading.flags, flags);
    assert_int_equal(hal->reading.valid, 0);
}

/* Its age grows, the rest stays. */
static void a_reading_is_held_until_a_newer_one_comes(void **state)
{
    (void)state;
    const nt_backend hand = backend_of(NT_HALF_MASTER), probe = backend_of(NT_HALF_SLAVE);
    device d = {.next = reading_of(3)}, e = {.next = reading_of(8)};
    nt_hal master, slave;
    assert_int_equal(open_half(&master, &hand, &d), NT_OK);
    assert_int_equal(open_half(&slave, &probe, &e), NT_OK);
    for (int tick = 0; tick < 4; tick++) {
        nt_sample sample;
        assert_int_equal(nt_hal_sample(&master, &slave, (uint64_t)tick, 10000 + 500 * tick, &sample), NT_OK);
        expect_number(&master, 3.0);
        assert_true(sample.master_age == (7000 + 500 * tick) / 1e9);
        assert_true(sample.age == (2000 + 500 * tick) / 1e9);
        assert_true(sample.master_position[NT_Y] == 6.0 && sample.operator_force[NT_Z] == 18.0);
        assert_true(sample.stage_position[NT_X] == 8.0 && sample.deflection[NT_Z] == 48.0);
        assert_int_equal(sample.tick, tick);
        d.next.sequence = tick % 2 ? 3 : 0; /* the same again, or not a word */
    }
    d.next = reading_of(4);
    assert_int_equal(nt_hal_read(&master), NT_OK);
    expect_number(&master, 4.0);
}

static void a_sequence_that_runs_backwards_is_no_measurement(void **state)
{
    (void)state;
    const nt_backend backend = backend_of(NT_HALF_SLAVE);
    device d = {.next = reading_of(9)};
    nt_hal hal;
    assert_int_equal(open_half(&hal, &backend, &d), NT_OK);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    d.next = reading_of(8);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    expect_nothing(&hal, NT_SAMPLE_INVALID);
    d.next.sequence = 0; /* nothing comes: nothing is known */
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    expect_nothing(&hal, NT_SAMPLE_INVALID);
    d.next = reading_of(10);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    expect_number(&hal, 10.0);
}

static double channel_of(const nt_reading *reading, int channel)
{
    const double numbers[NT_READS] = {reading->position[0], reading->position[1], reading->position[2],
                                      reading->felt[0],     reading->felt[1],     reading->felt[2],
                                      reading->amplitude,   reading->lag};
    return numbers[channel];
}

static void what_is_not_valid_is_no_number(void **state)
{
    (void)state;
    const nt_backend backend = backend_of(NT_HALF_MASTER);
    device d = {0};
    nt_hal hal;
    assert_int_equal(open_half(&hal, &backend, &d), NT_OK);
    for (int channel = 0; channel < NT_READS; channel++) {
        d.next = reading_of((uint64_t)channel + 1u);
        d.next.valid = ALL & ~(1u << channel);
        assert_int_equal(nt_hal_read(&hal), NT_OK);
        for (int i = 0; i < NT_READS; i++) {
            const double value = channel_of(&hal.reading, i);
            if (i == channel)
                assert_true(isnan(value));
            else
                assert_true(value == (i + 1.0) * (channel + 1.0));
        }
    }
}

static void nothing_has_been_measured_before_the_first_reading(void **state)
{
    (void)state;
    const nt_backend backend = backend_of(NT_HALF_MASTER);
    device d = {0}; /* event-driven: says nothing yet */
    nt_hal hal;
    assert_int_equal(open_half(&hal, &backend, &d), NT_OK);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    expect_nothing(&hal, 0); /* no number: that is enough */
}

static void a_device_that_is_lost_shows_in_the_reading(void **state)
{
    (void)state;
    const uint32_t lost = NT_SAMPLE_DEVICE_LOST | NT_SAMPLE_INVALID;
    const nt_backend backend = backend_of(NT_HALF_SLAVE);
    const nt_action action = {.size = sizeof action};
    device d = {.next = reading_of(1)};
    nt_hal hal;
    assert_int_equal(open_half(&hal, &backend, &d), NT_OK);
    d.reads = NT_E_DEVICE;
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    expect_nothing(&hal, lost);
    d.reads = NT_OK;
    d.next = reading_of(2);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    expect_number(&hal, 2.0); /* it is there again */
    d.writes = NT_E_DEVICE;
    assert_int_equal(nt_hal_write(&hal, &action), NT_OK);
    d.next = reading_of(3);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    expect_nothing(&hal, lost);
    d.writes = NT_OK;
    assert_int_equal(nt_hal_write(&hal, &action), NT_OK);
    d.next = reading_of(4);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    expect_number(&hal, 4.0);
    d.reads = 77; /* no status that anybody knows: lost all the same */
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    expect_nothing(&hal, lost);
    d.reads = d.writes = NT_E_NO_CONVERGENCE;
    hal.is_model = 1; /* what fails in a model is for the caller */
    assert_int_equal(nt_hal_read(&hal), NT_E_NO_CONVERGENCE);
    assert_int_equal(nt_hal_write(&hal, &action), NT_E_NO_CONVERGENCE);
}

static void what_is_no_lateness_is_too_late(void **state)
{
    (void)state;
    const nt_backend backend = backend_of(NT_HALF_SLAVE);
    device d = {.next = reading_of(1)};
    nt_hal hal;
    assert_int_equal(open_half(&hal, &backend, &d), NT_OK);
    const double wrong[] = {NAN, -1.0, -INFINITY};
    for (int i = 0; i < 3; ++i) {
        d.next.lateness = wrong[i];
        assert_int_equal(nt_hal_read(&hal), NT_OK);
        assert_true(isinf(hal.reading.lateness));
    }
    d.next.lateness = 2e-6;
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    assert_true(hal.reading.lateness == 2e-6);
}

static void flags_and_lateness_of_both_halves_count(void **state)
{
    (void)state;
    const nt_backend hand = backend_of(NT_HALF_MASTER), probe = backend_of(NT_HALF_SLAVE);
    device d = {.next = reading_of(1)}, e = {.next = reading_of(2)};
    nt_hal master, slave;
    assert_int_equal(open_half(&master, &hand, &d), NT_OK);
    assert_int_equal(open_half(&slave, &probe, &e), NT_OK);
    d.next.flags = NT_SAMPLE_EMERGENCY_STOP;
    e.next.flags = NT_SAMPLE_LIMIT_SWITCH;
    e.next.lateness = 2e-5;
    nt_sample sample;
    assert_int_equal(nt_hal_sample(&master, &slave, 5, 2000, &sample), NT_OK);
    assert_int_equal(sample.flags, NT_SAMPLE_EMERGENCY_STOP | NT_SAMPLE_LIMIT_SWITCH);
    assert_true(sample.lateness == 2e-5 && sample.age == 0.0 && sample.master_age == 1e-6);
    d.next.lateness = 3e-5;
    assert_int_equal(nt_hal_sample(&master, &slave, 5, 2000, &sample), NT_OK);
    assert_true(sample.lateness == 3e-5);
    sample.tick = 77;
    slave.is_model = 1;
    e.reads = NT_E_NO_CONVERGENCE; /* then nothing is written */
    assert_int_equal(nt_hal_sample(&master, &slave, 5, 2000, &sample), NT_E_NO_CONVERGENCE);
    assert_int_equal(sample.tick, 77);
}

static void a_command_reaches_both_halves(void **state)
{
    (void)state;
    const nt_backend hand = backend_of(NT_HALF_MASTER), probe = backend_of(NT_HALF_SLAVE);
    device d = {0}, e = {0};
    nt_hal master, slave;
    assert_int_equal(open_half(&master, &hand, &d), NT_OK);
    assert_int_equal(open_half(&slave, &probe, &e), NT_OK);
    const nt_command command = {.motor_force = {1.0, 2.0, 3.0}, .stage_position = {4.0, 5.0, 6.0}, .state = NT_HOLD};
    nt_action action = {.size = sizeof action, .tick = 11, .time = 12};
    master.is_model = slave.is_model = 1;
    d.writes = NT_E_NOT_FINITE; /* the slave is told all the same */
    assert_int_equal(nt_hal_command(&master, &slave, &command, &action), NT_E_NOT_FINITE);
    assert_memory_equal(d.told.target, command.motor_force, sizeof command.motor_force);
    assert_memory_equal(e.told.target, command.stage_position, sizeof command.stage_position);
    assert_true(d.told.tick == 11 && e.told.time == 12 && d.told.state == NT_HOLD && e.told.state == NT_HOLD);
    d.writes = NT_OK;
    e.writes = NT_E_RANGE;
    assert_int_equal(nt_hal_command(&master, &slave, &command, &action), NT_E_RANGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calls_come_in_their_order),
        cmocka_unit_test(close_disarms_what_is_armed),
        cmocka_unit_test(a_failed_open_is_closed),
        cmocka_unit_test(incomplete_or_foreign_backends_are_refused),
        cmocka_unit_test(read_and_write_are_all_that_is_needed),
        cmocka_unit_test(what_a_half_says_of_itself_is_checked),
        cmocka_unit_test(a_reading_is_held_until_a_newer_one_comes),
        cmocka_unit_test(a_sequence_that_runs_backwards_is_no_measurement),
        cmocka_unit_test(what_is_not_valid_is_no_number),
        cmocka_unit_test(nothing_has_been_measured_before_the_first_reading),
        cmocka_unit_test(a_device_that_is_lost_shows_in_the_reading),
        cmocka_unit_test(what_is_no_lateness_is_too_late),
        cmocka_unit_test(flags_and_lateness_of_both_halves_count),
        cmocka_unit_test(a_command_reaches_both_halves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
