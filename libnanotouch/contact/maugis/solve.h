/* SPDX-License-Identifier: BSD-3-Clause
 * Inverting the contact branch of Maugis-Dugdale: its point at an indentation or load; private. */
#ifndef NANOTOUCH_CONTACT_MAUGIS_SOLVE_H
#define NANOTOUCH_CONTACT_MAUGIS_SOLVE_H

#include "contact/maugis/branch.h"
#include "contact/maugis/newton.h"

/* What is given. */
typedef enum nt_maugis_given { NT_GIVEN_INDENTATION, NT_GIVEN_LOAD } nt_maugis_given;

/* Which point of the branch is wanted. */
typedef struct nt_maugis_goal {
    nt_maugis_given given;
    double target;                     /* reduced d or P, not below the fold's */
    const nt_maugis_equilibrium *fold; /* of the same kind */
    int below;                         /* 1: the part of the branch with y < y_fold; 0: y > y_fold */
    double guess;                      /* of y; 0: none */
} nt_maugis_goal;

/* {U, F, k, a} of a point of the contact branch, reduced; stable says from which side the displacement fold is seen. */
nt_law_value nt_maugis_value_of(const nt_maugis *maugis, const nt_maugis_equilibrium *point, int stable);

nt_status nt_maugis_point_find(double lambda, const nt_maugis_goal *goal, nt_maugis_equilibrium *point,
                               nt_solve_info *info);

/* Where the stable contact branch begins. */
nt_maugis_start nt_maugis_start_of(const nt_maugis *maugis);

/* The stable contact branch at a reduced d, not below that of its start. */
nt_status nt_maugis_stable_find(const nt_maugis_start *start, double d, nt_maugis_equilibrium *point,
                                nt_solve_info *info);

/* The contact branch at an indentation between its folds; reduced. */
nt_status nt_maugis_contact_find(const nt_maugis *maugis, double d, int stable, nt_maugis_equilibrium *point,
                                 nt_solve_info *info);

#endif
