/* SPDX-License-Identifier: BSD-3-Clause
 * The force of tip and sample at a potential difference, where both conduct and are connected. */
#include <math.h>

#include "forces/forces.h"
#include "scene/scene.h"
#include "scene/terms/term.h"

static void prepare(void *law, const nt_scene *scene, double capture_gap)
{
    (void)capture_gap;
    const nt_tip *tip = &scene->tip;
    const double potential = nt_scene_potential(scene), hold = scene->adhesion.equilibrium_distance;
    *(nt_electrostatic_term *)law =
        (nt_electrostatic_term){.sphere = {tip->radius, potential, hold},
                                .tip = {tip->radius, tip->half_angle, tip->height, potential, hold},
                                .angle = nt_tip_angle_of(tip->half_angle)};
}

static nt_form full_form(const void *law)
{
    const nt_electrostatic_term *force = law;
    return force->sphere.potential == 0.0 ? NT_FORM_OFF : force->tip.height > 0.0 ? NT_FORM_TIP : NT_FORM_SPHERE;
}

static nt_law_value eval(const void *law, nt_form form, double gap)
{
    const nt_electrostatic_term *force = law;
    return form == NT_FORM_TIP ? nt_electrostatic_tip_eval_with(&force->tip, &force->angle, gap)
                               : nt_electrostatic_eval(&force->sphere, gap);
}

static double hold(const void *law)
{
    return ((const nt_electrostatic_term *)law)->sphere.minimum_gap;
}

/* A plate capacitor that is held at U: W = -eps0 U^2/(2 h). */
static nt_pressure pressure(const void *law, double gap)
{
    const double U = ((const nt_electrostatic_term *)law)->sphere.potential;
    const double W = -0.5 * NT_VACUUM_PERMITTIVITY * U * U / gap;
    return (nt_pressure){W, W / gap, -2.0 * W / (gap * gap)};
}

static int facts(const nt_scene *scene, nt_term_fact *out)
{
    const nt_tip *tip = &scene->tip;
    const nt_specimen *sample = &scene->sample;
    const int liquid = scene->medium.kind == NT_MEDIUM_LIQUID;
    const int connected = !liquid && tip->conducting && sample->conducting && sample->grounded;
    const int both_known = tip->work_function > 0.0 && sample->work_function > 0.0;
    out[0] = (nt_term_fact){connected, "contact potential, which does not act between these bodies", "V",
                            scene->adhesion.contact_potential};
    out[1] = (nt_term_fact){both_known, "work function of one body alone, not used", "V",
                            fmax(tip->work_function, sample->work_function)};
    return 2;
}

static const nt_term_form forms[] = {
    {NT_FORM_SPHERE, 0.4, 0.45, "of the sphere"},
    {NT_FORM_TIP, 0.8, 0.75, "of the whole tip"},
};

NT_TERM_BESIDE(electrostatic, prepare, full_form, eval, hold, pressure,
               .words = {"electrostatic", "electrostatic", "conductors at a potential difference (Hudlet 1998)", NULL,
                         forms, 2, 1},
               .facts = facts, .noun = "the electrostatic force");
