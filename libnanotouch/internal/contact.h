/* SPDX-License-Identifier: BSD-3-Clause
 * Each contact law by itself; what users call is nt_contact_law_eval and its like. */
#ifndef NANOTOUCH_INTERNAL_CONTACT_H
#define NANOTOUCH_INTERNAL_CONTACT_H

#include "nanotouch/contact.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The contact branch at its parameter y in (0, inf): reduced radius, load, indentation, energy, and the derivatives
 * dP/dy, dd/dy. The basis of everything above; for fits and continuation. */
typedef struct nt_maugis_point {
    double a, P, d, U;   /* [reduced] */
    double dP_dy, dd_dy; /* [reduced] */
} nt_maugis_point;

/* --- Hertz, 1881 (paper, Eq. 4): F = 4/3 E* sqrt(R) delta^1.5, a = sqrt(R delta); all 0 for delta <= 0. --- */
NT_API nt_law_value nt_hertz_eval(const nt_contact *contact, double indentation);
/* delta(F) for F >= 0; NaN for F < 0. */
NT_API double nt_hertz_indentation(const nt_contact *contact, double force);
/* --- DMT, Derjaguin, Muller, Toporov 1975 (paper, Eq. 9): Hertz - 2 pi R w; all 0 for delta < 0. --- */
NT_API nt_law_value nt_dmt_eval(const nt_contact *contact, double indentation);
/* Its force alone [N], without the rest of the law; indentation [m]. */
NT_API double nt_dmt_force(const nt_contact *contact, double indentation);
/* delta(F) for F >= -2 pi R w; NaN below. */
NT_API double nt_dmt_indentation(const nt_contact *contact, double force);
/* 2 pi R w, a positive magnitude [N]. */
NT_API double nt_dmt_pull_off_force(const nt_contact *contact);
/* --- JKR, Johnson, Kendall, Roberts 1971 (the paper's lost Eq. 10; erratum E11):
 *     a^3 = (R/K)(F + 3 pi w R + sqrt(6 pi w R F + (3 pi w R)^2)), delta = a^2/R - sqrt(8 pi w a/(3 K)), K = 4/3 E*.
 * STABLE: a above the displacement fold a = (1/6)^(1/3) (reduced); APPROACH: apart for delta < 0. --- */
NT_API nt_status nt_jkr_eval(const nt_contact *contact, double indentation, nt_branch branch, nt_law_value *value);
/* delta(F); STABLE is the branch above the load fold F = -1.5 pi w R, UNSTABLE the one below it. */
NT_API nt_status nt_jkr_indentation(const nt_contact *contact, double force, nt_branch branch, double *indentation);
/* 1.5 pi R w, a positive magnitude [N] (load control). */
NT_API double nt_jkr_pull_off_force(const nt_contact *contact);
/* Indentation of the displacement fold, the last stable point under grips [m] (negative). */
NT_API double nt_jkr_pull_off_indentation(const nt_contact *contact);
/* Checks the contact, computes scales and folds. w = 0 is allowed and makes the law Hertz. NT_E_RANGE where lambda is
 * outside its valid range. */
NT_API nt_status nt_maugis_init(nt_maugis *maugis, const nt_contact *contact);
/* The same with lambda given; the cohesive stress follows from it. NT_MAUGIS_LAMBDA_MAX makes it JKR. */
NT_API nt_status nt_maugis_init_lambda(nt_maugis *maugis, const nt_contact *contact, double lambda);
/* {U, F, k, a} at an indentation [m]. info may be NULL. Error < 1e-12 relative away from the folds; at a fold the
 * result is square-root conditioned (1 ulp of the indentation is 1e-8 of the force) and k, infinite there, is reported
 * at the nearest distance that a double resolves. *value is untouched on failure. */
NT_API nt_status nt_maugis_eval(const nt_maugis *maugis, double indentation, nt_branch branch, nt_law_value *value,
                                nt_solve_info *info);
/* Indentation [m] at a force [N] >= minus the pull-off force: STABLE above the load fold, UNSTABLE below it. */
NT_API nt_status nt_maugis_indentation(const nt_maugis *maugis, double force, nt_branch branch, double *indentation,
                                       nt_solve_info *info);
/* Pull-off force under load control, positive [N]: 2 pi w R (lambda -> 0) .. 1.5 pi w R (lambda -> infinity). */
NT_API double nt_maugis_pull_off_force(const nt_maugis *maugis);
/* Jump-in gap on approach [m]: attraction starts at gap h0 = w/sigma0. */
NT_API double nt_maugis_onset_gap(const nt_maugis *maugis);
/* NT_E_NOT_FINITE, or NT_E_RANGE unless lambda > 0 and y >= 0; *point is then left alone. */
NT_API nt_status nt_maugis_at(double lambda, double y, nt_maugis_point *point);
/* Rigid cone of half-angle psi [rad], 0 < psi < pi/2: F = 2/pi E* tan(psi) delta^2, a = 2 tan(psi) delta/pi
 * (the paper's a is 2.467 times too large; erratum E6). All 0 for delta <= 0. */
NT_API nt_law_value nt_cone_eval(double effective_modulus, double half_angle, double indentation);
/* Rigid flat punch of radius a [m]: F = 2 E* a delta. All 0 for delta <= 0. */
NT_API nt_law_value nt_punch_eval(double effective_modulus, double radius, double indentation);

#ifdef __cplusplus
}
#endif
#endif
