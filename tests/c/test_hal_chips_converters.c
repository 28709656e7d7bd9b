/* SPDX-License-Identifier: BSD-3-Clause
 * The slave on AD5791 and AD7606 against chips that are modelled on their own: what it reads and drives, how it begins
 * and ends, what each fault of the bus leads to. Then dice: random faults, random answers.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "converter_rig.h"
#include "host_fixture.h"
#include "nanotouch/hal.h"

static simulated_bus bus;
static nt_converter_half half;
static nt_hal hal;

static const nt_backend *slave(void)
{
    return nt_converter_half_backend(NT_HALF_SLAVE);
}

static void begin(int has_sensor)
{
    const nt_converter_setup setup = slave_setup(&bus, has_sensor);
    const nt_configuration configuration = {sizeof configuration, 0, 1e-3, 1e-6, ""};
    assert_int_equal(nt_converter_half_init(&half, &setup, NULL), NT_OK);
    const nt_hal_choice choice = {slave(), &half};
    assert_int_equal(nt_hal_open(&hal, NT_HALF_SLAVE, &choice, &host, NULL), NT_OK);
    assert_int_equal(nt_hal_configure(&hal, &configuration, NULL), NT_OK);
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
}

static void tell(double z)
{
    const nt_action action = {.size = sizeof action, .target = {0.0, 0.0, z}};
    assert_int_equal(nt_hal_write(&hal, &action), NT_OK);
}

static const nt_reading *ask(void)
{
    pass(&host, 1e-3);
    assert_int_equal(nt_hal_read(&hal), NT_OK);
    return &hal.reading;
}

static void close_to(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.12g instead of %.12g", value, expected);
}

/* The spring behind the surface is as stiff as the lever: half of what is beyond it is deflection. */
static void it_drives_and_reads(void **state)
{
    (void)state;
    for (int has_sensor = 0; has_sensor < 2; ++has_sensor) {
        bus = simulated_bus_after_power_up();
        begin(has_sensor);
        const double dac = 20e-6 / 1048575.0, adc = 20e-6 / 65536.0;
        for (double z = -9e-6; z < 2.5e-6; z += 0.37e-6) {
            tell(z);
            const nt_reading *reading = ask();
            close_to(simulated_travel(&bus), z, 0.51 * dac);
            close_to(reading->position[NT_Z], simulated_travel(&bus), has_sensor ? 2.0 * adc : 1e-20);
            close_to(reading->felt[NT_Z], simulated_deflection(&bus), 2.0 * DEFLECTION_GAIN * 20.0 / 65536.0);
            assert_int_equal(reading->flags, 0);
            assert_true(isnan(reading->position[NT_X]) && isnan(reading->felt[NT_X]));
        }
        nt_hal_close(&hal);
    }
}

static void it_begins_without_a_jump(void **state)
{
    (void)state;
    bus = simulated_bus_after_power_up();
    begin(0); /* the output was off: it comes on at 0 V */
    close_to(simulated_travel(&bus), 0.0, 1e-11);
    tell(-3e-6);
    (void)ask();
    nt_hal_close(&hal);
    close_to(simulated_travel(&bus), -4e-6, 2e-11); /* lifted by 1 um */
    begin(0);                                       /* and now it was on: it stays where it is */
    close_to(simulated_travel(&bus), -4e-6, 2e-11);
    close_to(ask()->position[NT_Z], -4e-6, 2e-11);
    nt_hal_close(&hal);
}

/* Beyond its range a target goes to the end, and is counted; a deflection at the end of its range is saturated. */
static void ends_of_ranges(void **state)
{
    (void)state;
    bus = simulated_bus_after_power_up();
    begin(0);
    tell(11e-6);
    assert_int_equal(half.counts.clipped, 1);
    const nt_reading *reading = ask();
    close_to(simulated_travel(&bus), 10e-6, 4e-11);
    assert_int_equal(reading->flags, NT_SAMPLE_SATURATED);
    assert_true(isfinite(reading->felt[NT_Z]));
    const nt_action wrong = {.size = sizeof wrong, .target = {0.0, 0.0, NAN}};
    assert_int_equal(nt_hal_write(&hal, &wrong), NT_OK);
    assert_true(hal.is_lost);
    close_to(simulated_travel(&bus), 10e-6, 4e-11);
    nt_hal_close(&hal);
}

