/* SPDX-License-Identifier: BSD-3-Clause
 * Fitting a law to a measured force curve by nonlinear least squares (Ceres behind a C interface).
 *
 * The model: at a position X the measured force is
 *
 *     F0 + G (X - X_b) + F(delta)/s      where      X - delta0 = delta + F(delta)/k_c               (cantilever)
 *
 * X is the travel of the cantilever's base towards the sample, k_c its spring constant, s the true over the assumed
 * deflection sensitivity; F0 and G what is left of offset and tilt of the baseline. Where X is the indentation itself
 * (up to its zero delta0), set spring_constant = 0. Fitting at the position of the base keeps the noise of the force
 * out of the abscissa, and shows how little a curve says about a contact much stiffer than its cantilever.
 *
 * F(delta) is what a retraction shows: the stable branch, and beyond its lowest force (the load fold) the part that no
 * dead weight but this cantilever holds, until it tears the tip off (dF/ddelta = -k_c). Shortly before that, where the
 * curve has become steeper than NT_FIT_STEEPEST k_c, the model goes on as a straight line to F = 0, so that up to there
 * it is C1 in delta and in every parameter: what lies on it (nt_fit_point.held = 0) is not to be fitted. Without a
 * spring constant, and for DMT, the force stays at that of the load fold.
 *
 * All functions: thread-safe, no state between calls, nothing printed, no exception escapes. Not real-time (heap).
 * While nt_fit_run or nt_fit_batch runs, the new handler of C++ (std::set_new_handler) is the library's: Ceres survives
 * a full heap by it (docs/decisions/0010-memory-for-ceres.md). It hands on to the one that was set before, which is set
 * again at the end. Set none meanwhile. */
#ifndef NANOTOUCH_FIT_H
#define NANOTOUCH_FIT_H

#include "nanotouch/advanced/fit_models.h"
#include "nanotouch/contact.h"
#include "nanotouch/curves.h"
#include "nanotouch/rheology.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NT_FIT_STEEPEST 2.0

/* The first four belong to the law (NT_FIT_CUSTOM: in the order of its own), the others to every curve. */
typedef enum nt_fit_parameter {
    NT_FIT_EFFECTIVE_MODULUS, /* E* [Pa] */
    NT_FIT_WORK_OF_ADHESION,  /* w [J/m^2]; DMT, JKR, Maugis-Dugdale */
    NT_FIT_COHESIVE_RANGE,    /* h0 = w/sigma0 [m]; Maugis-Dugdale */
    NT_FIT_FOURTH,            /* thickness t of a layer [m]; the fourth of NT_FIT_CUSTOM */
    NT_FIT_CONTACT_POINT,     /* delta0: X at which the undeformed bodies touch [m] */
    NT_FIT_FORCE_OFFSET,      /* F0 [N] */
    NT_FIT_FORCE_TILT,        /* G [N/m] */
    NT_FIT_SENSITIVITY,       /* s [-]; with a spring constant only */
    NT_FIT_PARAMETERS         /* how many there are */
} nt_fit_parameter;
enum { NT_FIT_OWN = NT_FIT_CONTACT_POINT };

/* What a parameter is called, its SI unit ("" if none) and widest bounds. With minimum > 0 it is fitted by its
 * logarithm. */
typedef struct nt_fit_quantity {
    const char *name, *unit;
    double initial, minimum, maximum; /* initial NaN: guessed from the data [unit] */
} nt_fit_quantity;

struct nt_fit_options;

/* A law of the user's own. force fills force[i] [N] at indentation[i] [m] for i < count, NaN where there is none, and
 * is a pure function of its arguments; it is differentiated numerically (central differences, 1e-9). Of options it has
 * the tip, and its own law with its context. Where there is a spring constant, X must grow with delta. What it returns
 * but NT_OK means that there is no such contact. */
typedef struct nt_fit_law {
    const char *name;
    int count; /* of parameters, 1 .. NT_FIT_OWN */
    nt_fit_quantity parameter[NT_FIT_OWN];
    nt_status (*force)(const struct nt_fit_options *options, const double *value, long count, const double *indentation,
                       double *force);
    void *context;
} nt_fit_law;

