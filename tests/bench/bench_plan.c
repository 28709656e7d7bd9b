/* SPDX-License-Identifier: BSD-3-Clause
 * What the forms of a plan cost, in multiples of an inlined Hertz law {U, F, k, a} in the same run: the figures that
 * libnanotouch/scene/options.c ships, and whole plans beside everything-on, exact. Prints JSON. */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "../c/larger.h"
#include "nanotouch/nanotouch.h"
#include "scene/parts.h"

enum { POINTS = 256, REPETITIONS = 7 };

static double gaps[POINTS]; /* from 2 nm apart to 1 nm deep */
static nt_law_value values[POINTS];
static nt_plan plan;
static const nt_interaction_state held = {1, 0.0, 0.0};

static double now(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

/* Seconds per evaluation over all gaps: the least of several repetitions. */
#define MEASURE(expression)                                                                                            \
    __extension__({                                                                                                    \
        double best = INFINITY;                                                                                        \
        long rounds = 16;                                                                                              \
        for (int repetition = 0; repetition < REPETITIONS; ++repetition) {                                             \
            const double start = now();                                                                                \
            for (long r = 0; r < rounds; ++r) {                                                                        \
                for (int point = 0; point < POINTS; ++point) {                                                         \
                    const double gap = gaps[point];                                                                    \
                    values[point] = (expression);                                                                      \
                }                                                                                                      \
                __asm__ volatile("" ::"r"(values), "r"(gaps) : "memory");                                              \
            }                                                                                                          \
            const double seconds = now() - start;                                                                      \
            best = smaller(best, seconds / ((double)rounds * POINTS));                                                 \
            if (seconds < 0.01) {                                                                                      \
                rounds *= 4;                                                                                           \
                repetition = -1;                                                                                       \
                best = INFINITY;                                                                                       \
            }                                                                                                          \
        }                                                                                                              \
        best;                                                                                                          \
    })

static inline nt_law_value hertz(double delta, double R, double E)
{
    nt_law_value value = {0.0, 0.0, 0.0, 0.0};
    if (delta > 0.0) {
        value.a = sqrt(R * delta);
        value.k = 2.0 * E * value.a;
        value.F = value.k * delta * (2.0 / 3.0);
        value.U = value.F * delta * 0.4;
    }
    return value;
}

static double hertz_time;

static void report(const char *name, double seconds)
{
    printf(",\n  \"%s\": {\"ns\": %.2f, \"hertz\": %.1f}", name, 1e9 * seconds, seconds / hertz_time);
}

static void report_contact(void)
{
    static const nt_form forms[] = {NT_FORM_SHAPE, NT_FORM_TABLE, NT_FORM_POLISHED, NT_FORM_EXACT};
    for (int i = 0; i < 4; ++i) {
        const nt_form form = forms[i];
        report(nt_form_name(form), MEASURE(nt_plan_contact_eval(&plan, form, -gap)));
    }
}

static void report_shapes(void)
{
    static const nt_shape_kind kinds[] = {NT_SHAPE_SPHERE, NT_SHAPE_CONE, NT_SHAPE_BLUNTED};
    const nt_shape paraboloid = plan.shape;
    for (int i = 0; i < 3; ++i) {
        char name[32];
        plan.shape = (nt_shape){.kind = kinds[i], .radius = paraboloid.radius, .half_angle = 0.3};
        (void)snprintf(name, sizeof name, "shape: %s", nt_shape_name(kinds[i]));
        report(name, MEASURE(nt_plan_contact_eval(&plan, NT_FORM_SHAPE, -gap)));
    }
    report("series: sphere", MEASURE(nt_plan_contact_eval(&plan, NT_FORM_SERIES, -gap)));
    plan.jkr = (nt_jkr_shape){{.kind = NT_SHAPE_CONE, .half_angle = 0.3}, plan.contact.effective_modulus, 0.1};
    report("jkr: cone", MEASURE(nt_plan_contact_eval(&plan, NT_FORM_JKR, -gap)));
    plan.shape = paraboloid;
}

/* Every form of every law beside contact. */
static void report_laws(void)
{
    for (int term = NT_PLAN_CONTACT + 1; term <= NT_PLAN_CUSTOM_1; ++term)
        for (int i = 0; i < nt_term_words_of(term)->form_count; ++i) {
            const nt_form form = nt_term_words_of(term)->forms[i].form;
            char name[64];
            (void)snprintf(name, sizeof name, "%s %s", nt_term_words_of(term)->name, nt_form_name(form));
            report(name, MEASURE(nt_plan_law_eval(&plan, term, form, fabs(gap) + 1e-10)));
        }
}

/* A law of one's own. */
static nt_law_value exponential(const void *length, double gap)
{
    const double l = *(const double *)length, F = 1e-9 * exp(-gap / l);
    return (nt_law_value){.U = F * l, .F = F, .k = F / l};
}

static double bound_of_exponential(const void *length, double gap)
{
    return exponential(length, gap).F;
}

static nt_law_value on_surface(double gap)
{
    const nt_pose pose = {1e3 * gap + 3e-7, 5e-7, gap};
    const nt_interaction_value v = nt_interaction_eval(&plan, &held, &pose);
    return (nt_law_value){v.U, v.Fz, v.k, v.Fx};
}

/* With a radius that changes with the gap. */
static nt_law_value local_at(nt_form form, double gap)
{
    const nt_contact contact = nt_plan_contact_of_radius(&plan, (20.0 + 1e9 * gap) * 1e-9);
    return nt_plan_local_eval(&plan, form, &contact, -gap).law;
}

/* Bank, radius map and surface of a wavy map. */
static nt_status report_local(const nt_scene *scene)
{
    static double heights[64 * 64], coefficients[64 * 64], ratios[64 * 64];
    static nt_maugis_panel panels[512];
    static nt_maugis_bank_cell cells[32768];
    const nt_maugis_bank_options options = nt_maugis_bank_defaults();
    const nt_maugis_bank_memory memory = {panels, cells, 512, 32768};
    const nt_height_map map = {heights, 64, 64, 20e-9, 20e-9};
    nt_maugis_bank bank;
    nt_surface surface;
    nt_radius_map radii;
    for (int i = 0; i < 64 * 64; i++)
        heights[i] = 5e-9 * sin(0.3 * (i % 64)) * sin(0.2 * (double)(i / 64));
    nt_status status = nt_maugis_bank_init(&bank, &options, &memory);
    if (status == NT_OK)
        status = nt_surface_init(&surface, &map, coefficients);
    if (status == NT_OK)
        status = nt_radius_map_init(&radii, &surface, scene->tip.radius, NULL, ratios);
    if (status != NT_OK)
        return status;
    report("surface", MEASURE(((nt_law_value){nt_surface_eval(&surface, 1e3 * gap + 3e-7, 5e-7).z, 0.0, 0.0, 0.0})));
    report("radius map",
           MEASURE(((nt_law_value){nt_radius_map_eval(&radii, 1e3 * gap + 3e-7, 5e-7).dx, 0.0, 0.0, 0.0})));
    const nt_plan_inputs inputs = {.scene = scene, .surface = &surface, .radii = &radii, .bank = &bank};
    status = nt_plan_make(&plan, &inputs, NULL);
    if (status != NT_OK)
        return status;
    report("local", MEASURE(local_at(NT_FORM_LOCAL, gap)));
    report("local exact", MEASURE(local_at(NT_FORM_LOCAL_EXACT, gap)));
    const nt_adhesion_source source = plan.source;
    plan.source = NT_ADHESION_NONE;
    report("local, without adhesion", MEASURE(local_at(NT_FORM_LOCAL, gap)));
    plan.source = source;
    report("whole evaluation on a surface", MEASURE(on_surface(gap)));
    return NT_OK;
}

int main(void)
{
    nt_scene scene = nt_scene_defaults();
    for (int i = 0; i < POINTS; ++i)
        gaps[i] = 2e-9 - 3e-9 * ((i * 97) % POINTS + 0.5) / POINTS;
    scene.tip.height = 1e-5; /* every term has its parameters, whatever the medium */
    scene.adhesion.contact_potential = 1.0;
    scene.medium.yukawa_energy = scene.medium.yukawa_length = 1e-9;
    static const double length = 1e-9;
    scene.custom[0] = (nt_custom_term){"exponential", exponential, bound_of_exponential, &length};
    const nt_plan_inputs inputs = {.scene = &scene};
    if (nt_plan_make(&plan, &inputs, NULL) != NT_OK)
        return 1;
    const nt_plan_laws *l = &plan.laws;
    plan.laws.charge.charge = 1e-18;
    plan.laws.double_layer = (nt_double_layer){l->vdw.sphere.radius, 1e-9, 78.4, 0.02, 0.01, 2e-10};
    plan.laws.hydration = (nt_hydration){l->vdw.sphere.radius, 1e-3, 3e-10, 0.0, 3e-10, 2e-10};
    plan.laws.steric = (nt_steric){l->vdw.sphere.radius, 20e-9, 10e-9, 300.0, 2e-10};
    const double R = plan.contact.radius, E = plan.contact.effective_modulus;
    hertz_time = MEASURE(hertz(-gap, R, E));
    printf("{\n  \"hertz\": {\"ns\": %.2f, \"hertz\": 1.0}", 1e9 * hertz_time);
    report_contact();
    report_shapes();
    report_laws();
    scene = nt_scene_defaults();
    const nt_demand exact = {.relative_accuracy = 0.0};
    const nt_plan_inputs all = {.scene = &scene, .demand = &exact};
    if (nt_plan_make(&plan, &all, NULL) != NT_OK)
        return 1;
    report("silicon in air, everything exact", MEASURE(nt_interaction_eval_gap(&plan, &held, NULL, gap)));
    if (nt_plan_make(&plan, &inputs, NULL) != NT_OK)
        return 1;
    report("silicon in air, plan at 1 %", MEASURE(nt_interaction_eval_gap(&plan, &held, NULL, gap)));
    const nt_status status = report_local(&scene);
    printf("\n}\n");
    return status == NT_OK ? 0 : 1;
}
