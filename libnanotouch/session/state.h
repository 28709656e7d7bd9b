/* SPDX-License-Identifier: BSD-3-Clause
 * Private to session/: what a session holds. */
#ifndef NANOTOUCH_SESSION_STATE_H
#define NANOTOUCH_SESSION_STATE_H

#include <stdatomic.h>

#include "core/ring.h"
#include "nanotouch/session.h"

struct nt_session {
    nt_plan plan;
    nt_touch touch;
    nt_touch_state touch_state;
    double master_start; /* [m] */
    nt_margins margins;
    nt_guarantee guarantee;
    double minimum_margin;
    nt_tare tare;
    uint64_t first_tick; /* of the rig, after preflight */
    int device_lost;
    atomic_uint stop; /* emergency stop: STOP_HELD, STOP_UNSEEN (run.c) */
    nt_sim sim;
    nt_hal hal;
    nt_mailbox mailbox;
    nt_input mailbox_memory[3];
    nt_ring ring;
    nt_record *records;
};

/* Names what is wrong, and returns the status for it. */
nt_status nt_session_refuse(nt_problem *problem, const char *field, const char *unit, double value, double minimum,
                            double maximum);
/* Of these settings in a mode at the stiffest contact of the plan. */
nt_verdict nt_session_judge(const nt_session *session, const nt_settings *settings, nt_mode mode, nt_margins *margins);
/* Is that margin enough? A minimum of 0 asks for none. */
int nt_session_allows(const nt_session *session, double margin);
/* Keeps margins and guarantee; refuses below the minimum margin. */
nt_status nt_session_promise(nt_session *session, const nt_session_setup *setup, nt_problem *problem);
/* Tare and sign test, on the rig's own time. */
nt_status nt_session_fly(nt_session *session, nt_problem *problem);

#endif
