/* SPDX-License-Identifier: BSD-3-Clause
 * What the files of curves/ share; private to curves/. */
#ifndef NANOTOUCH_CURVES_PARTS_H
#define NANOTOUCH_CURVES_PARTS_H

#include "nanotouch/curves.h"

#define NT_CURVE_EVENT 5.0     /* standard deviations of the noise: one in 2e6 points */
#define NT_CURVE_SCATTERED 3.0 /* standard deviations of the scatter about the line, where interference makes waves */

/* nt_curve_fit_baseline where the point noise [N] is known. */
nt_status nt_curve_baseline_over(const nt_curve_segment *segment, const nt_curve_choice *choice, double noise,
                                 double *work, nt_curve_baseline *baseline, nt_problem *problem);
/* nt_curve_baseline_at of many. */
void nt_curve_baseline_of(const nt_curve_baseline *baseline, const double z[], long count, double force[]);
/* z and force over the baseline into the first 2 count doubles of work, z growing; 4 count more are scratch. */
void nt_curve_order(const nt_curve_segment *segment, const nt_curve_baseline *baseline, double *work);
/* Reads a branch whose baseline and point noise [N] are known; z and force of *branch are the first 2 count doubles of
 * work, 4 count more are scratch. */
void nt_curve_read_events(const nt_curve_segment *segment, const nt_curve_baseline *baseline, double noise,
                          double *work, nt_curve_branch *branch);
/* What its events are known to, once its baseline is known better or worse. */
void nt_curve_know_events(nt_curve_branch *branch);
/* The first point of a branch with z >= limit [m]; its count where none is. */
long nt_curve_first_from(const nt_curve_branch *branch, double limit);
/* Fills the contact point of a reading from its first branch. scratch: 2 count doubles. */
void nt_curve_find_contact(const nt_curve_branch *first, double spring_constant, double *scratch,
                           nt_curve_reading *reading);

#endif
