/* SPDX-License-Identifier: BSD-3-Clause
 * The touch step over the half on converters and both drivers, tick by tick, on the devices of the test kernel.
 * Include after cmocka. */
#ifndef TESTS_KERNEL_RIG_H
#define TESTS_KERNEL_RIG_H

#include "converter_rig.h"
#include "host_fixture.h"
#include "kernel_bus.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/advanced/hal_iio.h"
#include "nanotouch/advanced/hal_linux.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

enum { UNDER_WAY = 50, APPROACH = 3000, AFTER = 20 }; /* ticks: before a fault, to the set-point, after a fault */

static kernel_bus chips;
static struct {
    nt_touch touch;
    nt_touch_state state;
    nt_spi spi;
    nt_gpio *gpio;
    nt_converter_half half;
    nt_hal slave;
    nt_sample sample;
    nt_command command;
} l;

static int is_virtual(void) /* no time passes while something computes */
{
    return getenv("TIME") != NULL;
}

/* --- one tick after another, over both drivers --- */

static void begin_touch(void)
{
    nt_rig rig = nt_rig_defaults();
    rig.stage.axes = 1.0;
    nt_settings settings = nt_settings_defaults(&rig);
    settings.gains.approach_speed = 10e-6;
    memset(&l, 0, sizeof l);
    assert_int_equal(nt_touch_make(&l.touch, &rig, &settings, NT_MODE_APPROACH, NULL), NT_OK);
    l.state = nt_touch_start(&l.touch, 0.0, 0.0, 0.0);
}

static void open_drivers(void)
{
    const nt_spi_device devices[] = {{"/dev/spidev0.0", 1, 10e6}, {"/dev/spidev0.1", 2, 10e6}};
    const nt_gpio_wiring wiring = {"estop", "limit", "laser-en", "watchdog", NULL, 0.0};
    char reason[NT_SPI_REASON] = "";
    chips.bus = simulated_bus_after_power_up();
    if (nt_spi_open(&l.spi, devices, 2, NULL, reason) != NT_OK ||
        nt_gpio_open(&wiring, reason, sizeof reason, &l.gpio) != NT_OK)
        fail_msg("%s", reason);
    pull_line("estop", 1); /* a request's own pull-down is all that gpio-sim has until somebody pulls */
    pull_line("limit", 1);
}

static nt_converter_setup setup_of_slave(int has_sensor)
{
    nt_converter_setup setup = slave_setup(&chips.bus, has_sensor);
    setup.exchange = nt_spi_exchange;
    setup.bus = &l.spi;
    setup.lines = nt_gpio_lines(l.gpio);
    return setup;
}

static void close_drivers(void)
{
    nt_spi_close(&l.spi);
    nt_gpio_close(l.gpio);
    l.gpio = NULL;
}

static void begin(void)
{
    begin_touch();
    open_drivers();
    const nt_converter_setup setup = setup_of_slave(0);
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
    close_drivers();
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

static void approach(int ticks)
{
    begin();
    for (int i = 0; i < ticks; ++i)
        assert_int_equal(tick(), NT_RUN);
}

#endif
