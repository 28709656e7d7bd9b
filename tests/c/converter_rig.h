/* SPDX-License-Identifier: BSD-3-Clause
 * A slave on the simulated bus: AD5791 and AD7606, with and without a sensor of the stage. */
#ifndef TESTS_CONVERTER_RIG_H
#define TESTS_CONVERTER_RIG_H

#include "nanotouch/advanced/converters.h"
#include "simulated_bus.h"

static inline nt_status bus_exchange(void *context, int converter, const nt_transfer *transfers, int count)
{
    simulated_bus *bus = context;
    if (bus->fault == BUS_GONE)
        return NT_E_DEVICE;
    for (int i = 0; i < count; ++i) {
        if (bus->fault == BUS_REFUSED)
            return NT_E_STATE;
        const uint32_t through = simulated_through(bus, converter, transfers[i].count);
        simulated_frame(bus, converter, transfers[i].out, transfers[i].in, through);
        if (through < transfers[i].count)
            return NT_E_STATE; /* a driver that is told of it, as spidev's is not */
    }
    return NT_OK;
}

static inline nt_converter_setup slave_setup(simulated_bus *bus, int has_sensor)
{
    nt_converter_setup setup = {
        .half = NT_HALF_SLAVE, .axes = 1, .converters = 2, .exchange = bus_exchange, .bus = bus};
    setup.converter[0] = (nt_converter){nt_chip_find("AD5791"), {-10.0, 10.0}};
    setup.converter[1] = (nt_converter){nt_chip_find("AD7606"), {-10.0, 10.0}};
    const nt_converter_channel stage = {.is_used = 1, .gain = STAGE_GAIN, .minimum = -10e-6, .maximum = 10e-6};
    setup.driven[NT_Z] = setup.position[NT_Z] = stage;
    if (has_sensor)
        setup.position[NT_Z].converter = 1;
    setup.felt[NT_Z] = (nt_converter_channel){.is_used = 1,
                                              .converter = 1,
                                              .channel = 1,
                                              .gain = DEFLECTION_GAIN,
                                              .minimum = -0.33e-6,
                                              .maximum = 0.33e-6,
                                              .noise = 1e-11};
    return setup;
}

#endif
