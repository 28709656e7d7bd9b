/* SPDX-License-Identifier: BSD-3-Clause
 * The generalized Maxwell model of so many arms; private to rheology/. */
#ifndef NANOTOUCH_RHEOLOGY_PRONY_H
#define NANOTOUCH_RHEOLOGY_PRONY_H

#include "rheology/kernel.h"

nt_status nt_prony_check(const nt_rheology *rheology, int arms, nt_problem *problem);
double nt_prony_relaxation(const nt_rheology *rheology, int arms, double time);
double nt_prony_integral(const nt_rheology *rheology, int arms, double time);
double nt_prony_creep(const nt_rheology *rheology, int arms, double time);
nt_status nt_prony_spectrum(const nt_rheology *rheology, int arms, nt_spectrum *spectrum);
void nt_prony_derive(const nt_rheology *rheology, const nt_spectrum *spectrum, int parameter, nt_spectrum_slope *slope);

#endif
