/* SPDX-License-Identifier: BSD-3-Clause
 * Series, arrays and adhesion of shapes. */
#ifndef NANOTOUCH_INTERNAL_GEOMETRY_H
#define NANOTOUCH_INTERNAL_GEOMETRY_H

#include "nanotouch/advanced/geometry.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A SPHERE of radius R [m] in eight powers of delta/R: F is off by 1e-10 of itself at delta = R/3 and by 7e-7 at R, at
 * an eighth of the cost; F = dU/d(delta) and k = 2 E* a hold exactly. Beyond R as nt_shape_eval. */
NT_API nt_law_value nt_sphere_series_eval(double radius, double effective_modulus, double indentation);
/* The array form of nt_shape_eval; strides as in contact.h. */
NT_API void nt_shape_eval_n(const nt_shape *shape, double effective_modulus, const nt_strided *arrays);
/* NT_OK, or the first field that is wrong, in *problem; NT_E_UNSUPPORTED for another shape. */
NT_API nt_status nt_jkr_shape_check(const nt_jkr_shape *contact, nt_problem *problem);
/* {U, F, k, a} on a branch. A punch has none that is UNSTABLE (NT_E_NO_SOLUTION): it lets go with its whole face. */
NT_API nt_status nt_jkr_shape_eval(const nt_jkr_shape *contact, double indentation, nt_branch branch,
                                   nt_law_value *value);
/* delta(F); STABLE is the branch above the load fold, UNSTABLE the one below it. */
NT_API nt_status nt_jkr_shape_indentation(const nt_jkr_shape *contact, double force, nt_branch branch,
                                          double *indentation);
/* Under load control, positive [N]: cone 54 w^2 tan(psi)^3/(pi E*), punch sqrt(8 pi E* w a^3), paraboloid 1.5 pi w R.
 * NaN for other shapes. */
NT_API double nt_jkr_shape_pull_off_force(const nt_jkr_shape *contact);
/* The last indentation that grips hold [m], negative: cone -w tan(psi)/E*, punch -sqrt(2 pi w a/E*). */
NT_API double nt_jkr_shape_pull_off_indentation(const nt_jkr_shape *contact);
/* Eq. 8: delta = k_c Delta/(k_c + K cos(alpha) sqrt(2 Delta R)), the contact radius taken as sqrt(2 Delta R) with the
 * *stage* displacement. Too small by far where the sample is stiffer than the lever: 0.10 to 0.18 of the solution for
 * silicon, k_c = 8 N/m, Delta = 1 to 20 nm (erratum E8). contact: R and E*. Delta <= 0 gives 0. */
NT_API double nt_stage_displacement_approximate(const nt_contact *contact, const nt_lever *lever, double displacement);

#ifdef __cplusplus
}
#endif
#endif
