/* SPDX-License-Identifier: BSD-3-Clause
 * Private: the machine's monotonic clock. Linux, macOS and Windows have one; elsewhere (the page) time stands at 0 and
 * nothing waits. */
#ifndef NANOTOUCH_HAL_CLOCK_H
#define NANOTOUCH_HAL_CLOCK_H

#include <stdint.h>

#include "nanotouch/status.h"

/* Is there an operating system, with a clock and threads of ours? */
#if defined(__linux__) || defined(__APPLE__) || defined(_WIN32)
#define NT_HAS_SYSTEM 1
#else
#define NT_HAS_SYSTEM 0
#endif

/* The same for all processes [ns]; 0 if there is none or it fails. */
int64_t nt_clock_now(void);
/* Returns at the deadline [ns] or soon after it, whatever signals come. NT_E_DEVICE if the system refuses. */
nt_status nt_clock_sleep_until(int64_t deadline);

#endif
