/* SPDX-License-Identifier: BSD-3-Clause
 * What a Linux machine grants the thread of a loop: a real-time priority, memory that stays, a processor of its own, no
 * deep sleep. Each refusal is told in words; the loop may run without. NT_E_UNSUPPORTED elsewhere. */
#ifndef NANOTOUCH_REALTIME_H
#define NANOTOUCH_REALTIME_H

#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nt_realtime_wish {
    int priority;    /* of SCHED_FIFO: 1 .. 99; 0: not wished */
    int processor;   /* to stay on: 0 ..; -1: not wished */
    int locks;       /* memory is locked (mlockall), and some stack touched */
    int stays_awake; /* no deep idle state: /dev/cpu_dma_latency */
} nt_realtime_wish;
/* Priority 80, any processor, locked, awake. */
NT_API nt_realtime_wish nt_realtime_wish_defaults(void);

enum { NT_REALTIME_PRIORITY = 1, NT_REALTIME_PROCESSOR = 2, NT_REALTIME_MEMORY = 4, NT_REALTIME_AWAKE = 8 };

typedef struct nt_realtime {
    unsigned wished, granted; /* of the bits above */
    char refused[640];        /* a line for each wish that was refused, with why and what would help; "" if none */
    int awake_file;           /* -1: none */
    int policy, priority;     /* of the thread before */
} nt_realtime;

/* Asks for the calling thread. NT_OK whatever was granted; NT_E_RANGE for a priority or a processor that cannot be. */
NT_API nt_status nt_realtime_begin(nt_realtime *realtime, const nt_realtime_wish *wish);
/* Gives priority, memory and wakefulness back, by the same thread. Accepts NULL. */
NT_API void nt_realtime_end(nt_realtime *realtime);

#ifdef __cplusplus
}
#endif
#endif
