/* SPDX-License-Identifier: BSD-3-Clause
 * What a session is made of: terrain and plan, touch step, how far it is from its stability limit and what it promises.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "control/bound.h"
#include "control/margins.h"
#include "core/problem.h"
#include "internal/hazard.h"
#include "internal/margins.h"
#include "internal/terrain.h"
#include "session/grip.h"
#include "session/hazard.h"
#include "session/state.h"
#include "session/terrain.h"

/* A law of one's own is not tried where the margin is overridden: it may have a memory. */
nt_verdict nt_composition_judge(nt_composition *composition, const nt_settings *settings, nt_mode mode)
{
    nt_margins *margins = &composition->margins;
    nt_sideways_margins *sideways = &composition->sideways;
    *sideways = (nt_sideways_margins){
        .margin = HUGE_VAL, .exact_limit = HUGE_VAL, .exact_frequency = NAN, .coupled_margin = HUGE_VAL};
    nt_settings judged = *settings;
    if (!(composition->setup.minimum_margin > 0.0) && judged.control.choice == NT_CONTROL_OWN)
        judged.control.law = NULL;
    const nt_rig *rig = &composition->touch.rig;
    const double stiffness = nt_composition_stiffness(composition);
    judged.gains.alpha_f *= nt_margins_projected(rig, settings, stiffness, &composition->grip);
    const nt_verdict along_z = nt_margins_judge(rig, &judged, stiffness, mode, margins);
    composition->tap = (nt_verdict){.margin = INFINITY, .rule = "", .field = ""};
    if (mode == NT_MODE_TAPPING) {
        composition->tap = nt_session_judge_tap(rig, settings, nt_terrain_plan(composition->terrain));
        return along_z.margin <= composition->tap.margin ? along_z : composition->tap;
    }
    if (mode != NT_MODE_TOUCH || !composition->touch.feels_sideways || !rig->master.motor)
        return along_z;
    *sideways = nt_margins_sideways(rig, settings, stiffness, &composition->grip, margins);
    const nt_verdict found = nt_verdict_sideways(sideways);
    return along_z.margin <= found.margin ? along_z : found;
}

int nt_composition_allows(const nt_composition *composition, double margin)
{
    const double minimum = composition->setup.minimum_margin;
    return minimum <= 0.0 || margin >= minimum;
}

/* Radius and material that change with the place add to what friction and slope hold; past the lateral limit what they
 * push with may turn, too. */
static void add_uneven(nt_composition *made, const nt_hazard *hazard)
{
    nt_guarantee *found = &made->guarantee;
    const double start[] = {made->setup.x, made->setup.y};
    const double *place = made->setup.rig.stage.axes == 1.0 ? start : NULL;
    const double uneven = nt_grip_uneven(nt_terrain_plan(made->terrain), found->force, place);
    const double held = hazard->friction + hazard->slope * found->force;
    found->lateral_force = uneven + fmin(fmax(held, found->lateral_force), found->lateral_force + uneven);
}

static nt_status promise(nt_composition *made, nt_problem *problem)
{
    const nt_session_setup *setup = &made->setup;
    if (setup->rig.probe.lateral_stiffness > 0.0)
        made->grip =
            nt_grip_of(nt_terrain_plan(made->terrain), nt_composition_slope(made), setup->settings.limits.force);
    const nt_verdict verdict = nt_composition_judge(made, &setup->settings, setup->mode);
    if (!nt_composition_allows(made, verdict.margin))
        return nt_problem_set(problem, verdict.field, "", verdict.margin, setup->minimum_margin, INFINITY);
    const nt_plan *plan = nt_terrain_plan(made->terrain);
    const double clearance = setup->preflight ? setup->clearance : HUGE_VAL;
    nt_hazard hazard = nt_hazard_of(plan, &setup->rig, &setup->settings, nt_composition_slope(made), clearance);
    nt_composition_add_pushed(made, &hazard);
    const double relief = nt_hazard_relief(plan);
    made->guarantee = nt_guarantee_within(&setup->rig, &setup->settings, &hazard, relief);
    if (nt_composition_pushes(made)) { /* sideways they give way: no slope does */
        hazard.slope = made->reach.slope;
        const nt_guarantee aside = nt_guarantee_within(&setup->rig, &setup->settings, &hazard, relief);
        made->guarantee.lateral_force = aside.lateral_force + nt_composition_resistance(made, made->guarantee.force);
    }
    add_uneven(made, &hazard);
    return NT_OK;
}

/* What plan and bank depend on. The map was dilated when the first one was made: its surface serves from then on. */
static nt_status make_terrain(nt_composition *made, const nt_composition *before, nt_problem *problem)
{
    nt_session_setup *setup = &made->setup;
    nt_terrain_setup wanted = nt_terrain_defaults();
    wanted.scene = setup->scene;
    wanted.scene.range.maximum_load = setup->settings.limits.force;
    wanted.demand = setup->demand;
    wanted.probe = &setup->rig.probe;
    wanted.period = made->touch.period;
    wanted.map = setup->map;
    wanted.dilated = setup->dilated;
    wanted.surface = setup->surface;
    wanted.radii = setup->radii;
    wanted.properties = setup->properties;
    if (before) {
        wanted.map = (nt_height_map){0};
        wanted.surface = nt_terrain_surface(before->terrain);
        wanted.radii = nt_terrain_radii(before->terrain);
    }
    return nt_terrain_make(&made->terrain, &wanted, problem);
}

