/* SPDX-License-Identifier: BSD-3-Clause
 * Edges of the classes of a histogram. */
#ifndef NANOTOUCH_INTERNAL_TIMING_H
#define NANOTOUCH_INTERNAL_TIMING_H

#include "nanotouch/advanced/timing.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Where bucket `index` begins [ns]; that of NT_HISTOGRAM_BUCKETS is where the last one ends. */
NT_API int64_t nt_histogram_edge(int index);

#ifdef __cplusplus
}
#endif
#endif
