/* SPDX-License-Identifier: BSD-3-Clause
 * A record cut into straight pieces, and the jumps between them; private to curves/. */
#ifndef NANOTOUCH_CURVES_PIECES_H
#define NANOTOUCH_CURVES_PIECES_H

#include "nanotouch/curves.h"

enum { NT_PIECE_BLOCKS = 160 }; /* means that a record is reduced to before it is cut */

/* Points first .. end - 1 of the record, straight within the noise. */
typedef struct nt_curve_piece {
    long first, end;
    double slope, level; /* of force over z - z[first] [N/m], [N] */
} nt_curve_piece;

/* Cuts force(z) into the straight pieces with the least sum of squares/s^2 + 30 a piece, s from second differences of
 * neighbouring means (Jackson et al. 2005). Returns how many, at most NT_PIECE_BLOCKS; 0 for too few points. */
int nt_curve_cut(const double z[], const double force[], long count, nt_curve_piece pieces[NT_PIECE_BLOCKS]);

/* Change of the mean of so many points at index i, [N]. */
double nt_curve_step_at(const double force[], long i, long width);

#endif
