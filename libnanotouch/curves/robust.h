/* SPDX-License-Identifier: BSD-3-Clause
 * Order statistics in the caller's memory; private to curves/. */
#ifndef NANOTOUCH_CURVES_ROBUST_H
#define NANOTOUCH_CURVES_ROBUST_H

#define NT_MAD_SIGMA 1.4826 /* standard deviation over median absolute deviation, Gaussian noise */
#define NT_TUKEY 4.685      /* 95 % efficiency on Gaussian noise */

typedef struct nt_curve_point {
    double z, force; /* [m], [N] */
} nt_curve_point;

/* Of count >= 1 finite values, which are lost. */
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
/* Of count >= 1 values. */
double nt_curve_lowest(const double values[], long count);
double nt_curve_highest(const double values[], long count);
/* The first place of them. */
long nt_curve_place_of_lowest(const double values[], long count);
long nt_curve_place_of_highest(const double values[], long count);
/* Whether no size is above a limit, or NaN. */
int nt_curve_all_within(const double values[], long count, double limit);
/* Of values, and of their squares, in the order of core/variants.h. */
double nt_curve_sum(const double values[], long count);
double nt_curve_square_sum(const double values[], long count);
/* Index of the last value above a level; -1 without one. */
long nt_curve_last_above(const double values[], long count, double level);

/* Solves the symmetric positive n x n system a x = b by Cholesky in place: x in b, the factor in a (rows of n).
 * 0: it is singular. */
int nt_curve_solve(double a[], double b[], int n);

#endif
