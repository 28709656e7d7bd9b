/* SPDX-License-Identifier: BSD-3-Clause
 * Private: the numbers of a reading by their channel. */
#ifndef NANOTOUCH_HAL_READING_H
#define NANOTOUCH_HAL_READING_H

#include "nanotouch/hal_backend.h"

/* Where channel 0 .. NT_READS - 1 stands. */
static inline double *nt_reading_channel(nt_reading *reading, int channel)
{
    if (channel >= NT_READS_AMPLITUDE)
        return channel == NT_READS_LAG ? &reading->lag : &reading->amplitude;
    return channel < NT_READS_FELT ? &reading->position[channel] : &reading->felt[channel - NT_READS_FELT];
}

/* What a half may call valid: the axes that it has, what it feels along them, and what it taps with. */
static inline uint32_t nt_reading_may_hold(uint32_t can, int axes)
{
    const uint32_t has = axes == 1 ? 1u << NT_Z : (1u << NT_AXES) - 1u;
    const uint32_t taps = 1u << NT_READS_AMPLITUDE | 1u << NT_READS_LAG;
    return has << NT_READS_POSITION | (can & NT_CAN_FEEL ? has << NT_READS_FELT : 0u) | (can & NT_CAN_TAP ? taps : 0u);
}

#endif
