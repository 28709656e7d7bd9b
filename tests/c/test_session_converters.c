/* SPDX-License-Identifier: BSD-3-Clause
 * A whole touch loop over the real drivers: touch step, half on converters, spidev's driver, and behind its system
 * calls chips that are modelled on their own. No clock of the machine counts: a tick is a call. What the loop does is
 * that of a loop without converters, within their steps; and each fault of the bus has its reaction, counted in ticks.
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
#include "larger.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/advanced/hal_linux.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"
#include "spidev_calls.h"
#include "spidev_model.h"

enum { APPROACH = 40000 }; /* ticks after which the set-point is held */

static simulated_bus bus;
static spidev_model model[2];
static int interrupts; /* this many calls end with EINTR first */
static uint32_t lines; /* what the stop button says */

static int control_call(void *context, int file, unsigned long request, void *argument)
{
    (void)context;
    if (interrupts > 0 && interrupts--)
        return -EINTR;
    return model_request(&model[file], (unsigned)request, argument, copy_bytes, NULL);
}
static uint32_t line_flags(void *context)
{
    (void)context;
    return lines;
}

typedef struct loop {
    nt_touch touch;
    nt_touch_state state;
    nt_spi spi;
    nt_converter_half half;
    nt_hal slave;
    nt_sample sample;
    nt_command command;
} loop;

static loop l;

static void begin_touch(void)
{
    nt_rig rig = nt_rig_defaults();
    rig.stage.axes = 1.0;
    const nt_settings settings = nt_settings_defaults(&rig);
    assert_int_equal(nt_touch_make(&l.touch, &rig, &settings, NT_MODE_APPROACH, NULL), NT_OK);
    l.state = nt_touch_start(&l.touch, 0.0, 0.0, 0.0);
}

static void begin(int has_sensor)
{
    const nt_spi_calls calls = {open_call, control_call, close_call, NULL};
    const nt_spi_device devices[] = {{"0", 1, 10e6}, {"1", 2, 10e6}};
    l = (loop){.half = {.bad = 0}};
    bus = simulated_bus_after_power_up();
    lines = 0;
    interrupts = 0;
    for (int i = 0; i < 2; ++i)
        model[i] = (spidev_model){.bus = &bus, .chip = i};
    begin_touch();
    assert_int_equal(nt_spi_open(&l.spi, devices, 2, &calls, NULL), NT_OK);
    nt_converter_setup setup = slave_setup(&bus, has_sensor);
    setup.exchange = nt_spi_exchange;
    setup.bus = &l.spi;
    setup.lines.flags = line_flags;
    const nt_configuration configuration = {sizeof configuration, 0, l.touch.period, 1e-6, ""};
    const nt_hal_choice choice = {nt_converter_half_backend(NT_HALF_SLAVE), &l.half};
    assert_int_equal(nt_converter_half_init(&l.half, &setup, NULL), NT_OK);
    assert_int_equal(nt_hal_open(&l.slave, NT_HALF_SLAVE, &choice, &host, NULL), NT_OK);
    assert_int_equal(nt_hal_configure(&l.slave, &configuration, NULL), NT_OK);
    assert_int_equal(nt_hal_arm(&l.slave), NT_OK);
}

static void end(void)
{
    nt_hal_close(&l.slave);
    nt_spi_close(&l.spi);
}

static uint32_t tick(void)
{
    nt_action action = {.size = sizeof action};
    pass(&host, l.touch.period);
    assert_int_equal(nt_hal_read(&l.slave), NT_OK);
    l.sample.flags = l.slave.reading.flags;
    l.sample.stage_position[NT_Z] = l.slave.reading.position[NT_Z];
    l.sample.deflection[NT_Z] = l.slave.reading.felt[NT_Z];
    nt_touch_step(&l.touch, &l.state, &l.sample, &l.command);
    action.state = l.command.state;
    action.target[NT_Z] = l.command.stage_position[NT_Z];
    assert_int_equal(nt_hal_write(&l.slave, &action), NT_OK);
    ++l.sample.tick;
    return l.command.state;
}

static void hold_the_set_point(void)
{
    begin(0);
    for (int i = 0; i < APPROACH; ++i)
        assert_int_equal(tick(), NT_RUN);
    assert_true(simulated_deflection(&bus) > 0.0);
}

