/* SPDX-License-Identifier: BSD-3-Clause
 * What the forms of a plan cost, in evaluations of a Hertz contact by nt_interaction_eval_gap, the session's path: the
 * figures that the rows in libnanotouch/scene/terms/ ship, of evaluations that do not wait for each other (throughput)
 * and of a chain in which each waits for the last (latency). All in contact, spread evenly up to the largest load. Of
 * laws beside contact it is what they add to Hertz and to a table; the rows have a number between the two, since what
 * is added to a dear contact is done while it waits. Then random plans, stated beside measured, and inversions:
 * forms that are dearer than a truer one. An argument draws other plans. Prints JSON. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../c/larger.h"
#include "drawn.h"
#include "internal/maugis.h"
#include "internal/plan.h"
#include "nanotouch/nanotouch.h"
#include "scene/parts.h"
#include "scene/scene.h"

enum { POINTS = 256, REPETITIONS = 9, N = 64, RANDOM_PLANS = 20 };

typedef struct cost {
    double throughput, latency; /* [s] per evaluation, or in the unit */
} cost;

static double heights[N * N], coefficients[N * N], ratios[N * N], modulus[N * N], work[N * N];
static nt_surface surface;
static nt_radius_map radii;
static nt_properties properties;
static nt_maugis_bank bank;
static nt_maugis_bank_memory memory;
static nt_plan plan;
static cost unit;

