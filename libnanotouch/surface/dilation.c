/* SPDX-License-Identifier: BSD-3-Clause
 * Grey-scale dilation by the tip: the apex heights at which tip and surface touch first (Villarrubia, J. Res. NIST
 * 102, 425, 1997). Row by row and block by block; a row of the surface is compared with a block only as far as its
 * highest pixel can still lift the block's lowest, so that flat regions cost little.
 *
 * On the pixels alone the apex stands too low by up to h^2/8 (1/R + kappa), h the pixel, in a pattern of the period of
 * a few pixels, which curvature would show as a noise of +-50 %. So where the body is smooth beneath the touching pixel
 * the peak of the parabola through it and its neighbours is taken. Smooth: the second difference of body less tip does
 * not fall below a half of its value there over the neighbours; at an edge (below a quarter) it is the pixel's own
 * height, in between a part of the difference. */
#include "core/same_bits.h"
#include "internal/field.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/surface.h"
#include "surface/surface.h"

#include <math.h>
#include <stddef.h>

enum { BLOCK = 64 };

/* Where the tip is `height` above its apex: the inverse of nt_tip_shape_height. */
static double tip_reach(const nt_tip_shape *tip, double height)
{
    const double radius = tip->radius, tangent = radius * (1.0 - sin(tip->half_angle));
    if (height <= 0.0)
        return 0.0;
    if (height <= tangent)
        return sqrt(height * (2.0 * radius - height));
    return radius * cos(tip->half_angle) + (height - tangent) * tan(tip->half_angle);
}

/* Pixels along one axis within a distance, one to spare against rounding, and not beyond the map. */
static long pixels_within(double distance, double pixel, long n)
{
    const double pixels = distance / pixel + 1.0;
    return pixels < (double)n ? (long)pixels : n;
}

static double highest(const double *heights, long n)
{
    double height = heights[0];
    for (long i = 1; i < n; i++)
        height = heights[i] > height ? heights[i] : height;
    return height;
}

static double lowest(const double *heights, long n)
{
    double height = heights[0];
    for (long i = 1; i < n; i++)
        height = heights[i] < height ? heights[i] : height;
    return height;
}

/* One job: the pixels first .. last of one row of the map. */
typedef struct block {
    const nt_height_map *map;
    const nt_tip_shape *tip;
    long row, first, last;
    double top;           /* highest pixel of the map [m] */
    double *dilated;      /* the whole row */
    long touching[BLOCK]; /* from a pixel of the block to the pixel that touches */
} block;

/* Lifts the block by the heights of the row of the map that lies dj rows away. */
static void lift_by_row(block *b, long dj)
{
    const nt_height_map *map = b->map;
    const double *heights = map->heights + (b->row + dj) * map->nx;
    const double away = fabs((double)dj * map->dy);
    const double bottom = lowest(b->dilated + b->first, b->last - b->first + 1);
    const long far = pixels_within(tip_reach(b->tip, b->top - bottom), map->dx, map->nx);
    const long from = b->first > far ? b->first - far : 0;
    const long to = b->last < map->nx - far ? b->last + far : map->nx - 1;
    const double distance = tip_reach(b->tip, highest(heights + from, to - from + 1) - bottom);
    if (distance + map->dy < away)
        return;
    const long near = pixels_within(sqrt(fmax(distance * distance - away * away, 0.0)), map->dx, map->nx);
    for (long di = -near; di <= near; di++) {
        const double tip = nt_tip_shape_height(b->tip, hypotenuse((double)di * map->dx, away));
        const long start = b->first + di < 0 ? -di : b->first;
        const long end = b->last + di < map->nx ? b->last : map->nx - 1 - di;
        const long offset = dj * map->nx + di;
        for (long i = start; i <= end; i++) {
            const double apex = heights[i + di] - tip;
            const int higher = apex > b->dilated[i];
            long *touching = &b->touching[i - b->first];
            b->dilated[i] = higher ? apex : b->dilated[i];
            *touching = higher ? offset : *touching;
        }
    }
}

/* Nearest rows first: they lift the block's bottom, which shortens the reach for the rest. */
static void dilate_block(block *b)
{
    const nt_height_map *map = b->map;
    for (long i = b->first; i <= b->last; i++) {
        b->dilated[i] = map->heights[b->row * map->nx + i];
        b->touching[i - b->first] = 0;
    }
    lift_by_row(b, 0);
    const double bottom = lowest(b->dilated + b->first, b->last - b->first + 1);
    const long far = pixels_within(tip_reach(b->tip, b->top - bottom), map->dy, map->ny);
    for (long dj = 1; dj <= far; dj++) {
        if (b->row + dj < map->ny)
            lift_by_row(b, dj);
        if (b->row - dj >= 0)
            lift_by_row(b, -dj);
    }
}

