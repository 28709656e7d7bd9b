/* SPDX-License-Identifier: BSD-3-Clause
 * Private: bounds of a surface along a path or in an area, between the pixels, too. Never below the truth (to the
 * rounding of doubles); heights at most 1e-6 of the map's height range above it, slopes 0.1 % (or 1e-9). */
#ifndef NANOTOUCH_SURFACE_EXTREMES_H
#define NANOTOUCH_SURFACE_EXTREMES_H

#include "nanotouch/surface.h"

typedef struct nt_extremes {
    double highest, lowest;         /* [m] */
    double steepest;                /* along a path in its direction, in an area in any direction [-] */
    double least_ratio, most_ratio; /* of effective to tip radius; 1 without `ratio` [-] */
} nt_extremes;

/* Straight from point to point; xy: count >= 1 points on the surface [m]. `ratio`: of a radius map of that surface, or
 * NULL. Neither is a flat (without coefficients). */
nt_extremes nt_extremes_on_path(const nt_surface *surface, const nt_surface *ratio, const double *xy, long count);
/* Over the rectangle x[0] .. x[1], y[0] .. y[1] on the surface [m]. */
nt_extremes nt_extremes_in_area(const nt_surface *surface, const nt_surface *ratio, const double x[2],
                                const double y[2]);

#endif
