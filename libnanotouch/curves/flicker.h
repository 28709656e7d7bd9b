/* SPDX-License-Identifier: BSD-3-Clause
 * The noise of both free branches; private to curves/. */
#ifndef NANOTOUCH_CURVES_FLICKER_H
#define NANOTOUCH_CURVES_FLICKER_H

#include "curves/parts.h"

enum { NT_CURVE_SLOW = 16 }; /* coefficients that are kept one by one */

/* Squares of the cosine coefficients of a record whose line is taken off, white noise in each [N^2]. */
typedef struct nt_curve_spectrum {
    double energy[NT_CURVE_SLOW]; /* of 2, 3 .. half periods [N^2] */
    int slow;                     /* how many of them; 0: the record is too short */
    double fast, many, place;     /* sum of the others [N^2], how many, half periods they stand for */
    double points;                /* of the record */
} nt_curve_spectrum;

nt_curve_spectrum nt_curve_spectrum_of(const double rest[], long count);
/* Puts the 1/f noise of both free branches together in the baselines of both, unless they contradict each other, and
 * what level and slope are known to. */
void nt_curve_share_noise(nt_curve_branch *const branches[2]);
/* The noise of one free branch anew, once another baseline is taken off it. */
void nt_curve_renew_noise(nt_curve_branch *branch);

#endif
