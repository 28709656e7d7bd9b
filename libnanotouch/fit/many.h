/* SPDX-License-Identifier: BSD-3-Clause
 * A block of points of a law at once, each step a plain loop that compilers turn into vector code; private to fit/. */
#ifndef NANOTOUCH_FIT_MANY_H
#define NANOTOUCH_FIT_MANY_H

#include "fit/models/row.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How a lever shows the force. */
typedef struct nt_fit_lever {
    double compliance, sensitivity; /* 1/k_c [m/N]; [-] */
    double offset, tilt;            /* [N], [N/m] */
} nt_fit_lever;

/* Points whose places on a branch are sought by the position of the base. */
typedef struct nt_fit_many {
    nt_fit_lever lever;
    nt_fit_block at;           /* of the law at at.s */
    double base[NT_FIT_BLOCK]; /* X - delta0 [m] */
    double step[NT_FIT_BLOCK]; /* Newton's next step of s */
    double from[NT_FIT_BLOCK]; /* X - X_b [m] */
    /* Force as measured [N], and its derivatives by ln E*, ln w, ln h0, delta0 and s. */
    double force[NT_FIT_BLOCK], by_modulus[NT_FIT_BLOCK], by_work[NT_FIT_BLOCK], by_range[NT_FIT_BLOCK],
        by_place[NT_FIT_BLOCK], by_sensitivity[NT_FIT_BLOCK];
} nt_fit_many;

/* Newton's steps towards delta + F/k_c = base. 0: all are so small that the branch is straight over them, 1e-7 of s or
 * rounding. */
int nt_fit_many_step(nt_fit_many *many);
/* The same of one of them. */
int nt_fit_many_moves(const nt_fit_many *many, int i);
/* Takes the steps; no s falls below lowest. */
void nt_fit_many_move(nt_fit_many *many, double lowest);
/* Puts force and indentation where the last steps lead, and what is measured there of a paraboloid: the formulas of
 * contact_model.cpp. */
void nt_fit_many_show(nt_fit_many *many);

#ifdef __cplusplus
}
#endif
#endif
