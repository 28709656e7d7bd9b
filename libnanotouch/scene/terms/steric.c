/* SPDX-License-Identifier: BSD-3-Clause
 * Polymer brushes in a liquid that are pressed together. */
#include <math.h>

#include "scene/terms/term.h"

static void prepare(void *law, const nt_scene *scene, double capture_gap)
{
    (void)capture_gap;
    const nt_medium *medium = &scene->medium;
    const double hold = scene->adhesion.equilibrium_distance;
    const int felt = medium->kind == NT_MEDIUM_LIQUID && medium->brush_thickness > hold;
    *(nt_steric *)law = (nt_steric){.radius = scene->tip.radius,
                                    .thickness = felt ? medium->brush_thickness : 0.0,
                                    .spacing = medium->brush_spacing,
                                    .temperature = medium->temperature,
                                    .minimum_gap = hold};
}

static nt_form full_form(const void *law)
{
    return ((const nt_steric *)law)->thickness == 0.0 ? NT_FORM_OFF : NT_FORM_ON;
}

static nt_law_value eval(const void *law, nt_form form, double gap)
{
    (void)form;
    return nt_steric_eval(law, gap);
}

static double hold(const void *law)
{
    return ((const nt_steric *)law)->minimum_gap;
}

/* p = kT/s^3 [(T/h)^(9/4) - (h/T)^(3/4)], k/(2 pi R) of the sphere. */
static nt_pressure pressure(const void *law, double gap)
{
    nt_steric steric = *(const nt_steric *)law;
    steric.minimum_gap = 0.0;
    const nt_law_value value = nt_steric_eval(&steric, gap);
    const double per_area = 2.0 * NT_PI * steric.radius, T = steric.thickness, x = gap / T, q = sqrt(sqrt(x));
    const double scale = NT_BOLTZMANN * steric.temperature / (steric.spacing * steric.spacing * steric.spacing);
    const double slope = x < 1.0 ? -scale / T * (2.25 / (x * x * x * q) + 0.75 / q) : 0.0;
    return (nt_pressure){value.F / per_area, value.k / per_area, slope};
}

static int facts(const nt_scene *scene, nt_term_fact *out)
{
    out[0] = (nt_term_fact){scene->medium.kind == NT_MEDIUM_LIQUID,
                            "thickness of the brush, not used: there is no liquid", "m", scene->medium.brush_thickness};
    return 1;
}

static const nt_term_form forms[] = {{NT_FORM_ON, 0.4, 0.35, "computed"}};

NT_TERM_BESIDE(steric, prepare, full_form, eval, hold, pressure,
               .words = {"steric", "polymer brush", "scaling law of Alexander and de Gennes", NULL, forms, 1, 1},
               .facts = facts, .noun = "the brush");
