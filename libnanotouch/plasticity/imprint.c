/* SPDX-License-Identifier: BSD-3-Clause
 * A dent or a groove in a height field, and the ridge around it: see plasticity.h. The ridge follows u (1 - u)^2 from
 * the rim of the dent outwards; its height is what the sums over the pixels demand. */
#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "core/same_bits.h"
#include "internal/field.h"
#include "internal/plasticity.h"
#include "nanotouch/advanced/plasticity.h"
#include "nanotouch/material.h"

#define FIELD(path, ...) NT_FIELD(nt_displacement, path, __VA_ARGS__)

static const nt_field displacement_fields[] = {
    FIELD(piled_up, "", 0.0, 1.0, "share of the displaced volume in the ridge"),
    FIELD(debris, "", 0.0, 1.0, "share of the displaced volume that leaves"),
    FIELD(ridge_width, "", 0.1, 10.0, "of the ridge, over the radius of the dent"),
};

enum { DISPLACEMENT_FIELDS = (int)(sizeof displacement_fields / sizeof displacement_fields[0]) };

nt_displacement nt_displacement_defaults(void)
{
    return (nt_displacement){.piled_up = 0.8, .ridge_width = 1.0};
}

const nt_field *nt_displacement_fields(int *count)
{
    if (count != NULL)
        *count = DISPLACEMENT_FIELDS;
    return displacement_fields;
}

static nt_status refuse(nt_problem *problem, nt_problem what)
{
    if (problem != NULL)
        *problem = what;
    return NT_E_RANGE;
}

nt_status nt_displacement_check(const nt_displacement *displacement, nt_problem *problem)
{
    const nt_status status = nt_field_check(displacement_fields, DISPLACEMENT_FIELDS, displacement, problem);
    if (status == NT_OK && displacement->piled_up + displacement->debris > 1.0)
        return refuse(problem, nt_problem_of("debris (with piled_up above 1)", "", displacement->debris, 0.0,
                                             1.0 - displacement->piled_up));
    return status;
}

double nt_imprint_volume(const nt_imprint *imprint)
{
    const double length = hypotenuse(imprint->end[0] - imprint->start[0], imprint->end[1] - imprint->start[1]);
    return imprint->depth * imprint->radius * (NT_PI * imprint->radius / 2.0 + 4.0 / 3.0 * length);
}

/* Distance of a point from the line [m]. */
static double away(const nt_imprint *imprint, double x, double y)
{
    const double wx = imprint->end[0] - imprint->start[0], wy = imprint->end[1] - imprint->start[1];
    const double px = x - imprint->start[0], py = y - imprint->start[1], length2 = wx * wx + wy * wy;
    const double t = length2 > 0.0 ? fmin(fmax((px * wx + py * wy) / length2, 0.0), 1.0) : 0.0;
    return hypotenuse(px - t * wx, py - t * wy);
}

/* At a distance from the line, in shares of the radius: depth of the dent over its largest, and the ridge unscaled. */
static double dent_share(double s)
{
    return s < 1.0 ? (1.0 - s) * (1.0 + s) : 0.0;
}

static double ridge_share(double s, double width)
{
    const double u = (s - 1.0) / width;
    return u > 0.0 && u < 1.0 ? u * (1.0 - u) * (1.0 - u) : 0.0;
}

static nt_status check(const nt_imprint *imprint, const nt_displacement *displacement, const nt_height_map *map,
                       nt_problem *problem)
{
    const double pitch = fmax(map->dx, map->dy), limits = 1e-3;
    const double numbers[] = {imprint->start[0], imprint->start[1], imprint->end[0],
                              imprint->end[1],   imprint->radius,   imprint->depth};
    for (int i = 0; i < (int)(sizeof numbers / sizeof numbers[0]); ++i)
        if (!isfinite(numbers[i]))
            return NT_E_NOT_FINITE;
    if (!(imprint->depth >= 0.0 && imprint->depth <= limits))
        return refuse(problem, nt_problem_of("imprint.depth", "m", imprint->depth, 0.0, limits));
    if (!(imprint->radius >= NT_IMPRINT_PIXELS * pitch && imprint->radius <= limits))
        return refuse(problem, nt_problem_of("imprint.radius (6 pixels at least)", "m", imprint->radius,
                                             NT_IMPRINT_PIXELS * pitch, limits));
    if (displacement->piled_up > 0.0 && displacement->ridge_width * imprint->radius < 2.0 * pitch)
        return refuse(problem, nt_problem_of("ridge_width (2 pixels at least)", "", displacement->ridge_width,
                                             2.0 * pitch / imprint->radius, 10.0));
    return NT_OK;
}

/* First pixel and number of pixels of one axis; 0 if it does not fit. */
static int span(double low, double high, double pitch, long pixels, long *first, long *count)
{
    const double begin = ceil(low / pitch), end = floor(high / pitch);
    if (!(begin >= 0.0 && end <= (double)(pixels - 1)))
        return 0;
    *first = (long)begin;
    *count = (long)end - *first + 1;
    return 1;
}

