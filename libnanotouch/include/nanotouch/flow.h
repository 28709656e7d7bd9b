/* SPDX-License-Identifier: BSD-3-Clause
 * Tapping by its slow flow: amplitude and lag of a lever change little in one period, so that only what the force does
 * over a whole period counts (Krylov, Bogoliubov). With q = q0 + Re(Z e^(i w t)), t in 1/w0, r = w/w0:
 *     Z' = i/(2 r) [(1 - r^2 + i r/Q) Z - D - (fc - i fs) Z/|Z|],
 *     fc = 1/pi of the integral of F/k cos(psi) d(psi), fs = loss per period/(pi k |Z|), q = q0 + |Z| cos(psi).
 * One step costs some 40 forces and may last several periods; the time domain (tapping.h) needs 1000 in one. */
#ifndef NANOTOUCH_FLOW_H
#define NANOTOUCH_FLOW_H

#include "nanotouch/tapping.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Amplitude and lag, slowly changing. Copyable. */
typedef struct nt_flow_state {
    double real, imaginary; /* Z, of the tip's way q [m] */
    double mean;            /* q0 [m] */
    int attached;           /* 1: a contact holds through the whole period */
} nt_flow_state;
/* Swinging freely with A0. */
NT_API nt_flow_state nt_flow_free(const nt_tapping *tapping);

/* What a period does at an amplitude of q. */
typedef struct nt_flow_value {
    double amplitude;  /* A of the deflection [m] */
    double phase;      /* phi, as nt_tapping_value [rad] */
    double mean;       /* deflection [m] */
    double peak_force; /* the larger of those at the lowest and the highest point [N] */
    double lowest_gap; /* [m] */
    double virial;     /* <F (q - q0)> [J] */
    double tip_loss;   /* taken by the contact in a period [J] */
} nt_flow_value;
/* Now, over a place. */
NT_API NT_REALTIME nt_flow_value nt_flow_now(const nt_tapping *tapping, const nt_flow_state *state,
                                             const nt_tapping_over *over);

/* Goes on by `time` [s] in one step: the lever alone exactly, the force in between (Strang; second order). Stable and
 * good for steps of up to some sqrt(Q) periods. Returns what the period in the middle of the step is like. */
NT_API NT_REALTIME nt_flow_value nt_flow_step(const nt_tapping *tapping, nt_flow_state *state,
                                              const nt_tapping_over *over, double time);

/* Steps until nothing changes. NT_E_NO_CONVERGENCE: it still does after 60 Q periods; NT_E_ARGUMENT; NT_E_NOT_FINITE.
 */
NT_API nt_status nt_flow_settle(const nt_tapping *tapping, nt_flow_state *state, const nt_tapping_over *over,
                                nt_flow_value *value, nt_solve_info *info);

#ifdef __cplusplus
}
#endif
#endif
