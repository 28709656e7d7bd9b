/* SPDX-License-Identifier: BSD-3-Clause
 * Private to session/: a simulated session as it was at a tick. */
#ifndef NANOTOUCH_SESSION_HISTORY_H
#define NANOTOUCH_SESSION_HISTORY_H

#include "session/state.h"

typedef struct nt_past {
    nt_session_setup setup;
    nt_touch touch;
    nt_margins margins;
    nt_sideways_margins sideways;
    nt_guarantee guarantee;
    nt_touch_state touch_state;
    nt_sim sim;
    nt_reading readings[2];
    uint64_t kept_events; /* until then */
} nt_past;

enum { NT_HISTORY = 128 }; /* moments: half a minute */

struct nt_history {
    uint64_t interval; /* [ticks] */
    uint64_t next;     /* number of moments that were kept */
    nt_past moments[NT_HISTORY];
};

#endif
