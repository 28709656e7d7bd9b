/* SPDX-License-Identifier: BSD-3-Clause
 * Makes a terrain: what is needed is checked first, then surface, radii, bank and plan follow from each other. The heap
 * is used in make only. */
#include "internal/terrain.h"
#include "internal/maugis.h"
#include "internal/plan.h"
#include "nanotouch/advanced/terrain.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "core/problem.h"
#include "session/state.h"
#include "session/terrain.h"

struct nt_terrain {
    atomic_int holders; /* who has yet to close it */
    nt_plan plan;       /* borrows what follows */
    const nt_surface *surface;
    const nt_radius_map *radii;
    struct {
        nt_surface surface;
        nt_radius_map radii;
        nt_maugis_bank bank;
        double *coefficients, *ratios;
        nt_maugis_bank_memory tables;
        nt_deform_table *room;
    } own; /* what was made here */
};

nt_terrain_setup nt_terrain_defaults(void)
{
    return (nt_terrain_setup){.scene = nt_scene_defaults(), .demand = nt_demand_defaults()};
}

static nt_status refuse(nt_problem *problem, nt_problem found, nt_status status)
{
    if (problem)
        *problem = found;
    return status;
}

/* What has to be the same. */
typedef struct agreement {
    const char *field, *unit;
    double value, expected;
} agreement;

static nt_status check_same(const agreement *same, size_t count, nt_problem *problem)
{
    for (size_t i = 0; i < count; i++)
        if (same[i].value != same[i].expected)
            return refuse(problem,
                          nt_problem_of(same[i].field, same[i].unit, same[i].value, same[i].expected, same[i].expected),
                          NT_E_RANGE);
    return NT_OK;
}

/* Were these radii made of this surface, for this tip? */
static nt_status check_radii(const nt_terrain_setup *setup, nt_problem *problem)
{
    const nt_surface *grid = &setup->radii->ratio, *surface = setup->surface;
    if (!surface)
        return refuse(problem, nt_problem_of("radii without a surface", "", 1.0, 0.0, 0.0), NT_E_ARGUMENT);
    const agreement same[] = {
        {"radii.nx", "", (double)grid->nx, (double)surface->nx},
        {"radii.ny", "", (double)grid->ny, (double)surface->ny},
        {"radii.dx", "m", grid->dx, surface->dx},
        {"radii.dy", "m", grid->dy, surface->dy},
        {"tip.radius", "m", setup->scene.tip.radius, setup->radii->tip_radius}, /* another tip has dilated it */
    };
    return check_same(same, sizeof same / sizeof same[0], problem);
}

/* Are these properties on the grid of this surface or map? */
static nt_status check_properties(const nt_terrain_setup *setup, nt_problem *problem)
{
    const nt_surface *grid = &setup->properties->youngs_modulus, *surface = setup->surface;
    const nt_height_map *map = &setup->map;
    if (!surface && !map->heights)
        return refuse(problem, nt_problem_of("properties without a surface", "", 1.0, 0.0, 0.0), NT_E_ARGUMENT);
    const agreement same[] = {
        {"properties.nx", "", (double)grid->nx, (double)(surface ? surface->nx : map->nx)},
        {"properties.ny", "", (double)grid->ny, (double)(surface ? surface->ny : map->ny)},
        {"properties.dx", "m", grid->dx, surface ? surface->dx : map->dx},
        {"properties.dy", "m", grid->dy, surface ? surface->dy : map->dy},
    };
    return check_same(same, sizeof same / sizeof same[0], problem);
}

static nt_status check(const nt_terrain_setup *setup, nt_problem *problem)
{
    const nt_status status = nt_scene_check(&setup->scene, problem);
    if (status != NT_OK)
        return status;
    if (setup->map.heights && setup->surface)
        return refuse(problem, nt_problem_of("surface beside a map", "", 1.0, 0.0, 0.0), NT_E_ARGUMENT);
    if (setup->dilated != 0 && setup->dilated != 1)
        return refuse(problem, nt_problem_of("dilated", "", setup->dilated, 0.0, 1.0), NT_E_RANGE);
    if (setup->radii && check_radii(setup, problem) != NT_OK)
        return setup->surface ? NT_E_RANGE : NT_E_ARGUMENT;
    if (setup->properties && check_properties(setup, problem) != NT_OK)
        return setup->surface || setup->map.heights ? NT_E_RANGE : NT_E_ARGUMENT;
    if (setup->map.heights || setup->map.nx != 0 || setup->map.ny != 0)
        return nt_height_map_check(&setup->map, problem);
    return NT_OK;
}

