/* SPDX-License-Identifier: BSD-3-Clause
 * Private: one period of a tapping tip of given swing and depth, its higher harmonics in balance with the force. */
#ifndef NANOTOUCH_SCAN_ORBIT_H
#define NANOTOUCH_SCAN_ORBIT_H

#include "internal/balance.h"

enum { NEGLECTED = 24, ORDERS = NT_HARMONICS_MAX + NEGLECTED, PRODUCTS = 2 * NT_HARMONICS_MAX };

typedef struct orbit {
    const nt_balance *balance;
    nt_balance_state at; /* swing, depth, higher harmonics */
    double middle;       /* gap where only the mean acts [m] */
    double low_angle, lowest, top;
    int orders, captured, released;
    double force[ORDERS + 1][2];    /* F_n/k_c, real and imaginary, n = 0 .. orders [m] */
    double slope[PRODUCTS + 1][2];  /* 1/pi of the integral of dF/dh e^(-i p psi)/k_c */
    double damper[PRODUCTS + 1][2]; /* the same of the contact's damping over w t */
    double loss;                    /* of the contact, over pi k_c [m^2] */
    double peak, contact_time;      /* [N], [-] */
    double down[4], up[4];          /* of the complete one: what small deviations of q and dq/d(w t) become, top to
                                       lowest point and on to the top; without their decay */
    double decay;                   /* exponent by which their area falls in a period */
    int is_complete;
    long evaluations;
} orbit;

/* From o->balance and o->at, whose harmonics are where it begins. 0 where there is no such period. */
int nt_orbit_find(orbit *o);
/* F_n up to NEGLECTED harmonics more than the balance has, and what small deviations become. */
void nt_orbit_complete(orbit *o);
/* Of a complete one: small deviations die out, from period to period (Floquet). */
int nt_orbit_returns(const orbit *o);

#endif
