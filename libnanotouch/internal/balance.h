/* SPDX-License-Identifier: BSD-3-Clause
 * Steady tapping by harmonic balance: what repeats each period is a mean and N harmonics of the tip's way, each in
 * balance with that harmonic of the force (Hayashi 1964). With q = q0 + Re(sum u_n e^(i n psi)), psi = w t - theta,
 * u_1 = A > 0, r = w/w0:
 *     (1 - n^2 r^2 + i n r/Q) u_n = F_n/k_c   (n = 0, 2 .. N),     |(1 - r^2 + i r/Q) A - F_1/k_c| = D.
 * One harmonic is where the slow flow rests. Motions lie on one curve of swing A and depth, the gap at psi =
 * pi, where the first harmonic is lowest; one height may have three of them, one of which is unstable. */
#ifndef NANOTOUCH_INTERNAL_BALANCE_H
#define NANOTOUCH_INTERNAL_BALANCE_H

#include "nanotouch/advanced/tapping.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { NT_HARMONICS_MAX = 24, NT_BALANCE_POINTS = 600 };

/* Over what it taps, and by how many harmonics. */
typedef struct nt_balance {
    const nt_tapping *lever;
    const nt_plan *plan;
    const nt_place *place; /* NULL: a flat at z = 0 */
    int harmonics;         /* N, 1 .. NT_HARMONICS_MAX */
    double accuracy;       /* nt_balance_find takes fewer of them where amplitude over A0 and peak force over the larger
                              of itself and the pull-off are bound by this; 0: all [-] */
} nt_balance;

/* A motion, enough to go on from to another one nearby. Copyable. */
typedef struct nt_balance_state {
    double swing;                                                       /* A of the tip's way [m] */
    double depth;                                                       /* gap at psi = pi [m] */
    double lag;                                                         /* psi = w t - lag [rad] */
    double real[NT_HARMONICS_MAX + 1], imaginary[NT_HARMONICS_MAX + 1]; /* u_n at [n], n >= 2; beyond those in balance
                                                                           a guess [m] */
} nt_balance_state;

typedef struct nt_balance_value {
    double base_height;                  /* z_b at rest [m] */
    double amplitude;                    /* A of the deflection [m] */
    double phase;                        /* phi, as nt_tapping_value [rad] */
    double mean;                         /* deflection [m] */
    double peak_force;                   /* largest force [N] */
    double lowest_gap;                   /* [m] */
    double contact_time;                 /* share of the period with a contact area [-] */
    double tip_loss;                     /* taken by the contact in a period [J] */
    double gain;                         /* dA/dz_b, the amplitude's answer to the base [-]; NaN at a fold */
    int stable;                          /* 1: at this height the lever keeps this motion */
    int harmonics;                       /* taken */
    double amplitude_bound, force_bound; /* of what the harmonics left out would change, at this height [m], [N] */
    long evaluations;                    /* of the force */
} nt_balance_value;

/* What a motion is wanted for. */
typedef enum nt_balance_aim { NT_AIM_HEIGHT, NT_AIM_AMPLITUDE, NT_AIM_PHASE } nt_balance_aim;
typedef struct nt_balance_target {
    nt_balance_aim aim;
    double value; /* base height [m], amplitude of the deflection [m], phase [rad] */
    int lifted;   /* 1: the lever comes up from the surface; 0: down from far */
} nt_balance_target;

/* A point of the curve of all motions, with one harmonic. */
typedef struct nt_balance_point {
    double swing, depth, base_height; /* [m] */
    double amplitude, phase;          /* of the deflection [m], [rad] */
    double peak_force;                /* [N] */
    int piece;                        /* points of one number hang together */
    int stable;                       /* 1: at this height the lever keeps this motion */
} nt_balance_point;
/* All branches, and the unstable parts between them, in pieces, the free lever's first: the curve is cut where a
 * meniscus or contact takes hold. Caller-owned, 40 kB. */
typedef struct nt_balance_curve {
    int count;
    nt_balance_point at[NT_BALANCE_POINTS];
} nt_balance_curve;
/* Neither balance->harmonics nor its accuracy is asked. NT_E_ARGUMENT, NT_E_NO_CONVERGENCE. */
NT_API nt_status nt_balance_trace(const nt_balance *balance, nt_balance_curve *curve);

#ifdef __cplusplus
}
#endif
#endif