/* Heights of the body become those of the apex, and both a spline in the same memory; its curvature gives the radii. */
static nt_status make_surface(nt_terrain *terrain, const nt_terrain_setup *setup)
{
    const nt_tip_shape tip = {setup->scene.tip.radius, setup->scene.tip.half_angle};
    const size_t pixels = (size_t)setup->map.nx * (size_t)setup->map.ny;
    nt_height_map map = setup->map;
    nt_status status = NT_OK;
    terrain->own.coefficients = malloc(pixels * sizeof(double));
    terrain->own.ratios = malloc(pixels * sizeof(double));
    if (!terrain->own.coefficients || !terrain->own.ratios)
        return NT_E_NO_MEMORY;
    if (!setup->dilated) {
        status = nt_surface_dilate(&setup->map, &tip, terrain->own.coefficients);
        map.heights = terrain->own.coefficients;
    }
    if (status == NT_OK)
        status = nt_surface_init(&terrain->own.surface, &map, terrain->own.coefficients);
    if (status == NT_OK)
        status = nt_radius_map_init(&terrain->own.radii, &terrain->own.surface, tip.radius, NULL, terrain->own.ratios);
    terrain->surface = &terrain->own.surface;
    terrain->radii = &terrain->own.radii;
    return status;
}

static nt_status make_bank(nt_terrain *terrain, const nt_maugis_bank_options *options)
{
    nt_maugis_bank_memory *tables = &terrain->own.tables;
    const nt_status status = nt_maugis_bank_size(options, tables);
    if (status != NT_OK)
        return status;
    tables->panels = malloc((size_t)tables->panel_capacity * sizeof *tables->panels);
    tables->cells = malloc((size_t)tables->cell_capacity * sizeof *tables->cells);
    if (!tables->panels || !tables->cells)
        return NT_E_NO_MEMORY;
    return nt_maugis_bank_init(&terrain->own.bank, options, tables);
}

/* One plan: its contact says which bank is needed, and with the bank it chooses. */
static nt_status make_plan(nt_terrain *terrain, const nt_terrain_setup *setup, nt_problem *problem)
{
    nt_plan_inputs inputs = {.scene = &setup->scene,
                             .demand = &setup->demand,
                             .probe = setup->probe,
                             .surface = terrain->surface,
                             .radii = terrain->radii,
                             .properties = setup->properties,
                             .period = setup->period};
    nt_maugis_bank_options options;
    if (terrain->radii) {
        inputs.room = terrain->own.room = calloc(NT_DEFORM_RADII, sizeof *inputs.room);
        if (!inputs.room)
            return NT_E_NO_MEMORY;
    }
    nt_status status = nt_plan_begin(&terrain->plan, &inputs, problem);
    if (status == NT_OK && nt_plan_wants_bank(&terrain->plan, &options)) {
        status = make_bank(terrain, &options);
        inputs.bank = &terrain->own.bank;
    }
    return status == NT_OK ? nt_plan_decide(&terrain->plan, &inputs, problem) : status;
}

nt_status nt_terrain_make(nt_terrain **terrain, const nt_terrain_setup *setup, nt_problem *problem)
{
    if (!terrain || !setup)
        return NT_E_ARGUMENT;
    nt_status status = check(setup, problem);
    if (status != NT_OK)
        return status;
    nt_terrain *made = calloc(1, sizeof *made);
    if (!made)
        return NT_E_NO_MEMORY;
    atomic_init(&made->holders, 1);
    made->surface = setup->surface;
    made->radii = setup->radii;
    if (setup->map.heights)
        status = make_surface(made, setup);
    if (status == NT_OK)
        status = make_plan(made, setup, problem);
    if (status != NT_OK) {
        nt_terrain_close(made);
        return status;
    }
    *terrain = made;
    return NT_OK;
}

nt_terrain *nt_terrain_hold(nt_terrain *terrain)
{
    atomic_fetch_add(&terrain->holders, 1);
    return terrain;
}

void nt_terrain_close(nt_terrain *terrain)
{
    if (!terrain || atomic_fetch_sub(&terrain->holders, 1) > 1)
        return;
    free(terrain->own.coefficients);
    free(terrain->own.ratios);
    free(terrain->own.tables.panels);
    free(terrain->own.tables.cells);
    free(terrain->own.room);
    free(terrain);
}

const nt_surface *nt_terrain_surface(const nt_terrain *terrain)
{
    return terrain->surface;
}
const nt_radius_map *nt_terrain_radii(const nt_terrain *terrain)
{
    return terrain->radii;
}
const nt_maugis_bank *nt_terrain_bank(const nt_terrain *terrain)
{
    return terrain->plan.bank;
}
const nt_plan *nt_terrain_plan(const nt_terrain *terrain)
{
    return &terrain->plan;
}
