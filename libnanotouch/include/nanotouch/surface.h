/* SPDX-License-Identifier: BSD-3-Clause
 * The surface that is touched: a height field made C2 by cubic B-splines, so that curvature and force are continuous;
 * contact is computed on the tip-dilated surface (apex positions of first touch), because a tip touches with its flank
 * where the surface is steep. Row 0 lies at y = 0 (the lower edge of the picture), pixel (j, i) at x = i dx, y = j dy.
 */
#ifndef NANOTOUCH_SURFACE_H
#define NANOTOUCH_SURFACE_H

#include <stdint.h>

#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A grid of heights; the memory is the caller's. */
typedef struct nt_height_map {
    const double *heights; /* [m], row-major, heights[j * nx + i] */
    long nx, ny;           /* pixels along x and y, 4 .. 32768 each */
    double dx, dy;         /* pixel size [m], 1e-12 .. 1e-3 */
} nt_height_map;

/* Without the curvatures, which a force does not need. */
typedef struct nt_height_value {
    double z;      /* height [m] */
    double zx, zy; /* slopes [-] */
} nt_height_value;

/* A touchable surface. Immutable after nt_surface_init; `coefficients` stays the caller's and must outlive it. */
typedef struct nt_surface {
    const double *coefficients; /* B-spline coefficients [m], nx * ny; NULL for a flat at z = 0 */
    long nx, ny;
    double dx, dy;                         /* [m] */
    double height_minimum, height_maximum; /* of the heights it was made from [m] */
} nt_surface;

/* NT_OK, or NT_E_ARGUMENT / NT_E_RANGE / NT_E_NOT_FINITE with the field in *problem (NULL allowed); heights: within
 * +-1 m. */
NT_API nt_status nt_height_map_check(const nt_height_map *map, nt_problem *problem);

/* Interpolating cubic B-spline with mirrored borders (Unser 1999): passes through every pixel, C2 everywhere inside.
 * coefficients: nx * ny doubles of the caller's, may be the same memory as map->heights. Not real-time (O(nx ny)). */
NT_API nt_status nt_surface_init(nt_surface *surface, const nt_height_map *map, double *coefficients);
/* A flat at z = 0 without limits. */
NT_API nt_surface nt_surface_flat(void);
/* Height and slopes alone, at half the cost. */
NT_API NT_REALTIME nt_height_value nt_surface_height(const nt_surface *surface, double x, double y);
/* 1 if (x, y) lies on the map (always for a flat). */
NT_API int nt_surface_contains(const nt_surface *surface, double x, double y);

/* The tip as a sphere of radius R that runs tangentially into a cone. */
typedef struct nt_tip_shape {
    double radius;     /* R [m], 1e-10 .. 1e-3 */
    double half_angle; /* psi of the cone [rad], 0 .. 1.5 */
} nt_tip_shape;
/* Grey-scale dilation: dilated[j, i] = max over pixels p of heights[p] - tip(|p - (j, i)|): where the apex is at first
 * touch; between the pixels by a parabola where the body is smooth. dilated: nx * ny doubles, not the memory of
 * map->heights. O(nx ny k^2), k = the reach of the tip within the height range of the map. */
NT_API nt_status nt_surface_dilate(const nt_height_map *map, const nt_tip_shape *tip, double *dilated);

/* --- The effective radius of the contact on a curved surface (docs/surface.md) ---
 * A sphere of radius R on a body whose tip-dilated surface has the principal curvatures k1, k2 (> 0 convex) touches it
 * as a flat touches a sphere of the radius R sqrt((1 - R k1)(1 - R k2)): smaller on a bump, larger in a hollow. */

/* Kept between these ratios of effective to tip radius: an edge that is sharper than a pixel has none, and a hollow as
 * narrow as the tip is no paraboloid. A ball rests on three flanks at most, none of which pulls more than a flat. */
typedef struct nt_radius_limits {
    double minimum; /* 1e-3 .. 1 [-] */
    double maximum; /* 1 .. 1e3 [-] */
} nt_radius_limits;

/* The effective radius over a map. Immutable after nt_radius_map_init; the coefficients stay the caller's. */
typedef struct nt_radius_map {
    nt_surface ratio;        /* R_eff/R; its coefficients are the ratios at the pixels. No coefficients: R everywhere */
    double tip_radius;       /* R [m] */
    double minimum, maximum; /* of the effective radius, anywhere: true bounds [m] */
    long limited;            /* pixels whose ratio was beyond the limits */
} nt_radius_map;

