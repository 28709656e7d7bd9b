/* SPDX-License-Identifier: BSD-3-Clause
 * A chip that a driver of the kernel runs. The half sends it frames as it does to others; hal/linux/iio.c makes numbers
 * of the driver's from them. A word to drive is 24 bits: bit 23 asks, bit 22 writes, channel in bits 21 and 20, the
 * code left-aligned below. An answer has three bytes a channel, two's complement, and a last one that is 1. */
#include <stddef.h>

#include "nanotouch/advanced/hal_iio.h"

nt_chip nt_chip_of_iio(int bits, int channels, int is_output)
{
    if (bits < 2 || bits > (is_output ? 20 : 24) || channels < 1 ||
        channels > (is_output ? NT_IIO_OUTPUTS : NT_IIO_INPUTS))
        return (nt_chip){.name = NULL};
    nt_chip chip = {.name = "IIO",
                    .is_dac = is_output,
                    .bits = bits,
                    .channels = channels,
                    .is_signed = !is_output,
                    .steps = (double)((1u << bits) - 1u)};
    if (is_output)
        chip.words = (nt_chip_words){.write = 0x400000u,
                                     .read = 0x800000u,
                                     .channels = {0x000000u, 0x100000u, 0x200000u, 0x300000u},
                                     .field = 20};
    else
        chip.answer = (nt_chip_answer){
            .count = 3u * (uint32_t)channels + 1u, .width = 3, .status = 3u * (uint32_t)channels, .bad = 0xFE};
    return chip;
}
