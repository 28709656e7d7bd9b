/* SPDX-License-Identifier: BSD-3-Clause
 * How long things take in a loop, in fixed memory: a histogram whose buckets are a sixteenth of their value wide, one
 * for each phase of a period; and a loop that fills them. */
#ifndef NANOTOUCH_TIMING_H
#define NANOTOUCH_TIMING_H

#include <stdint.h>

#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { NT_HISTOGRAM_BUCKETS = 592 }; /* up to 2^40 ns, 18 minutes; what is longer is in the last one */

/* Zero is an empty one. */
typedef struct nt_histogram {
    uint64_t counts[NT_HISTOGRAM_BUCKETS];
    uint64_t total;
    int64_t most; /* [ns] */
    double sum;   /* [ns] */
} nt_histogram;

/* The duration that a share of all do not exceed: the upper end of its bucket, or the longest one if that is less [ns].
 * share 0 .. 1; 0 if the histogram is empty. */
NT_API int64_t nt_histogram_quantile(const nt_histogram *histogram, double share);

typedef enum nt_loop_phase {
    NT_LOOP_WAKE,    /* from the deadline to the first instruction */
    NT_LOOP_READ,    /* the three that the caller gives */
    NT_LOOP_COMPUTE, /* */
    NT_LOOP_WRITE,   /* */
    NT_LOOP_SLACK,   /* from the end to the next deadline; 0 once that has passed */
    NT_LOOP_PHASES
} nt_loop_phase;
/* "wake-up", "read", "compute", "write", "slack". "" for what is none. */
NT_API const char *nt_loop_phase_name(nt_loop_phase phase);

typedef struct nt_timing {
    nt_histogram phases[NT_LOOP_PHASES];
    uint64_t ticks;
    uint64_t overrun; /* periods whose work ended after the next deadline */
    uint64_t missed;  /* periods that were lost as a whole, and skipped */
} nt_timing;

/* What a loop does in a period; each may be NULL. Non-zero ends the loop. */
typedef struct nt_loop_phases {
    int (*read)(void *context, uint64_t tick, double lateness);
    int (*compute)(void *context);
    int (*write)(void *context);
    void *context;
} nt_loop_phases;

/* As nt_loop_run (hal.h), with each phase timed. *timing goes on from what it holds: zero it before the first run. */
NT_API nt_status nt_loop_run_timed(double period, uint64_t ticks, const nt_loop_phases *phases, nt_timing *timing);

#ifdef __cplusplus
}
#endif
#endif
