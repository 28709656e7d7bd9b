/* SPDX-License-Identifier: BSD-3-Clause
 * The stage follows a reference: notch on the resonance, integral action on the read-out. */
#ifndef NANOTOUCH_STAGE_LOOP_H
#define NANOTOUCH_STAGE_LOOP_H

#include "nanotouch/settings.h"
#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nt_stage_loop {
    nt_sum b[3], a[3]; /* biquad in z^-1, a[0] = 1: zeros on the sampled poles of the stage */
    nt_sum integral;   /* integral gain per period [-] */
} nt_stage_loop;
typedef struct nt_stage_loop_state {
    nt_sum w[2];       /* filter memory [m] */
    nt_sum correction; /* integral of the error [m] */
} nt_stage_loop_state;
/* Whether samples are many enough to see the resonance: two in its period; else the notch is off. */
NT_API int nt_stage_loop_notches(const nt_stage *stage, const nt_gains *gains);
/* Notch and gain for a stage and gains that have been checked. */
NT_API nt_stage_loop nt_stage_loop_make(const nt_stage *stage, const nt_gains *gains);
/* One period: reference and read-out [m] in, the command to the stage [m] out. */
NT_API NT_REALTIME nt_sum nt_stage_loop_step(const nt_stage_loop *loop, nt_stage_loop_state *state, nt_sum reference,
                                             double measured);

#ifdef __cplusplus
}
#endif
#endif
