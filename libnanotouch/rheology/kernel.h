/* SPDX-License-Identifier: BSD-3-Clause
 * One row per kernel: what E(t) is and what else follows from it. Private to rheology/. A new kernel is a file with its
 * row, a line in rheology.c and a word in nt_rheology_kind. */
#ifndef NANOTOUCH_RHEOLOGY_KERNEL_H
#define NANOTOUCH_RHEOLOGY_KERNEL_H

#include "internal/rheology.h"
#include "nanotouch/rheology.h"

/* How a spectrum changes with a parameter p of its description. */
typedef struct nt_spectrum_slope {
    double equilibrium_modulus;      /* [Pa/unit of p] */
    double moduli[NT_SPECTRUM_ARMS]; /* [Pa/unit of p] */
    int arm;                         /* the one whose rate changes; -1: none */
    double rate;                     /* by how much [1/s/unit of p] */
} nt_spectrum_slope;
/* Derivative of a spectrum of this description by one of its parameters, its range of times fixed. */
void nt_spectrum_derive(const nt_rheology *rheology, const nt_spectrum *spectrum, int parameter,
                        nt_spectrum_slope *slope);

typedef struct nt_kernel {
    nt_status (*check)(const nt_rheology *rheology, nt_problem *problem); /* of what the table of fields cannot say */
    double (*relaxation)(const nt_rheology *rheology, double time);
    double (*integral)(const nt_rheology *rheology, double time);
    double (*creep)(const nt_rheology *rheology, double time);
    nt_status (*discretize)(const nt_rheology *rheology, const nt_time_range *range, double error,
                            nt_spectrum *spectrum);
    int (*parameter_count)(const nt_rheology *rheology);
    void (*derive)(const nt_rheology *rheology, const nt_spectrum *spectrum, int parameter, nt_spectrum_slope *slope);
} nt_kernel;

extern const nt_kernel nt_kernel_power_law;
extern const nt_kernel nt_kernel_standard_linear_solid;
extern const nt_kernel nt_kernel_prony;

#endif
