/* SPDX-License-Identifier: BSD-3-Clause
 * Faster Maugis-Dugdale: the same law from a table, in tiers of measured error (docs/contact.md).
 *
 * A table is made once per contact (some microseconds), of cubic polynomials in Z = sqrt(delta - delta_fold), in which
 * the fold is no singularity; cells grow with Z, and the cell is read off the bits of the float u = 1 + Z/Zs. JKR is
 * the table of a large lambda (nt_maugis_init_lambda), and faster than its own closed form. Within a table F =
 * dU/d(delta) and k = dF/d(delta) hold exactly: U is the integral of the tabulated F. The non-contact branch is
 * closed-form in every tier. Beyond the last tabulated indentation, and on the unstable branch, every tier is the exact
 * solver: nothing is extrapolated. */
#ifndef NANOTOUCH_MAUGIS_TABLE_H
#define NANOTOUCH_MAUGIS_TABLE_H

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

/* How far NT_TIER_TABLE is from the exact law, as near to a fold as rounding leaves it. */
typedef struct nt_table_error {
    double stiffness; /* over max(|k|, P/delta of the units of the contact) [-] */
    double radius;    /* over max(a, a at zero load) [-] */
} nt_table_error;

/* Measures it, which takes as long as making the table. */
NT_API nt_table_error nt_maugis_table_error(const nt_maugis_table *table);

/* Force alone on the stable branch [N], from the table and polished; NaN for NaN and +infinity, 0 for
 * -infinity (apart). */
NT_API double nt_maugis_table_force(const nt_maugis_table *table, double indentation);

/* Arrays. force[i] from indentation[i], contiguous, the same array allowed; bit for bit what nt_maugis_table_force and
 * nt_maugis_table_eval give, on every instruction set. The first failure sets the status; what fails is NaN. */
NT_API nt_status nt_maugis_table_force_n(const nt_maugis_table *table, nt_branch branch, const double *indentation,
                                         double *force, long count);
/* The same polished: the force at rounding level, away from the folds. */
NT_API nt_status nt_maugis_table_polish_n(const nt_maugis_table *table, nt_branch branch, const double *indentation,
                                          double *force, long count);
/* {U, F, k, a}, strided (contact.h). */
NT_API nt_status nt_maugis_table_eval_n(const nt_maugis_table *table, nt_tier tier, nt_branch branch,
                                        const nt_strided *arrays);

#ifdef __cplusplus
}
#endif
#endif