/* The same loop without converters: what was told is where the stage is, the lever reads what it does. */
static void it_is_the_loop_without_converters(void **state)
{
    (void)state;
    const double dac = 20e-6 / 1048575.0, adc = DEFLECTION_GAIN * 20.0 / 65536.0;
    double travels[2] = {0.0, 0.0}, forces[2] = {0.0, 0.0};
    hold_the_set_point();
    travels[0] = simulated_travel(&bus);
    forces[0] = simulated_deflection(&bus);
    end();
    begin_touch();
    nt_sample sample = {.tick = 0};
    nt_command command = {.state = NT_RUN};
    for (int i = 0; i < APPROACH; ++i) {
        const double beyond = command.stage_position[NT_Z] - SURFACE;
        sample.stage_position[NT_Z] = command.stage_position[NT_Z];
        sample.deflection[NT_Z] = beyond > 0.0 ? 0.5 * beyond : 0.0;
        sample.deflection[NT_Z] += 1e-15 * (i % 2); /* a lever that does not move at all is stuck */
        nt_touch_step(&l.touch, &l.state, &sample, &command);
        assert_int_equal(command.state, NT_RUN);
        ++sample.tick;
        travels[1] = sample.stage_position[NT_Z];
        forces[1] = sample.deflection[NT_Z];
    }
    print_message("set-point held at %.2f nm of travel, without converters %.2f nm\n", 1e9 * travels[0],
                  1e9 * travels[1]);
    assert_true(fabs(travels[0] - travels[1]) <= 2.0 * (2.0 * adc + dac)); /* the spring is half as stiff as the pair */
    assert_true(fabs(forces[0] - forces[1]) <= 2.0 * adc + dac);
}

/* From the set-point: ticks until each state is reached, -1 within 50 if it is not. */
static void react(int ticks[4])
{
    for (int i = 0; i < 4; ++i)
        ticks[i] = -1;
    for (int i = 1; i <= 50; ++i) {
        const uint32_t reached = tick();
        if (ticks[reached] < 0)
            ticks[reached] = i;
    }
}

static void each_fault_in_ticks(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        bus_fault fault;
        uint32_t lines;
        int hold, retract, latched; /* ticks */
    } table[] = {
        {"all zero", BUS_ALL_ZERO, 0, 1, 2, NT_CONVERTER_BAD},
        {"all one", BUS_ALL_ONE, 0, 1, 2, NT_CONVERTER_BAD},
        {"short transfers", BUS_SHORT, 0, 1, 2, NT_CONVERTER_BAD},
        {"EIO", BUS_REFUSED, 0, 1, 2, NT_CONVERTER_BAD},
        {"one bit wrong", BUS_FLIPPED, 0, 1, 2, NT_CONVERTER_BAD},
        {"ESHUTDOWN", BUS_GONE, 0, -1, -1, 1},
        {"emergency stop", BUS_WELL, NT_SAMPLE_EMERGENCY_STOP, -1, -1, 1},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; ++i) {
        int ticks[4];
        hold_the_set_point();
        bus.fault = table[i].fault;
        lines = table[i].lines;
        react(ticks);
        print_message("%-16s HOLD %d, RETRACT %d, LATCHED %d\n", table[i].name, ticks[NT_HOLD], ticks[NT_RETRACT],
                      ticks[NT_LATCHED]);
        assert_int_equal(ticks[NT_HOLD], table[i].hold);
        assert_int_equal(ticks[NT_RETRACT], table[i].retract);
        assert_int_equal(ticks[NT_LATCHED], table[i].latched);
        end();
    }
}

/* No length tells of a short transfer: the kernel says the whole, and leaves what came last time. Of the DAC the
 * read-back shows it, at the latest when the code changes. */
