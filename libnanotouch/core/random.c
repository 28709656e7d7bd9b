/* SPDX-License-Identifier: BSD-3-Clause
 * xoshiro256++ 1.0 (Blackman and Vigna, "Scrambled linear pseudorandom number generators", 2019), seeded by splitmix64
 * (Steele, Lea and Flood 2014) as its authors advise: no seed gives the forbidden all-zero state. */
#include "nanotouch/random.h"

#include <math.h>

static uint64_t splitmix64(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

static uint64_t rotate_left(uint64_t x, int bits)
{
    return (x << bits) | (x >> (64 - bits));
}

static uint64_t xoshiro256pp(uint64_t s[4])
{
    const uint64_t result = rotate_left(s[0] + s[3], 23) + s[0];
    const uint64_t t = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= t;
    s[3] = rotate_left(s[3], 45);
    return result;
}

nt_random nt_random_seed(uint64_t seed)
{
    nt_random random;
    for (int i = 0; i < 4; i++)
        random.state[i] = splitmix64(&seed);
    return random;
}

double nt_random_uniform(nt_random *random)
{
    return (double)(xoshiro256pp(random->state) >> 11) * 0x1p-53;
}

double nt_random_normal(nt_random *random)
{
    enum { TRIES = 32 }; /* each is accepted with probability pi/4 */
    for (int i = 0; i < TRIES; i++) {
        const double u = 2.0 * nt_random_uniform(random) - 1.0;
        const double v = 2.0 * nt_random_uniform(random) - 1.0;
        const double s = u * u + v * v;
        if (s > 0.0 && s < 1.0)
            return u * sqrt(-2.0 * log(s) / s);
    }
    return 0.0;
}
