/* SPDX-License-Identifier: BSD-3-Clause
 * Histograms of durations, in buckets of constant relative width: below 32 ns one each, then 16 to an octave. */
#include "internal/timing.h"
#include "hal/timing.h"
#include "nanotouch/advanced/timing.h"

#include <math.h>
#include <stddef.h>

enum { FINE = 32, PER_OCTAVE = 16 };

static int bucket_of(int64_t duration)
{
    if (duration < FINE)
        return duration < 0 ? 0 : (int)duration;
    int octave = 0;
    while (duration >> (octave + 1) >= PER_OCTAVE) /* until its five leading bits are left */
        ++octave;
    const int index = PER_OCTAVE * octave + (int)(duration >> octave);
    return index < NT_HISTOGRAM_BUCKETS ? index : NT_HISTOGRAM_BUCKETS - 1;
}

int64_t nt_histogram_edge(int index)
{
    if (index < FINE)
        return index < 0 ? 0 : index;
    const int octave = index / PER_OCTAVE - 1;
    return (int64_t)(PER_OCTAVE + index % PER_OCTAVE) << octave;
}

void nt_histogram_add(nt_histogram *histogram, int64_t duration)
{
    const int64_t taken = duration < 0 ? 0 : duration;
    ++histogram->counts[bucket_of(taken)];
    ++histogram->total;
    histogram->sum += (double)taken;
    if (taken > histogram->most)
        histogram->most = taken;
}

int64_t nt_histogram_quantile(const nt_histogram *histogram, double share)
{
    const double wanted = ceil(share * (double)histogram->total);
    uint64_t seen = 0;
    for (int i = 0; i < NT_HISTOGRAM_BUCKETS && histogram->total > 0; ++i) {
        seen += histogram->counts[i];
        if (seen > 0 && (double)seen >= wanted) {
            const int64_t end = nt_histogram_edge(i + 1);
            return end < histogram->most ? end : histogram->most;
        }
    }
    return histogram->most;
}

const char *nt_loop_phase_name(nt_loop_phase phase)
{
    static const char *const names[NT_LOOP_PHASES] = {"wake-up", "read", "compute", "write", "slack"};
    return (unsigned)phase < NT_LOOP_PHASES ? names[phase] : "";
}
