/* SPDX-License-Identifier: BSD-3-Clause
 * Random numbers for simulated noise and scattered samples: small, seeded, the same on every machine. */
#ifndef NANOTOUCH_RANDOM_H
#define NANOTOUCH_RANDOM_H

#include <stdint.h>

#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* xoshiro256++ (Blackman and Vigna 2019), seeded by splitmix64. */
typedef struct nt_random {
    uint64_t state[4];
} nt_random;

/* Any seed is good, 0 too. */
NT_API nt_random nt_random_seed(uint64_t seed);
/* Uniform in [0, 1), in steps of 2^-53. */
NT_API NT_REALTIME double nt_random_uniform(nt_random *random);
/* Standard normal, by Marsaglia's polar method; bounded: after 32 rejections (probability 4e-22) it gives the mean, 0.
 */
NT_API NT_REALTIME double nt_random_normal(nt_random *random);

/* Noise of one channel: a function of seed, channel and tick, whatever other channels draw and whatever came before. So
 * one half of a rig may be replaced, or restored at any tick, and the other's noise stays. splitmix64 (Steele, Lea and
 * Flood 2014) at a position: number n of a stream is mix(key + n gamma). */
typedef struct nt_noise {
    uint64_t key;      /* of seed and channel */
    uint64_t position; /* next number of the stream */
} nt_noise;

#ifdef __cplusplus
}
#endif
#endif
