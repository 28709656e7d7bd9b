/* SPDX-License-Identifier: BSD-3-Clause
 * The generalized Maxwell model of so many arms; private to rheology/. */
#ifndef NANOTOUCH_RHEOLOGY_PRONY_H
#define NANOTOUCH_RHEOLOGY_PRONY_H

#include "internal/rheology.h"
#include "rheology/kernel.h"

nt_status nt_prony_check(const nt_rheology *rheology, int arms, nt_problem *problem);
double nt_prony_relaxation(const nt_rheology *rheology, int arms, double time);
double nt_prony_integral(const nt_rheology *rheology, int arms, double time);
double nt_prony_creep(const nt_rheology *rheology, int arms, double time);
/* The creep compliance as arms: J(t) = J(infinity) - Sum J_j exp(-q_j t), or beside the flow of a fluid.
 * NT_E_NO_CONVERGENCE where two relaxation times cannot be told apart. */
typedef struct nt_retardation {
    int count;
    double compliances[NT_RHEOLOGY_ARMS]; /* J_j [1/Pa] */
    double rates[NT_RHEOLOGY_ARMS];       /* q_j [1/s] */
} nt_retardation;
nt_status nt_prony_retard(const nt_rheology *rheology, int arms, nt_retardation *made);
nt_status nt_prony_spectrum(const nt_rheology *rheology, int arms, nt_spectrum *spectrum);
void nt_prony_derive(const nt_rheology *rheology, const nt_spectrum *spectrum, int parameter, nt_spectrum_slope *slope);

#endif
