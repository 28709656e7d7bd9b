/* SPDX-License-Identifier: BSD-3-Clause
 * Noise by seed, channel and tick. */
#ifndef NANOTOUCH_INTERNAL_RANDOM_H
#define NANOTOUCH_INTERNAL_RANDOM_H

#include "nanotouch/advanced/random.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The stream of a channel, before its first tick. Any seed and any channel are good. */
NT_API nt_noise nt_noise_of(uint64_t seed, uint32_t channel);
/* To the beginning of a tick, which has 2^32 numbers. */
NT_API NT_REALTIME void nt_noise_seek(nt_noise *noise, uint64_t tick);
/* As nt_random_uniform and nt_random_normal. */
NT_API NT_REALTIME double nt_noise_uniform(nt_noise *noise);
/* The next normal number of mean 0 and variance 1; real-time safe. */
NT_API NT_REALTIME double nt_noise_normal(nt_noise *noise);

#ifdef __cplusplus
}
#endif
#endif
