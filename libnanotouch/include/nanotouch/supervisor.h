/* SPDX-License-Identifier: BSD-3-Clause
 * RUN, HOLD, RETRACT, LATCHED: a pure function of sample, command and limits (the table in docs/safety.md). */
#ifndef NANOTOUCH_SUPERVISOR_H
#define NANOTOUCH_SUPERVISOR_H

#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    NT_REASON_INVALID = 1u << 0,   /* NaN, infinite, beyond any reading of the sensor, or bad frame */
    NT_REASON_SATURATED = 1u << 1, /* deflection at the end of its range */
    NT_REASON_FORCE_LIMIT = 1u << 2,
    NT_REASON_STALE = 1u << 3,    /* sample older than 2 T */
    NT_REASON_STUCK = 1u << 4,    /* the deflection does not change while z moves */
    NT_REASON_FOLLOW = 1u << 5,   /* the stage does not follow */
    NT_REASON_UNSTABLE = 1u << 6, /* the passivity observer has taken all force gain away */
    NT_REASON_EMERGENCY_STOP = 1u << 7,
    NT_REASON_LIMIT_SWITCH = 1u << 8,
    NT_REASON_OPERATOR_CLIPPED = 1u << 9, /* the gauge is at its range: a flag, the state stays RUN */
    NT_REASON_COMMAND_LIMITED = 1u << 10  /* stage speed or travel is at its limit: a flag */
};
/* "force limit", ... of one reason bit; "" for none. */
NT_API const char *nt_reason_name(uint32_t reason);

typedef struct nt_supervisor_state {
    nt_state state;
    uint32_t reasons;
    uint32_t invalid_run;    /* invalid samples in a row */
    uint32_t stuck_run;      /* identical deflections in a row */
    double stuck_deflection; /* [m] */
    double stuck_position;   /* x_s where they began [m] */
    double follow_time;      /* the stage has been off for this long [s] */
} nt_supervisor_state;

struct nt_touch;
/* One tick. reference: where the stage was told to be [m]. Returns the new state, never less severe than RETRACT or
 * LATCHED once reached (nt_touch_arm). */
NT_API NT_REALTIME nt_state nt_supervisor_step(const struct nt_touch *touch, nt_supervisor_state *state,
                                               const nt_sample *sample, double reference, int unstable);

#ifdef __cplusplus
}
#endif
#endif