/* Body less tip around the pixel that touches. */
typedef struct patch {
    const block *b;
    long i, j;   /* the touching pixel */
    long di, dj; /* from the apex to it */
} patch;

/* At a neighbour; -inf outside the map. */
static double apex_at(const patch *p, long ei, long ej)
{
    const nt_height_map *map = p->b->map;
    const long i = p->i + ei, j = p->j + ej;
    if (i < 0 || i >= map->nx || j < 0 || j >= map->ny)
        return -HUGE_VAL;
    const double x = (double)(p->di + ei) * map->dx, y = (double)(p->dj + ej) * map->dy;
    return map->heights[j * map->nx + i] - nt_tip_shape_height(p->b->tip, hypotenuse(x, y));
}

/* Slope and curvature (> 0) of body less tip along an axis, per pixel; 0 slope where it is not smooth. */
typedef struct parabola {
    double slope, curvature;
    double smooth; /* 1 smooth, 0 not */
} parabola;

static parabola parabola_along(const patch *p, long ei, long ej)
{
    double g[5];
    for (long k = -2; k <= 2; k++)
        g[k + 2] = apex_at(p, k * ei, k * ej);
    const double bend = 2.0 * g[2] - g[1] - g[3];
    const double least = fmin(2.0 * g[1] - g[0] - g[2], 2.0 * g[3] - g[2] - g[4]);
    if (!(bend > 0.0) || !(4.0 * least > bend))
        return (parabola){.curvature = 1.0};
    const double smooth = fmin(4.0 * least / bend - 1.0, 1.0);
    return (parabola){.slope = 0.5 * (g[3] - g[1]) * smooth, .curvature = bend, .smooth = smooth};
}

/* How far the peak of the parabola lies above its pixel [m]. */
static double peak_above(const patch *p)
{
    const parabola x = parabola_along(p, 1, 0), y = parabola_along(p, 0, 1);
    double twist = 0.0;
    if (x.smooth * y.smooth > 0.0)
        twist = x.smooth * y.smooth * 0.25 *
                (apex_at(p, 1, -1) + apex_at(p, -1, 1) - apex_at(p, 1, 1) - apex_at(p, -1, -1));
    if (!(fabs(twist) < 0.9 * sqrt(x.curvature * y.curvature))) /* a diagonal ridge */
        twist = 0.0;
    const double sum =
        x.slope * x.slope * y.curvature - 2.0 * x.slope * y.slope * twist + y.slope * y.slope * x.curvature;
    return 0.5 * sum / (x.curvature * y.curvature - twist * twist);
}

static void refine_block(const block *b)
{
    const long nx = b->map->nx;
    for (long i = b->first; i <= b->last; i++) {
        const long pixel = b->row * nx + i + b->touching[i - b->first];
        const patch p = {b, pixel % nx, pixel / nx, pixel % nx - i, pixel / nx - b->row};
        b->dilated[i] += peak_above(&p);
    }
}

double nt_tip_shape_height(const nt_tip_shape *tip, double r)
{
    const double radius = tip->radius, tangent = radius * cos(tip->half_angle);
    if (r > tangent)
        return radius * (1.0 - sin(tip->half_angle)) + (r - tangent) / tan(tip->half_angle);
    return r * r / (radius + sqrt(radius * radius - r * r)); /* R - sqrt(R^2 - r^2) without its cancellation */
}

nt_status nt_surface_dilate(const nt_height_map *map, const nt_tip_shape *tip, double *dilated)
{
    static const nt_field fields[] = {
        NT_FIELD_NAMED("tip.radius", nt_tip_shape, radius, "m", 1e-10, 1e-3, "radius R of the apex"),
        NT_FIELD_NAMED("tip.half_angle", nt_tip_shape, half_angle, "rad", 0.0, 1.5, "half angle psi of the cone"),
    };
    nt_status status = nt_height_map_check(map, NULL);
    if (status == NT_OK)
        status = nt_field_check(fields, 2, tip, NULL);
    if (status != NT_OK)
        return status;
    if (dilated == NULL)
        return NT_E_ARGUMENT;
    block b = {.map = map, .tip = tip, .top = highest(map->heights, map->nx * map->ny)};
    for (b.row = 0; b.row < map->ny; b.row++) {
        b.dilated = dilated + b.row * map->nx;
        for (b.first = 0; b.first < map->nx; b.first += BLOCK) {
            b.last = b.first + BLOCK <= map->nx ? b.first + BLOCK - 1 : map->nx - 1;
            dilate_block(&b);
            refine_block(&b);
        }
    }
    return NT_OK;
}
