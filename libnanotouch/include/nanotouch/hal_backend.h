/* SPDX-License-Identifier: BSD-3-Clause
 * For those who write a backend: one const table of operations. */
#ifndef NANOTOUCH_HAL_BACKEND_H
#define NANOTOUCH_HAL_BACKEND_H

#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NT_HAL_API_VERSION 1

/* read and write are called once per period, in this order, by one thread; both must be real-time safe. A missing
 * operation is NULL. What cannot be measured is NaN with NT_SAMPLE_INVALID set, never 0. */
typedef struct nt_hal_backend {
    const char *name; /* "sim", "spidev", ... */
    int api_version;  /* NT_HAL_API_VERSION */
    nt_status (*read)(void *context, nt_sample *sample);
    nt_status (*write)(void *context, const nt_command *command);
    void (*close)(void *context); /* leaves the rig safe: motor force 0, stage where it is */
} nt_hal_backend;

#ifdef __cplusplus
}
#endif
#endif
