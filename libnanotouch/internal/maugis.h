/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale from tables: one contact, and a bank over lambda. */
#ifndef NANOTOUCH_INTERNAL_MAUGIS_H
#define NANOTOUCH_INTERNAL_MAUGIS_H

#include "nanotouch/advanced/maugis.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How far NT_TIER_TABLE is from the exact law, as near to a fold as rounding leaves it. */
typedef struct nt_table_error {
    double stiffness; /* over max(|k|, P/delta of the units of the contact) [-] */
    double radius;    /* over max(a, a at zero load) [-] */
} nt_table_error;

/* The caller's memory. */
typedef struct nt_maugis_bank_memory {
    nt_maugis_panel *panels;
    nt_maugis_bank_cell *cells;
    int panel_capacity, cell_capacity;
} nt_maugis_bank_memory;

/* With the slope of the energy over the radius, at constant indentation, E*, w and sigma0: where R varies with place,
 * the force along x has the part -dU/dR dR/dx. */
typedef struct nt_bank_value {
    nt_law_value law;
    double dU_dR; /* [J/m] */
} nt_bank_value;

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

/* lambda 0.01 .. 100, indentation up to 100, 4 panels and 4 cells per octave. */
NT_API nt_maugis_bank_options nt_maugis_bank_defaults(void);
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
/* nt_maugis_bank_eval, with how the energy changes with the radius; fails as that does. */
NT_API nt_status nt_maugis_bank_eval_radius(const nt_maugis_bank *bank, const nt_contact *contact, double indentation,
                                            nt_branch branch, nt_bank_value *value);
/* Where the STABLE branch of nt_maugis_bank_eval_* ends under grips [m]: apart below it. 0 for w = 0; NaN for a contact
 * that is none. */
NT_API double nt_maugis_bank_grip_indentation(const nt_maugis_bank *bank, const nt_contact *contact);
/* Every contact is checked; what fails is NaN, and the first failure sets the status. */
NT_API nt_status nt_maugis_bank_pairs_n(const nt_maugis_bank *bank, nt_branch branch, const nt_bank_pairs *pairs);
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

#ifdef __cplusplus
}
#endif
#endif
