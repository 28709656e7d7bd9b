/* SPDX-License-Identifier: BSD-3-Clause
 * Where a retraction outside contact tears off; private to curves/. */
#ifndef NANOTOUCH_CURVES_RUPTURES_H
#define NANOTOUCH_CURVES_RUPTURES_H

#include "curves/pieces.h"

enum {
    NT_CURVE_LEAST_WIDTH = 3,
    NT_CURVE_MOST_WIDTH = 12 /* points of the means on both sides of a step */
};

/* The retraction over the approach's baseline, outside contact. */
typedef struct nt_curve_outside {
    const double *z;
    double *over; /* force above the approach's baseline [N] */
    long count;
    long free;                  /* index from which on the tip may be free */
    nt_curve_baseline straight; /* the approach's, when ruptures were looked for */
    double noise, deepest;      /* [N] */
    double decoy;               /* largest jump that can be no rupture [N] */
    nt_curve_piece piece[NT_PIECE_BLOCKS];
    int pieces;
    long after[NT_CURVE_RUPTURES];   /* first point after each rupture */
    double sigma[NT_CURVE_RUPTURES]; /* of its force [N] */
} nt_curve_outside;

/* From where the force is no longer above the baseline of the approach in *reading, into whose table the ruptures go.
 * Of the retraction there the noise is known. room: 6 doubles for each point. */
nt_curve_outside nt_curve_outside_contact(const nt_curve_segment *retract, double *room, nt_curve_reading *reading);
/* The same points once the retraction is read, over another baseline of the approach. */
void nt_curve_renew_outside(nt_curve_outside *out, const nt_curve_reading *reading);
/* A straight line through the points from .. end - 1, at z, and the standard deviation of that; NaN where they are not
 * straight. */
nt_curve_measured nt_curve_line_at(const nt_curve_outside *out, long from, long end, double at);
/* Points of the means on both sides of a step. */
long nt_curve_step_width(const nt_curve_outside *out);

#endif
