/* SPDX-License-Identifier: BSD-3-Clause
 * Between the files of a half on converters. */
#ifndef HAL_CHIPS_HALF_H
#define HAL_CHIPS_HALF_H

#include "nanotouch/advanced/converters.h"

/* What has been read of all converters in one tick. */
typedef struct nt_converter_answers {
    nt_chip_frame adc[NT_CONVERTERS];
    nt_chip_verdict verdict[NT_CONVERTERS];
    int32_t held[NT_DRIVES]; /* what the DACs say that they hold, by what is driven */
    int is_unset;            /* one of them is not as it was set up */
} nt_converter_answers;

/* Exchanges, with the count of those that failed. NT_E_DEVICE once the half is lost. */
nt_status nt_converter_half_send(nt_converter_half *c, int converter, nt_chip_frame *frames, int count);
nt_status nt_converter_half_drive(nt_converter_half *c, int axis, int32_t code);
nt_status nt_converter_half_held(nt_converter_half *c, nt_converter_answers *answers);
nt_status nt_converter_half_set_up(nt_converter_half *c);
/* The value of a code on this channel, and the code of a value within its range. */
double nt_converter_half_value(const nt_converter_half *c, const nt_converter_channel *channel, int32_t code);
nt_status nt_converter_half_code(nt_converter_half *c, const nt_converter_channel *channel, double value,
                                 int32_t *code);
/* Fills c->rows. */
void nt_converter_half_describe(nt_converter_half *c);

#endif