typedef struct nt_fit_start {
    double initial;          /* [SI]; NaN: guessed from the data (not possible for a fixed one) */
    double minimum, maximum; /* bounds, [SI] */
    double sigma;            /* > 0: initial is a datum of this standard uncertainty, [SI]; needs force_noise */
    int fixed;               /* 1: stays at initial */
} nt_fit_start;

/* Loss on each point, of u = residual/loss_scale; least squares or one that outliers cannot pull. */
typedef enum nt_fit_loss { NT_LOSS_SQUARES, NT_LOSS_HUBER, NT_LOSS_SOFT_L1, NT_LOSS_CAUCHY } nt_fit_loss;

typedef struct nt_fit_options {
    nt_fit_model model;
    const nt_fit_law *law;  /* of NT_FIT_CUSTOM, borrowed */
    double radius;          /* R of the tip [m] */
    double half_angle;      /* psi of cones and pyramids [rad] */
    double spring_constant; /* k_c [N/m]; 0: the position is the indentation */
    double tilt_position;   /* X_b: where the tilt adds nothing [m] */
    nt_fit_start parameter[NT_FIT_PARAMETERS];
    nt_fit_loss loss;
    double loss_scale;    /* residual at which the loss leaves the parabola [N]; read unless NT_LOSS_SQUARES */
    double force_noise;   /* standard deviation of the force data [N]; 0: unknown, taken from the residuals */
    double tear_position; /* X at which the tip was torn off [m], a datum like the points, used if tear_sigma > 0 */
    double tear_sigma;    /* its standard uncertainty [m]; needs force_noise, adhesion, spring constant */
    int max_iterations;
} nt_fit_options;
/* Free: E*, w and delta0 (guessed). Fixed: h0 = 0.2 nm, t = 1 m, F0 = 0, G = 0, s = 1. R = 20 nm, psi = 20 degrees, k_c
 * = 0, least squares, no noise known, 100 iterations. */
NT_API nt_fit_options nt_fit_defaults(nt_fit_model model);
/* The same for a law of the user's own (borrowed), whose parameters are free and start where it says. */
NT_API nt_fit_options nt_fit_defaults_for(const nt_fit_law *law);
/* A parameter of the model that options name; its name is NULL if the model has none in that place. */
NT_API nt_fit_quantity nt_fit_quantity_of(const nt_fit_options *options, nt_fit_parameter parameter);

/* Points of the curve in any order; point i is at position[i * position_stride]. */
typedef struct nt_fit_data {
    const double *position;             /* X, + towards the sample [m] */
    const double *force;                /* + repulsive, baseline taken off [N] */
    long count;                         /* at least 3 more than there are free parameters */
    long position_stride, force_stride; /* [elements]; 1 for plain arrays */
} nt_fit_data;

/* A parameter that the data determine: free, off its bounds, outside the null space of the problem, and known to
 * NT_FIT_IDENTIFIABLE: relative, for contact point, force offset and tilt of the range of the data. */
#define NT_FIT_IDENTIFIABLE 0.5

enum { NT_FIT_MESSAGE = 300 };

typedef struct nt_fit_result {
    double value[NT_FIT_PARAMETERS]; /* [SI]; those of the model that are fixed too; NaN for those not in the model */
    double sigma[NT_FIT_PARAMETERS]; /* standard uncertainty, [SI]; 0 if fixed, +infinity in the null space */
    double covariance[NT_FIT_PARAMETERS][NT_FIT_PARAMETERS]; /* [SI]; 0 if fixed, NaN beside an infinite variance */
    double from_tear[NT_FIT_PARAMETERS]; /* part of the variance that comes from the tear's position [-] */
    int identifiable[NT_FIT_PARAMETERS];
    double residual_rms;     /* of the force [N] */
    double residual_noise;   /* of the residuals from point to point, standard deviation [N]; residual_rms if white */
    int residuals_are_noise; /* 0: the model does not describe the points, and sigma is too small. Looked for at a ratio
                                of residual_rms (from the median with a robust loss) to residual_noise or force_noise
                                above 1.5 + 4/sqrt(count) */
    double misfit;     /* reduced chi^2 against force_noise [-]; NaN if that is 0. The covariance is scaled up by it
                          if > 1 */
    double chi_square; /* against force_noise, with that of the tear and of what is known [-]; NaN if that is 0 */
    double transition_parameter; /* Maugis' lambda [-]; NaN for other models */
    double pull_off_force;       /* of the fitted contact, positive [N]; NaN for NT_FIT_CUSTOM, as the next two */
    double contact_radius;       /* a at the deepest point [m] */
    double contact_stiffness;    /* k at the deepest point [N/m] */
    int iterations;
    int converged;                /* 0: stopped at max_iterations; the values are the best so far */
    char message[NT_FIT_MESSAGE]; /* one sentence; ends with a misfit and what the data cannot determine, if any */
} nt_fit_result;

