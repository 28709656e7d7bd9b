/* SPDX-License-Identifier: BSD-3-Clause
 * A half of a rig that gives again what one has measured before: the same hand on another sample, or a touch of
 * yesterday felt once more. What it is told moves nothing. */
#ifndef NANOTOUCH_HAL_REPLAY_H
#define NANOTOUCH_HAL_REPLAY_H

#include "nanotouch/hal_backend.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NT_REPLAY_LONGEST 1e9 /* [s] */

/* What was measured, row by row; the caller's, and in place as long as the half is used. */
typedef struct nt_replay_rows {
    int64_t count;
    int axes;               /* 1: z alone, or 3 */
    const double *time;     /* of each row since the first, rising [s] */
    const double *position; /* of hand or stage, x, y, z of each row; NaN: not measured [m] */
    const double *felt;     /* master: the operator's force [N]; slave: deflections [m]; NULL: nothing */
} nt_replay_rows;

/* The caller's, opened through nt_replay_backend. */
typedef struct nt_replay_half {
    nt_replay_rows rows;
    const nt_host *host;
    int64_t begun; /* when it was armed [ns] */
    int64_t row;   /* that was read last; -1: none */
} nt_replay_half;

/* NT_E_ARGUMENT without rows, time or position; NT_E_RANGE if there is no row, axes are neither 1 nor 3, or time does
 * not rise from 0 to NT_REPLAY_LONGEST at most; NT_E_NOT_FINITE if a time is no number. */
NT_API nt_status nt_replay_half_init(nt_replay_half *half, const nt_replay_rows *rows, nt_problem *problem);
/* The backend of a half; its context is the nt_replay_half. The first row comes with the first read after arm, each
 * other at its time since then. After the last row nothing new comes: the reading grows old, as docs/hal.md tells. */
NT_API const nt_backend *nt_replay_backend(nt_half half);

#ifdef __cplusplus
}
#endif
#endif
