/* SPDX-License-Identifier: BSD-3-Clause
 * Private: nt_noise_seek inline, for what draws from several streams in each period. */
#ifndef NANOTOUCH_CORE_NOISE_H
#define NANOTOUCH_CORE_NOISE_H

#include "nanotouch/advanced/random.h"

static inline void noise_seek(nt_noise *noise, uint64_t tick)
{
    noise->position = tick << 32;
}

#endif
