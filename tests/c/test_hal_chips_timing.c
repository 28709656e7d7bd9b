/* SPDX-License-Identifier: BSD-3-Clause
 * Buckets of durations and the chip that a kernel's driver runs, by number. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "hal/timing.h"
#include "internal/timing.h"
#include "nanotouch/advanced/hal_iio.h"
#include "nanotouch/advanced/timing.h"

/* One each up to 32, then the five leading bits. */
static int bucket_by_hand(int64_t duration)
{
    if (duration < 32)
        return duration < 0 ? 0 : (int)duration;
    int bits = 0;
    while (duration >> bits)
        ++bits;
    const int index = 16 * (bits - 5) + (int)(duration >> (bits - 5));
    return index < NT_HISTOGRAM_BUCKETS ? index : NT_HISTOGRAM_BUCKETS - 1;
}

static void buckets_and_their_edges(void **state)
{
    (void)state;
    static nt_histogram h;
    memset(&h, 0, sizeof h);
    uint64_t count = 0;
    double sum = 0.0;
    int64_t most = 0;
    for (int64_t base = 1; base > 0 && base < (int64_t)1 << 62; base *= 2)
        for (int64_t off = -1; off <= 1; ++off) {
            const int64_t duration = base + off;
            static nt_histogram before;
            before = h;
            nt_histogram_add(&h, duration);
            const int bucket = bucket_by_hand(duration);
            assert_true(h.counts[bucket] == before.counts[bucket] + 1);
            if (bucket < NT_HISTOGRAM_BUCKETS - 1)
                assert_true(nt_histogram_edge(bucket) <= duration && duration < nt_histogram_edge(bucket + 1));
            sum += (double)duration;
            most = duration > most ? duration : most;
            assert_true(h.total == ++count && h.sum == sum && h.most == most);
        }
    nt_histogram_add(&h, -5);
    assert_true(h.counts[0] == 2 && h.sum == sum && h.total == count + 1); /* 0 and this one */
    assert_true(nt_histogram_edge(-1) == 0 && nt_histogram_edge(31) == 31 && nt_histogram_edge(32) == 32);
    assert_true(nt_histogram_edge(33) == 34 && nt_histogram_edge(48) == 64 && nt_histogram_edge(49) == 68);
}

static void quantiles(void **state)
{
    (void)state;
    static nt_histogram h;
    memset(&h, 0, sizeof h);
    assert_true(nt_histogram_quantile(&h, 0.5) == 0);
    for (int i = 1; i <= 20; ++i)
        nt_histogram_add(&h, i);                        /* 1 .. 20, one each */
    assert_true(nt_histogram_quantile(&h, 0.5) == 11);  /* the end of the bucket of 10 */
    assert_true(nt_histogram_quantile(&h, 0.51) == 12); /* the eleventh */
    assert_true(nt_histogram_quantile(&h, 0.0) == 2 && nt_histogram_quantile(&h, 1.0) == 20);
    nt_histogram_add(&h, 1000);
    assert_true(nt_histogram_quantile(&h, 1.0) == 1000 && h.most == 1000);
}

static void names_of_phases(void **state)
{
    (void)state;
    assert_string_equal(nt_loop_phase_name((nt_loop_phase)0), "wake-up");
    assert_string_equal(nt_loop_phase_name((nt_loop_phase)(NT_LOOP_PHASES - 1)), "slack");
    assert_string_equal(nt_loop_phase_name(NT_LOOP_PHASES), "");
}

static void a_chip_of_a_driver(void **state)
{
    (void)state;
    for (int output = 0; output < 2; ++output) {
        const int most = output ? 20 : 24, channels = output ? NT_IIO_OUTPUTS : NT_IIO_INPUTS;
        for (int bits = 0; bits <= most + 1; ++bits)
            for (int n = 0; n <= channels + 1; ++n) {
                const nt_chip chip = nt_chip_of_iio(bits, n, output);
                const int is_one = bits >= 2 && bits <= most && n >= 1 && n <= channels;
                assert_int_equal(chip.name != NULL, is_one);
                if (!is_one)
                    continue;
                assert_true(chip.is_dac == output && chip.bits == bits && chip.channels == n);
                assert_true(chip.is_signed == !output && chip.steps == ldexp(1.0, bits) - 1.0);
                if (output) {
                    assert_true(chip.words.write == 1u << 22 && chip.words.read == 1u << 23 && chip.words.field == 20);
                    for (uint32_t i = 0; i < 4; ++i)
                        assert_true(chip.words.channels[i] == i << 20);
                } else {
                    assert_true(chip.answer.count == 3u * (uint32_t)n + 1u && chip.answer.width == 3);
                    assert_true(chip.answer.status == 3u * (uint32_t)n && chip.answer.bad == 0xFE);
                }
            }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buckets_and_their_edges),
        cmocka_unit_test(quantiles),
        cmocka_unit_test(names_of_phases),
        cmocka_unit_test(a_chip_of_a_driver),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
