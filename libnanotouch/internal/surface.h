/* SPDX-License-Identifier: BSD-3-Clause
 * Parts of surfaces and maps of radii. */
#ifndef NANOTOUCH_INTERNAL_SURFACE_H
#define NANOTOUCH_INTERNAL_SURFACE_H

#include "nanotouch/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Height and its derivatives at a point. */
typedef struct nt_surface_value {
    double z;             /* height [m] */
    double zx, zy;        /* slopes [-] */
    double zxx, zxy, zyy; /* curvatures [1/m] */
} nt_surface_value;

/* Value at a point. Outside the map the border continues level (slopes across it 0): nt_surface_contains() tells.
 * NaN in, NaN out. Real-time safe. */
NT_API NT_REALTIME nt_surface_value nt_surface_eval(const nt_surface *surface, double x, double y);
/* 0.1 and 3. */
NT_API nt_radius_limits nt_radius_limits_defaults(void);
/* Effective radius and its slope at a point; beyond the map as nt_surface_eval. NaN in, NaN out. Real-time safe. */
NT_API NT_REALTIME nt_radius_value nt_radius_map_eval(const nt_radius_map *map, double x, double y);

#ifdef __cplusplus
}
#endif
#endif
