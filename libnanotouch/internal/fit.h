/* SPDX-License-Identifier: BSD-3-Clause
 * The steps of nt_fit_batch, one by one. */
#ifndef NANOTOUCH_INTERNAL_FIT_H
#define NANOTOUCH_INTERNAL_FIT_H

#include "nanotouch/fit.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is known of the points; all 0: no more than the points say themselves. */
typedef struct nt_fit_known {
    double noise;                     /* of the force from point to point, standard deviation [N] */
    nt_curve_noise free;              /* white and 1/f noise of the free cantilever [N^2] */
    double baseline_position;         /* X where level and tilt of the baseline are not correlated [m] */
    double level_sigma, tilt_sigma;   /* their standard uncertainties [N], [N/m]; 0: exact */
    double tear_position, tear_sigma; /* X at which the tip was torn off [m], as in options; sigma 0: nowhere */
    double sensitivity_sigma;         /* of the deflection, relative [-]; 0: exact */
    int fit_offset;                   /* 1: the force offset is free; 0: known as well as the baseline is */
    int held[NT_FIT_PARAMETERS];      /* 1: of sensitivity, offset, tilt, stays at its value in options */
} nt_fit_known;

typedef struct nt_fit_solution {
    nt_fit_options options; /* with which it was fitted in the end: noise, tear, and what is known as data */
    nt_fit_result fit;      /* identifiable 0 also where calibration or law are in doubt */
    long count;             /* of points that were fitted: the last ones, close to the tear, may be left out */
    double rating;          /* nt_fit_rating [-] */
    unsigned flags;         /* nt_fit_flag */
    int exact;              /* 1: the law leaves nothing but rounding */
    double half_modulus[2]; /* E* that the shallow and the deep half of the contact ask for [Pa]; NaN where untold */
    double power[2]; /* of the indentation with which the force rises, and its sigma [-]; of laws without adhesion; NaN
                        where untold */
    double any_sensitivity, any_modulus, any_rms; /* fitted with any sensitivity [-], [Pa], [N]; NaN without need */
} nt_fit_solution;

typedef enum nt_fit_calibration {
    NT_FIT_SPRING_CONSTANT,
    NT_FIT_RADIUS,
    NT_FIT_HALF_ANGLE,
    NT_FIT_THICKNESS
} nt_fit_calibration;

/* What both branches of a recorded curve say against a law without adhesion that was fitted to its approach. */
typedef struct nt_fit_branches {
    const nt_curve_branch *approach, *retract;
    int ruptures;           /* of the retraction */
    double spring_constant; /* [N/m] */
    double contact_point;   /* fitted, as z of the base [m] */
    double power_sigma;     /* of the solution [-]; NaN: unknown */
} nt_fit_branches;

/* NT_OK, or NT_E_NOT_FINITE / NT_E_RANGE / NT_E_ARGUMENT with the offending field in *problem (NULL allowed). */
NT_API nt_status nt_fit_check(const nt_fit_options *options, nt_problem *problem);
/* X at which the cantilever tears the tip off [m]; NT_E_UNSUPPORTED without spring constant or adhesion. */
NT_API nt_status nt_fit_tear_position(const nt_fit_options *options, const double value[NT_FIT_PARAMETERS],
                                      double *position);
/* Fits with the noise of the free cantilever, then once more with the scatter that is left where that is more: a law
 * that does not describe the points gets wide sigmas instead of a bent calibration. Points from the deepest outwards,
 * where they were torn off. As nt_fit_run. */
NT_API nt_status nt_fit_solve(const nt_fit_options *options, const nt_fit_known *known, const nt_fit_data *data,
                              nt_fit_solution *solution, nt_problem *problem);
/* d value/d ln of what is calibrated (of the half angle: by the angle [rad]): differences of whole fits. */
NT_API nt_status nt_fit_shift(const nt_fit_solution *solution, const nt_fit_data *data, nt_fit_calibration changed,
                              double shift[NT_FIT_PARAMETERS]);
/* The least and the most that a positive parameter can be (95 %): where chi^2, all others fitted again, has risen by
 * 3.84; 0 and infinity where it does not. */
NT_API nt_status nt_fit_bounds(const nt_fit_solution *solution, const nt_fit_data *data, nt_fit_parameter parameter,
                               double bounds[2]);
/* How far before its tear the model is only a straight continuation [m]. */
NT_API nt_status nt_fit_steep_width(const nt_fit_options *options, const double value[NT_FIT_PARAMETERS],
                                    double *width);
/* 1 where the baseline's points scatter by more than four times the noise [N], and a contact that begins in their outer
 * half, over a level line, describes the whole branch within half of that: by so much *further out [m] than the
 * baseline ends, with so much *left over, RMS [N]. 0: the branch has a free part. */
NT_API int nt_fit_begins_in_contact(const nt_curve_branch *branch, double noise, double spring_constant,
                                    double *further, double *left);
/* NT_FIT_ADHESIVE, NT_FIT_HYSTERESIS; returned: which part of the work of the approach the retraction keeps back [-];
 * NaN where one of them shows no contact. */
NT_API unsigned nt_fit_branch_doubts(const nt_fit_branches *branches, double *kept_back);

#ifdef __cplusplus
}
#endif
#endif
