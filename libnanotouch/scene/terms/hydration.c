/* SPDX-License-Identifier: BSD-3-Clause
 * Hydration and hydrophobic forces in a liquid: one exponential. */
#include <math.h>

#include "scene/terms/term.h"

static void prepare(void *law, const nt_scene *scene, double capture_gap)
{
    (void)capture_gap;
    const nt_medium *medium = &scene->medium;
    *(nt_hydration *)law =
        (nt_hydration){.radius = scene->tip.radius,
                       .amplitude = medium->kind == NT_MEDIUM_LIQUID ? medium->hydration_energy : 0.0,
                       .decay_length = medium->hydration_length,
                       .second_decay_length = medium->hydration_length,
                       .minimum_gap = scene->adhesion.equilibrium_distance};
}

static nt_form full_form(const void *law)
{
    return ((const nt_hydration *)law)->amplitude == 0.0 ? NT_FORM_OFF : NT_FORM_ON;
}

static nt_law_value eval(const void *law, nt_form form, double gap)
{
    (void)form;
    return nt_hydration_eval(law, gap);
}

static double hold(const void *law)
{
    return ((const nt_hydration *)law)->minimum_gap;
}

static nt_pressure pressure(const void *law, double gap)
{
    const nt_hydration *hydration = law;
    const double l = hydration->decay_length, W = hydration->amplitude * exp(-gap / l);
    return (nt_pressure){W, W / l, -W / (l * l)};
}

static int facts(const nt_scene *scene, nt_term_fact *out)
{
    out[0] = (nt_term_fact){scene->medium.kind == NT_MEDIUM_LIQUID, "hydration energy, not used: there is no liquid",
                            "J/m^2", scene->medium.hydration_energy};
    return 1;
}

static const nt_term_form forms[] = {{NT_FORM_ON, 0.25, 0.2, "computed"}};

NT_TERM_BESIDE(hydration, prepare, full_form, eval, hold, pressure,
               .words = {"hydration", "hydration", "exponential, also hydrophobic (Israelachvili 2011)", NULL, forms, 1,
                         1},
               .facts = facts, .noun = "hydration");
