/* SPDX-License-Identifier: BSD-3-Clause
 * Frames of converters. */
#ifndef NANOTOUCH_INTERNAL_CONVERTERS_H
#define NANOTOUCH_INTERNAL_CONVERTERS_H

#include "nanotouch/advanced/converters.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The step between two codes [V], > 0. Real-time safe. */
NT_API NT_REALTIME double nt_chip_step(const nt_chip *chip, const nt_chip_span *span);
/* The question for what a channel holds. The answer comes with the next frame. */
NT_API NT_REALTIME nt_chip_frame nt_chip_ask(const nt_chip *chip, int channel);
/* The frame that fetches a sample, of the channel that the chip has. */
NT_API NT_REALTIME nt_chip_frame nt_chip_poll(const nt_chip *chip);
/* Checks one channel of it, which must be part of the setup; NT_OK for one that is not used. */
NT_API nt_status nt_converter_channel_check(const nt_converter_setup *setup, const nt_converter_channel *channel,
                                            nt_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
