/* SPDX-License-Identifier: BSD-3-Clause
 * Electric double layers of tip and sample in a liquid with ions; the surfaces keep their potential. */
#include <math.h>

#include "scene/terms/term.h"

static int has_ions(const nt_scene *scene)
{
    return scene->medium.kind == NT_MEDIUM_LIQUID && scene->medium.ionic_strength > 0.0;
}

/* psi of a surface: as given, or linear in the pH near the isoelectric point. */
static double potential_of(const nt_medium *medium, double given, double isoelectric_point)
{
    return medium->ph > 0.0 ? medium->potential_per_ph * (isoelectric_point - medium->ph) : given;
}

static void prepare(void *law, const nt_scene *scene, double capture_gap)
{
    (void)capture_gap;
    const nt_medium *medium = &scene->medium;
    const int ions = has_ions(scene);
    const double tip = potential_of(medium, scene->tip.surface_potential, scene->tip.isoelectric_point);
    const double sample = potential_of(medium, scene->sample.surface_potential, scene->sample.isoelectric_point);
    *(nt_double_layer *)law = (nt_double_layer){
        .radius = scene->tip.radius,
        .debye_length =
            ions ? nt_debye_length(medium->ionic_strength, medium->relative_permittivity, medium->temperature) : 1e-9,
        .relative_permittivity = medium->relative_permittivity,
        .tip_potential = ions ? tip : 0.0,
        .sample_potential = ions ? sample : 0.0,
        .minimum_gap = scene->adhesion.equilibrium_distance};
}

static nt_form full_form(const void *law)
{
    const nt_double_layer *layer = law;
    return layer->tip_potential == 0.0 && layer->sample_potential == 0.0 ? NT_FORM_OFF : NT_FORM_ON;
}

static nt_law_value eval(const void *law, nt_form form, double gap)
{
    (void)form;
    return nt_double_layer_potential_eval(law, gap);
}

static double hold(const void *law)
{
    return ((const nt_double_layer *)law)->minimum_gap;
}

/* It is a repulsion ~ (a + b)^2 less an attraction ~ (a - b)^2 of the potentials a, b. Both fall with the gap, their
 * difference need not; it is never above the larger one. */
static nt_law_value limit(const void *law, double gap)
{
    nt_double_layer push = *(const nt_double_layer *)law, pull = push;
    push.tip_potential = push.sample_potential = 0.5 * (push.tip_potential + push.sample_potential);
    pull.tip_potential = 0.5 * (pull.tip_potential - pull.sample_potential);
    pull.sample_potential = -pull.tip_potential;
    const nt_law_value a = nt_double_layer_potential_eval(&push, gap), b = nt_double_layer_potential_eval(&pull, gap);
    return (nt_law_value){.U = fmax(a.U, -b.U), .F = fmax(a.F, -b.F), .k = fmax(a.k, -b.k)};
}

/* p = k/(2 pi R) ~ e [S/(1 + e)^2 - D/(1 - e)^2], e = exp(-h/debye_length) (forces/double_layer.c), and its slope. */
static nt_pressure pressure(const void *law, double gap)
{
    nt_double_layer layer = *(const nt_double_layer *)law;
    layer.minimum_gap = 0.0;
    const nt_law_value value = nt_double_layer_potential_eval(&layer, gap);
    const double per_area = 2.0 * NT_PI * layer.radius, kappa = 1.0 / layer.debye_length;
    const double e = exp(-gap * kappa), more = 1.0 + e, less = -expm1(-gap * kappa);
    const double plus = layer.tip_potential + layer.sample_potential;
    const double minus = layer.tip_potential - layer.sample_potential;
    const double C = 0.5 * NT_VACUUM_PERMITTIVITY * layer.relative_permittivity * kappa * kappa * kappa;
    return (nt_pressure){value.F / per_area, value.k / per_area,
                         -C * e *
                             (plus * plus * less / (more * more * more) - minus * minus * more / (less * less * less))};
}

static void warn(nt_plan *plan, const nt_scene *scene)
{
    (void)scene;
    const nt_double_layer *layer = &plan->laws.double_layer;
    const double potential = fmax(fabs(layer->tip_potential), fabs(layer->sample_potential));
    if (plan->terms[NT_PLAN_DOUBLE_LAYER].form == NT_FORM_OFF)
        return;
    if (potential > 0.025)
        nt_plan_add_warning(plan, (nt_plan_warning){"surface potential, beyond the linear theory of double layers", "V",
                                                    potential, 0.025});
    if (layer->debye_length > 0.2 * layer->radius)
        nt_plan_add_warning(plan, (nt_plan_warning){"Debye length, not small against the tip", "m", layer->debye_length,
                                                    0.2 * layer->radius});
}

static int facts(const nt_scene *scene, nt_term_fact *out)
{
    const nt_medium *medium = &scene->medium;
    const int ions = has_ions(scene);
    const double potential = fmax(fabs(scene->tip.surface_potential), fabs(scene->sample.surface_potential));
    out[0] = (nt_term_fact){medium->kind == NT_MEDIUM_LIQUID, "ionic strength, not used: there is no liquid", "mol/m^3",
                            medium->ionic_strength};
    out[1] = (nt_term_fact){ions, "pH, not used: there are no ions", "", medium->ph};
    out[2] = (nt_term_fact){ions && !(medium->ph > 0.0),
                            "surface potential, not used: there are no ions, or there is a pH", "V", potential};
    return 3;
}

static const nt_term_form forms[] = {{NT_FORM_ON, 1.2, 1.05, "computed"}};

NT_TERM_BESIDE(double_layer, prepare, full_form, eval, hold, pressure,
               .words = {"double_layer", "double layer",
                         "linear theory at constant potential (Hogg, Healy, Fuerstenau 1966)", NULL, forms, 1, 1},
               .limit = limit, .warn = warn, .facts = facts, .noun = "the double layer");
