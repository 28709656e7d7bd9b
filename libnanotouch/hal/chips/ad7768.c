/* SPDX-License-Identifier: BSD-3-Clause
 * AD7768-1: one input of 24 bits between plus and minus the reference, with status and CRC behind every number. It is
 * put into continuous reading: register 0x14 is given CRC (bit 6), status (4) and continuous reading (0). The byte 0x6C
 * ends that mode, and is a harmless reading of the data register outside it, so that a second start finds the same.
 * Status: bits 7 .. 4 and 1 are errors, 3 says saturated, 2 not settled, 0 that it has been reset. */
#include "hal/chips/families.h"

const nt_chip nt_chips_ad7768[NT_CHIPS_AD7768] = {
    {.name = "AD7768-1",
     .bits = 24,
     .channels = 1,
     .is_signed = 1,
     .steps = 16777216.0,
     .spi_mode = 3,
     .clock = 20e6,
     .settle = 1e-4, /* by its filter: far less at its fastest; the rig may say better */
     .answer = {.count = 5, .width = 3, .status = 3, .bad = 0xF6u, .clips = 0x08u, .sum = 4, .sum_start = 0x03},
     .setup = {{{0x6C, 0, 0, 0, 0}, 5}, {{0x14, 0x51}, 2}}},
};
