/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what timing.h does not promise. */
#ifndef NANOTOUCH_HAL_TIMING_PRIVATE_H
#define NANOTOUCH_HAL_TIMING_PRIVATE_H

#include "nanotouch/advanced/timing.h"

/* A duration [ns]; one below 0 counts as 0. */
NT_REALTIME void nt_histogram_add(nt_histogram *histogram, int64_t duration);

#endif
