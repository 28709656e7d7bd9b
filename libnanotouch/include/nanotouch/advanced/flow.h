/* SPDX-License-Identifier: BSD-3-Clause
 * Tapping by its slow flow: amplitude and lag of a lever change little in one period, so that only what the force does
 * over a whole period counts (Krylov, Bogoliubov). With q = q0 + Re(Z e^(i w t)), t in 1/w0, r = w/w0:
 *     Z' = i/(2 r) [(1 - r^2 + i r/Q) Z - D - (fc - i fs) Z/|Z|],
 *     fc = 1/pi of the integral of F/k cos(psi) d(psi), fs = loss per period/(pi k |Z|), q = q0 + |Z| cos(psi).
 * One step costs some 40 forces and may last several periods; the time domain (tapping.h) needs 1000 in one. */
#ifndef NANOTOUCH_FLOW_H
#define NANOTOUCH_FLOW_H

#include "nanotouch/advanced/tapping.h"

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
/* What the force does in a period of amplitude A of q. */
typedef struct nt_flow_average {
    double cosine; /* fc [m] */
    double sine;   /* fs [m] */
    double mean;   /* <F>/k_c [m] */
    double low;    /* gap at the lowest point [m] */
    double peak;   /* the larger force of those at the lowest and the highest point [N] */
    double loss;   /* [J] */
    int attached;  /* at the top, afterwards */
} nt_flow_average;

/* Averages at the corners of cells of amplitude and lowest gap, made where steps come and kept for the next ones: a
 * step costs a tenth. Between the corners they are bilinear, and linear in the radius of the place. Zero: none yet.
 * Caller-owned, of one lever and plan; copyable. There is none across the capture gap, of a lever that stays attached,
 * or where a sample's properties change from place to place. */
enum { NT_FLOW_CELLS = 64 };
typedef struct nt_flow_cell {
    double low, amplitude, radius; /* of its first corner, and of the place [m] */
    int is_made;
    nt_flow_average corner[5]; /* low, low + width; the same at the next amplitude; the first at a larger radius */
} nt_flow_cell;
typedef struct nt_flow_table {
    nt_flow_cell cell[NT_FLOW_CELLS];
} nt_flow_table;

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
