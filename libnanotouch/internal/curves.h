/* SPDX-License-Identifier: BSD-3-Clause
 * The steps of nt_curve_read, one by one. */
#ifndef NANOTOUCH_INTERNAL_CURVES_H
#define NANOTOUCH_INTERNAL_CURVES_H

#include "nanotouch/curves.h"

#ifdef __cplusplus
extern "C" {
#endif

/* NT_OK, or NT_E_NOT_FINITE / NT_E_RANGE with "z", "force" or "z (travel)" in *problem (NULL allowed). */
NT_API nt_status nt_curve_segment_check(const nt_curve_segment *segment, nt_problem *problem);
/* Standard deviation of white noise from differences of neighbours, so that no shape of the curve enters [N]: 1.4826
 * times their median, over sqrt(2). Where more than half of them are 0, because the converter's step exceeds the noise,
 * from all but the largest hundredth. work: count doubles. */
NT_API double nt_curve_point_noise(const double force[], long count, double *work);
/* White and 1/f noise of residuals in the order of time, whose line is taken off: the mean over all ratios of one to
 * the other by the likelihood of the residuals' spectrum (Whittle 1953), white noise alone being as likely beforehand
 * as 1/f noise. The spectrum is that of at most 64 means of 8 points or more. `scatter`: their robust standard
 * deviation, which white is no less than [N]. */
NT_API nt_curve_noise nt_curve_split_noise(const double rest[], long count, double scatter);
/* Standard deviation of one of `count` points such that the mean of independent ones would scatter as theirs does [N]:
 * (max(point_noise^2, white) + count flicker)^(1/2); 0 where the free cantilever does not show that they are not
 * independent. */
NT_API double nt_curve_correlated_noise(double point_noise, const nt_curve_noise *free, long count);
/* By how much the correlation of residuals raises the variance of their mean, from the means of 20 blocks; 1 where it
 * is not evident (below 2). */
NT_API double nt_curve_residual_correlation(const double rest[], long count);
/* The baseline of one branch alone. NT_E_ARGUMENT for no kind; NT_E_RANGE with "baseline (points)" if fewer than
 * NT_CURVE_FEWEST lie between the ends. segment: checked, of at least NT_CURVE_FEWEST points. */
NT_API nt_status nt_curve_fit_baseline(const nt_curve_segment *segment, const nt_curve_choice *choice, double *work,
                                       nt_curve_baseline *baseline, nt_problem *problem);
/* Its force at z [N], and the standard uncertainty of that [N]. */
NT_API double nt_curve_baseline_at(const nt_curve_baseline *baseline, double z);
/* The standard uncertainty of that force [N], at the same z [m]. */
NT_API double nt_curve_baseline_sigma(const nt_curve_baseline *baseline, double z);
/* One branch alone, with its own baseline. The arrays of *branch lie in work. segment: checked, of at least
 * NT_CURVE_FEWEST points. Errors of nt_curve_fit_baseline. */
NT_API nt_status nt_curve_read_branch(const nt_curve_segment *segment, const nt_curve_choice *choice, double *work,
                                      nt_curve_branch *branch, nt_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