/* Fits. problem (NULL allowed) names what is wrong with options or data. The result is written on NT_OK only; fails
 * with NT_E_NO_CONVERGENCE if no law of this kind comes near the data, NT_E_NO_MEMORY. */
NT_API nt_status nt_fit_run(const nt_fit_options *options, const nt_fit_data *data, nt_fit_result *result,
                            nt_problem *problem);

/* One point of the model and its derivatives. */
typedef struct nt_fit_point {
    double force;                       /* as measured: F0 + G (X - X_b) + F/s [N] */
    double indentation;                 /* delta [m] */
    double gradient[NT_FIT_PARAMETERS]; /* d force/d parameter, [SI] */
    int held;                           /* 1: on the branch; 0: where the cantilever has (almost) torn the tip off */
} nt_fit_point;
/* The model at every position of data (data->force is not read) into point[i], i < data->count; parameter values in SI
 * as in nt_fit_result. */
NT_API nt_status nt_fit_model_n(const nt_fit_options *options, const double value[NT_FIT_PARAMETERS],
                                const nt_fit_data *data, nt_fit_point *point);

/* What a fit left over, for its rating. */
typedef struct nt_fit_rated {
    const double *indentation; /* delta of each point [m], in the order of the base's positions */
    const double *force;       /* measured, baseline taken off [N] */
    const double *fitted;      /* the model's [N] */
    long count;
    double noise; /* of the force from point to point, standard deviation [N] */
} nt_fit_rated;
/* 0 (reject) to 10: the largest residuals of three parts of the indentation from a quarter of its depth on, beside the
 * load, as people have rated such curves. 0 where the load does not rise above ten times the noise. */
NT_API double nt_fit_rating(const nt_fit_rated *rated);
#define NT_FIT_GOOD 4.5 /* below, a fit is a misfit if its residuals are no noise either */

/* ---- A fit with what is known beforehand, and what it is worth ---- */

/* What the user of a fit has to know, one bit each. */
typedef enum nt_fit_flag {
    NT_FIT_NOT_CONVERGED = 1, /* stopped at max_iterations */
    NT_FIT_STIFF = 2,         /* contact much stiffer than the cantilever: E* hardly shows */
    NT_FIT_MISFIT = 4,        /* residuals above 3 times the noise, and a rating below NT_FIT_GOOD */
    NT_FIT_WIDE = 8,          /* contact radius above R/2, or twice a layer's thickness: the law is not valid there */
    NT_FIT_CALIBRATION = 16,  /* the curve contradicts its calibration, or the model is wrong: E* not determined */
    NT_FIT_WRONG_MODEL = 32,  /* residuals also above 5 % of the force, or torn elsewhere: nothing is determined */
    NT_FIT_WAVES = 64,        /* a wave of interference was taken off with the baseline */
    NT_FIT_TORN_ELSEWHERE = 128, /* than where this contact and cantilever let go: the tear is not used */
    NT_FIT_UNEVEN = 1 << 20,     /* shallow and deep half of the contact ask for different E* and contact points: their
                                    sigma covers half of that */
    NT_FIT_BEGINS_IN_CONTACT = 1 << 21, /* no part of the branch is surely free: nothing is determined; of recorded
                                           curves, and laws without adhesion */
    /* Of laws without adhesion, each leaves E* undetermined; the last two of recorded curves with both branches. */
    NT_FIT_IMPRECISE = 1 << 22,   /* noise and baseline leave E* a 95 % interval beyond +-20 %; of every law */
    NT_FIT_OTHER_POWER = 1 << 23, /* the force rises with another power of the indentation, or a cone (of a cone: a
                                     paraboloid) describes it better */
    NT_FIT_ADHESIVE = 1 << 24,    /* the tip snaps in, or is torn off a contact */
    NT_FIT_HYSTERESIS = 1 << 25   /* the retraction returns another work than the approach puts in */
} nt_fit_flag;

