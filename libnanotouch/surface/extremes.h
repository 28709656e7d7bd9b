/* SPDX-License-Identifier: BSD-3-Clause
 * Private: bounds of a surface along a path or in an area, between the pixels, too. Never below the truth (to the
 * rounding of doubles); heights at most 1e-6 of the map's height range above it, slopes 0.1 % (or 1e-9). */
#ifndef NANOTOUCH_SURFACE_EXTREMES_H
#define NANOTOUCH_SURFACE_EXTREMES_H

#include "nanotouch/surface.h"

/* What else there is at each place of a surface, on its grid: ratio of effective to tip radius [-], E of the sample
 * [Pa], w [J/m^2]. NULL: not given. */
enum { NT_FIELD_RATIO, NT_FIELD_MODULUS, NT_FIELD_WORK, NT_FIELDS };
typedef struct nt_fields {
    const nt_surface *of[NT_FIELDS];
} nt_fields;

typedef struct nt_extremes {
    double highest, lowest;                   /* [m] */
    double steepest;                          /* along a path in its direction, in an area in any direction [-] */
    double least[NT_FIELDS], most[NT_FIELDS]; /* of the fields; 0 where there is none */
} nt_extremes;

/* Straight from point to point; xy: count >= 1 points on the surface [m]. None of the surfaces is a flat (without
 * coefficients). */
nt_extremes nt_extremes_on_path(const nt_surface *surface, const nt_fields *fields, const double *xy, long count);
/* Over the rectangle x[0] .. x[1], y[0] .. y[1] on the surface [m]. */
nt_extremes nt_extremes_in_area(const nt_surface *surface, const nt_fields *fields, const double x[2],
                                const double y[2]);
/* The steepest slope in the cell right of and above the pixel i, j, at most; no closer than is needed to know that it
 * is at most `enough` [-]. */
double nt_extremes_in_cell(const nt_surface *surface, long i, long j, double enough);
/* The lowest place there, at least; at most so far below it [m]. */
double nt_extremes_lowest_in_cell(const nt_surface *surface, long i, long j, double close);

#endif
