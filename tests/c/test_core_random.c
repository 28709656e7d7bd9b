/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/random.h"
#include "nanotouch/advanced/random.h"

/* The numbers were computed by a separate implementation in Python from the published algorithms (arbitrary integers
 * masked to 64 bits); splitmix64's agree with its well-known sequence for the seed 1234567, xoshiro256++'s with the one
 * for the state 1, 2, 3, 4. */
static void seeds_by_splitmix64(void **state)
{
    (void)state;
    const nt_random random = nt_random_seed(1234567);
    assert_true(random.state[0] == UINT64_C(6457827717110365317));
    assert_true(random.state[1] == UINT64_C(3203168211198807973));
    assert_true(random.state[2] == UINT64_C(9817491932198370423));
    assert_true(random.state[3] == UINT64_C(4593380528125082431));
}

static void follows_xoshiro256pp(void **state)
{
    (void)state;
    static const uint64_t published[10] = {UINT64_C(41943041),
                                           UINT64_C(58720359),
                                           UINT64_C(3588806011781223),
                                           UINT64_C(3591011842654386),
                                           UINT64_C(9228616714210784205),
                                           UINT64_C(9973669472204895162),
                                           UINT64_C(14011001112246962877),
                                           UINT64_C(12406186145184390807),
                                           UINT64_C(15849039046786891736),
                                           UINT64_C(10450023813501588000)};
    nt_random random = {{1, 2, 3, 4}};
    for (int i = 0; i < 10; i++) /* the upper 53 bits make the double, exactly */
        assert_true((uint64_t)ldexp(nt_random_uniform(&random), 53) == published[i] >> 11);

    static const uint64_t seed_0[5] = {2923514112319844, 3442905506672666, 3239143844713295, 103182051538891,
                                       4460996193544523};
    random = nt_random_seed(0);
    for (int i = 0; i < 5; i++)
        assert_true((uint64_t)ldexp(nt_random_uniform(&random), 53) == seed_0[i]);

    uint64_t last = 0;
    random = nt_random_seed(42);
    for (int i = 0; i < 1001; i++)
        last = (uint64_t)ldexp(nt_random_uniform(&random), 53);
    assert_true(last != UINT64_C(5767628694198384)); /* the 1000th, one before */
    random = nt_random_seed(42);
    for (int i = 0; i < 1000; i++)
        last = (uint64_t)ldexp(nt_random_uniform(&random), 53);
    assert_true(last == UINT64_C(5767628694198384));
}

static void uniform_fills_the_unit_interval(void **state)
{
    (void)state;
    enum { N = 200000, BINS = 20 };
    int count[BINS] = {0};
    nt_random random = nt_random_seed(7);
    for (int i = 0; i < N; i++) {
        const double u = nt_random_uniform(&random);
        assert_true(u >= 0.0 && u < 1.0);
        count[(int)(u * BINS)]++;
    }
    double chi2 = 0.0;
    for (int b = 0; b < BINS; b++)
        chi2 += pow(count[b] - (double)N / BINS, 2) / ((double)N / BINS);
    assert_true(chi2 < 43.8); /* 19 degrees of freedom, 0.1 % level */
}

static void normal_has_its_moments_and_tails(void **state)
{
    (void)state;
    enum { N = 400000 };
    nt_random random = nt_random_seed(11);
    double sum[5] = {0};
    int beyond_1 = 0, beyond_3 = 0;
    for (int i = 0; i < N; i++) {
        const double x = nt_random_normal(&random);
        for (int p = 1; p <= 4; p++)
            sum[p] += pow(x, p) / N;
        beyond_1 += fabs(x) > 1.0;
        beyond_3 += fabs(x) > 3.0;
    }
    /* Four standard errors: sqrt(var(x^p)/N) with var = 1, 2, 15, 96. */
    assert_true(fabs(sum[1]) < 4 * sqrt(1.0 / N));
    assert_true(fabs(sum[2] - 1.0) < 4 * sqrt(2.0 / N));
    assert_true(fabs(sum[3]) < 4 * sqrt(15.0 / N));
    assert_true(fabs(sum[4] - 3.0) < 4 * sqrt(96.0 / N));
    assert_true(fabs(beyond_1 - 0.3173105079 * N) < 4 * sqrt(0.3173 * 0.6827 * N));
    assert_true(fabs(beyond_3 - 0.0026997961 * N) < 4 * sqrt(0.0027 * N));
}

/* A draw is a function of seed, channel and tick: not of what was drawn before. */
static void noise_is_known_by_its_place(void **state)
{
    (void)state;
    nt_noise noise = nt_noise_of(5, 2), other = nt_noise_of(5, 2);
    nt_noise_seek(&noise, 1000);
    const double there = nt_noise_normal(&noise);
    for (uint64_t tick = 0; tick <= 1000; tick++) {
        nt_noise_seek(&other, tick);
        const double drawn = nt_noise_normal(&other);
        assert_true(tick < 1000 ? drawn != there : drawn == there);
    }
    /* splitmix64 (Steele, Lea and Flood) from state 0: its first number is published with the generator */
    nt_noise published = {0, 0};
    assert_true((uint64_t)ldexp(nt_noise_uniform(&published), 53) == UINT64_C(0xe220a8397b1dcdaf) >> 11);
}

enum { CHANNELS = 12, TICKS = 40000 };

/* The noise that a sensor shows: the first normal number of each tick. */
static double first_normal(uint64_t seed, uint32_t channel, uint64_t tick)
{
    nt_noise noise = nt_noise_of(seed, channel);
    nt_noise_seek(&noise, tick);
    return nt_noise_normal(&noise);
}

/* White over ticks, unrelated between channels and neighbouring seeds: correlations within 5 standard errors. */
static void noise_of_channels_and_ticks_is_independent(void **state)
{
    (void)state;
    double lag = 0.0, square = 0.0, across[CHANNELS] = {0.0}, seeds = 0.0;
    for (uint64_t tick = 0; tick < TICKS; tick++) {
        const double now = first_normal(1, 0, tick);
        square += now * now / TICKS;
        lag += now * first_normal(1, 0, tick + 1) / TICKS;
        seeds += now * first_normal(2, 0, tick) / TICKS;
        for (uint32_t channel = 1; channel < CHANNELS; channel++)
            across[channel] += now * first_normal(1, channel, tick) / TICKS;
    }
    const double error = 5.0 / sqrt(TICKS);
    assert_true(fabs(square - 1.0) < sqrt(2.0) * error);
    assert_true(fabs(lag) < error);
    assert_true(fabs(seeds) < error);
    for (int channel = 1; channel < CHANNELS; channel++)
        assert_true(fabs(across[channel]) < error);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(seeds_by_splitmix64),
        cmocka_unit_test(follows_xoshiro256pp),
        cmocka_unit_test(uniform_fills_the_unit_interval),
        cmocka_unit_test(normal_has_its_moments_and_tails),
        cmocka_unit_test(noise_is_known_by_its_place),
        cmocka_unit_test(noise_of_channels_and_ticks_is_independent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
