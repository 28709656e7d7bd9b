/* SPDX-License-Identifier: BSD-3-Clause
 * A rigid tip on a linear viscoelastic sample, without adhesion: the force along any history of the probe's base.
 *
 * While the contact grows F = 1/(1 - nu^2) Int E(t - s) dg(delta(s)) (Lee and Radok 1960), g(delta) the elastic law
 * over E*; while it shrinks the integral ends at the time t_1 when the contact was last as large (Ting 1966). The base
 * moves in straight lines between the points given; a lever bends in between: delta = position - contact - F/k_c. */
#ifndef NANOTOUCH_VISCOELASTIC_H
#define NANOTOUCH_VISCOELASTIC_H

#include "nanotouch/advanced/geometry.h"
#include "nanotouch/rheology.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A contact. E(t) is Young's modulus of the sample; Poisson's ratio does not change in time. */
typedef struct nt_viscoelastic {
    nt_shape shape; /* PARABOLOID, SPHERE, CONE (also a pyramid) or PUNCH */
    nt_rheology rheology;
    double poisson_ratio;   /* nu, of the sample [-] */
    double thickness;       /* h, of a layer bonded to rigid ground; 0: a half-space. PARABOLOID and CONE, nu = 0.5: the
                             * polynomials of the fit models "layer" and "layer_cone", contact radius up to 2 h [m] */
    double spring_constant; /* k_c; 0: rigid, the indentation is given [N/m] */
} nt_viscoelastic;
/* A paraboloid of 5 um on nt_rheology_defaults(), nu = 0.5, a half-space, a rigid lever. */
NT_API nt_viscoelastic nt_viscoelastic_defaults(void);
/* NT_OK, or NT_E_ARGUMENT / NT_E_NOT_FINITE / NT_E_RANGE with the offending field in *problem (NULL
 * allowed). */
NT_API nt_status nt_viscoelastic_check(const nt_viscoelastic *contact, nt_problem *problem);

/* The points of a history. */
typedef struct nt_viscoelastic_path {
    const double *times;     /* increasing [s] */
    const double *positions; /* of the base, towards the sample; the first one out of contact [m] */
    double contact;          /* position of first touch, z_0 [m] */
    long count;              /* 2 or more */
    double *workspace;       /* nt_viscoelastic_workspace() doubles */
} nt_viscoelastic_path;

/* What is computed, `count` of each; those that are NULL are left out. */
typedef struct nt_viscoelastic_result {
    double *forces;       /* F, never below 0 [N] */
    double *indentations; /* delta = position - contact - F/k_c; below 0: above the sample [m] */
    double *derivatives; /* of F: rows of 1 + nt_rheology_parameter_count(): by `contact`, then by the parameters of the
                          * rheology in their order [N over the parameter's unit] */
    int arms;            /* of the sum of exponentials */
    double kernel_error; /* of it [1], as nt_spectrum.error; the force errs by some tenth of that */
    int by_springs;      /* 1: a contact that had shrunk grew again, and 128 springs followed it; 3e-4 of F_max */
} nt_viscoelastic_result;

/* Doubles that a history of so many points needs, with derivatives or without. */
NT_API long nt_viscoelastic_workspace(const nt_viscoelastic *contact, long count, int with_derivatives);
/* Along a history. The derivatives are those of the discretized law, exact but for the grid of the first steps of a
 * contact. NT_OK; NT_E_NOT_FINITE or NT_E_RANGE with a problem (the field and its value: times that do not increase, a
 * first point in contact, a layer or a sphere pressed beyond its law). */
NT_API nt_status nt_viscoelastic_run(const nt_viscoelastic *contact, const nt_viscoelastic_path *path,
                                     nt_viscoelastic_result *result, nt_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
