/* SPDX-License-Identifier: BSD-3-Clause
 * The edge of an adhesive contact on a sample that relaxes, as a crack that opens or closes: its effective work of
 * adhesion by its speed. Private to rheology/. */
#ifndef NANOTOUCH_RHEOLOGY_CRACK_H
#define NANOTOUCH_RHEOLOGY_CRACK_H

#include "rheology/prony.h"

typedef struct nt_crack {
    int count;
    double shares[NT_RHEOLOGY_ARMS]; /* E_inf J_j [-] */
    double times[NT_RHEOLOGY_ARMS];  /* retardation times [s] */
    double length;                   /* a_0, of the process zone of a crack at rest [m] */
    double max_ratio;                /* E_0/E_inf [-] */
    double viscosity;                /* of the bulk, Int (E - E_inf) dt [Pa s] */
} nt_crack;

/* Of a standard linear solid or a Prony series with E_inf > 0. */
nt_status nt_crack_make(const nt_rheology *rheology, double length, nt_crack *crack);
/* w_eff/w of a crack that opens and crosses its own process zone s times a second, 1 .. max_ratio; it then moves at
 * length * ratio * s. */
double nt_crack_ratio(const nt_crack *crack, double s);
/* Its inverse. 0 for ratios up to 1, INFINITY from max_ratio on. [1/s] */
double nt_crack_crossings(const nt_crack *crack, double ratio);
/* Those of a crack that moves at a speed > 0 [m/s]; ln. */
nt_status nt_crack_log_crossings_at(const nt_crack *crack, double speed, double *log_s);

#endif
