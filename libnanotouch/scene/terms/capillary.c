/* SPDX-License-Identifier: BSD-3-Clause
 * The meniscus of humid air: no law beside contact, but the source of its adhesion (decision 2): its Laplace pressure
 * is the stress of the contact law, which forms and ruptures with it. Here is what the plan says of it. */
#include <math.h>

#include "scene/scene.h"
#include "scene/terms/term.h"

void nt_capillary_warn(nt_plan *plan, const nt_scene *scene)
{
    const nt_medium *medium = &scene->medium;
    if (plan->source != NT_ADHESION_MENISCUS)
        return;
    /* film and meniscus are of one humidity (erratum E4) */
    const double r1 = nt_scene_meniscus_radius(scene);
    const double kelvin =
        nt_kelvin_radius(medium->surface_tension, medium->molar_volume, medium->temperature, medium->relative_humidity);
    const double ratio = r1 / kelvin;
    if (fabs(ratio - 1.0) > 0.25)
        nt_plan_add_warning(plan,
                            (nt_plan_warning){"meniscus radius over that of the Kelvin equation for this humidity", "",
                                              ratio, ratio > 1.0 ? 1.25 : 0.75});
    if (medium->film_thickness > r1)
        nt_plan_add_warning(plan,
                            (nt_plan_warning){"film thicker than the meniscus radius, which no one humidity makes", "m",
                                              medium->film_thickness, r1});
    const double T = medium->temperature, warmer = T + scene->range.warming;
    const double change = medium->meniscus_radius > 0.0 ? 0.0 : T / warmer - 1.0; /* r1 ~ 1/T at a given humidity */
    if (fabs(change) > 0.01)
        nt_plan_add_warning(
            plan, (nt_plan_warning){"relative change of the meniscus radius with temperature", "", change, -0.01});
}
