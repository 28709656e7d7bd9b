/* SPDX-License-Identifier: BSD-3-Clause
 * The slow flow of a tapping lever. */
#ifndef NANOTOUCH_INTERNAL_TAPPING_H
#define NANOTOUCH_INTERNAL_TAPPING_H

#include "nanotouch/advanced/tapping.h"

#ifdef __cplusplus
extern "C" {
#endif

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

/* Swinging freely with A0. */
NT_API nt_flow_state nt_flow_free(const nt_tapping *tapping);
/* Goes on by `time` [s]: the lever alone exactly, the force in between (Strang; second order); in halves where the
 * force turns the lag by more than 0.05 rad. Good for steps of up to 0.25 sqrt(Q) periods. Returns what the period in
 * the middle of the step is like. */
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
