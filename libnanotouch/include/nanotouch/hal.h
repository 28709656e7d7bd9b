/* SPDX-License-Identifier: BSD-3-Clause
 * The rig as the loop sees it: read a sample, write a command. The simulated rig (sim.h) keeps the same contract as
 * real devices and ships with the library. */
#ifndef NANOTOUCH_HAL_H
#define NANOTOUCH_HAL_H

#include "nanotouch/hal_backend.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A backend and its context. Both belong to whoever made them; nt_hal_close hands the context to the backend. */
typedef struct nt_hal {
    const nt_hal_backend *backend;
    void *context;
} nt_hal;

/* NT_E_ARGUMENT if an operation is missing, NT_E_UNSUPPORTED if the backend was written for another version. */
NT_API nt_status nt_hal_open(nt_hal *hal, const nt_hal_backend *backend, void *context);
NT_API NT_REALTIME nt_status nt_hal_read(nt_hal *hal, nt_sample *sample);
NT_API NT_REALTIME nt_status nt_hal_write(nt_hal *hal, const nt_command *command);
/* Accepts NULL and a closed hal. */
NT_API void nt_hal_close(nt_hal *hal);

/* --- the loop: calls a step at a fixed rate on the monotonic clock (POSIX; NT_E_UNSUPPORTED elsewhere) --- */

typedef struct nt_loop_statistics {
    uint64_t ticks;     /* wake-ups */
    uint64_t late;      /* wake-ups later than a fifth of the period */
    uint64_t missed;    /* periods without a step: lost as a whole and skipped, not caught up */
    double worst_delay; /* [s] */
    double mean_delay;  /* [s] */
} nt_loop_statistics;
/* tick: number of the period, 0 first, strictly rising; lateness of this wake-up against its deadline, with the periods
 * that were lost before it: for nt_sample.lateness [s]. Returns 0 to go on; anything else ends the loop. */
typedef int (*nt_loop_step)(void *context, uint64_t tick, double lateness);
/* Periods 0 .. ticks - 1 of `period` seconds (1e-6 .. 0.999, NT_E_RANGE), the first one at once. statistics may be
 * NULL; it is written unless the arguments are refused. NT_E_DEVICE if the clock fails. */
NT_API nt_status nt_loop_run(double period, uint64_t ticks, nt_loop_step step, void *context,
                             nt_loop_statistics *statistics);

#ifdef __cplusplus
}
#endif
#endif