static double now(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

/* Over all gaps once; `waits` 0 or a number that changes nothing, so that each gap waits for the last force. */
static double pass(const double *gaps, int over_surface, double waits)
{
    const nt_interaction_state held = {1, 0.0, 0.0};
    double F = 0.0, sum = 0.0;
    for (int i = 0; i < POINTS; ++i) {
        const double gap = gaps[i] + waits * F;
        if (over_surface) {
            const nt_pose pose = {(10 + i % 41) * 7e-9 + 1e-9 * waits * F, (10 + i % 43) * 7e-9, gap};
            F = nt_interaction_eval(&plan, &held, &pose).Fz;
        } else
            F = nt_interaction_eval_gap(&plan, &held, NULL, gap).F;
        sum += F;
    }
    return sum;
}

/* The least of several repetitions: other programs only ever add. */
static double seconds_of(const double *gaps, int over_surface, double waits)
{
    double best = INFINITY;
    volatile double kept = 0.0;
    long rounds = 4;
    for (int repetition = 0; repetition < REPETITIONS; ++repetition) {
        const double start = now();
        for (long r = 0; r < rounds; ++r)
            kept = kept + pass(gaps, over_surface, waits);
        const double seconds = now() - start;
        best = smaller(best, seconds / ((double)rounds * POINTS));
        if (seconds < 0.002) {
            rounds *= 2;
            repetition = -1;
            best = INFINITY;
        }
    }
    return best;
}

static cost measure(double deepest, int over_surface)
{
    double gaps[POINTS];
    for (int i = 0; i < POINTS; ++i)
        gaps[i] = -deepest * ((i * 97) % POINTS + 0.5) / POINTS;
    return (cost){seconds_of(gaps, over_surface, 0.0), seconds_of(gaps, over_surface, 1e-300)};
}

/* In the unit, less what is counted elsewhere. */
static cost report(const char *name, cost found, cost less)
{
    const cost in_unit = {found.throughput / unit.throughput - less.throughput,
                          found.latency / unit.latency - less.latency};
    printf(",\n  \"%s\": {\"throughput\": %.2f, \"latency\": %.2f}", name, in_unit.throughput, in_unit.latency);
    return in_unit;
}

/* A form that is truer than the one before it and no dearer: the other is no trade. */
static void report_inversion(const char *name, cost before, cost truer)
{
    if (before.throughput > truer.throughput)
        printf(",\n  \"inversion: %s\": [%.2f, %.2f]", name, before.throughput, truer.throughput);
}

static const cost none = {0.0, 0.0}, one = {1.0, 1.0};
#define DEEP (0.9 * plan.largest_indentation) /* tables end at the largest load */

/* Only contact, in a form. */
static void only(nt_form form)
{
    plan.on_count = 0;
    plan.terms[NT_PLAN_CONTACT].form = form;
    plan.deformation.count = 0;
}

static void report_contact(void)
{
    static const nt_form forms[] = {NT_FORM_OFF, NT_FORM_TABLE, NT_FORM_EXACT, NT_FORM_POLISHED};
    cost before = none;
    for (int i = 0; i < 4; ++i) {
        only(forms[i]);
        const cost found = report(nt_form_name(forms[i]), measure(DEEP, 0), none);
        report_inversion(nt_form_name(forms[i]), before, found); /* the exact solver, which plans do not offer */
        before = found;
    }
}

static void report_shapes(void)
{
    static const nt_shape_kind kinds[] = {NT_SHAPE_SPHERE, NT_SHAPE_CONE, NT_SHAPE_PUNCH, NT_SHAPE_BLUNTED,
                                          NT_SHAPE_TRUNCATED};
    const nt_shape paraboloid = plan.shape;
    const double R = paraboloid.radius;
    only(NT_FORM_SHAPE);
    for (int i = 0; i < 5; ++i) {
        plan.shape = (nt_shape){.kind = kinds[i], .radius = R, .half_angle = 0.3};
        if (kinds[i] == NT_SHAPE_BLUNTED || kinds[i] == NT_SHAPE_TRUNCATED) {
            nt_scene scene = nt_scene_defaults();
            scene.tip.shape = kinds[i];
            scene.tip.radius = kinds[i] == NT_SHAPE_TRUNCATED ? 1e-9 : 2e-9;
            plan.shape = nt_scene_shape(&scene);
        }
        report(nt_shape_name(kinds[i]), measure(DEEP, 0), none);
    }
    plan.shape = (nt_shape){.kind = NT_SHAPE_SPHERE, .radius = R};
    only(NT_FORM_SERIES);
    report("series", measure(DEEP, 0), none);
    only(NT_FORM_PARABOLOID);
    report("paraboloid", measure(DEEP, 0), none);
    plan.jkr = (nt_jkr_shape){{.kind = NT_SHAPE_CONE, .half_angle = 0.3}, plan.contact.effective_modulus, 0.1};
    only(NT_FORM_JKR);
    report("jkr", measure(DEEP, 0), none);
    plan.shape = paraboloid;
}

/* Every form of every law beside contact, added to a contact. */
static void report_laws(nt_form contact)
{
    only(contact);
    const cost alone = measure(DEEP, 0);
    const cost less = {alone.throughput / unit.throughput, alone.latency / unit.latency};
    cost before = none;
    for (int term = NT_PLAN_CONTACT + 1; term <= NT_PLAN_CUSTOM_1; ++term)
        for (int i = 0; i < nt_term_words_of(term)->form_count; ++i) {
            char name[64];
            plan.on_count = 1;
            plan.on[0] = term;
            plan.terms[term].form = nt_term_words_of(term)->forms[i].form;
            (void)snprintf(name, sizeof name, "%s %s beside %s", nt_term_words_of(term)->name,
                           nt_form_name(plan.terms[term].form), nt_form_name(contact));
            const cost found = report(name, measure(DEEP, 0), less);
            if (i > 0)
                report_inversion(name, before, found);
            before = found;
        }
}

static nt_status make_surface(const nt_scene *scene)
{
    nt_random random = nt_random_seed(1);
    for (int i = 0; i < N * N; i++) {
        heights[i] = 1e-9 * sin(0.3 * (i % N)) * sin(0.2 * (double)(i / N));
        modulus[i] = scene->sample.youngs_modulus * (1.0 + nt_random_uniform(&random));
        work[i] = 0.1 * (1.0 + nt_random_uniform(&random));
    }
    const nt_height_map map = {heights, N, N, 7e-9, 7e-9};
    nt_status status = nt_surface_init(&surface, &map, coefficients);
    if (status == NT_OK)
        status = nt_radius_map_init(&radii, &surface, scene->tip.radius, NULL, ratios);
    return status;
}

/* With its bank. */
static nt_status make(const nt_plan_inputs *given)
{
    nt_plan_inputs inputs = *given;
    nt_maugis_bank_options options;
    nt_status status = nt_plan_begin(&plan, &inputs, NULL);
    free(memory.panels);
    free(memory.cells);
    memory = (nt_maugis_bank_memory){0};
    if (status == NT_OK && nt_plan_wants_bank(&plan, &options)) {
        status = nt_maugis_bank_size(&options, &memory);
        memory.panels = malloc((size_t)memory.panel_capacity * sizeof *memory.panels);
        memory.cells = malloc((size_t)memory.cell_capacity * sizeof *memory.cells);
        if (status == NT_OK)
            status = nt_maugis_bank_init(&bank, &options, &memory);
        inputs.bank = &bank;
    }
    return status == NT_OK ? nt_plan_decide(&plan, &inputs, NULL) : status;
}

static void report_surface(const nt_scene *scene)
{
    nt_scene bare = *scene;
    bare.medium.relative_humidity = bare.adhesion.work_of_adhesion = bare.adhesion.hamaker_constant = 0.0;
    if (make_surface(scene) != NT_OK)
        return;
    const nt_scene *const scenes[] = {&bare, scene};
    for (int adhesive = 0; adhesive < 2; ++adhesive)
        for (int made = 0; made < 2; ++made) {
            char name[64];
            nt_plan_inputs inputs = {.scene = scenes[adhesive], .surface = &surface, .radii = &radii};
            if (made && nt_properties_init(&properties, &surface, modulus, adhesive ? work : NULL, NULL) == NT_OK)
                inputs.properties = &properties;
            if (make(&inputs) != NT_OK)
                continue;
            const nt_form form = plan.terms[NT_PLAN_CONTACT].form;
            only(form);
            (void)snprintf(name, sizeof name, "%s%s%s", nt_form_name(form), adhesive ? "" : ", no adhesion",
                           made ? ", properties" : "");
            report(name, measure(DEEP, 0), none);
            (void)snprintf(name, sizeof name, "%s%s%s, with its place", nt_form_name(form),
                           adhesive ? "" : ", no adhesion", made ? ", properties" : "");
            report(name, measure(DEEP, 1), none);
            only(NT_FORM_LOCAL_EXACT);
            if (adhesive && !made)
                report("local exact", measure(DEEP, 0), none);
        }
    const nt_plan_inputs level = {.scene = &bare, .surface = &surface};
    if (make(&level) == NT_OK)
        report("height", measure(DEEP, 1), one);
}

/* Stated beside measured. */
static void report_plan(const char *name, int over)
{
    const cost found = measure(plan.largest_indentation, over);
    const cost in_unit = {found.throughput / unit.throughput, found.latency / unit.latency};
    printf(",\n  \"%s\": {\"stated\": [%.2f, %.2f], \"measured\": [%.2f, %.2f], \"ratio\": [%.2f, %.2f]}", name,
           plan.cost, plan.latency, in_unit.throughput, in_unit.latency, in_unit.throughput / plan.cost,
           in_unit.latency / plan.latency);
}

/* Soft samples, which deform: dry and sticky, or pushed by a double layer; flat and over relief. */
static void report_deformed(void)
{
    static nt_deform_table room[NT_DEFORM_RADII];
    for (int wet = 0; wet < 3; ++wet)
        for (int over = 0; over < 2; ++over) {
            static const char *const names[] = {"", " to a double layer", " to a double layer, sticky"};
            char name[64];
            nt_scene scene = nt_scene_defaults();
            const nt_demand demand = {.relative_accuracy = 0.01};
            nt_plan_inputs inputs = {.scene = &scene, .demand = &demand};
            scene.medium.relative_humidity = 0.0;
            scene.sample.youngs_modulus = 1e7;
            scene.range.maximum_load = 1e-9;
            if (wet) {
                scene.medium.kind = NT_MEDIUM_LIQUID;
                scene.medium.ionic_strength = 10.0;
                scene.tip.surface_potential = scene.sample.surface_potential = 0.02;
                scene.adhesion.hamaker_constant = 0.0;
                scene.adhesion.work_of_adhesion = wet == 1 ? 0.0 : 1e-3;
            }
            if (over && make_surface(&scene) == NT_OK) {
                inputs.surface = &surface;
                inputs.radii = &radii;
                inputs.room = room;
            }
            if (make(&inputs) != NT_OK || plan.deformation.count == 0)
                continue;
            (void)snprintf(name, sizeof name, "deforming%s%s", names[wet], over ? ", relief" : "");
            report_plan(name, over);
        }
}

/* `own`: with laws of one's own, and over surfaces that have properties. */
static void report_random(uint64_t seed, int own)
{
    nt_random random = nt_random_seed(seed);
    for (int made = 0; made < RANDOM_PLANS;) {
        nt_scene scene;
        nt_demand demand;
        draw(&random, &scene, &demand);
        if (own)
            draw_own(&random, &scene);
        const int over = nt_random_uniform(&random) < (own ? 0.6 : 0.3);
        nt_plan_inputs inputs = {.scene = &scene, .demand = &demand};
        if (over && make_surface(&scene) == NT_OK) {
            inputs.surface = &surface;
            inputs.radii = &radii;
        }
        const int has = over && own && nt_random_uniform(&random) < 0.5;
        const double *w = scene.adhesion.work_of_adhesion > 0.0 && scene.medium.relative_humidity == 0.0 ? work : NULL;
        if (has && nt_properties_init(&properties, &surface, modulus, w, NULL) == NT_OK)
            inputs.properties = &properties;
        if (make(&inputs) != NT_OK)
            continue;
        char forms[200] = "";
        for (int i = -1; i < plan.on_count; ++i) {
            const nt_plan_term *term = &plan.terms[i < 0 ? NT_PLAN_CONTACT : plan.on[i]];
            const size_t used = strlen(forms);
            (void)snprintf(forms + used, sizeof forms - used, "%s%s %s", i < 0 ? "" : ", ", term->name,
                           nt_form_name(term->form));
        }
        char name[sizeof forms + 32];
        (void)snprintf(name, sizeof name, "%s %d%s%s: %s", own ? "own" : "plan", ++made, over ? ", surface" : "",
                       has ? ", properties" : "", forms);
        report_plan(name, over);
    }
}

int main(int argc, char **argv)
{
    nt_scene scene = nt_scene_defaults();
    scene.tip.height = 1e-5; /* every term has its parameters, whatever the medium */
    scene.adhesion.contact_potential = 1.0;
    scene.medium.yukawa_energy = scene.medium.yukawa_length = 1e-9;
    static const wave exponential = {1e-9, 1e-9, 0.0};
    scene.custom[0] = (nt_custom_term){"exponential", wave_law, wave_bound, &exponential};
    const nt_plan_inputs inputs = {.scene = &scene};
    if (nt_plan_make(&plan, &inputs, NULL) != NT_OK)
        return 1;
    const nt_plan_laws *l = &plan.laws;
    plan.laws.charge.charge = 1e-18;
    plan.laws.double_layer = (nt_double_layer){l->vdw.sphere.radius, 1e-9, 78.4, 0.02, 0.01, 2e-10};
    plan.laws.hydration = (nt_hydration){l->vdw.sphere.radius, 1e-3, 3e-10, 0.0, 3e-10, 2e-10};
    plan.laws.steric = (nt_steric){l->vdw.sphere.radius, 20e-9, 10e-9, 300.0, 2e-10};
    only(NT_FORM_SHAPE);
    unit = measure(DEEP, 0);
    printf("{\n  \"ns\": {\"throughput\": %.1f, \"latency\": %.1f}", 1e9 * unit.throughput, 1e9 * unit.latency);
    report_contact();
    report_shapes();
    report_laws(NT_FORM_SHAPE);
    report_laws(NT_FORM_TABLE);
    scene = nt_scene_defaults();
    report_surface(&scene);
    report_deformed();
    const uint64_t seed = argc > 1 ? strtoull(argv[1], NULL, 10) : 7;
    report_random(seed, 0);
    report_random(seed, 1);
    printf("\n}\n");
    return 0;
}
