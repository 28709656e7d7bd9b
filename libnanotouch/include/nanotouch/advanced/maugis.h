/* SPDX-License-Identifier: BSD-3-Clause
 * Faster Maugis-Dugdale: the same law from a table, in tiers of measured error (docs/evidence/contact.md).
 *
 * A table is made once per contact (some microseconds), of cubic polynomials in Z = sqrt(delta - delta_fold), in which
 * the fold is no singularity; cells grow with Z, and the cell is read off the bits of the float u = 1 + Z/Zs. JKR is
 * the table of a large lambda (nt_maugis_init_lambda), and faster than its own closed form. Within a table F =
 * dU/d(delta) and k = dF/d(delta) hold exactly: U is the integral of the tabulated F. The non-contact branch is
 * closed-form in every tier. Beyond the last tabulated indentation, and on the unstable branch, every tier is the exact
 * solver: nothing is extrapolated. */
#ifndef NANOTOUCH_ADVANCED_MAUGIS_H
#define NANOTOUCH_ADVANCED_MAUGIS_H

#include "nanotouch/contact.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum nt_tier {
    NT_TIER_TABLE,    /* a cubic */
    NT_TIER_POLISHED, /* the table, then one evaluation of the exact branch and second order from there */
    NT_TIER_EXACT     /* Newton to rounding (nt_maugis_eval) */
} nt_tier;

/* One cell: polynomials in its own variable s = u - (u at its start). */
typedef struct nt_maugis_cell {
    double F[4]; /* force [N] */
    double a[4]; /* contact radius [m] */
    double U;    /* energy at its start [J] */
    double u;    /* u at its start [-] */
    float y[4];  /* branch parameter above that of the start of the table: where polishing starts [-] */
} nt_maugis_cell;

typedef struct nt_maugis_table_options {
    int cells_per_octave;       /* 1, 2, 4, .. 64; each doubling divides the error by about 16 */
    double largest_indentation; /* [m]; 0: 1000 indentation scales (1000 (pi^2 w^2 R/K^2)^(1/3)) */
} nt_maugis_table_options;

/* 8 cells per octave: at most 1e-5 of the force, mostly below 1e-6. */
NT_API nt_maugis_table_options nt_maugis_table_defaults(void);

/* Refers to the caller's cells; immutable after nt_maugis_table_init, may be shared. */
typedef struct nt_maugis_table {
    nt_maugis maugis;
    const nt_maugis_cell *cells; /* apart, attracted, contact .., beyond the end; NULL for w = 0, which is Hertz */
    int count;                   /* of cells */
    int shift;                   /* of the bits of u that gives the cell */
    double start;                /* lowest tabulated indentation: the fold, or a = 0 where that is no fold [m] */
    double largest_indentation;  /* [m] */
    double rate;                 /* 1/Zs [m^-1/2] */
    double u_end;                /* start of the cell beyond the end [-] */
    nt_accuracy accuracy[2];     /* of NT_TIER_TABLE and NT_TIER_POLISHED, measured when it was made */
} nt_maugis_table;

/* Cells that nt_maugis_table_init needs; 0 for w = 0 and for invalid options. Some 60 for the defaults, 200 at most. */
NT_API int nt_maugis_table_cells(const nt_maugis *maugis, const nt_maugis_table_options *options);
/* Makes a table in cells[0 .. capacity). options NULL: the defaults. NT_E_RANGE for invalid options, NT_E_CAPACITY. */
NT_API nt_status nt_maugis_table_init(nt_maugis_table *table, const nt_maugis *maugis,
                                      const nt_maugis_table_options *options, nt_maugis_cell *cells, int capacity);

/* {U, F, k, a}, strided (contact.h). */
NT_API nt_status nt_maugis_table_eval_n(const nt_maugis_table *table, nt_tier tier, nt_branch branch,
                                        const nt_strided *arrays);

/* --- A bank of Maugis-Dugdale tables over a range of lambda: for curved surfaces, grains of many sizes and pairs of
 * bodies, where lambda changes at every sample (docs/evidence/contact.md).
 *
 * In panels of lambda every number of a table is a cubic in lambda that shares value and slope with its neighbours: U
 * is one function of indentation and lambda, continuous with its first derivatives on the stable branch, and F = dU/dd,
 * k = dF/dd and dU/dlambda are its exact derivatives. Panels crowd towards lambda = 0.9379, where the branch changes
 * its kind, and leave out 1 % around it. There, outside the range, beyond the largest indentation and on the unstable
 * branch the exact solver answers (some microseconds); in between the two potentials are blended, with their
 * derivatives. --- */

/* Coefficients of a cell, as of a table, each a cubic in t, the place in the panel. */
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

/* Refers to the memory it was made in; immutable after nt_maugis_bank_init, may be shared. */
typedef struct nt_maugis_bank {
    nt_maugis_bank_options options;
    const nt_maugis_panel *panels;
    const nt_maugis_bank_cell *cells;
    int panel_count[2];   /* below 0.9379 and above it */
    nt_accuracy accuracy; /* the worst of all lambda; fold_shift reduced */
} nt_maugis_bank;

#ifdef __cplusplus
}
#endif
#endif
