/* SPDX-License-Identifier: BSD-3-Clause
 * Is a contact inside the range of its law? The laws return a number everywhere; this says when not to believe it.
 * Where each range comes from is in docs/geometry.md; erratum E13 is a case that it finds. */
#include <math.h>

#include "nanotouch/advanced/geometry.h"

#define TABOR 0.2 /* representative strain over slope of the surface at the edge (Tabor 1951; Johnson 1985, Ch. 6) */
/* The same strain for the same mean pressure under a punch: sphere p/E* = 4 a/(3 pi R), punch p/E* = 2 delta/(pi a). */
#define TABOR_PUNCH 0.3

/* Radius ratio and slope of the tip's surface at radius a. */
static void measure(const nt_shape *shape, double a, nt_contact_validity *validity)
{
    const double x = a / shape->radius;
    switch (shape->kind) {
    case NT_SHAPE_PARABOLOID:
        validity->radius_ratio = validity->slope = x;
        break;
    case NT_SHAPE_SPHERE:
        validity->radius_ratio = x;
        validity->slope = x < 1.0 ? x / sqrt((1.0 - x) * (1.0 + x)) : (double)INFINITY;
        break;
    case NT_SHAPE_BLUNTED: {
        const double flank = 1.0 / tan(shape->half_angle);
        const double rim = shape->transition > 0.0 ? shape->transition / shape->radius : flank;
        validity->radius_ratio = fmin(x, rim);
        validity->slope = x < rim ? x : flank;
        break;
    }
    case NT_SHAPE_CONE:
    case NT_SHAPE_TRUNCATED:
        validity->slope = 1.0 / tan(shape->half_angle);
        break;
    case NT_SHAPE_PUNCH:
        break;
    }
}

nt_status nt_contact_validity_of(const nt_shape *shape, double contact_radius, double indentation, double thickness,
                                 nt_contact_validity *validity)
{
    if (!isfinite(contact_radius) || !isfinite(indentation) || isnan(thickness))
        return NT_E_NOT_FINITE;
    if (contact_radius < 0.0 || thickness <= 0.0)
        return NT_E_RANGE;
    nt_contact_validity found = {.thickness_ratio = contact_radius / thickness};
    if (contact_radius > 0.0) {
        measure(shape, contact_radius, &found);
        found.strain = shape->kind == NT_SHAPE_PUNCH    ? TABOR_PUNCH * fabs(indentation) / contact_radius
                       : shape->kind == NT_SHAPE_SPHERE ? TABOR * found.radius_ratio
                                                        : TABOR * found.slope;
    }
    if (shape->kind != NT_SHAPE_SPHERE && found.radius_ratio > NT_VALID_RADIUS_RATIO)
        found.outside |= NT_OUTSIDE_RADIUS_RATIO;
    if (found.slope > NT_VALID_SLOPE)
        found.outside |= NT_OUTSIDE_SLOPE;
    if (found.strain > NT_VALID_STRAIN)
        found.outside |= NT_OUTSIDE_STRAIN;
    if (found.thickness_ratio > NT_VALID_THICKNESS_RATIO)
        found.outside |= NT_OUTSIDE_THICKNESS;
    *validity = found;
    return NT_OK;
}
