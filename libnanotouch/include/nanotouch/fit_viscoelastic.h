/* SPDX-License-Identifier: BSD-3-Clause
 * Fitting a viscoelastic contact (viscoelastic.h) to a whole recorded curve: approach, pauses and retraction in one
 * least-squares fit, by analytic derivatives.
 *
 *     force = level + tilt (X - X_b) + drag v h_d/(h_d + h) + F(X - z_0, t)
 *
 * X is the position of the base, towards the sample, v its speed, h the tip's height over first touch z_0 (0 in
 * contact). Points are binned: less after a turn and around first touch, where the force bends; the path is not.
 *
 * Thread-safe, no state between calls, no exception escapes. Not real-time (heap). */
#ifndef NANOTOUCH_FIT_VISCOELASTIC_H
#define NANOTOUCH_FIT_VISCOELASTIC_H

#include "nanotouch/viscoelastic.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The first NT_RHEOLOGY_PARAMETERS are those of the rheology, in the order of nt_rheology_parameter_count(). */
enum {
    NT_FIT_PATH_CONTACT = NT_RHEOLOGY_PARAMETERS, /* z_0 [m] */
    NT_FIT_PATH_LEVEL,                            /* [N] */
    NT_FIT_PATH_TILT,                             /* [N/m] */
    NT_FIT_PATH_DRAG,                             /* at the surface [N s/m] */
    NT_FIT_PATH_PARAMETERS
};

/* A curve as it was recorded, in the order of time. */
typedef struct nt_fit_path {
    const double *times;         /* increasing [s] */
    const double *positions;     /* X; the first ones out of contact [m] */
    const double *forces;        /* + repulsive [N] */
    const unsigned char *fitted; /* 0: the point is on the path alone; NULL: all are fitted */
    long count;
    const long *starts; /* index of the first point of each segment (approach, pause, retraction); starts[0] = 0 */
    int segments;       /* 1 or more */
} nt_fit_path;

typedef struct nt_fit_path_options {
    nt_viscoelastic contact;              /* tip, layer, lever; rheology: its kind and number of arms, and those of its
                                           * parameters that are held */
    double start[NT_FIT_PATH_PARAMETERS]; /* where the fit begins; NaN: guessed [SI] */
    unsigned held;                        /* bit p: parameter p stays at its start */
    double noise;                         /* standard deviation of the force from point to point, > 0 [N] */
    double tilt_position;                 /* X_b [m] */
    double drag_height;                   /* h_d; 0: drag does not depend on the height [m] */
    int max_iterations;
} nt_fit_path_options;
/* A power law under a paraboloid; all starts NaN but level, tilt and drag (0), nothing held, 60 iterations. */
NT_API nt_fit_path_options nt_fit_path_defaults(void);

typedef struct nt_fit_path_result {
    double value[NT_FIT_PATH_PARAMETERS]; /* [SI]; NaN for those that the kind does not have */
    double sigma[NT_FIT_PATH_PARAMETERS]; /* standard uncertainty; 0: held; infinity: the curve does not say */
    double covariance[NT_FIT_PATH_PARAMETERS][NT_FIT_PATH_PARAMETERS]; /* [SI], 0 if held; of an exponent at 0 the
                                                                        * others' are those with it held there */
    double free_exponent; /* beta where it could fall below 0, by the last step: value[1] unless that is 0 */
    double chi_square;    /* over the noise, of the bins */
    long bins;            /* that were fitted */
    double correlation;   /* of the residuals: by how much sigma^2 was raised for it; 1: none evident [-] */
    double peak;          /* max of F [N] */
    double indentation;   /* max of delta [m] */
    double contact_time;  /* from first touch to the peak of the force [s] */
    double kernel_error;  /* as nt_viscoelastic_result */
    int by_springs;       /* 1: the contact shrank and grew again */
    int iterations, converged;
    unsigned held; /* as options.held, with drag where the speed does not change its sign */
} nt_fit_path_result;

/* Fits. NT_E_RANGE, NT_E_NOT_FINITE or NT_E_ARGUMENT with a problem (NULL allowed); NT_E_NO_CONVERGENCE where no law of
 * this kind comes near; NT_E_NO_MEMORY. */
NT_API nt_status nt_fit_path_run(const nt_fit_path_options *options, const nt_fit_path *path,
                                 nt_fit_path_result *result, nt_problem *problem);
/* The fitted force, level, tilt and drag in it [N], and the indentation [m], at every point; either may be NULL. */
NT_API nt_status nt_fit_path_model(const nt_fit_path_options *options, const nt_fit_path_result *found,
                                   const nt_fit_path *path, double *forces, double *indentations);

#ifdef __cplusplus
}
#endif
#endif
