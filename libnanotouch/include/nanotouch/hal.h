/* SPDX-License-Identifier: BSD-3-Clause
 * The rig as the loop sees it: two halves, master and slave, each behind a backend (hal_backend.h). The simulated rig
 * (sim.h) keeps the same contract as real devices and ships with the library. */
#ifndef NANOTOUCH_HAL_H
#define NANOTOUCH_HAL_H

#include "nanotouch/hal_backend.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One half: a backend and its context. The context belongs to whoever made it until nt_hal_close hands it back. */
typedef struct nt_hal {
    const nt_backend *backend;
    void *context;
    nt_capabilities capabilities;
    nt_reading reading; /* the newest; it is held until a newer one comes */
    int is_armed;
    int is_lost;  /* a write has failed: the next sample says so */
    int is_model; /* a simulated half: what fails in it is for the caller, and no lost device */
} nt_hal;

/* Which backend, and its context; NULL takes that of the backend itself. */
typedef struct nt_hal_choice {
    const nt_backend *backend;
    void *context;
} nt_hal_choice;

/* Opens a half and asks what it can do. NT_E_ARGUMENT if read or write is missing, NT_E_UNSUPPORTED if the backend was
 * written for another version or the other half, NT_E_RANGE with a problem if what it says of itself cannot be; or what
 * its open says. host may be NULL. */
NT_API nt_status nt_hal_open(nt_hal *hal, nt_half half, const nt_hal_choice *choice, const nt_host *host,
                             nt_problem *problem);
/* Tells an open half period and limits. NT_E_STATE if it is not open; else what its backend says. */
NT_API nt_status nt_hal_configure(nt_hal *hal, const nt_configuration *configuration, nt_problem *problem);
/* Lets the half move from now on. NT_E_STATE if it is not open; else what its backend says. */
NT_API nt_status nt_hal_arm(nt_hal *hal);
/* A new reading into hal->reading, or the last one held. A half that is gone, whose sequence runs backwards or that
 * gives what it does not call valid shows that in hal->reading.flags and as NaN: NT_OK. So does one that fails with any
 * other status, unless is_model. A lateness below 0 or NaN is infinite. */
NT_API NT_REALTIME nt_status nt_hal_read(nt_hal *hal);
/* A device that fails is NT_OK here and shows with the next reading. */
NT_API NT_REALTIME nt_status nt_hal_write(nt_hal *hal, const nt_action *action);
/* Accepts a half that is not armed. */
NT_API void nt_hal_disarm(nt_hal *hal);
/* Accepts NULL and a closed half. */
NT_API void nt_hal_close(nt_hal *hal);

/* --- a half in a shared object, by its path (Linux, macOS, Windows; NT_E_UNSUPPORTED elsewhere) --- */

typedef struct nt_module {
    void *handle;
    const nt_backend *backend; /* for nt_hal_choice; NULL: nothing is loaded */
    char text[1024];           /* what is wrong with it, in words; empty if nothing */
} nt_module;

/* Loads the object (a path, with a slash) and checks its table: size, version, half. *module is written unless the
 * arguments are refused (NT_E_ARGUMENT); its text says what is wrong. NT_E_DEVICE if the file cannot be loaded,
 * NT_E_ARGUMENT if it has no NT_BACKEND_ENTRY or no table, NT_E_UNSUPPORTED for another version or the other half. */
NT_API nt_status nt_hal_load(nt_module *module, const char *path, nt_half half);
/* Once the half is closed: its code goes. Accepts NULL and one that is not loaded. */
NT_API void nt_hal_unload(nt_module *module);

/* --- a rehearsal: does a backend keep the contract? --- */

typedef struct nt_rehearsal {
    nt_half half;
    nt_hal_choice choice;
    const nt_host *host;                              /* whose now counts for stamps and ages */
    nt_configuration configuration;                   /* what it is told; its period is that of the rehearsal */
    long periods;                                     /* to read and write, at least 1 */
    void (*pass)(const nt_host *host, double period); /* lets a period pass on the host's clock */
    double move; /* how far a slave goes along each axis that it reads, and back; 0: nothing is moved [m] */
} nt_rehearsal;

/* What has been seen. */
typedef struct nt_rehearsed {
    nt_capabilities capabilities; /* its channels belong to the backend: read them before it is unloaded */
    uint64_t readings;            /* new ones */
    double oldest;                /* largest age of a valid reading [s] */
    uint32_t same;                /* channels (NT_READS_*) whose readings, fifty at least, were one number all along */
    uint32_t moved;               /* bit 1 << axis: it went where it was commanded, and back */
} nt_rehearsed;

/* Opens and closes a half, then goes twice through its whole life: open, describe, configure, arm, some periods,
 * disarm, close. A master's motor is told 0 N, a slave to stay where it reads; with `move`, at the end of the second
 * life, each axis goes that far and back, z away from the sample where its range allows it, a leg within half of the
 * periods. Not real-time safe. seen and problem may be NULL. NT_OK; what an operation returned, with its name as
 * problem->field; or NT_E_RANGE with the broken rule (docs/hal.md lists them). */
NT_API nt_status nt_hal_rehearse(const nt_rehearsal *rehearsal, nt_rehearsed *seen, nt_problem *problem);

/* --- the loop: calls a step at a fixed rate on the monotonic clock (NT_E_UNSUPPORTED where there is none) --- */

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
