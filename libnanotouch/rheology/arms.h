/* SPDX-License-Identifier: BSD-3-Clause
 * Sums over the arms of a spectrum, and what a step of a given length does to them; private to rheology/.
 *
 * Arm 0 is the equilibrium modulus, of rate 0. Rows are padded with arms of modulus 0, so that loops have whole
 * vectors. */
#ifndef NANOTOUCH_RHEOLOGY_ARMS_H
#define NANOTOUCH_RHEOLOGY_ARMS_H

#include "internal/rheology.h"
#include "nanotouch/rheology.h"

enum {
    NT_ARMS = 44,                                  /* 1 + NT_SPECTRUM_ARMS, in whole fours */
    NT_ARM_PARAMETERS = NT_RHEOLOGY_PARAMETERS + 1 /* 0 is the contact's position, which no arm depends on */
};

typedef struct nt_arms {
    int width;                              /* arms in use, a multiple of 4 */
    int parameters;                         /* 0: no derivatives */
    double modulus[NT_ARMS], rate[NT_ARMS]; /* E_k [Pa], [1/s] */
    double by[NT_ARM_PARAMETERS][NT_ARMS];  /* dE_k/d(parameter) */
    int arm[NT_ARM_PARAMETERS];             /* whose rate depends on the parameter; -1: none */
    double rate_by[NT_ARM_PARAMETERS];      /* by how much */
} nt_arms;
void nt_arms_make(nt_arms *arms, const nt_rheology *rheology, const nt_spectrum *spectrum, int with_derivatives);

/* A step of length h: exp(-x) and psi_j = Int_0^1 exp(-(1 - y) x) y^j dy for x = h rate, and Sum E_k psi_jk. */
typedef struct nt_step {
    double h; /* [s] */
    double decay[NT_ARMS], psi[3][NT_ARMS];
    double sum[3];                       /* [Pa] */
    double sum_by[NT_ARM_PARAMETERS][3]; /* its derivatives */
    double psi_by[NT_ARM_PARAMETERS][3]; /* d(psi_j)/d(parameter) of the arm whose rate it changes */
} nt_step;
#define NT_SAME_STEP 1e-9 /* relative: times from counting steps differ by less */
/* Makes the step for this length, unless it is there already. */
void nt_step_to(nt_step *step, const nt_arms *arms, double h);

/* --- Loops over the arms. Sums are kept in lanes, so that they are the same on every machine. --- */
enum { NT_ARM_LANES = 4 };

static inline double nt_lanes(const double lane[NT_ARM_LANES])
{
    return (lane[0] + lane[2]) + (lane[1] + lane[3]);
}

/* Sum of weight x. */
static inline double nt_arms_sum(int width, const double *restrict weight, const double *restrict x)
{
    double lane[NT_ARM_LANES] = {0.0, 0.0, 0.0, 0.0};
    for (int k = 0; k < width; k += NT_ARM_LANES)
        for (int j = 0; j < NT_ARM_LANES; j++)
            lane[j] += weight[k + j] * x[k + j];
    return nt_lanes(lane);
}

/* Sum of weight late x. */
static inline double nt_arms_sum_late(int width, const double *restrict weight, const double *restrict late,
                                      const double *restrict x)
{
    double lane[NT_ARM_LANES] = {0.0, 0.0, 0.0, 0.0};
    for (int k = 0; k < width; k += NT_ARM_LANES)
        for (int j = 0; j < NT_ARM_LANES; j++)
            lane[j] += weight[k + j] * late[k + j] * x[k + j];
    return nt_lanes(lane);
}

/* x <- factor x. */
static inline void nt_arms_multiply(int width, double *restrict x, const double *restrict factor)
{
    for (int k = 0; k < width; k++)
        x[k] *= factor[k];
}

/* x <- x + scale y. */
static inline void nt_arms_add(int width, double *restrict x, double scale, const double *restrict y)
{
    for (int k = 0; k < width; k++)
        x[k] += scale * y[k];
}

/* x <- x + Sum d_j psi_j. */
static inline void nt_arms_add_piece(int width, double *restrict x, const double d[3],
                                     const double (*restrict psi)[NT_ARMS])
{
    const double a = d[0], b = d[1], c = d[2];
    for (int k = 0; k < width; k++)
        x[k] += a * psi[0][k] + b * psi[1][k] + c * psi[2][k];
}

#endif
