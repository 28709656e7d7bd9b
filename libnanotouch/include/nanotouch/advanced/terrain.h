/* SPDX-License-Identifier: BSD-3-Clause
 * A scene's surface with all that its curvature needs, and the plan over it: heights dilated by the scene's tip, the
 * effective radius of each place, the bank of tables that reaches as far as the contact goes there, made once. And what
 * of it can be reached: how far the surface rises, how steep it is, how blunt and how sharp. */
#ifndef NANOTOUCH_TERRAIN_H
#define NANOTOUCH_TERRAIN_H

#include "nanotouch/plan.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nt_terrain nt_terrain;

/* What a terrain is made of: heights, or a surface that is there already, or neither for a flat at z = 0. */
typedef struct nt_terrain_setup {
    nt_scene scene;                  /* its tip (tip.radius, tip.half_angle) is the one that touches */
    nt_demand demand;                /* of the plan; the bank is as fine as it asks */
    const nt_probe *probe;           /* only adds probe_noise, which the plan tells; NULL: none */
    nt_height_map map;               /* heights, read by nt_terrain_make only; map.heights NULL: none */
    int dilated;                     /* of the map; 0: heights of the body, 1: of the apex of this tip at first touch */
    const nt_surface *surface;       /* dilated by this tip, borrowed until nt_terrain_close; NULL: none */
    const nt_radius_map *radii;      /* of `surface`, borrowed; NULL: its curvature is not felt */
    double period;                   /* of the loop that runs it, for a sample that relaxes; 0: 0.1 ms [s] */
    const nt_properties *properties; /* on the grid of `surface` or `map`, borrowed; NULL: the scene's everywhere */
} nt_terrain_setup;
/* The paper's scene, 1 % of the force, no probe, a flat at z = 0. */
NT_API nt_terrain_setup nt_terrain_defaults(void);

/* Makes surface, radii (nt_radius_limits_defaults), bank and plan, in this order, each once: 0.5 to 1 s at 1024 x 1024
 * pixels, most of it dilation. On failure *problem (NULL allowed) names the field of scene, demand, probe, map,
 * surface, radii or properties with its valid range; NT_E_ARGUMENT for a map beside a surface, or radii without one; as
 * nt_plan_make for a demand that cannot be kept; NT_E_NO_MEMORY. The terrain belongs to the caller: nt_terrain_close.
 * Uses the heap; not real-time. Immutable afterwards, may be shared by threads. */
NT_API nt_status nt_terrain_make(nt_terrain **terrain, const nt_terrain_setup *setup, nt_problem *problem);
/* Accepts NULL. */
NT_API void nt_terrain_close(nt_terrain *terrain);

/* The plan of scene, demand and probe; never NULL. */
NT_API const nt_plan *nt_terrain_plan(const nt_terrain *terrain);

/* What of a surface can be reached. Each number is a bound between the pixels, too: never below the truth (to the
 * rounding of doubles), rise and relief at most 2e-6 of the map's height range above it, slope at most 0.1 %. */
typedef struct nt_reach {
    double rise;   /* highest place above the start, >= 0 [m] */
    double relief; /* highest less lowest place [m] */
    double slope;  /* steepest: along a path in its direction, in an area in any direction [-] */
    double least_radius,
        largest_radius; /* bounds of the effective radius of the contact; the tip's without radii [m] */
    /* bounds of what the sample is made of; 0: the scene's everywhere */
    double least_modulus, largest_modulus; /* E [Pa] */
    double least_work, largest_work;       /* w [J/m^2] */
} nt_reach;

/* A rectangle over which the tip moves freely in x and y, and where it starts. */
typedef struct nt_area {
    double x, y;         /* start, in the rectangle [m] */
    double x_min, x_max; /* [m] */
    double y_min, y_max; /* [m] */
} nt_area;

/* Along the straight lines from point to point, the start first; xy: count points (x, y) [m], count >= 1.
 *
 * Taylor's series about the middle of pieces of a pixel, which are halved until the bound is close; its remainder from
 * the differences of the B-spline's coefficients, which no derivative of the spline exceeds. NT_E_NOT_FINITE or
 * NT_E_RANGE with "path.x" or "path.y" in *problem (NULL allowed) for a point that is not on the surface; NT_E_RANGE
 * with "path.count". Not real-time. */
NT_API nt_status nt_terrain_reach_path(const nt_terrain *terrain, const double *xy, long count, nt_reach *reach,
                                       nt_problem *problem);
/* Over an area, by the same bounds in two dimensions. NT_E_NOT_FINITE or NT_E_RANGE with "area.x", .. for a rectangle
 * that is not on the surface or a start outside it. Some 0.2 s at 1024 x 1024 pixels. Not real-time. */
NT_API nt_status nt_terrain_reach_area(const nt_terrain *terrain, const nt_area *area, nt_reach *reach,
                                       nt_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