/* A path of a stage of one axis is the place where it starts. */
static nt_status check_standing(const nt_session_setup *setup, nt_problem *problem)
{
    static const char *const names[] = {"path.x of a stage of one axis", "path.y of a stage of one axis"};
    const double start[] = {setup->x, setup->y};
    for (long i = 0; i < 2 * setup->path_count; ++i)
        if (setup->path[i] != start[i % 2])
            return nt_problem_set(problem, names[i % 2], "m", setup->path[i], start[i % 2], start[i % 2]);
    return NT_OK;
}

/* A declared path holds only where no master can leave it. */
static int keeps_to_path(const nt_session_setup *setup)
{
    return setup->path && setup->rig.master.axes == 1.0;
}

/* All places that the tip can be led to: by the stage's axes, the master's, inputs and requests (check_place). */
static nt_area led_over(const nt_composition *made)
{
    const nt_session_setup *setup = &made->setup;
    nt_area area = {setup->x, setup->y, setup->x, setup->x, setup->y, setup->y};
    if (setup->rig.stage.axes == 1.0)
        return area;
    if (!keeps_to_path(setup))
        return nt_terrain_whole(made->terrain, setup->x, setup->y);
    for (long i = 0; i < setup->path_count; ++i) {
        const double x = setup->path[2 * i], y = setup->path[2 * i + 1];
        area.x_min = fmin(area.x_min, x);
        area.x_max = fmax(area.x_max, x);
        area.y_min = fmin(area.y_min, y);
        area.y_max = fmax(area.y_max, y);
    }
    return area;
}

/* On a flat each place is as the start. */
static void set_borders(nt_composition *made, const nt_area *led)
{
    const nt_surface *surface = nt_terrain_surface(made->terrain);
    const double borders[2][2] = {{led->x_min, led->x_max}, {led->y_min, led->y_max}};
    if ((surface && surface->coefficients) || made->setup.rig.stage.axes == 1.0)
        memcpy(made->touch.borders, borders, sizeof borders);
}

static nt_status find_reach(nt_composition *made, const nt_composition *before, nt_problem *problem)
{
    const nt_session_setup *setup = &made->setup;
    if (before) {
        made->reach = before->reach;
        memcpy(made->touch.borders, before->touch.borders, sizeof made->touch.borders);
        return NT_OK;
    }
    nt_status status = NT_OK;
    if (keeps_to_path(setup) && setup->rig.stage.axes == 1.0)
        status = check_standing(setup, problem);
    if (status == NT_OK && keeps_to_path(setup))
        status = nt_terrain_check_path(made->terrain, setup->path, setup->path_count, problem);
    const nt_area led = led_over(made);
    if (status == NT_OK)
        status = nt_terrain_reach_area(made->terrain, &led, &made->reach, problem);
    set_borders(made, &led);
    return status;
}

static int has_same_scene(const nt_session_setup *a, const nt_session_setup *b)
{
    int count;
    const nt_field *fields = nt_scene_fields(&count);
    for (int i = 0; i < count; ++i)
        if (nt_field_get(&fields[i], &a->scene) != nt_field_get(&fields[i], &b->scene))
            return 0;
    return 1;
}

static int keeps_terrain(const nt_session_setup *setup, const nt_composition *before)
{
    return before && setup->settings.limits.force == before->setup.settings.limits.force &&
           has_same_scene(setup, &before->setup);
}

nt_status nt_compose(nt_composition **made, const nt_session_setup *setup, const nt_composition *before,
                     nt_problem *problem)
{
    nt_composition *next = calloc(1, sizeof *next);
    if (!next)
        return NT_E_NO_MEMORY;
    next->setup = *setup;
    nt_status status = nt_touch_make(&next->touch, &setup->rig, &setup->settings, setup->mode, problem);
    if (status == NT_OK && keeps_terrain(setup, before))
        next->terrain = before->terrain;
    else if (status == NT_OK)
        status = make_terrain(next, before, problem);
    next->ground = before ? before->ground : next->terrain;
    if (status == NT_OK)
        status = nt_composition_take_pushed(next, before, problem);
    if (status == NT_OK)
        status = find_reach(next, before, problem);
    if (status == NT_OK)
        status = promise(next, problem);
    if (status == NT_OK)
        *made = next;
    else
        nt_composition_close(next, before);
    return status;
}

nt_status nt_compose_standing(nt_composition **made, const nt_composition *before, nt_mode mode,
                              const nt_scaling *scaling, nt_problem *problem)
{
    nt_composition *next = malloc(sizeof *next);
    if (!next)
        return NT_E_NO_MEMORY;
    *next = *before;
    next->setup.mode = mode;
    next->setup.settings.gains.alpha_p = scaling->alpha_p;
    next->setup.settings.gains.alpha_f = scaling->alpha_f;
    nt_status status = nt_settings_check(&next->setup.settings, problem);
    if (status == NT_OK)
        status = promise(next, problem);
    if (status == NT_OK)
        *made = next;
    else
        free(next);
    return status;
}

void nt_composition_close(nt_composition *composition, const nt_composition *other)
{
    if (!composition)
        return;
    nt_terrain *terrain = composition->terrain, *ground = composition->ground;
    if (!other || (other->terrain != terrain && other->ground != terrain))
        nt_terrain_close(terrain);
    if (ground != terrain && (!other || other->ground != ground))
        nt_terrain_close(ground);
    free(composition);
}
