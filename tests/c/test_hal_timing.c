/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "hal/timing.h"
#include "internal/timing.h"
#include "nanotouch/advanced/timing.h"

static nt_histogram histogram;

static void buckets_are_a_sixteenth_wide(void **state)
{
    (void)state;
    for (int i = 0; i < NT_HISTOGRAM_BUCKETS; ++i) {
        const int64_t from = nt_histogram_edge(i), to = nt_histogram_edge(i + 1);
        assert_true(to > from && (to - from == 1 || (double)(to - from) <= (double)from / 16.0));
        const int64_t inside[] = {from, to - 1};
        for (int k = 0; k < 2; ++k) { /* both ends are in it, and in no other */
            histogram = (nt_histogram){.total = 0};
            nt_histogram_add(&histogram, inside[k]);
            assert_int_equal(histogram.counts[i], 1);
        }
    }
    assert_true(nt_histogram_edge(NT_HISTOGRAM_BUCKETS) >= 1LL << 40);
    assert_int_equal(nt_histogram_edge(-1), 0);
}

static int by_size(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

/* Against the sorted list itself. */
static void quantiles_of_dice(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    static int64_t list[COUNT];
    const double shares[] = {0.0, 0.5, 0.9, 0.99, 0.999, 0.9999, 1.0};
    uint32_t dice = 12345;
    histogram = (nt_histogram){.total = 0};
    for (int i = 0; i < COUNT; ++i) {
        dice = dice * 1664525u + 1013904223u;
        list[i] = (int64_t)exp(25.0 * (dice >> 8) / 16777216.0);
        nt_histogram_add(&histogram, list[i]);
    }
    qsort(list, COUNT, sizeof *list, by_size);
    for (int i = 0; i < 7; ++i) {
        const int at = (int)ceil(shares[i] * COUNT) - 1;
        const double exact = (double)list[at < 0 ? 0 : at],
                     found = (double)nt_histogram_quantile(&histogram, shares[i]);
        if (!(found >= exact && found <= 1.0626 * exact + 1.0))
            fail_msg("share %g: %g instead of %g", shares[i], found, exact);
    }
    assert_int_equal(histogram.most, list[COUNT - 1]);
}

static void ends(void **state)
{
    (void)state;
    histogram = (nt_histogram){.total = 0};
    assert_int_equal(nt_histogram_quantile(&histogram, 0.5), 0);
    nt_histogram_add(&histogram, -5);
    nt_histogram_add(&histogram, INT64_MAX);
    assert_true(histogram.counts[0] == 1 && histogram.counts[NT_HISTOGRAM_BUCKETS - 1] == 1);
    assert_true(histogram.most == INT64_MAX && histogram.total == 2);
    assert_string_equal(nt_loop_phase_name(NT_LOOP_SLACK), "slack");
    assert_string_equal(nt_loop_phase_name(NT_LOOP_PHASES), "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buckets_are_a_sixteenth_wide),
        cmocka_unit_test(quantiles_of_dice),
        cmocka_unit_test(ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
