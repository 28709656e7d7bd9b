/* SPDX-License-Identifier: BSD-3-Clause
 * xoshiro256++ 1.0 (Blackman and Vigna, "Scrambled linear pseudorandom number generators", 2019), seeded by splitmix64
 * (Steele, Lea and Flood 2014) as its authors advise: no seed gives the forbidden all-zero state. */
#include "internal/random.h"
#include "core/noise.h"

#include <math.h>

static const uint64_t gamma64 = UINT64_C(0x9e3779b97f4a7c15); /* 2^64 over the golden ratio, odd */

static inline uint64_t mix64(uint64_t z)
{
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

static uint64_t splitmix64(uint64_t *state)
{
    return mix64(*state += gamma64);
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

static inline double to_uniform(uint64_t bits)
{
    return (double)(bits >> 11) * 0x1p-53;
}

enum { TRIES = 32 }; /* of Marsaglia's polar method; each is accepted with probability pi/4 */

/* Of two uniform numbers: 1 and a standard normal one, or 0 where the point is outside the circle. */
static inline int to_normal(double first, double second, double *normal)
{
    const double u = 2.0 * first - 1.0, v = 2.0 * second - 1.0, s = u * u + v * v;
    if (!(s > 0.0 && s < 1.0))
        return 0;
    *normal = u * sqrt(-2.0 * log(s) / s);
    return 1;
}

double nt_random_uniform(nt_random *random)
{
    return to_uniform(xoshiro256pp(random->state));
}

double nt_random_normal(nt_random *random)
{
    double normal = 0.0;
    for (int i = 0; i < TRIES; i++) {
        const double first = nt_random_uniform(random);
        if (to_normal(first, nt_random_uniform(random), &normal))
            break;
    }
    return normal;
}

nt_noise nt_noise_of(uint64_t seed, uint32_t channel)
{
    return (nt_noise){.key = mix64(mix64(seed + gamma64) + gamma64 * (channel + UINT64_C(1)))};
}

void nt_noise_seek(nt_noise *noise, uint64_t tick)
{
    noise_seek(noise, tick);
}

static inline double next_uniform(nt_noise *noise)
{
    return to_uniform(mix64(noise->key + gamma64 * ++noise->position));
}

double nt_noise_uniform(nt_noise *noise)
{
    return next_uniform(noise);
}

double nt_noise_normal(nt_noise *noise)
{
    double normal = 0.0;
    for (int i = 0; i < TRIES; i++) {
        const double first = next_uniform(noise);
        if (to_normal(first, next_uniform(noise), &normal))
            break;
    }
    return normal;
}
