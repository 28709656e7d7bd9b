/* SPDX-License-Identifier: BSD-3-Clause
 * A charge trapped on the sample, under a tip that conducts. */
#include "scene/terms/term.h"

static int is_felt(const nt_scene *scene)
{
    return scene->tip.conducting && scene->medium.kind != NT_MEDIUM_LIQUID;
}

static void prepare(void *law, const nt_scene *scene, double capture_gap)
{
    (void)capture_gap;
    const double charge = is_felt(scene) ? scene->sample.charge : 0.0;
    *(nt_point_charge *)law = (nt_point_charge){scene->tip.radius, charge, scene->adhesion.equilibrium_distance};
}

static nt_form full_form(const void *law)
{
    return ((const nt_point_charge *)law)->charge == 0.0 ? NT_FORM_OFF : NT_FORM_ON;
}

static nt_law_value eval(const void *law, nt_form form, double gap)
{
    (void)form;
    return nt_point_charge_eval(law, gap);
}

static double hold(const void *law)
{
    return ((const nt_point_charge *)law)->minimum_gap;
}

static int facts(const nt_scene *scene, nt_term_fact *out)
{
    out[0] = (nt_term_fact){is_felt(scene), "trapped charge, which does not act on this tip here", "C",
                            scene->sample.charge};
    return 1;
}

static const nt_term_form forms[] = {{NT_FORM_ON, 0.15, 0.15, "computed"}};

NT_TERM_BESIDE(charge, prepare, full_form, eval, hold, NULL,
               .words = {"charge", "trapped charge", "its image in the tip (Thomson)", NULL, forms, 1, 0},
               .facts = facts);