/* One bad tick is invalid and nothing of it is used; eight in a row, or a bus that is gone, are a lost device. */
static void each_fault_has_its_reaction(void **state)
{
    (void)state;
    for (int fault = BUS_ALL_ZERO; fault < BUS_FAULTS; ++fault) {
        bus = simulated_bus_after_power_up();
        begin(0);
        tell(-1e-6);
        assert_int_equal(ask()->flags, 0);
        bus.fault = (bus_fault)fault;
        tell(-1.1e-6); /* that a deaf chip does not take */
        const nt_reading *reading = ask();
        const uint32_t lost = NT_SAMPLE_INVALID | NT_SAMPLE_DEVICE_LOST;
        assert_int_equal(reading->flags, fault == BUS_GONE ? lost : (uint32_t)NT_SAMPLE_INVALID);
        assert_true(reading->valid == 0 && isnan(reading->position[NT_Z]) && isnan(reading->felt[NT_Z]));
        for (int i = 2; i < NT_CONVERTER_BAD; ++i)
            assert_int_equal(ask()->flags & NT_SAMPLE_DEVICE_LOST, fault == BUS_GONE ? NT_SAMPLE_DEVICE_LOST : 0);
        assert_int_equal(ask()->flags, lost);
        bus.fault = BUS_WELL;
        nt_hal_close(&hal); /* over a bus that works again the tip is lifted, but for one that said it is gone */
        close_to(simulated_travel(&bus), fault == BUS_GONE ? -1e-6 : -2.1e-6, 4e-11);
    }
}

static void a_single_bad_tick_passes(void **state)
{
    (void)state;
    bus = simulated_bus_after_power_up();
    begin(0);
    for (int i = 0; i < 100; ++i) { /* every second one is bad: never lost */
        bus.fault = i % 2 ? BUS_ALL_ONE : BUS_WELL;
        assert_int_equal(ask()->flags, i % 2 ? NT_SAMPLE_INVALID : 0);
    }
    assert_int_equal(half.counts.mismatched + half.counts.stuck, 50);
    bus.fault = BUS_WELL;
    nt_hal_close(&hal);
}

/* The supply of the DAC fails for a moment: it takes codes and reads them back as before, with its output at ground. */
static void a_chip_that_was_reset_is_found(void **state)
{
    (void)state;
    bus = simulated_bus_after_power_up();
    begin(0);
    tell(1e-6);
    assert_int_equal(ask()->flags, 0);
    bus.control = simulated_bus_after_power_up().control;
    for (int i = 1; i < NT_CONVERTER_BAD; ++i) {
        tell(1e-6);
        assert_int_equal(bus.dac, half.codes[NT_Z]);
        assert_int_equal(ask()->flags, NT_SAMPLE_INVALID);
    }
    assert_int_equal(ask()->flags, NT_SAMPLE_INVALID | NT_SAMPLE_DEVICE_LOST);
    nt_hal_close(&hal);
}

/* Where a stage stands is read before it is driven: misread, it would jump. So nothing is driven then. */
static void arm_moves_nothing_on_a_bad_bus(void **state)
{
    (void)state;
    for (int fault = BUS_ALL_ZERO; fault < BUS_FLIPPED; ++fault) {
        bus = simulated_bus_after_power_up();
        begin(0);
        tell(7e-6);
        bus.fault = (bus_fault)fault; /* the program dies, and is started again */
        const double stood = simulated_travel(&bus);
        const nt_converter_setup setup = slave_setup(&bus, 0);
        const nt_hal_choice choice = {slave(), &half};
        assert_int_equal(nt_converter_half_init(&half, &setup, NULL), NT_OK);
        assert_int_equal(nt_hal_open(&hal, NT_HALF_SLAVE, &choice, &host, NULL), NT_OK);
        assert_int_not_equal(nt_hal_arm(&hal), NT_OK);
        nt_hal_close(&hal);
        assert_true(simulated_travel(&bus) == stood);
    }
}

static void arm_fails_on_a_bad_bus(void **state)
{
    (void)state;
    for (int fault = BUS_ALL_ZERO; fault < BUS_FAULTS; ++fault) {
        if (fault == BUS_FLIPPED) /* the control register survives it; the first reading does not */
            continue;
        bus = simulated_bus_after_power_up();
        const nt_converter_setup setup = slave_setup(&bus, 0);
        const nt_hal_choice choice = {slave(), &half};
        bus.fault = (bus_fault)fault;
        assert_int_equal(nt_converter_half_init(&half, &setup, NULL), NT_OK);
        assert_int_equal(nt_hal_open(&hal, NT_HALF_SLAVE, &choice, &host, NULL), NT_OK);
        assert_int_not_equal(nt_hal_arm(&hal), NT_OK);
        nt_hal_close(&hal);
    }
}

/* --- a master, and lines beside the bus --- */

static struct {
    int is_on, beats, conversions;
    uint32_t flags;
} lines;

static uint32_t line_flags(void *context)
{
    (void)context;
    return lines.flags;
}
static void line_beat(void *context)
{
    (void)context;
    ++lines.beats;
}
static void line_convert(void *context)
{
    (void)context;
    ++lines.conversions;
}
static nt_status line_enable(void *context, int on)
{
    (void)context;
    lines.is_on = on;
    return NT_OK;
}

