/* SPDX-License-Identifier: BSD-3-Clause
 * Contact mechanics: the force between an elastic tip and an elastic half-space at a given indentation.
 *
 * Every law returns {U, F, k, a} with F = dU/d(delta), k = dF/d(delta) (types.h). U is the energy relative to separated
 * bodies at rest; for DMT, whose tail has no range, relative to first touch (delta = 0).
 * Adhesive laws have branches: at one indentation there can be more than one equilibrium.
 * All functions: thread-safe, real-time safe, no state. NaN in the indentation gives NaN out (or NT_E_NOT_FINITE where
 * a status is returned). */
#ifndef NANOTOUCH_CONTACT_H
#define NANOTOUCH_CONTACT_H

#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A sphere (paraboloid) on a half-space. */
typedef struct nt_contact {
    double radius;            /* R of the tip [m], > 0; for sphere on sphere 1/R = 1/R1 + 1/R2 */
    double effective_modulus; /* E* [Pa], > 0 */
    double work_of_adhesion;  /* w [J/m^2], >= 0; 0 makes every law Hertz exactly */
    double cohesive_stress;   /* sigma0 of the Dugdale zone [Pa]; read by nt_maugis_* only, > 0 there if w > 0 */
} nt_contact;

/* R = 20 nm, E* = 76.9 GPa (silicon on silicon), w = 0.144 J/m^2 (water film), sigma0 of a 0.2 nm atomic range. */
NT_API nt_contact nt_contact_defaults(void);
/* NT_OK, or NT_E_NOT_FINITE / NT_E_RANGE with the offending field in *problem (NULL allowed). */
NT_API nt_status nt_contact_check(const nt_contact *contact, nt_problem *problem);

/* Which equilibrium is meant where there are several. */
typedef enum nt_branch {
    NT_BRANCH_STABLE, /* what retraction from contact meets under grips, down to its last fold; beyond it: apart (all 0)
                       */
    NT_BRANCH_APPROACH, /* what approach from far away meets: apart until the jump-in, then as STABLE */
    NT_BRANCH_UNSTABLE  /* the equilibrium between the two folds that no grip can hold; NT_E_NO_SOLUTION where there is
                           none */
} nt_branch;

/* Its force alone [N], without the rest of the law; indentation [m]. */
NT_API double nt_hertz_force(const nt_contact *contact, double indentation);

/* --- Maugis-Dugdale, Maugis 1992 (paper, Eq. 11; errata E9, E10): every lambda between DMT and JKR, in the explicit
 *     form of the branch parameter y = a/sqrt(c^2 - a^2). --- */

/* Where a branch ends or turns, in Maugis' units: load in pi w R, radius in (pi w R^2/K)^(1/3),
 * indentation in (pi^2 w^2 R/K^2)^(1/3). */
typedef struct nt_maugis_folds {
    double pull_off_load, pull_off_radius, pull_off_indentation; /* load fold: dead weight falls off [reduced] */
    double grip_load, grip_radius, grip_indentation;             /* displacement fold: grips let go [reduced] */
    int grip_in_contact; /* 1: the displacement fold lies on the contact branch (lambda > 0.9379); 0: on the non-contact
                            one */
    double zero_load_radius, zero_load_indentation; /* [reduced] */
    double touch_load, touch_indentation;           /* the a = 0 end of the contact branch [reduced] */
    double onset_indentation; /* where attraction starts on approach: -2/(pi lambda) (gap = h0) [reduced] */
} nt_maugis_folds;

/* A Maugis-Dugdale contact made ready: scales and folds. Immutable after nt_maugis_init; may be shared and copied. */
typedef struct nt_maugis {
    double lambda;            /* Maugis' transition parameter = 1.157 Tabor's mu [-] */
    double load_scale;        /* pi w R [N] */
    double radius_scale;      /* (pi w R^2/K)^(1/3) [m] */
    double indentation_scale; /* (pi^2 w^2 R/K^2)^(1/3) [m] */
    nt_maugis_folds folds;    /* reduced */
    double fold_y;            /* branch parameter y of the displacement fold, 0 if it is not in contact [-] */
    double load_fold_y;       /* branch parameter y of the load fold [-] */
    nt_contact contact;
} nt_maugis;

/* lambda = 2 sigma0 (R/(pi w K^2))^(1/3). NaN in, NaN out; +inf for w = 0. */
NT_API double nt_maugis_lambda(const nt_contact *contact);
/* Valid lambda. */
#define NT_MAUGIS_LAMBDA_MIN 1e-15
#define NT_MAUGIS_LAMBDA_MAX 1e15

/* --- Arrays: out[i * out_stride] from in[i * in_stride], strides in elements; in and out may be the same array.
 *     The first element that fails sets the returned status; its output and all that fail are NaN. --- */
typedef enum nt_model { NT_HERTZ, NT_DMT, NT_JKR, NT_MAUGIS } nt_model;
/* "hertz", "dmt", "jkr", "maugis". */
NT_API const char *nt_model_name(nt_model model);

/* A contact law chosen at run time, with whatever it needs prepared. Immutable after nt_contact_law_init. */
typedef struct nt_contact_law {
    nt_model model;
    nt_maugis maugis; /* prepared for NT_MAUGIS; .contact holds the parameters for every model */
} nt_contact_law;
/* Checks the contact and prepares what the law needs; returns what the check refuses. */
NT_API nt_status nt_contact_law_init(nt_contact_law *law, nt_model model, const nt_contact *contact);
/* {U, F, k, a} at an indentation [m] on a branch; fails as the law that was chosen. */
NT_API nt_status nt_contact_law_eval(const nt_contact_law *law, double indentation, nt_branch branch,
                                     nt_law_value *value);
/* Pull-off force under load control, positive [N]; 0 for Hertz. */
NT_API double nt_contact_law_pull_off_force(const nt_contact_law *law);
/* The last indentation that the STABLE branch holds under grips [m]; below it the bodies are apart. */
NT_API double nt_contact_law_grip_indentation(const nt_contact_law *law);

/* The same over arrays of indentations [m], by the rule of all arrays above. */
NT_API nt_status nt_contact_law_eval_n(const nt_contact_law *law, nt_branch branch, const nt_strided *arrays);

#ifdef __cplusplus
}
#endif
#endif
