/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_HAL_CHIPS_CHIPS_PRIVATE_H
#define NANOTOUCH_HAL_CHIPS_CHIPS_PRIVATE_H

#include "nanotouch/advanced/converters.h"

/* The voltage of a code [V]. Real-time safe. */
NT_REALTIME double nt_chip_volts(const nt_chip *chip, const nt_chip_span *span, int32_t code);
/* The lowest and the highest code that are used. A DAC's two end codes are left out: a bus that hangs at 0 or 1 reads
 * back as one of them. */
NT_REALTIME int32_t nt_chip_lowest(const nt_chip *chip);
/* The highest code that is used; nt_chip_lowest says what is left out. */
NT_REALTIME int32_t nt_chip_highest(const nt_chip *chip);
/* The code nearest to a voltage. NT_E_NOT_FINITE, or NT_E_RANGE outside those codes; *code is then left alone. */
NT_REALTIME nt_status nt_chip_code(const nt_chip *chip, const nt_chip_span *span, double volts, int32_t *code);
/* The frame that sets a channel to a code. */
NT_REALTIME nt_chip_frame nt_chip_write(const nt_chip *chip, int channel, int32_t code);
/* A frame that changes nothing: it fetches the answer to the one before. */
NT_REALTIME nt_chip_frame nt_chip_nothing(const nt_chip *chip);
/* The code in an answer; its bits above the code are not looked at. */
NT_REALTIME int32_t nt_chip_code_of(const nt_chip *chip, const uint8_t *bytes);
/* The control register for such a span: 1 if the chip has one, else 0 and nothing is written. */
int nt_chip_control(const nt_chip *chip, const nt_chip_span *span, nt_chip_frame *set, nt_chip_frame *ask);
/* Of the answer to that question: is it what was set (1), or not (0)? */
int nt_chip_is_set(const nt_chip *chip, const nt_chip_span *span, const uint8_t *bytes);
/* Of the same answer: is the output off, at ground (1), or not (0)? */
int nt_chip_is_off(const nt_chip *chip, const uint8_t *bytes);
/* Checks a frame of chip->answer.count bytes. */
NT_REALTIME nt_chip_verdict nt_chip_check(const nt_chip *chip, const uint8_t *bytes);
/* A channel's code of a frame that is good, whatever the frame is. */
NT_REALTIME int32_t nt_chip_decode(const nt_chip *chip, const uint8_t *bytes, int channel);

#endif
