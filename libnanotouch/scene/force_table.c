/* SPDX-License-Identifier: BSD-3-Clause
 * The force of a plan from a table of cubics, in single precision. */
#include <math.h>

#include "nanotouch/advanced/force_table.h"

/* The last piece that begins at or below a gap; of what lies before all of them the first. */
static const nt_force_piece *piece_at(const nt_force_piece *pieces, int count, float gap)
{
    int low = 0, high = count;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (pieces[middle].gap <= gap)
            low = middle;
        else
            high = middle;
    }
    return &pieces[low];
}

static nt_force_here eval_piece(const nt_force_piece *piece, float gap)
{
    const float *c = piece->cubic, u = (gap - piece->gap) * piece->per_width;
    if (u < 0.0f) /* deeper than the table */
        return (nt_force_here){c[0] + u * c[1], -c[1] * piece->per_width};
    return (nt_force_here){c[0] + u * (c[1] + u * (c[2] + u * c[3])),
                           -(c[1] + u * (2.0f * c[2] + u * 3.0f * c[3])) * piece->per_width};
}

nt_force_here nt_force_table_eval(const nt_force_table *table, int *attached, float gap)
{
    if (isnan(gap))
        return (nt_force_here){gap, gap};
    *attached = gap <= table->capture_gap || (*attached && gap <= table->release_gap);
    if (*attached)
        return eval_piece(piece_at(table->pieces, table->contact, gap), gap);
    if (table->apart == 0 || gap > table->farthest)
        return (nt_force_here){0.0f, 0.0f};
    return eval_piece(piece_at(table->pieces + table->contact, table->apart, gap), gap);
}
