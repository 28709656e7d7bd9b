/* SPDX-License-Identifier: BSD-3-Clause
 * What is done before arming: zero the gauges (tare), and see that the stage moves as it is told (sign test). Steps
 * like the touch step: a sample in, a command out, once per period; the probe clear of the surface, nobody touching the
 * master. */
#ifndef NANOTOUCH_PREFLIGHT_H
#define NANOTOUCH_PREFLIGHT_H

#include "nanotouch/settings.h"
#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the sensors say where nothing is. */
typedef struct nt_tare {
    double deflection;     /* [m] */
    double operator_force; /* [N] */
} nt_tare;

typedef enum nt_preflight_verdict {
    NT_PREFLIGHT_RUNNING,
    NT_PREFLIGHT_PASSED,
    NT_PREFLIGHT_BAD_SAMPLE,       /* not a number, a device gone, a stop pressed */
    NT_PREFLIGHT_DEFLECTION_BIAS,  /* above limits.deflection_bias */
    NT_PREFLIGHT_DEFLECTION_DRIFT, /* above limits.deflection_drift */
    NT_PREFLIGHT_GAUGE_BIAS,
    NT_PREFLIGHT_GAUGE_DRIFT,
    NT_PREFLIGHT_STAGE /* it does not move, or the wrong way */
} nt_preflight_verdict;

typedef struct nt_preflight {
    nt_rig rig;
    nt_limits limits;
    double period;   /* T [s] */
    uint32_t ticks;  /* of each of the two halves of the tare */
    uint32_t move;   /* ticks that a move of the stage takes, and as many to settle */
    double distance; /* the stage draws back by this [m] */
} nt_preflight;
typedef struct nt_preflight_state {
    nt_preflight_verdict verdict;
    uint32_t tick;
    nt_tare sums[2];     /* of the halves */
    nt_tare tare;        /* found; valid from PASSED on */
    double rest, lifted; /* sums of the read-out before the move and after it [m] */
    double measure;      /* what the verdict is about [unit of its limit] */
} nt_preflight_state;
/* One period. The command leaves motor and lateral position alone. */
NT_API NT_REALTIME nt_preflight_verdict nt_preflight_step(const nt_preflight *preflight, nt_preflight_state *state,
                                                          const nt_sample *sample, nt_command *command);

#ifdef __cplusplus
}
#endif
#endif
