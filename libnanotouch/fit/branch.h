/* SPDX-License-Identifier: BSD-3-Clause
 * The retraction of a contact law as an explicit function of one parameter s, from its deepest point through its load
 * fold to its displacement fold, the last that any cantilever could hold; private to fit/. A fit asks for the force at
 * positions of the base, thousands of times: without an inner search for the indentation that is one Newton iteration
 * in this parameter instead of two, one inside the other. */
#ifndef NANOTOUCH_FIT_BRANCH_H
#define NANOTOUCH_FIT_BRANCH_H

#include "nanotouch/fit.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nt_fit_branch {
    nt_fit_model model;
    double lambda;            /* Maugis-Dugdale only */
    double load, indentation; /* Maugis' units of JKR and Maugis-Dugdale [N], [m] */
    double prefactor;         /* of Hertz, DMT [N/m^1.5], cone and pyramid [N/m^2] */
    double exponent;          /* F ~ E* delta^exponent: 1.5, cone and pyramid 2 */
    double pull_off;          /* force at the load fold, positive [N] */
    double touch_c;           /* Maugis-Dugdale: c at a = 0, reduced */
    double load_fold;         /* s there: the lowest force */
    double grip_fold;         /* s <= load_fold, where the indentation turns */
    double unit;              /* a step of s of the size of the contact */
} nt_fit_branch;

typedef struct nt_fit_state {
    double F, indentation;   /* [N], [m] */
    double F1, indentation1; /* their derivatives by s: never both 0 */
    double range;            /* lambda dF/dlambda at constant indentation [N] (model.cpp) */
} nt_fit_state;

/* law: of Hertz, DMT, JKR, Maugis-Dugdale. */
nt_fit_branch nt_fit_branch_of(const nt_contact_law *law);
/* F = 2/pi E* tan(psi) delta^2. */
nt_fit_branch nt_fit_branch_of_cone(nt_fit_model model, double effective_modulus, double half_angle);

/* At s > grip_fold. */
nt_fit_state nt_fit_branch_at(const nt_fit_branch *branch, double s);

#ifdef __cplusplus
}
#endif
#endif
