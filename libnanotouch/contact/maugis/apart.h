/* SPDX-License-Identifier: BSD-3-Clause
 * The non-contact branch of Maugis-Dugdale (maugis.c has its equations): surfaces apart, a disc of radius c inside the
 * range of the stress. Private to contact/; reduced. */
#ifndef NANOTOUCH_CONTACT_MAUGIS_APART_H
#define NANOTOUCH_CONTACT_MAUGIS_APART_H

#include <math.h>

#include "contact/reduced.h"
#include "nanotouch/material.h"

/* c at its displacement fold. */
static inline double nt_maugis_apart_fold(double lambda)
{
    return 8.0 / (3.0 * NT_PI) * lambda;
}

static inline double nt_maugis_apart_indentation(const nt_maugis *maugis, double c)
{
    return 0.5 * c * c - nt_maugis_apart_fold(maugis->lambda) * c + maugis->folds.onset_indentation;
}

/* c at a load. */
static inline double nt_maugis_apart_radius(const nt_maugis *maugis, double P)
{
    return sqrt(-P / (0.5 * NT_PI * maugis->lambda));
}

/* {U, F, k, a} at c; beyond_fold = c - c_fold, which the caller has without cancellation. */
static inline nt_law_value nt_maugis_apart_value(const nt_maugis *maugis, double c, double beyond_fold)
{
    const double lambda = maugis->lambda;
    const double resolution = NT_FOLD_RESOLUTION * sqrt(fabs(nt_maugis_apart_indentation(maugis, c)));
    return (nt_law_value){
        .U = lambda * c * c * c * (4.0 / 9.0 * lambda - NT_PI / 8.0 * c),
        .F = -0.5 * NT_PI * lambda * c * c,
        .k = -NT_PI * lambda * c / copysign(fmax(fabs(beyond_fold), resolution), beyond_fold),
    };
}

/* {U, F, k, a} at d between the fold and the end of the contact branch: the stable state, which has the larger c. Of
 * `maugis`, lambda and onset_indentation are read. */
static inline nt_law_value nt_maugis_apart_stable(const nt_maugis *maugis, double d)
{
    const double c_fold = nt_maugis_apart_fold(maugis->lambda), beyond_onset = d - maugis->folds.onset_indentation;
    const double square = c_fold * c_fold + 2.0 * beyond_onset, root = sqrt(square > 0.0 ? square : 0.0);
    return nt_maugis_apart_value(maugis, c_fold + root, root);
}

/* dU/dlambda at c, at constant indentation. */
static inline double nt_maugis_apart_slope(double lambda, double c)
{
    return c * c * (1.0 / lambda - c * (4.0 / 9.0 * lambda + NT_PI / 8.0 * c));
}

#endif
