/* SPDX-License-Identifier: BSD-3-Clause
 * What the views and the Python package ask of a session. */
#ifndef NANOTOUCH_INTERNAL_SESSION_H
#define NANOTOUCH_INTERNAL_SESSION_H

#include "nanotouch/session.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Would it be taken? */
NT_API nt_status nt_session_check_input(const nt_session *session, const nt_input *input, nt_problem *problem);
/* The terrain that this plan borrows from, for a caller that keeps the plan beyond the next change: it stays until the
 * caller closes it with nt_terrain_close. It may itself borrow from the session: of no use after nt_session_close. */
NT_API nt_terrain *nt_session_hold_terrain(nt_session *session);
/* 1 where the session itself has called, while it runs or prepares a request: a half, a law, who takes its lines. From
 * there nothing that runs, asks, starts, halts, publishes or copies is done (NT_E_STATE), and it is not closed. Inputs,
 * emergency stop, pause, steps and speed are taken. */
NT_API int nt_session_runs_here(const nt_session *session);
/* Its state after the last tick: targets, scales, reasons. */
NT_API const nt_touch_state *nt_session_touch_state(const nt_session *session);
/* Height of the cantilever base at x_s = 0 [m]: z_b = start_height - x_s. NaN where the slave is not simulated. */
NT_API double nt_session_start_height(const nt_session *session);
/* x_m at the start [m]: the stage shall be at alpha_p (x_m - master_start). */
NT_API double nt_session_master_start(const nt_session *session);

#ifdef __cplusplus
}
#endif
#endif