static void a_dac_cut_short_is_seen_by_its_read_back(void **state)
{
    (void)state;
    enum { CHANGES = 3 }; /* ticks without a new code, at the set-point */
    for (uint32_t lost = 1; lost <= 3; ++lost) {
        int ticks[4];
        hold_the_set_point();
        const double stood = simulated_travel(&bus);
        bus.fault = BUS_SHORT;
        bus.lost[0] = lost;
        bus.lost[1] = 0;
        react(ticks);
        print_message("DAC, %u of 3 bytes lost: HOLD %d, RETRACT %d, LATCHED %d\n", (unsigned)lost, ticks[NT_HOLD],
                      ticks[NT_RETRACT], ticks[NT_LATCHED]);
        assert_true(ticks[NT_HOLD] >= 1 && ticks[NT_HOLD] <= CHANGES);
        assert_int_equal(ticks[NT_RETRACT], ticks[NT_HOLD] + 1);
        assert_int_equal(ticks[NT_LATCHED], ticks[NT_HOLD] + NT_CONVERTER_BAD - 1);
        assert_true(simulated_travel(&bus) <= stood && l.spi.short_ones == 0);
        end();
    }
}

/* An ADC without a check sum is seen by what stands still: a deflection while the stage moves (row 3), or a stage that
 * does not follow. On the spring, at the set-point, the loop may stand still as well, and nothing is amiss. */
static void an_adc_cut_short_is_seen_by_what_stands_still(void **state)
{
    (void)state;
    enum { IN_AIR = 2000 };
    static const struct {
        const char *name;
        int has_sensor, from;
        uint32_t lost;
    } table[] = {{"deflection, in air", 0, IN_AIR, 14},
                 {"deflection, at the set-point", 0, APPROACH, 14},
                 {"stage and deflection, in air", 1, IN_AIR, 16},
                 {"stage and deflection, at the set-point", 1, APPROACH, 16}};
    for (size_t i = 0; i < sizeof table / sizeof *table; ++i) {
        begin(table[i].has_sensor);
        for (int k = 0; k < table[i].from; ++k)
            assert_int_equal(tick(), NT_RUN);
        const double stood = simulated_travel(&bus);
        double lowest = stood;
        int ticks = 0;
        bus.fault = BUS_SHORT;
        bus.lost[0] = 0;
        bus.lost[1] = table[i].lost;
        for (uint32_t reached = NT_RUN; reached != NT_LATCHED && ticks < APPROACH; ++ticks) {
            reached = tick();
            lowest = larger(lowest, simulated_travel(&bus));
        }
        print_message("ADC, lost: %s: %d ticks, %.2f nm on\n", table[i].name, ticks, 1e9 * (lowest - stood));
        const nt_supervisor *s = &l.touch.supervisor;
        const double shown = table[i].has_sensor ? s->stage_most + s->correction_most : s->stuck_distance;
        const double a_tick =
            l.touch.settings.gains.approach_speed * l.touch.period; /* HOLD comes after it has moved */
        assert_true(lowest - stood <= shown + 3.0 * a_tick);
        assert_true(table[i].from == APPROACH || l.command.state == NT_LATCHED);
        assert_int_equal(l.spi.short_ones, 0);
        end();
    }
}

/* A single bad tick is a HOLD, and the loop goes on by itself or waits; never more than that. */
static void a_single_bad_tick_never_retracts(void **state)
{
    (void)state;
    for (int fault = BUS_ALL_ZERO; fault <= BUS_REFUSED; ++fault) {
        hold_the_set_point();
        bus.fault = (bus_fault)fault;
        assert_int_equal(tick(), NT_HOLD);
        bus.fault = BUS_WELL;
        for (int i = 0; i < 50; ++i)
            assert_true(tick() <= NT_HOLD);
        end();
    }
}

static void interrupts_cost_nothing(void **state)
{
    (void)state;
    hold_the_set_point();
    for (int i = 0; i < 200; ++i) {
        interrupts = i % NT_SPI_ATTEMPTS; /* fewer than it tries */
        assert_int_equal(tick(), NT_RUN);
    }
    interrupts = 1000; /* a storm of signals: bounded, and as bad as a refusal */
    const uint64_t before = l.spi.messages;
    assert_int_equal(tick(), NT_HOLD);
    assert_true(l.spi.messages - before <= 3 * NT_SPI_ATTEMPTS);
    interrupts = 0;
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_loop_without_converters),
        cmocka_unit_test(each_fault_in_ticks),
        cmocka_unit_test(a_dac_cut_short_is_seen_by_its_read_back),
        cmocka_unit_test(an_adc_cut_short_is_seen_by_what_stands_still),
        cmocka_unit_test(a_single_bad_tick_never_retracts),
        cmocka_unit_test(interrupts_cost_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
