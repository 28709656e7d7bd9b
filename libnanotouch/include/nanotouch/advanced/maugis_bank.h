/* SPDX-License-Identifier: BSD-3-Clause
 * A bank of Maugis-Dugdale tables over a range of lambda: for curved surfaces, grains of many sizes and pairs of
 * bodies, where lambda changes at every sample (docs/contact.md).
 *
 * In panels of lambda every number of a table is a cubic in lambda that shares value and slope with its neighbours: U
 * is one function of indentation and lambda, continuous with its first derivatives on the stable branch, and F = dU/dd,
 * k = dF/dd and dU/dlambda are its exact derivatives. Panels crowd towards lambda = 0.9379, where the branch changes
 * its kind, and leave out 1 % around it. There, outside the range, beyond the largest indentation and on the unstable
 * branch the exact solver answers (some microseconds); in between the two potentials are blended, with their
 * derivatives. */
#ifndef NANOTOUCH_MAUGIS_BANK_H
#define NANOTOUCH_MAUGIS_BANK_H

#include "nanotouch/contact.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Coefficients of a cell (maugis_table.h), each a cubic in t, the place in the panel. */
typedef struct nt_maugis_bank_cell {
    double F[4][4], a[4][4], U[4]; /* U and F above what they are at a = 0, below 0.9379 [reduced] */
} nt_maugis_bank_cell;

/* How far a bank is from the exact law over some lambda, away from folds; measured when it was made, between the
 * lambdas and indentations that it was made from. */
typedef struct nt_bank_error {
    double force;      /* over max(|F|, the pull-off force) [-] */
    double stiffness;  /* over max(|k|, 1) [reduced] */
    double radius;     /* over max(a, 1) [reduced] */
    double fold_shift; /* of the grip indentation [reduced] */
} nt_bank_error;

typedef struct nt_maugis_panel {
    double low, high;   /* of the distance max(lambda/0.9379, 0.9379/lambda) - 1; t = 0 .. 1 [-] */
    double start[8];    /* the fold above 0.9379: divided differences [-] */
    double rate, u_end; /* [-] */
    int first, count;   /* its cells */
    nt_bank_error error;
} nt_maugis_panel;

typedef struct nt_maugis_bank_options {
    double lambda_min, lambda_max; /* [-] */
    double largest_indentation;    /* [reduced] */
    int panels_per_octave;         /* of the distance from 0.9379; 1, 2, 4 .. 64 */
    int cells_per_octave;          /* as in a table */
} nt_maugis_bank_options;
/* lambda 0.01 .. 100, indentation up to 100, 4 panels and 4 cells per octave. */
NT_API nt_maugis_bank_options nt_maugis_bank_defaults(void);

/* The caller's memory. */
typedef struct nt_maugis_bank_memory {
    nt_maugis_panel *panels;
    nt_maugis_bank_cell *cells;
    int panel_capacity, cell_capacity;
} nt_maugis_bank_memory;

/* Refers to the memory it was made in; immutable after nt_maugis_bank_init, may be shared. */
typedef struct nt_maugis_bank {
    nt_maugis_bank_options options;
    const nt_maugis_panel *panels;
    const nt_maugis_bank_cell *cells;
    int panel_count[2];   /* below 0.9379 and above it */
    nt_accuracy accuracy; /* the worst of all lambda; fold_shift reduced */
} nt_maugis_bank;

/* Sets the capacities that a bank needs. NT_E_RANGE for invalid options. Some milliseconds. */
NT_API nt_status nt_maugis_bank_size(const nt_maugis_bank_options *options, nt_maugis_bank_memory *memory);
/* Some ten milliseconds. NT_E_CAPACITY. */
NT_API nt_status nt_maugis_bank_init(nt_maugis_bank *bank, const nt_maugis_bank_options *options,
                                     const nt_maugis_bank_memory *memory);

/* The worst between two lambdas; 0 where the exact solver answers. A bank of zeros (no panels) is exact everywhere. */
NT_API nt_bank_error nt_maugis_bank_error(const nt_maugis_bank *bank, double lambda_min, double lambda_max);

/* load[i] on the stable branch; what fails is NaN and sets the status. */
NT_API nt_status nt_maugis_bank_load_n(const nt_maugis_bank *bank, const double *lambda, const double *d, double *load,
                                       long count);

/* With the slope of the energy over the radius, at constant indentation, E*, w and sigma0: where R varies with place,
 * the force along x has the part -dU/dR dR/dx. */
typedef struct nt_bank_value {
    nt_law_value law;
    double dU_dR; /* [J/m] */
} nt_bank_value;
/* nt_maugis_bank_eval, with how the energy changes with the radius; fails as that does. */
NT_API nt_status nt_maugis_bank_eval_radius(const nt_maugis_bank *bank, const nt_contact *contact, double indentation,
                                            nt_branch branch, nt_bank_value *value);
/* Where the STABLE branch of nt_maugis_bank_eval_* ends under grips [m]: apart below it. 0 for w = 0; NaN for a contact
 * that is none. */
NT_API double nt_maugis_bank_grip_indentation(const nt_maugis_bank *bank, const nt_contact *contact);

/* Many contacts, each its own: contact i is contacts[i * contact_stride], its indentation [m] and results lie i *
 * stride elements along theirs. Results that are NULL are not wanted. Parts of the arrays may be done in different
 * threads. */
typedef struct nt_bank_pairs {
    const nt_contact *contacts;
    const double *indentation;     /* [m] */
    double *U, *F, *k, *a, *dU_dR; /* [J], [N], [N/m], [m], [J/m] */
    long count;
    long contact_stride; /* 0: one contact for all */
    long in_stride, out_stride;
} nt_bank_pairs;
/* Every contact is checked; what fails is NaN, and the first failure sets the status. */
NT_API nt_status nt_maugis_bank_pairs_n(const nt_maugis_bank *bank, nt_branch branch, const nt_bank_pairs *pairs);

#ifdef __cplusplus
}
#endif
#endif
