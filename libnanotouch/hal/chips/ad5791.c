/* SPDX-License-Identifier: BSD-3-Clause
 * AD5791 and its smaller sisters: one precise output between two references (data sheet AD5791 Rev. D: tables 10 to
 * 13). Control register: LINCOMP (bits 9 .. 6) follows the span, BIN/2sC (4) is set for plain binary codes, DACTRI (3)
 * and OPGND (2) hold the output at ground after power-up, RBUF (1) is set: the inner amplifier is off. */
#include "hal/chips/families.h"

#define WORDS                                                                                                          \
    {.write = 0x100000u,                                                                                               \
     .read = 0x900000u,                                                                                                \
     .field = 20,                                                                                                      \
     .control = 0x200000u,                                                                                             \
     .ask = 0xA00000u,                                                                                                 \
     .off = 0x00000Cu,                                                                                                 \
     .always = 0x000012u,                                                                                              \
     .spans = spans,                                                                                                   \
     .matching = compensations}

static const double spans[] = {10.0, 12.0, 16.0, 19.0, 20.0, 0.0}; /* V_REFP - V_REFN [V] */
static const uint32_t compensations[] = {0u << 6, 1u << 6, 2u << 6, 3u << 6, 12u << 6};
static const double two_spans[] = {10.0, 20.0, 0.0}; /* AD5760, AD5780 */
static const uint32_t two_compensations[] = {0u << 6, 12u << 6};

/* V = V_REFN + (V_REFP - V_REFN) D / (2^bits - 1); 35 MHz of clock when writing, less when reading back. */
const nt_chip nt_chips_ad5791[NT_CHIPS_AD5791] = {
    {.name = "AD5791",
     .is_dac = 1,
     .bits = 20,
     .channels = 1,
     .steps = 1048575.0,
     .spi_mode = 1,
     .clock = 16e6,
     .settle = 1e-6,
     .words = WORDS},
    {.name = "AD5781",
     .is_dac = 1,
     .bits = 18,
     .channels = 1,
     .steps = 262143.0,
     .spi_mode = 1,
     .clock = 16e6,
     .settle = 1e-6,
     .words = WORDS},
    {.name = "AD5760",
     .is_dac = 1,
     .bits = 16,
     .channels = 1,
     .steps = 65535.0,
     .spi_mode = 1,
     .clock = 16e6,
     .settle = 2.5e-6,
     .words = {.write = 0x100000u,
               .read = 0x900000u,
               .field = 20,
               .control = 0x200000u,
               .ask = 0xA00000u,
               .off = 0x00000Cu,
               .always = 0x000012u,
               .spans = two_spans,
               .matching = two_compensations}},
};
