/* SPDX-License-Identifier: BSD-3-Clause
 * AD7606, AD7606-6, AD7606-4: all inputs are sampled at the edge of CONVST, +-10 V or +-5 V by the RANGE pin, and read
 * through one line, DOUTA, in the order of the channels (data sheet Rev. C, page 28). The falling chip select brings
 * the first bit, each rising clock the next one: mode 2. Its frames have neither status nor check sum. */
#include "hal/chips/families.h"

#define SAMPLES(title, inputs)                                                                                         \
    {.name = title,                                                                                                    \
     .bits = 16,                                                                                                       \
     .channels = inputs,                                                                                               \
     .is_signed = 1,                                                                                                   \
     .steps = 65536.0,                                                                                                 \
     .spi_mode = 2,                                                                                                    \
     .clock = 17e6,                                                                                                    \
     .settle = 4.15e-6,                                                                                                \
     .answer = {.count = 2 * inputs, .width = 2}}

const nt_chip nt_chips_ad7606[NT_CHIPS_AD7606] = {
    SAMPLES("AD7606", 8),
    SAMPLES("AD7606-6", 6),
    SAMPLES("AD7606-4", 4),
};
