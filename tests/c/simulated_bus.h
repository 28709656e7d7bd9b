/* SPDX-License-Identifier: BSD-3-Clause
 * Chips at the ends of an SPI bus, as a data sheet describes them, frame by frame; nothing of the library's tables is
 * used. A DAC at number 0 moves a stage, an ADC at number 1 measures stage (input 1) and deflection (input 2). Behind
 * them is a spring of the lever's own stiffness. Faults are set by name. */
#ifndef TESTS_SIMULATED_BUS_H
#define TESTS_SIMULATED_BUS_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#define STAGE_GAIN 1e-6       /* of the stage: -10 .. 10 V are -10 .. 10 um of travel [m/V] */
#define DEFLECTION_GAIN 33e-9 /* of the read-out [m/V] */
#define SURFACE 2e-6          /* travel at which the tip meets the spring [m] */

typedef enum bus_fault {
    BUS_WELL,
    BUS_ALL_ZERO, /* MISO hangs */
    BUS_ALL_ONE,
    BUS_SHORT,   /* the end of each frame does not go through: `lost` */
    BUS_REFUSED, /* EIO */
    BUS_GONE,    /* ENODEV */
    BUS_FLIPPED, /* one bit of what comes back is wrong */
    BUS_DEAF,    /* the DAC no longer hears: it keeps its code */
    BUS_FAULTS
} bus_fault;

typedef struct simulated_bus simulated_bus;
struct simulated_bus {
    bus_fault fault;
    /* What other chips answer, in place of those below; NULL: none do. */
    void (*plays)(simulated_bus *bus, int chip, const uint8_t *out, uint8_t *in, uint32_t count);
    uint32_t dac, control, reply; /* registers of an AD5791 */
    int has_reply;
    long frames[2];
    uint32_t lost[2]; /* last bytes of each frame of a chip, while the bus is short; at power-up one */
    uint32_t noise;   /* of the ADC: its lowest bits change */
    int has_crc;      /* the ADC is an AD7768-1, which reads the deflection alone, with status and check sum */
    int corrupt;      /* so many of its frames come with a bit wrong; below 0: all */
    int error;        /* errno of messages ... */
    int errors;       /* ... so many of them; below 0: all */
};

static inline simulated_bus simulated_bus_after_power_up(void)
{
    return (simulated_bus){.control = 0x00000E, .lost = {1, 1}};
}

/* At ground while the output is off. */
static inline double simulated_volts(const simulated_bus *bus)
{
    return bus->control & 0xCu ? 0.0 : -10.0 + 20.0 * bus->dac / 1048575.0;
}

static inline double simulated_travel(const simulated_bus *bus)
{
    return STAGE_GAIN * simulated_volts(bus);
}

static inline double simulated_deflection(const simulated_bus *bus)
{
    const double beyond = simulated_travel(bus) - SURFACE;
    return beyond > 0.0 ? 0.5 * beyond : 0.0;
}

/* What goes through of a frame [bytes]. */
static inline uint32_t simulated_through(const simulated_bus *bus, int chip, uint32_t count)
{
    const uint32_t lost = bus->fault == BUS_SHORT ? bus->lost[chip & 1] : 0u;
    return count > lost ? count - lost : 0u;
}

/* Fewer than 24 clocks are no word: it sends what it has to, and takes nothing. */
static inline void simulated_ad5791(simulated_bus *bus, const uint8_t *out, uint8_t *in, uint32_t count)
{
    const uint32_t reply = bus->has_reply ? bus->reply : 0u;
    for (uint32_t i = 0; i < count && i < 3; ++i)
        in[i] = (uint8_t)(reply >> (16 - 8 * i));
    if (count != 3)
        return;
    const uint32_t word = (uint32_t)out[0] << 16 | (uint32_t)out[1] << 8 | out[2], at = word >> 20 & 7u;
    bus->has_reply = word >> 23 != 0;
    bus->reply = at << 20 | (at == 1 ? bus->dac : at == 2 ? bus->control : 0u);
    if (word >> 23 || bus->fault == BUS_DEAF)
        return;
    if (at == 1)
        bus->dac = word & 0xFFFFFu;
    if (at == 2)
        bus->control = word & 0xFFFFFu;
}

static inline void simulated_ad7606(simulated_bus *bus, uint8_t *in, uint32_t count)
{
    const double inputs[8] = {simulated_volts(bus), simulated_deflection(bus) / DEFLECTION_GAIN};
    ++bus->noise;
    for (uint32_t i = 0; i < count && i < 16; ++i) { /* a byte that comes alone is the upper one */
        double code = floor(inputs[i / 2] / 20.0 * 65536.0 + 0.5) + (double)(bus->noise >> 1 & 1u);
        code += i >= 4 ? i / 2 * 2 : 0; /* offsets of inputs that nobody uses */
        code = code > 32767.0 ? 32767.0 : code < -32768.0 ? -32768.0 : code;
        in[i] = (uint8_t)((uint32_t)(int32_t)code >> (i % 2 ? 0 : 8));
    }
}

static inline void simulated_ad7768(simulated_bus *bus, const uint8_t *out, uint8_t *in, uint32_t count)
{
    uint8_t answer[5];
    if (count < 4 || out[0] == 0x6C)
        return;
    const double volts = simulated_deflection(bus) / DEFLECTION_GAIN;
    const uint32_t bits = (uint32_t)(int32_t)floor(volts / 20.0 * 16777216.0 + 0.5) + (++bus->noise >> 1 & 1u);
    uint8_t sum = 0x03; /* x^8 + x^2 + x + 1 */
    answer[0] = (uint8_t)(bits >> 16), answer[1] = (uint8_t)(bits >> 8), answer[2] = (uint8_t)bits, answer[3] = 0;
    for (int i = 0; i < 32; ++i) {
        const uint32_t bit = (uint32_t)(answer[i / 8] >> (7 - i % 8) & 1) ^ (uint32_t)(sum >> 7);
        sum = (uint8_t)(sum << 1 ^ (bit ? 0x07 : 0));
    }
    answer[4] = sum;
    if (bus->corrupt != 0)
        answer[1] ^= 0x10;
    bus->corrupt -= bus->corrupt > 0;
    memcpy(in, answer, count < 5 ? count : 5);
}

/* One frame under one chip select. */
static inline void simulated_frame(simulated_bus *bus, int chip, const uint8_t *out, uint8_t *in, uint32_t count)
{
    ++bus->frames[chip & 1];
    memset(in, 0, count);
    if (bus->plays)
        bus->plays(bus, chip, out, in, count);
    else if (chip == 0)
        simulated_ad5791(bus, out, in, count);
    else if (bus->has_crc)
        simulated_ad7768(bus, out, in, count);
    else
        simulated_ad7606(bus, in, count);
    if (bus->fault == BUS_ALL_ZERO || bus->fault == BUS_ALL_ONE)
        memset(in, bus->fault == BUS_ALL_ONE ? 0xFF : 0x00, count);
    if (bus->fault == BUS_FLIPPED && count > 0)
        in[count - 1] ^= 1u;
}

#endif
