/* SPDX-License-Identifier: BSD-3-Clause
 * Small linear systems with one input: exact discretisation of x' = A x + B u under a zero-order hold. Private. */
#ifndef NANOTOUCH_CORE_LTI_H
#define NANOTOUCH_CORE_LTI_H

#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { NT_LTI_MAX = 4 };

/* Continuous, x' = a x + b u, or discrete, x[k+1] = a x[k] + b u[k]. */
typedef struct nt_lti {
    int order; /* 1 .. NT_LTI_MAX */
    double a[NT_LTI_MAX][NT_LTI_MAX];
    double b[NT_LTI_MAX];
} nt_lti;

/* phi = exp(A T), gamma = integral of exp(A t) B over one period T [s], u held. Scale the states so that the entries of
 * A T are of like size: accuracy is about (1 + omega T) 2^-52 for the fastest oscillation omega. NT_E_ARGUMENT (order),
 * NT_E_NOT_FINITE, NT_E_RANGE (T <= 0, or |A T| above 2^40: nothing is left of the phase there). */
nt_status nt_lti_discretise(const nt_lti *continuous, double period, nt_lti *discrete);

#ifdef __cplusplus
}
#endif
#endif
