/* SPDX-License-Identifier: BSD-3-Clause
 * A slave of converters behind spidev's driver, on a model of the kernel, in a session at hard pace. Include after
 * cmocka. */
#ifndef TESTS_RIG_SESSION_H
#define TESTS_RIG_SESSION_H

#include <stdatomic.h>
#include <string.h>

#include "converter_rig.h"
#include "nanotouch/advanced/hal_linux.h"
#include "session_fixture.h"
#include "spidev_calls.h"
#include "spidev_model.h"

static simulated_bus bus;
static spidev_model model[2];
static atomic_int is_pressed, is_refusing; /* the button; the bus, EIO */

static int control_call(void *context, int file, unsigned long request, void *argument)
{
    (void)context;
    bus.fault = atomic_load(&is_refusing) ? BUS_REFUSED : BUS_WELL;
    return model_request(&model[file], (unsigned)request, argument, copy_bytes, NULL);
}
static uint32_t line_flags(void *context)
{
    (void)context;
    return atomic_load(&is_pressed) ? (uint32_t)NT_SAMPLE_EMERGENCY_STOP : 0u;
}

static nt_session_setup setup_on(nt_converter_half *half)
{
    nt_session_setup setup = nt_session_defaults();
    setup.rig.master.gauge = setup.rig.master.motor = 0;
    setup.rig.stage.axes = 1.0;
    setup.rig.stage.resonance = 100.0; /* far from the rate of the loop */
    setup.rig.stage.quality = 1.0;
    setup.settings = nt_settings_defaults(&setup.rig);
    setup.settings.gains.rate = 500.0;
    setup.settings.gains.alpha_p = 1e-3;
    setup.settings.limits.force = 0.4e-6;
    setup.slave = (nt_hal_choice){nt_converter_half_backend(NT_HALF_SLAVE), half};
    return setup;
}

/* The half, over a bus that is well and a stop button that is up. */
static void open_slave(nt_converter_half *half, nt_spi *spi)
{
    const nt_spi_calls calls = {open_call, control_call, close_call, NULL};
    const nt_spi_device devices[] = {{"0", 1, 10e6}, {"1", 2, 10e6}};
    bus = simulated_bus_after_power_up();
    atomic_store(&is_pressed, 0);
    atomic_store(&is_refusing, 0);
    for (int i = 0; i < 2; ++i)
        model[i] = (spidev_model){.bus = &bus, .chip = i};
    assert_int_equal(nt_spi_open(spi, devices, 2, &calls, NULL), NT_OK);
    nt_converter_setup made = slave_setup(&bus, 1);
    made.exchange = nt_spi_exchange;
    made.bus = spi;
    made.lines.flags = line_flags;
    assert_int_equal(nt_converter_half_init(half, &made, NULL), NT_OK);
}

#endif
