/* SPDX-License-Identifier: BSD-3-Clause
 * Makes the cells of tables of Maugis-Dugdale, one after the other; private to contact/. */
#ifndef NANOTOUCH_CONTACT_MAUGIS_CELLS_H
#define NANOTOUCH_CONTACT_MAUGIS_CELLS_H

#include "contact/maugis/place.h"
#include "contact/maugis/solve.h"

/* A border of cells; reduced. */
typedef struct nt_maugis_border {
    double Z;
    double P, a, y;       /* y above that at the start */
    double P_Z, a_Z, y_Z; /* their slopes */
} nt_maugis_border;

typedef struct nt_maugis_builder {
    const nt_maugis_table *table; /* .maugis, .rate, .shift are read */
    nt_maugis_equilibrium start;
    nt_maugis_border at;
    double U;      /* there [J] */
    uint64_t name; /* of the next cell */
    nt_maugis_cell last;
} nt_maugis_builder;

/* The reduced scale Zs for a table of so many cells per octave. */
double nt_maugis_cell_scale(const nt_maugis *maugis, int cells_per_octave);

/* From the start of the contact branch, cell by cell. */
void nt_maugis_builder_start(nt_maugis_builder *builder, const nt_maugis_table *table);
nt_status nt_maugis_builder_next(nt_maugis_builder *builder, nt_maugis_cell *cell);

#endif
