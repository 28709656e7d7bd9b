/* SPDX-License-Identifier: BSD-3-Clause
 * What of a terrain can be reached: checks where, and puts the bounds of the surface there together. */
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "internal/terrain.h"
#include "nanotouch/advanced/terrain.h"
#include "session/state.h"
#include "session/terrain.h"
#include "surface/extremes.h"

static nt_status check_within(double value, const nt_problem *valid, nt_problem *problem)
{
    if (value >= valid->minimum && value <= valid->maximum)
        return NT_OK;
    if (problem) {
        *problem = *valid;
        problem->value = value;
    }
    return isfinite(value) ? NT_E_RANGE : NT_E_NOT_FINITE;
}

static int has_borders(const nt_terrain *terrain)
{
    const nt_surface *surface = nt_terrain_surface(terrain);
    return surface && surface->coefficients;
}

/* Where points may lie: on the surface, or anywhere on a flat [m]. */
typedef struct borders {
    double first, last[2]; /* along x and y */
} borders;

static borders borders_of(const nt_terrain *terrain)
{
    const nt_surface *surface = nt_terrain_surface(terrain);
    if (!has_borders(terrain))
        return (borders){-DBL_MAX, {DBL_MAX, DBL_MAX}};
    return (borders){0.0, {(double)(surface->nx - 1) * surface->dx, (double)(surface->ny - 1) * surface->dy}};
}

nt_status nt_terrain_check_path(const nt_terrain *terrain, const double *xy, long count, nt_problem *problem)
{
    const borders on = borders_of(terrain);
    const nt_problem counts = nt_problem_of("path.count", "", 0.0, 1.0, (double)LONG_MAX);
    nt_status status = check_within((double)count, &counts, problem);
    for (long i = 0; i < 2 * count && status == NT_OK; i++) {
        const nt_problem valid = nt_problem_of(i % 2 ? "path.y" : "path.x", "m", 0.0, on.first, on.last[i % 2]);
        status = check_within(xy[i], &valid, problem);
    }
    return status;
}

static const nt_surface *if_given(const nt_surface *field)
{
    return field->coefficients ? field : NULL;
}

static nt_fields fields_of(const nt_terrain *terrain)
{
    const nt_radius_map *radii = nt_terrain_radii(terrain);
    const nt_properties *properties = nt_terrain_plan(terrain)->properties;
    nt_fields fields = {{NULL, NULL, NULL}};
    if (radii)
        fields.of[NT_FIELD_RATIO] = if_given(&radii->ratio);
    if (properties) {
        fields.of[NT_FIELD_MODULUS] = if_given(&properties->youngs_modulus);
        fields.of[NT_FIELD_WORK] = if_given(&properties->work_of_adhesion);
    }
    return fields;
}

/* Nothing rises on a flat. */
static nt_reach level(const nt_terrain *terrain)
{
    const double R = nt_terrain_plan(terrain)->contact.radius;
    return (nt_reach){.least_radius = R, .largest_radius = R};
}

static nt_reach reach_of(const nt_terrain *terrain, const nt_extremes *found, double x, double y)
{
    const double R = nt_terrain_plan(terrain)->contact.radius;
    const double start = nt_surface_height(nt_terrain_surface(terrain), x, y).z;
    const int curves = fields_of(terrain).of[NT_FIELD_RATIO] != NULL;
    return (nt_reach){.rise = fmax(found->highest - start, 0.0),
                      .relief = found->highest - found->lowest,
                      .slope = found->steepest,
                      .least_radius = curves ? R * found->least[NT_FIELD_RATIO] : R,
                      .largest_radius = curves ? R * found->most[NT_FIELD_RATIO] : R,
                      .least_modulus = found->least[NT_FIELD_MODULUS],
                      .largest_modulus = found->most[NT_FIELD_MODULUS],
                      .least_work = found->least[NT_FIELD_WORK],
                      .largest_work = found->most[NT_FIELD_WORK]};
}

nt_status nt_terrain_reach_path(const nt_terrain *terrain, const double *xy, long count, nt_reach *reach,
                                nt_problem *problem)
{
    if (!terrain || !xy || !reach)
        return NT_E_ARGUMENT;
    const nt_status status = nt_terrain_check_path(terrain, xy, count, problem);
    if (status != NT_OK)
        return status;
    *reach = level(terrain);
    if (has_borders(terrain)) {
        const nt_fields fields = fields_of(terrain);
        const nt_extremes found = nt_extremes_on_path(nt_terrain_surface(terrain), &fields, xy, count);
        *reach = reach_of(terrain, &found, xy[0], xy[1]);
    }
    return NT_OK;
}

static nt_status check_area(const nt_terrain *terrain, const nt_area *area, nt_problem *problem)
{
    const borders on = borders_of(terrain);
    const nt_problem valid[] = {
        nt_problem_of("area.x_min", "m", area->x_min, on.first, on.last[0]),
        nt_problem_of("area.x_max", "m", area->x_max, area->x_min, on.last[0]),
        nt_problem_of("area.y_min", "m", area->y_min, on.first, on.last[1]),
        nt_problem_of("area.y_max", "m", area->y_max, area->y_min, on.last[1]),
        nt_problem_of("area.x", "m", area->x, area->x_min, area->x_max),
        nt_problem_of("area.y", "m", area->y, area->y_min, area->y_max),
    };
    nt_status status = NT_OK;
    for (size_t i = 0; i < sizeof valid / sizeof valid[0] && status == NT_OK; i++)
        status = check_within(valid[i].value, &valid[i], problem);
    return status;
}

nt_area nt_terrain_whole(const nt_terrain *terrain, double x, double y)
{
    const nt_surface *surface = nt_terrain_surface(terrain);
    if (!has_borders(terrain))
        return (nt_area){x, y, x, x, y, y};
    return (nt_area){x, y, 0.0, (double)(surface->nx - 1) * surface->dx, 0.0, (double)(surface->ny - 1) * surface->dy};
}

nt_status nt_terrain_reach_area(const nt_terrain *terrain, const nt_area *area, nt_reach *reach, nt_problem *problem)
{
    if (!terrain || !area || !reach)
        return NT_E_ARGUMENT;
    const nt_status status = check_area(terrain, area, problem);
    if (status != NT_OK)
        return status;
    *reach = level(terrain);
    if (has_borders(terrain)) {
        const double x[2] = {area->x_min, area->x_max}, y[2] = {area->y_min, area->y_max};
        const nt_fields fields = fields_of(terrain);
        const nt_extremes found = nt_extremes_in_area(nt_terrain_surface(terrain), &fields, x, y);
        *reach = reach_of(terrain, &found, area->x, area->y);
    }
    return NT_OK;
}
