/* SPDX-License-Identifier: BSD-3-Clause
 * Fitting a contact law to a measured force curve by nonlinear least squares (Ceres behind a C interface).
 *
 * The model: at a position X the force is F0 + F(delta), where
 *
 *     X - delta0 = delta + c F(delta)/k_c                                                   (cantilever)
 *
 * X is the travel of the cantilever's base towards the sample and k_c its spring constant; where X is the indentation
 * itself (up to its zero delta0), set spring_constant = 0. Fitting at the position of the base keeps the noise of the
 * force out of the abscissa, and shows how little a curve says about a contact much stiffer than its cantilever.
 *
 * F(delta) is the stable branch down to the load fold (the pull-off force), constant below it: what a retraction shows
 * from the deepest point to its minimum. It is C1 in delta and in every parameter, whatever k_c.
 *
 * All functions: thread-safe, no state between calls, nothing printed, no exception escapes. Not real-time (heap). */
#ifndef NANOTOUCH_FIT_H
#define NANOTOUCH_FIT_H

#include "nanotouch/contact.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum nt_fit_parameter {
    NT_FIT_EFFECTIVE_MODULUS, /* E* [Pa] */
    NT_FIT_WORK_OF_ADHESION,  /* w [J/m^2]; not in Hertz */
    NT_FIT_COHESIVE_RANGE,    /* h0 = w/sigma0 [m]; Maugis-Dugdale only */
    NT_FIT_CONTACT_POINT,     /* delta0: X at which the undeformed bodies touch [m] */
    NT_FIT_FORCE_OFFSET,      /* F0 [N] */
    NT_FIT_COMPLIANCE,        /* c: true over assumed deflection sensitivity [-]; with a spring constant only */
    NT_FIT_PARAMETERS         /* how many there are */
} nt_fit_parameter;
/* "effective_modulus", ... and its SI unit ("" if none); NULL for no parameter. */
NT_API const char *nt_fit_parameter_name(nt_fit_parameter parameter);
NT_API const char *nt_fit_parameter_unit(nt_fit_parameter parameter);
/* 1 if the model has this parameter (work of adhesion: all but Hertz; cohesive range: Maugis-Dugdale). */
NT_API int nt_fit_model_has(nt_model model, nt_fit_parameter parameter);

typedef struct nt_fit_start {
    double initial;          /* SI; NaN: guessed from the data (not possible for a fixed one) */
    double minimum, maximum; /* bounds, SI */
    int fixed;               /* 1: stays at initial */
} nt_fit_start;

/* Loss on each point, of u = residual/loss_scale; least squares or one that outliers cannot pull. */
typedef enum nt_fit_loss { NT_LOSS_SQUARES, NT_LOSS_HUBER, NT_LOSS_SOFT_L1, NT_LOSS_CAUCHY } nt_fit_loss;

typedef struct nt_fit_options {
    nt_model model;
    double radius;          /* R of the tip [m] */
    double spring_constant; /* k_c [N/m]; 0: the position is the indentation */
    nt_fit_start parameter[NT_FIT_PARAMETERS];
    nt_fit_loss loss;
    double loss_scale;     /* residual at which the loss leaves the parabola [N]; read unless NT_LOSS_SQUARES */
    double force_noise;    /* standard deviation of the force data [N]; 0: unknown, taken from the residuals */
    double pull_off_force; /* measured, positive [N]; a datum like the points, used if pull_off_sigma > 0 */
    double pull_off_sigma; /* its standard uncertainty [N]; needs force_noise */
    double
        compliance_sigma; /* relative uncertainty of the deflection sensitivity; needs force_noise; used if c is free */
    int max_iterations;
} nt_fit_options;
/* Free: E*, w and delta0 (guessed). Fixed: h0 = 0.2 nm, F0 = 0, c = 1. R = 20 nm, k_c = 0, least squares, no noise
 * known, 100 iterations. */
NT_API nt_fit_options nt_fit_defaults(nt_model model);
/* NT_OK, or NT_E_NOT_FINITE / NT_E_RANGE / NT_E_ARGUMENT with the offending field in *problem (NULL allowed). */
NT_API nt_status nt_fit_check(const nt_fit_options *options, nt_problem *problem);

/* Points of the curve in any order; point i is at position[i * position_stride]. */
typedef struct nt_fit_data {
    const double *position;             /* X, + towards the sample [m] */
    const double *force;                /* + repulsive, baseline taken off [N] */
    long count;                         /* at least 3 more than there are free parameters */
    long position_stride, force_stride; /* [elements]; 1 for plain arrays */
} nt_fit_data;

/* A parameter that the data determine: free, off its bounds, outside the null space of the problem, and known to
 * NT_FIT_IDENTIFIABLE: relative, for contact point and force offset of the range of the data. */
#define NT_FIT_IDENTIFIABLE 0.5

enum { NT_FIT_MESSAGE = 200 };

typedef struct nt_fit_result {
    double value[NT_FIT_PARAMETERS]; /* SI; those of the model that are fixed too; NaN for those not in the model */
    double sigma[NT_FIT_PARAMETERS]; /* standard uncertainty, SI; 0 if fixed, +infinity in the null space */
    double covariance[NT_FIT_PARAMETERS][NT_FIT_PARAMETERS]; /* SI; 0 if fixed, NaN beside an infinite variance */
    int identifiable[NT_FIT_PARAMETERS];
    double residual_rms; /* of the force [N] */
    double misfit;       /* reduced chi^2 against force_noise; NaN if that is 0. The covariance is scaled up by it
                            if > 1 */
    double transition_parameter; /* Maugis' lambda [-]; NaN for other models */
    double pull_off_force;       /* of the fitted contact, positive [N] */
    double contact_radius;       /* a at the deepest point [m] */
    double contact_stiffness;    /* k at the deepest point [N/m] */
    int iterations;
    int converged;                /* 0: stopped at max_iterations; the values are the best so far */
    char message[NT_FIT_MESSAGE]; /* one sentence; ends with what the data cannot determine, if any */
} nt_fit_result;

/* Fits. problem (NULL allowed) names what is wrong with options or data. The result is written on NT_OK only; fails
 * with NT_E_NO_CONVERGENCE if no contact law of this kind comes near the data, NT_E_NO_MEMORY. */
NT_API nt_status nt_fit_run(const nt_fit_options *options, const nt_fit_data *data, nt_fit_result *result,
                            nt_problem *problem);

/* One point of the model and its derivatives. */
typedef struct nt_fit_point {
    double force;                       /* F0 + F [N] */
    double indentation;                 /* delta [m] */
    double gradient[NT_FIT_PARAMETERS]; /* d force/d parameter, SI */
} nt_fit_point;
/* The model at a position, parameter values in SI as in nt_fit_result; reads model, radius, spring constant of options.
 */
NT_API nt_status nt_fit_model_at(const nt_fit_options *options, const double value[NT_FIT_PARAMETERS], double position,
                                 nt_fit_point *point);
/* The force of the model at every position of data into force[i], i < data->count (data->force is not read). */
NT_API nt_status nt_fit_model_n(const nt_fit_options *options, const double value[NT_FIT_PARAMETERS],
                                const nt_fit_data *data, double *force);

#ifdef __cplusplus
}
#endif
#endif