nt_status nt_imprint_extent(const nt_imprint *imprint, const nt_displacement *displacement, const nt_height_map *map,
                            nt_edit *edit, nt_problem *problem)
{
    if (imprint == NULL || displacement == NULL || map == NULL || edit == NULL)
        return NT_E_ARGUMENT;
    nt_status status = nt_displacement_check(displacement, problem);
    if (status == NT_OK)
        status = check(imprint, displacement, map, problem);
    if (status != NT_OK)
        return status;
    const double reach = imprint->radius * (1.0 + (displacement->piled_up > 0.0 ? displacement->ridge_width : 0.0));
    const double pitch[2] = {map->dx, map->dy};
    const long pixels[2] = {map->nx, map->ny};
    static const char *const names[2] = {"imprint (with its ridge) x", "imprint (with its ridge) y"};
    long first[2], count[2];
    for (int i = 0; i < 2; ++i) {
        const double low = fmin(imprint->start[i], imprint->end[i]) - reach;
        const double high = fmax(imprint->start[i], imprint->end[i]) + reach;
        const double far = (double)(pixels[i] - 1) * pitch[i];
        if (!span(low, high, pitch[i], pixels[i], &first[i], &count[i]))
            return refuse(problem, nt_problem_of(names[i], "m", low < 0.0 ? low : high, 0.0, far));
    }
    *edit = (nt_edit){.first_x = first[0], .first_y = first[1], .count_x = count[0], .count_y = count[1]};
    return NT_OK;
}

/* An imprint on its grid: how deep, and how high its ridge is [m]. */
typedef struct stamp {
    nt_imprint imprint;
    double width;   /* of the ridge, over the radius */
    double ridge;   /* height per ridge_share [m] */
    double removed; /* [m^3] */
} stamp;

static double height_of(const stamp *made, double x, double y)
{
    const double s = away(&made->imprint, x, y) / made->imprint.radius;
    return made->ridge * ridge_share(s, made->width) - made->imprint.depth * dent_share(s);
}

/* Sums over its pixels: what is removed, and how high the ridge must be. */
static stamp stamped(const nt_imprint *imprint, const nt_displacement *displacement, const nt_height_map *map,
                     const nt_edit *area)
{
    stamp made = {*imprint, displacement->ridge_width, 0.0, 0.0};
    double dent = 0.0, ridge = 0.0;
    for (long j = area->first_y; j < area->first_y + area->count_y; ++j)
        for (long i = area->first_x; i < area->first_x + area->count_x; ++i) {
            const double s = away(imprint, (double)i * map->dx, (double)j * map->dy) / imprint->radius;
            dent += dent_share(s);
            ridge += ridge_share(s, made.width);
        }
    made.removed = imprint->depth * dent * map->dx * map->dy;
    made.ridge = ridge > 0.0 ? displacement->piled_up * imprint->depth * dent / ridge : 0.0;
    return made;
}

static nt_edit both(const nt_edit *a, const nt_edit *b)
{
    const long x = a->first_x < b->first_x ? a->first_x : b->first_x;
    const long y = a->first_y < b->first_y ? a->first_y : b->first_y;
    const long ax = a->first_x + a->count_x, bx = b->first_x + b->count_x;
    const long ay = a->first_y + a->count_y, by = b->first_y + b->count_y;
    return (nt_edit){
        .first_x = x, .first_y = y, .count_x = (ax > bx ? ax : bx) - x, .count_y = (ay > by ? ay : by) - y};
}

nt_status nt_imprint_edit(double *heights, const nt_height_map *map, const nt_imprint_change *change, nt_edit *edit,
                          nt_problem *problem)
{
    nt_edit area, old;
    if (heights == NULL || change == NULL || edit == NULL)
        return NT_E_ARGUMENT;
    const nt_imprint *before = change->before, *after = change->after;
    const nt_displacement *displacement = change->displacement;
    nt_status status = nt_imprint_extent(after, displacement, map, &area, problem);
    if (status == NT_OK && before != NULL)
        status = nt_imprint_extent(before, displacement, map, &old, problem);
    if (status != NT_OK)
        return status;
    stamp made = stamped(after, displacement, map, &area), gone = {.imprint = *after, .width = made.width};
    gone.imprint.depth = 0.0;
    if (before != NULL) {
        gone = stamped(before, displacement, map, &old);
        area = both(&area, &old);
    }
    for (long j = area.first_y; j < area.first_y + area.count_y; ++j)
        for (long i = area.first_x; i < area.first_x + area.count_x; ++i) {
            const double x = (double)i * map->dx, y = (double)j * map->dy;
            heights[j * map->nx + i] += height_of(&made, x, y) - height_of(&gone, x, y);
        }
    *edit = area;
    edit->removed = made.removed - gone.removed;
    edit->piled_up = displacement->piled_up * edit->removed;
    edit->debris = displacement->debris * edit->removed;
    edit->densified = edit->removed - edit->piled_up - edit->debris;
    return NT_OK;
}
