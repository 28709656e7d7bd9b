/* SPDX-License-Identifier: BSD-3-Clause
 * Descriptions by the field tables, and what is drawn of their plan (page.h). */
#include "page.h"

#include <math.h>
#include <stdlib.h>

static page_world world;
static char words[512];

page_world *page_the_world(void)
{
    return &world;
}

/* --- memory of the caller's --- */

PAGE_API(page_alloc) void *page_alloc(uint32_t bytes)
{
    return malloc(bytes);
}

PAGE_API(page_free) void page_free(void *memory)
{
    free(memory);
}

/* --- the field tables --- */

static const nt_field *table(int kind, int *count)
{
    switch (kind) {
    case PAGE_SCENE:
        return nt_scene_fields(count);
    case PAGE_RIG:
        return nt_rig_fields(count);
    default:
        return nt_settings_fields(count);
    }
}

static void *described(int kind)
{
    switch (kind) {
    case PAGE_SCENE:
        return &world.scene;
    case PAGE_RIG:
        return &world.rig;
    default:
        return &world.settings;
    }
}

PAGE_API(page_field_count) int page_field_count(int kind)
{
    int count;
    table(kind, &count);
    return count;
}

PAGE_API(page_field_text) const char *page_field_text(int kind, int number, int part)
{
    const nt_field *field = table(kind, NULL) + number;
    return part == 0 ? field->name : part == 1 ? field->unit : field->doc;
}

PAGE_API(page_field_minimum) double page_field_minimum(int kind, int number)
{
    return table(kind, NULL)[number].minimum;
}

PAGE_API(page_field_maximum) double page_field_maximum(int kind, int number)
{
    return table(kind, NULL)[number].maximum;
}

PAGE_API(page_get) double page_get(int kind, int number)
{
    return nt_field_get(table(kind, NULL) + number, described(kind));
}

PAGE_API(page_set) void page_set(int kind, int number, double value)
{
    nt_field_set(table(kind, NULL) + number, described(kind), value);
}

/* The paper's scene and rig, the settings of that rig, and the usual accuracy. */
PAGE_API(page_defaults) void page_defaults(void)
{
    world.demand = nt_demand_defaults();
    world.scene = nt_scene_defaults();
    world.rig = nt_rig_defaults();
    world.settings = nt_settings_defaults(&world.rig);
}

/* What forces are planned for from now on [-]. */
PAGE_API(page_accuracy) void page_accuracy(double relative)
{
    world.demand.relative_accuracy = relative;
}

PAGE_API(page_check) int page_check(int kind)
{
    world.problem = (nt_problem){0};
    switch (kind) {
    case PAGE_SCENE:
        return (int)nt_scene_check(&world.scene, &world.problem);
    case PAGE_RIG:
        return (int)nt_rig_check(&world.rig, &world.problem);
    default:
        return (int)nt_settings_check(&world.settings, &world.problem);
    }
}

/* What was wrong last, in words: the field with its range, or what the status says. */
PAGE_API(page_problem) const char *page_problem(int status)
{
    if (world.problem.field || world.problem.code != NT_PROBLEM_RANGE)
        return nt_problem_print(&world.problem, words, sizeof words);
    return nt_status_message((nt_status)status);
}

/* --- the plan, and what is drawn of it --- */

PAGE_API(page_plan) int page_plan(void)
{
    world.problem = (nt_problem){0};
    const nt_plan_inputs inputs = {.scene = &world.scene, .demand = &world.demand, .probe = &world.rig.probe};
    return (int)nt_plan_make(&world.plan, &inputs, &world.problem);
}

typedef struct fact {
    const char *name;
    double value;
} fact;

static fact fact_of(int number)
{
    const nt_plan *plan = &world.plan;
    const fact facts[] = {
        {"bound", plan->bound.force_error},
        {"lambda", plan->lambda},
        {"source", plan->source},
        {"radius", plan->contact.radius},
        {"effective_modulus", plan->contact.effective_modulus},
        {"work_of_adhesion", plan->contact.work_of_adhesion},
        {"capture_gap", plan->capture_gap},
        {"release_gap", plan->release_gap},
        {"pull_off_force", plan->pull_off_force},
        {"minimum_spring", plan->minimum_spring},
        {"maximum_stiffness", plan->maximum_stiffness},
        {"largest_indentation", plan->largest_indentation},
        {"probe_noise", plan->probe_noise},
        {"cost", plan->cost},
        {"model_error", plan->bound.model_error},
    };
    const int count = (int)(sizeof facts / sizeof facts[0]);
    return number >= 0 && number < count ? facts[number] : (fact){"", (double)NAN};
}

/* "" beyond the last one. */
PAGE_API(page_fact_name) const char *page_fact_name(int number)
{
    return fact_of(number).name;
}

PAGE_API(page_fact) double page_fact(int number)
{
    return fact_of(number).value;
}

PAGE_API(page_term_count) int page_term_count(void)
{
    return NT_PLAN_TERMS;
}

/* part 0: title, 1: how it is computed */
PAGE_API(page_term_text) const char *page_term_text(int number, int part)
{
    const nt_plan_term *term = &world.plan.terms[number];
    return part == 0 ? term->title : term->words;
}

/* part 0: largest force [N], 1: error [-] */
PAGE_API(page_term_value) double page_term_value(int number, int part)
{
    const nt_plan_term *term = &world.plan.terms[number];
    return part == 0 ? term->force : term->bound;
}

PAGE_API(page_warning_count) int page_warning_count(void)
{
    return world.plan.warning_count;
}

PAGE_API(page_warning) const char *page_warning(int number)
{
    return world.plan.warnings[number].text;
}

PAGE_API(page_cutoff_gap) double page_cutoff_gap(double force)
{
    return nt_plan_cutoff_gap(&world.plan, force);
}

/* Rows of gap and force into `rows`, 2 count doubles; how many. */
PAGE_API(page_curve) int page_curve(int part, double nearest, double farthest, nt_view_point *rows, int count)
{
    const nt_view_range range = {(nt_view_part)part, nearest, farthest};
    return (int)nt_view_curve(&world.plan, NULL, &range, rows, count);
}

/* a, c and whether it holds into `found`; rows of tip, sample, rigid tip at the distances r. */
PAGE_API(page_section)
void page_section(const double pose[2], const double *r, nt_view_profile *rows, int count, double found[3])
{
    const nt_view_pose at = {pose[0], pose[1], nt_view_tip_share(&world.scene)};
    const nt_view_contact contact = nt_view_contact_at(&world.plan, NULL, &at);
    nt_view_section(&contact, r, rows, count);
    found[0] = contact.contact_radius;
    found[1] = contact.cohesive_radius;
    found[2] = contact.attached;
}

/* --- built-in samples --- */

PAGE_API(page_dots) int page_dots(double *heights, int pixels, double size)
{
    nt_dots dots;
    const nt_status status = nt_dots_scatter(&dots, 24, size, 1);
    for (int j = 0; status == NT_OK && j < pixels; ++j)
        for (int i = 0; i < pixels; ++i)
            heights[j * pixels + i] = nt_dots_height(&dots, i * size / pixels, j * size / pixels);
    return (int)status;
}