/* ---- Curves as they were recorded, many at once: baseline, what is fitted of each, the fit ---- */

/* How each curve is fitted. */
typedef struct nt_fit_recipe {
    nt_fit_options options; /* as for nt_fit_run; spring constant, noise, tear and what is known of sensitivity, offset
                               and tilt come from each curve; loss_scale 0: three times its noise. Positions are -z. */
    int approach;           /* 1: the approach is fitted; 0: the retraction */
    nt_curve_choice baseline;           /* which is taken off */
    int fit_offset;                     /* 1: the force offset is free; 0: known as well as the baseline is */
    int held[NT_FIT_PARAMETERS];        /* 1: of sensitivity, offset, tilt, stays at its value in options */
    double lowest_force, highest_force; /* only points between these are fitted [N]; -inf, inf: all */
    double sensitivity_uncertainty;     /* of the deflection, relative [-]; 0: exact */
} nt_fit_recipe;
/* The retraction for adhesive models, else the approach; all its points, a sensitivity known to 3 %. */
NT_API nt_fit_recipe nt_fit_recipe_defaults(nt_fit_model model);
/* As nt_fit_check, of the recipe with any valid spring constant. */
NT_API nt_status nt_fit_recipe_check(const nt_fit_recipe *recipe, nt_problem *problem);

/* What a curve shows without any model (curves.h). */
typedef struct nt_fit_reading {
    double noise;                    /* of the force from point to point, standard deviation [N] */
    double baseline_tilt;            /* [N/m]; of the approach, of the retraction where there is no approach */
    nt_curve_measured snap_in_force; /* depth below the baseline, positive [N]; 0 where no dip is visible */
    nt_curve_measured pull_off_force;
    nt_curve_measured adhesion_work;      /* area of the retraction below its baseline [J]; 0 without pull-off */
    nt_curve_measured contact_slope;      /* -dF/dz over the upper half of the load [N/m] */
    double pull_off_least, pull_off_most; /* ends of the 95 % interval of the pull-off [N] (curves.h) */
    nt_curve_measured offset; /* by which the retraction ends below the approach: drag, or what still holds [N] */
    int ruptures;             /* how many tear off on the retraction */
} nt_fit_reading;

typedef struct nt_fit_outcome {
    nt_status status;       /* NT_OK; NT_E_NOT_FINITE, NT_E_RANGE (values or too few points); or as nt_fit_run */
    nt_problem problem;     /* what is wrong with the curve; field NULL where that says no more than the status */
    nt_fit_reading reading; /* NaN where the curve could not be read */
    nt_fit_result fit;      /* value, sigma, rms, ... NaN and identifiable 0 where status is not NT_OK */
    unsigned flags;         /* nt_fit_flag */
    double rating;          /* nt_fit_rating; NaN where status is not NT_OK [-] */
} nt_fit_outcome;

/* Fits count curves in up to `threads` threads (0: one per processor). Every outcome is written; none depends on
 * another curve or on the number of threads. NT_OK, or what is wrong with the arguments, with nothing written. */
typedef struct nt_fit_curves {
    const nt_curve *curve;
    long count;
    int threads;
} nt_fit_curves;
/* Fits all of them as told above, by one recipe. */
NT_API nt_status nt_fit_batch(const nt_fit_recipe *recipe, const nt_fit_curves *curves, nt_fit_outcome *outcome);

/* --- Fitting a viscoelastic contact (rheology.h) to a whole recorded curve: approach, pauses and retraction in one
 * least-squares fit, by analytic derivatives.
 *
 *     force = level + tilt (X - X_b) + drag v h_d/(h_d + h) + F(X - z_0, t)
 *
 * X is the position of the base, towards the sample, v its speed, h the tip's height over first touch z_0 (0 in
 * contact). Points are binned: less after a turn and around first touch, where the force bends; the path is not.
 *
 * Thread-safe, no state between calls, no exception escapes. Not real-time (heap). --- */

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
