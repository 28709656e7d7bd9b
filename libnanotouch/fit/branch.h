/* SPDX-License-Identifier: BSD-3-Clause
 * The stable branch of a contact law from its load fold on, as an explicit function of one parameter; private to fit/.
 * A fit asks for the force at positions of the base, thousands of times: without an inner search for the indentation
 * that is one Newton iteration in this parameter instead of two, one inside the other. */
#ifndef NANOTOUCH_FIT_BRANCH_H
#define NANOTOUCH_FIT_BRANCH_H

#include "nanotouch/contact.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nt_fit_branch {
    nt_model model;
    double lambda;            /* Maugis-Dugdale only */
    double load, indentation; /* Maugis' units of JKR and Maugis-Dugdale [N], [m] */
    double hertz, pull_off;   /* of Hertz and DMT: 4/3 E* sqrt(R) [N/m^1.5], pull-off force [N] */
    double start;             /* s at the load fold */
    double unit;              /* a step of s of the size of the contact */
} nt_fit_branch;

typedef struct nt_fit_state {
    double F, indentation;   /* [N], [m] */
    double F1, indentation1; /* their derivatives by s: never both 0 */
    double range;            /* lambda dF/dlambda at constant indentation [N] (model.cpp) */
} nt_fit_state;

nt_fit_branch nt_fit_branch_of(const nt_contact_law *law);

/* At s >= start. */
nt_fit_state nt_fit_branch_at(const nt_fit_branch *branch, double s);

#ifdef __cplusplus
}
#endif
#endif
