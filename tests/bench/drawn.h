/* SPDX-License-Identifier: BSD-3-Clause
 * Random scenes whose plans are measured: tips and samples in a medium, and laws of one's own. */
#ifndef NANOTOUCH_BENCH_DRAWN_H
#define NANOTOUCH_BENCH_DRAWN_H

#include <math.h>

#include "nanotouch/nanotouch.h"

static double up_to(nt_random *random, double factor)
{
    return exp(log(factor) * nt_random_uniform(random));
}

/* In air, dry or in a liquid, with one tip or another, at any demand. */
static void draw(nt_random *random, nt_scene *scene, nt_demand *demand)
{
    *scene = nt_scene_defaults();
    *demand = nt_demand_defaults();
    scene->tip.radius = 5e-9 * up_to(random, 100.0);
    scene->sample.youngs_modulus = 1e9 * up_to(random, 100.0);
    scene->adhesion.contact_potential = nt_random_uniform(random) < 0.5 ? 1.0 : 0.0;
    scene->tip.height = nt_random_uniform(random) < 0.5 ? 10.0 * scene->tip.radius : 0.0;
    demand->relative_accuracy = 1e-9 * up_to(random, 1e8);
    const int kind = (int)(4.0 * nt_random_uniform(random));
    if (kind > 0)
        scene->medium.relative_humidity = 0.0;
    if (kind > 1)
        scene->adhesion.work_of_adhesion = scene->adhesion.hamaker_constant = 0.0;
    if (kind > 1 && nt_random_uniform(random) < 0.7)
        scene->tip.shape = NT_SHAPE_SPHERE;
    if (kind > 2) {
        scene->medium.kind = NT_MEDIUM_LIQUID;
        scene->medium.ionic_strength = 10.0;
        scene->tip.surface_potential = scene->sample.surface_potential = 0.02;
        scene->medium.hydration_energy = 1e-4;
    }
    scene->range.maximum_load = 1e-6 * scene->tip.radius / 20e-9 * 0.1;
}

/* Laws of one's own: one to four, that decay or oscillate, so that their tables have few cells or many. */
typedef struct wave {
    double force, length, wave_number; /* F at gap 0 [N], decay [m], [1/m] */
} wave;

static nt_law_value wave_law(const void *context, double gap)
{
    const wave *w = context;
    const double l = w->length, q = w->wave_number, decay = w->force * exp(-gap / l);
    const double c = decay * cos(q * gap), s = decay * sin(q * gap), n = 1.0 / (l * l) + q * q;
    return (nt_law_value){.U = (c / l - q * s) / n, .F = c, .k = c / l + q * s};
}

static double wave_bound(const void *context, double gap)
{
    const wave *w = context;
    return fabs(w->force) * exp(-gap / w->length);
}

static void draw_own(nt_random *random, nt_scene *scene)
{
    static wave waves[NT_CUSTOM_TERMS];
    const int count = 1 + (int)(NT_CUSTOM_TERMS * nt_random_uniform(random));
    for (int i = 0; i < count; ++i) {
        const double length = 1e-9 * up_to(random, 30.0);
        waves[i].force = 1e-4 * scene->range.maximum_load * up_to(random, 1000.0);
        waves[i].length = length;
        waves[i].wave_number = nt_random_uniform(random) < 0.5 ? 0.0 : up_to(random, 20.0) / length;
        scene->custom[i] = (nt_custom_term){"wave", wave_law, wave_bound, &waves[i]};
        scene->custom[i].name[4] = (char)('0' + i);
        scene->custom[i].name[5] = '\0';
    }
}

#endif
