/* SPDX-License-Identifier: BSD-3-Clause
 * Grey-scale dilation by the tip: the apex heights at which tip and surface touch first (Villarrubia, J. Res. NIST
 * 102, 425, 1997), exact on the grid. Row by row and block by block; a row of the surface is compared with a block
 * only as far as its highest pixel can still lift the block's lowest, so that flat regions cost little. */
#include "nanotouch/field.h"
#include "nanotouch/surface.h"

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
    double top;      /* highest pixel of the map [m] */
    double *dilated; /* the whole row */
} block;

/* Lifts the block by the heights of the row of the map that lies dj rows away. */
static void lift_by_row(const block *b, long dj)
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
        const double tip = nt_tip_shape_height(b->tip, hypot((double)di * map->dx, away));
        const long start = b->first + di < 0 ? -di : b->first;
        const long end = b->last + di < map->nx ? b->last : map->nx - 1 - di;
        for (long i = start; i <= end; i++) {
            const double apex = heights[i + di] - tip;
            b->dilated[i] = apex > b->dilated[i] ? apex : b->dilated[i];
        }
    }
}

/* Nearest rows first: they lift the block's bottom, which shortens the reach for the rest. */
static void dilate_block(const block *b)
{
    const nt_height_map *map = b->map;
    for (long i = b->first; i <= b->last; i++)
        b->dilated[i] = map->heights[b->row * map->nx + i];
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
        {"tip.radius", "m", 1e-10, 1e-3, offsetof(nt_tip_shape, radius), "radius R of the apex"},
        {"tip.half_angle", "rad", 0.0, 1.5, offsetof(nt_tip_shape, half_angle), "half angle psi of the cone"},
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
        }
    }
    return NT_OK;
}
