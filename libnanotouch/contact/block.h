/* SPDX-License-Identifier: BSD-3-Clause
 * A block of a contact law over an array, small enough for the first cache; private to contact/. */
#ifndef NANOTOUCH_CONTACT_BLOCK_H
#define NANOTOUCH_CONTACT_BLOCK_H

#include "nanotouch/contact.h"

enum { NT_BLOCK = 64 };

typedef struct nt_law_block {
    double in[NT_BLOCK]; /* indentations [m] */
    double U[NT_BLOCK], F[NT_BLOCK], k[NT_BLOCK], a[NT_BLOCK];
} nt_law_block;

/* JKR, STABLE or APPROACH, with the bits of nt_jkr_eval; w > 0. Returns 0, and fills nothing, where an indentation is
 * beyond what its reduced form can tell from Hertz. What is not finite gives any value. */
int nt_jkr_block(const nt_contact *contact, nt_branch branch, nt_law_block *block);

/* The same of Maugis-Dugdale, exact; of what stands for U, k and a nothing is known where the load alone is wanted. */
int nt_maugis_block(const nt_maugis *maugis, nt_branch branch, int load_alone, nt_law_block *block);

/* A contact of its own for every indentation of a block, checked and with adhesion: as nt_reduced_units_of and
 * nt_reduced_lambda have it, within the valid lambda. */
typedef struct nt_block_contacts {
    double lambda[NT_BLOCK];
    double load[NT_BLOCK], radius[NT_BLOCK], indentation[NT_BLOCK]; /* units: [N], [m], [m] */
} nt_block_contacts;

/* nt_maugis_block of each, with the same bits. */
int nt_maugis_block_each(const nt_block_contacts *contacts, nt_branch branch, int load_alone, nt_law_block *block);

#endif