typedef struct nt_radius_value {
    double radius; /* [m] */
    double dx, dy; /* dR/dx, dR/dy [-] */
} nt_radius_value;

/* From the curvature of a dilated surface at its pixels. limits NULL: the defaults. coefficients: nx * ny doubles of
 * the caller's (none for a flat, which makes R everywhere). The pixels' ratios are the coefficients of a cubic
 * B-spline: C2, never outside their range, and free of the ringing of an interpolation; a pixel's own value is smoothed
 * with its neighbours' (1/36, 4/36 .. 16/36). Not real-time. */
NT_API nt_status nt_radius_map_init(nt_radius_map *map, const nt_surface *dilated, double tip_radius,
                                    const nt_radius_limits *limits, double *coefficients);

/* --- What the sample is made of at each place (docs/surface.md) --- */

/* Over the grid of a surface: cubic B-splines whose coefficients are the values at the pixels, as those of the radius
 * map: C2, never outside their range. Immutable after nt_properties_init; the values stay the caller's. */
typedef struct nt_properties {
    nt_surface youngs_modulus;   /* E_s [Pa]; no coefficients: that of the scene everywhere */
    nt_surface work_of_adhesion; /* w [J/m^2]; no coefficients: that of the scene everywhere */
} nt_properties;

/* A property at a point and its slope. */
typedef struct nt_property_value {
    double value;  /* 0: not given [SI] */
    double dx, dy; /* [SI/m] */
} nt_property_value;

/* From values at the pixels of `grid`, row-major as its heights; either may be NULL. youngs_modulus: 1e2 .. 1e13 Pa;
 * work_of_adhesion: up to 10 J/m^2, nowhere below a thousandth of its largest value. NT_E_NOT_FINITE, NT_E_RANGE with
 * "surface.youngs_modulus" or "surface.work_of_adhesion" in *problem (NULL allowed); NT_E_ARGUMENT for a flat, which
 * has no pixels. */
NT_API nt_status nt_properties_init(nt_properties *properties, const nt_surface *grid, const double *youngs_modulus,
                                    const double *work_of_adhesion, nt_problem *problem);

/* A place on the surface: all that does not depend on the gap there. */
typedef struct nt_place {
    nt_height_value surface;
    nt_radius_value radius;             /* effective radius of the contact there, and its slope */
    nt_property_value youngs_modulus;   /* E_s [Pa] */
    nt_property_value work_of_adhesion; /* w [J/m^2] */
} nt_place;
/* All at a point, at less than the cost of one after the other; `radii` (NULL: radius 0) and `properties` (NULL: none)
 * are of this surface. NaN in, NaN out. */
NT_API NT_REALTIME nt_place nt_surface_place(const nt_surface *surface, const nt_radius_map *radii,
                                             const nt_properties *properties, double x, double y);

/* Built-in samples. */

/* Square grating, lines along y, like TGZ-03: ridges of `height` on a floor at 0. */
typedef struct nt_grating {
    double period; /* [m] */
    double height; /* step [m] */
    double duty;   /* width of the ridge over the period, 0 .. 1 [-] */
    double offset; /* x of the first rising edge [m] */
} nt_grating;
/* 3 um period, 480 nm, 0.5, 0.75 um. */
NT_API nt_grating nt_grating_defaults(void);
/* Height at a place [m]: 0 or the grating's; NaN for NaN. */
NT_API double nt_grating_height(const nt_grating *grating, double x, double y);

/* Quantum dots: spherical caps on a flat (the paper's second sample: 10 .. 30 nm). */
enum { NT_DOTS_MAX = 64 };
typedef struct nt_dots {
    int count;
    struct {
        double x, y;     /* centre [m] */
        double diameter; /* of the base [m] */
        double height;   /* [m] */
    } dot[NT_DOTS_MAX];
} nt_dots;
/* `count` (1 .. NT_DOTS_MAX) dots of 10 .. 30 nm diameter, height a third of it, scattered without overlap over
 * width x width, the same for the same seed. NT_E_CAPACITY if they do not fit. */
NT_API nt_status nt_dots_scatter(nt_dots *dots, int count, double width, uint64_t seed);
/* Height of the dots at a place [m]; 0 beside them, NaN for NaN. */
NT_API double nt_dots_height(const nt_dots *dots, double x, double y);

#ifdef __cplusplus
}
#endif
#endif
