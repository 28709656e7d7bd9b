/* SPDX-License-Identifier: BSD-3-Clause
 * Order statistics in the caller's memory; private to curves/. */
#ifndef NANOTOUCH_CURVES_ROBUST_H
#define NANOTOUCH_CURVES_ROBUST_H

#define NT_MAD_SIGMA 1.4826 /* standard deviation over median absolute deviation, Gaussian noise */
#define NT_TUKEY 4.685      /* 95 % efficiency on Gaussian noise */

typedef struct nt_curve_point {
    double z, force; /* [m], [N] */
} nt_curve_point;

/* Of count >= 1 finite values, which it reorders. */
double nt_curve_median(double values[], long count);
/* The same, sooner where it is about what is expected, > 0: within a share of that. */
double nt_curve_median_near(double values[], long count, double expected, double doubt);
/* Median of |values|, through scratch of count. */
double nt_curve_median_size(const double values[], long count, double scratch[]);
/* Stable, z growing; scratch of count points. Fast where they are in order or in the opposite one. */
void nt_curve_sort(nt_curve_point points[], long count, nt_curve_point scratch[]);
void nt_curve_sort_values(double values[], long count);
/* Tukey's weights (1 - (rest/(4.685 scatter))^2)^2, 0 outside. */
void nt_curve_weigh(const double rest[], long count, double scatter, double weight[]);
double nt_curve_lowest(const double values[], long count);
double nt_curve_highest(const double values[], long count);

/* Solves the symmetric positive n x n system a x = b by Cholesky in place: x in b, the factor in a (rows of n).
 * 0: it is singular. */
int nt_curve_solve(double a[], double b[], int n);

#endif