static void a_motor_is_left_at_no_force(void **state)
{
    (void)state;
    bus = simulated_bus_after_power_up();
    nt_converter_setup setup = slave_setup(&bus, 1);
    setup.half = NT_HALF_MASTER;
    setup.driven[NT_Z].gain = 0.5; /* N/V */
    setup.driven[NT_Z].minimum = -4.0;
    setup.driven[NT_Z].maximum = 4.0;
    setup.lines = (nt_converter_lines){line_flags, line_beat, line_convert, line_enable, NULL};
    const nt_hal_choice choice = {nt_converter_half_backend(NT_HALF_MASTER), &half};
    assert_int_equal(nt_converter_half_init(&half, &setup, NULL), NT_OK);
    assert_int_equal(nt_hal_open(&hal, NT_HALF_MASTER, &choice, &host, NULL), NT_OK);
    assert_true(hal.capabilities.can == (NT_IS_REAL | NT_CAN_FEEL | NT_CAN_PUSH) && hal.capabilities.rows == 3);
    assert_int_equal(lines.is_on, 0);
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
    assert_int_equal(lines.is_on, 1);
    tell(3.0);
    close_to(simulated_volts(&bus), 6.0, 1e-5);
    lines.flags = NT_SAMPLE_EMERGENCY_STOP;
    assert_int_equal(ask()->flags, NT_SAMPLE_EMERGENCY_STOP);
    assert_true(lines.beats == 1 && lines.conversions == 1);
    nt_hal_close(&hal);
    close_to(simulated_volts(&bus), 0.0, 1e-5);
    assert_int_equal(lines.is_on, 0);
}

/* --- dice --- */

static uint32_t dice_state;

static uint32_t dice(void)
{
    dice_state ^= dice_state << 13, dice_state ^= dice_state >> 17, dice_state ^= dice_state << 5;
    return dice_state;
}

/* Any status and any bytes. */
static nt_status wild_exchange(void *context, int converter, const nt_transfer *transfers, int count)
{
    const nt_status statuses[] = {NT_OK, NT_OK, NT_OK, NT_OK, NT_E_STATE, NT_E_RANGE};
    (void)context, (void)converter;
    for (int i = 0; i < count; ++i)
        for (uint32_t byte = 0; byte < transfers[i].count; ++byte)
            transfers[i].in[byte] = (uint8_t)dice();
    return dice() % 4096 ? statuses[dice() % 6] : NT_E_DEVICE;
}

/* Faults come and go: what is called valid is within a step of what the chips did, or it is flagged. */
static void random_faults_never_lie(void **state)
{
    (void)state;
    dice_state = 20261122;
    long good = 0, flagged = 0;
    for (int life = 0; life < 200; ++life) {
        bus = simulated_bus_after_power_up();
        begin(0);
        for (int tick = 0; tick < 200; ++tick) {
            bus.fault = dice() % 5 ? BUS_WELL : (bus_fault)(dice() % BUS_GONE); /* no more than hanging and refusing */
            tell(-9e-6 + 12e-6 * (dice() % 1000) / 1000.0);
            bus.fault = dice() % 5 ? bus.fault : (bus_fault)(dice() % BUS_GONE);
            const nt_reading *reading = ask();
            if (reading->flags & NT_SAMPLE_INVALID) {
                ++flagged;
                assert_true(reading->valid == 0 && isnan(reading->position[NT_Z]));
                continue;
            }
            ++good;
            close_to(reading->position[NT_Z], simulated_travel(&bus), 1e-18);
            close_to(reading->felt[NT_Z],
                     simulated_deflection(&bus) > 0.33e-6 ? reading->felt[NT_Z] : simulated_deflection(&bus), 2.1e-11);
        }
        bus.fault = BUS_WELL;
        nt_hal_close(&hal);
    }
    assert_true(good > 20000 && flagged > 5000);
}

static void random_answers_break_nothing(void **state)
{
    (void)state;
    dice_state = 4711;
    for (int life = 0; life < 2000; ++life) {
        nt_converter_setup setup = slave_setup(&bus, life % 2);
        setup.exchange = wild_exchange;
        const nt_hal_choice choice = {slave(), &half};
        assert_int_equal(nt_converter_half_init(&half, &setup, NULL), NT_OK);
        assert_int_equal(nt_hal_open(&hal, NT_HALF_SLAVE, &choice, &host, NULL), NT_OK);
        (void)nt_hal_arm(&hal); /* with luck */
        for (int tick = 0; tick < 50; ++tick) {
            const nt_reading *reading = ask();
            assert_true(reading->valid == 0 || isfinite(reading->position[NT_Z]));
            tell(1e-6);
        }
        nt_hal_close(&hal);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_drives_and_reads),
        cmocka_unit_test(it_begins_without_a_jump),
        cmocka_unit_test(ends_of_ranges),
        cmocka_unit_test(each_fault_has_its_reaction),
        cmocka_unit_test(a_single_bad_tick_passes),
        cmocka_unit_test(a_chip_that_was_reset_is_found),
        cmocka_unit_test(arm_moves_nothing_on_a_bad_bus),
        cmocka_unit_test(arm_fails_on_a_bad_bus),
        cmocka_unit_test(a_motor_is_left_at_no_force),
        cmocka_unit_test(random_faults_never_lie),
        cmocka_unit_test(random_answers_break_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
