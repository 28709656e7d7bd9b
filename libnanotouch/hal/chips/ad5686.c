/* SPDX-License-Identifier: BSD-3-Clause
 * AD5686, AD5685, AD5684: four outputs from 0 to the reference, or twice that by their GAIN pin (data sheet AD5686 Rev.
 * D: tables 8 and 9). A word is command (4 bits), channels (one bit each), 16 bits of data, the code left-aligned.
 * Commands: 3 writes and updates a channel, 9 asks for its register, 0 does nothing. They need no control register. */
#include "hal/chips/families.h"

#define FOUR(title, width, count)                                                                                      \
    {.name = title,                                                                                                    \
     .is_dac = 1,                                                                                                      \
     .bits = width,                                                                                                    \
     .channels = 4,                                                                                                    \
     .steps = count,                                                                                                   \
     .spi_mode = 1,                                                                                                    \
     .clock = 25e6,                                                                                                    \
     .settle = 8e-6,                                                                                                   \
     .words = {.write = 0x300000u,                                                                                     \
               .read = 0x900000u,                                                                                      \
               .channels = {0x010000u, 0x020000u, 0x040000u, 0x080000u},                                               \
               .field = 16}}

/* V = V_REF gain D / 2^bits: the span ends one step above the highest code. */
const nt_chip nt_chips_ad5686[NT_CHIPS_AD5686] = {
    FOUR("AD5686", 16, 65536.0),
    FOUR("AD5685", 14, 16384.0),
    FOUR("AD5684", 12, 4096.0),
};
