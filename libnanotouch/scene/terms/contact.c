/* SPDX-License-Identifier: BSD-3-Clause
 * Contact as a row: its forms with cost and error, what it says, its history. The laws themselves are
 * scene/contact.c's.
 *
 * Contact is off by at most e max(|X_c|, S), X_c its part of the demanded quantity X. With T the largest that the terms
 * beside contact come to where there can be contact, |X_c| <= |X| + T, so that its share is e (1 + T/S); of a force T
 * need only be their largest attraction, since X_c <= |X| + T then, and X_c >= -S. */
#include <math.h>
#include <stddef.h>

#include "internal/contact.h"
#include "internal/maugis.h"
#include "scene/scene.h"
#include "scene/terms/term.h"

#define TABLED 2.0     /* the error of a table oscillates within its cells: what was sampled may be half of it */
#define NOTHING 0.2    /* cost of an evaluation without contact [Hertz evaluations] */
#define ROUNDING 1e-12 /* of a force in polished and exact tiers, away from folds (docs/evidence/contact.md) */
#define ROOTS 4e-11    /* and of stiffness and radius, which go as a root there: 32 DBL_EPSILON over twice 1e-4 */

/* The rows of `forms` whose words and cost depend on more than the form; before them those of nt_shape_kind. */
enum {
    IN_PLACE_OF_SPHERE = NT_SHAPE_COUNT,
    IN_PLACE_OF_BLUNTED,
    LOCAL_HERTZ,
    LOCAL_MAUGIS,
    MADE_HERTZ,
    MADE_SHAPE,
    MADE_MAUGIS,
    SERIES,
    JKR,
    TABLE,
    POLISHED,
    DEFORMED,
    LOCAL_EXACT,
    FORMS
};
static const nt_term_form forms[FORMS] = {
    [NT_SHAPE_PARABOLOID] = {NT_FORM_SHAPE, 1.0, 1.0, "Hertz"},
    [NT_SHAPE_SPHERE] = {NT_FORM_SHAPE, 8.3, 7.5, "law of the sphere"},
    [NT_SHAPE_CONE] = {NT_FORM_SHAPE, 1.0, 1.9, "law of the cone"},
    [NT_SHAPE_PUNCH] = {NT_FORM_SHAPE, 0.65, 0.6, "law of the punch"},
    [NT_SHAPE_BLUNTED] = {NT_FORM_SHAPE, 1.1, 1.4, "law of the blunted"},
    [NT_SHAPE_TRUNCATED] = {NT_FORM_SHAPE, 18.0, 16.0, "law of the truncated"},
    [IN_PLACE_OF_SPHERE] = {NT_FORM_PARABOLOID, 1.0, 1.0, "Hertz in place of the sphere"},
    [IN_PLACE_OF_BLUNTED] = {NT_FORM_PARABOLOID, 1.0, 1.0, "Hertz in place of the blunted"},
    [LOCAL_HERTZ] = {NT_FORM_LOCAL, 1.2, 1.2, "Hertz with the radius of each place"},
    [LOCAL_MAUGIS] = {NT_FORM_LOCAL, 4.1, 3.9, "Maugis-Dugdale with the radius of each place"}, /* with dU/dR */
    [MADE_HERTZ] = {NT_FORM_LOCAL, 1.2, 1.2, "Hertz with radius and modulus of each place"},
    [MADE_SHAPE] = {NT_FORM_LOCAL, 8.3, 7.5, "law of the shape with the modulus of each place"},
    [MADE_MAUGIS] = {NT_FORM_LOCAL, 4.1, 3.9, "Maugis-Dugdale with radius, modulus and adhesion of each place"},
    [SERIES] = {NT_FORM_SERIES, 1.05, 1.05, "law of the sphere as a series"},
    [JKR] = {NT_FORM_JKR, 1.5, 2.4, "JKR"},
    [TABLE] = {NT_FORM_TABLE, 1.85, 1.75, "Maugis-Dugdale table"},
    [POLISHED] = {NT_FORM_POLISHED, 6.7, 5.9, "Maugis-Dugdale, polished table"},
    [DEFORMED] = {NT_FORM_DEFORMED, 2.45, 2.5, "on a sample that deforms under all forces together"},
    [LOCAL_EXACT] = {NT_FORM_LOCAL_EXACT, 68.0, 59.0, "Maugis-Dugdale, exact, with the radius of each place"},
};

static int local_row(const nt_plan *plan)
{
    const int is_made = plan->properties != NULL;
    if (plan->source != NT_ADHESION_NONE)
        return is_made ? MADE_MAUGIS : LOCAL_MAUGIS;
    if (plan->shape.kind != NT_SHAPE_PARABOLOID)
        return MADE_SHAPE;
    return is_made ? MADE_HERTZ : LOCAL_HERTZ;
}

/* The row of a form. Adhesion that cannot be felt is none: then the shape is Hertz' paraboloid. */
static int row_of(const nt_plan *plan, nt_form form)
{
    switch (form) {
    case NT_FORM_SHAPE:
        return (int)plan->shape.kind;
    case NT_FORM_PARABOLOID:
        return plan->shape.kind == NT_SHAPE_BLUNTED ? IN_PLACE_OF_BLUNTED : IN_PLACE_OF_SPHERE;
    case NT_FORM_LOCAL:
        return local_row(plan);
    case NT_FORM_SERIES:
        return SERIES;
    case NT_FORM_JKR:
        return JKR;
    case NT_FORM_TABLE:
        return TABLE;
    case NT_FORM_POLISHED:
        return POLISHED;
    case NT_FORM_DEFORMED:
        return DEFORMED;
    case NT_FORM_LOCAL_EXACT:
        return LOCAL_EXACT;
    case NT_FORM_EXACT: /* the truth that others are measured by, never computed itself */
    case NT_FORM_OFF:
    case NT_FORM_ON:
    case NT_FORM_DERJAGUIN:
    case NT_FORM_SPHERE:
    case NT_FORM_TIP:
        break;
    }
    return LOCAL_EXACT;
}

static const nt_term_form *form_of(const void *law, nt_form form)
{
    return &forms[row_of(law, form)];
}

static void offer(const nt_plan *plan, nt_plan_options *options, nt_form form, double error)
{
    nt_plan_offer(plan, options, NT_PLAN_CONTACT, form, error);
}

/* Of contact, which other terms may hide; of what hides contact there is no less. */
static double rounding(const nt_plan *plan, double more)
{
    const int is_root = plan->source != NT_ADHESION_NONE &&
                        (plan->quantity == NT_QUANTITY_STIFFNESS || plan->quantity == NT_QUANTITY_RADIUS);
    return (is_root ? ROOTS : ROUNDING) * fmax(more, 1.0);
}

/* What leaving out the curvature of the surface costs beside contact. */
static double curved_laws(const nt_plan *plan, double beside)
{
    const double R = plan->contact.radius;
    if (!nt_plan_is_curved(plan))
        return 0.0;
    const double ratio = fmax(fabs(plan->radii->minimum / R - 1.0), fabs(plan->radii->maximum / R - 1.0));
    return nt_plan_share(plan, ratio * beside);
}

/* And in contact: force grows with the radius, so that the smallest and the largest on the map are the worst. */
static double curved_contact(const nt_plan *plan, double more)
{
    if (!nt_plan_is_curved(plan))
        return 0.0;
    if (plan->quantity == NT_QUANTITY_FOLDS)
        return nt_plan_share(plan, nt_plan_curvature_shift(plan));
    return more * NT_SAMPLED * nt_plan_curvature_distance(plan);
}

static void offer_local(const nt_plan *plan, nt_plan_options *options, double more)
{
    if (!nt_plan_varies(plan))
        return;
    if (plan->source == NT_ADHESION_NONE) {
        offer(plan, options, NT_FORM_LOCAL, rounding(plan, more));
        return;
    }
    if (plan->bank) {
        const double error = nt_plan_bank_error(plan, plan->quantity);
        offer(plan, options, NT_FORM_LOCAL, more * error + rounding(plan, more));
    }
    offer(plan, options, NT_FORM_LOCAL_EXACT, rounding(plan, more));
}

/* Of the table. Its units of stiffness and its radius at zero load are the scale S of these. */
static double table_error(const nt_plan *plan, nt_quantity quantity)
{
    const nt_accuracy *accuracy = &plan->table.accuracy[NT_TIER_TABLE];
    switch (quantity) {
    case NT_QUANTITY_STIFFNESS:
        return nt_maugis_table_error(&plan->table).stiffness;
    case NT_QUANTITY_RADIUS:
        return nt_maugis_table_error(&plan->table).radius;
    case NT_QUANTITY_FOLDS:
        return nt_plan_share(plan, accuracy->fold_shift);
    default:
        return TABLED * accuracy->force_error * fmax(1.0, nt_plan_share(plan, nt_maugis_pull_off_force(&plan->maugis)));
    }
}

/* Contact of tips that adhesion makes Maugis-Dugdale's. */
static void offer_maugis(nt_plan *plan, nt_plan_options *options, double more)
{
    const nt_quantity quantity = plan->quantity;
    const double table = table_error(plan, quantity);
    const int hertz_shape = plan->shape.kind == NT_SHAPE_PARABOLOID;
    if (hertz_shape && quantity == NT_QUANTITY_FORCE && plan->demand.force_floor > 0.0)
        offer(plan, options, NT_FORM_SHAPE,
              NT_SAMPLED * more * nt_plan_contact_distance(plan, NT_FORM_PARABOLOID) + plan->curvature_error);
    const double bits = rounding(plan, more);
    offer(plan, options, NT_FORM_TABLE, more * table + bits + plan->curvature_error);
    offer(plan, options, NT_FORM_POLISHED, bits + plan->curvature_error); /* the exact solver is no better */
    offer_local(plan, options, more);
}

/* The largest attraction of all beside contact, at the gaps where there can be contact; all is held inside 0. */
static double opposing(const nt_plan *plan)
{
    double pull = fmax(-nt_plan_beside_at(plan, 0.0).F, 0.0);
    for (double gap = nt_plan_contact_reach(plan); gap > 1e-13; gap *= 0.9)
        pull = fmax(pull, -NT_SAMPLED * nt_plan_beside_at(plan, gap).F);
    return pull * nt_plan_largest_ratio(plan);
}

/* max(|k_c|, S)/max(|k|, S) at a gap, at most: |k| >= |k_c| - T. Over a surface k_c is that of no one radius, and the
 * worst of all k_c is S + T. */
static double more_stiffness_at(const nt_plan *plan, double gap)
{
    const double T = NT_SAMPLED * nt_plan_largest_ratio(plan) * fabs(nt_plan_beside_at(plan, gap).k), S = plan->scale;
    if (nt_plan_varies(plan))
        return 1.0 + T / S;
    const double k = fabs(nt_plan_contact_eval(plan, nt_plan_contact_truth(plan), -gap).k);
    return fmax(k, S) / fmax(k - T, S);
}

/* The largest of it at the gaps where there can be contact; terms that are held have no stiffness. */
static double more_stiffness(const nt_plan *plan)
{
    const double reach = nt_plan_contact_reach(plan);
    double more = 1.0;
    for (double gap = reach; gap > 1e-13; gap *= 0.95)
        more = fmax(more, more_stiffness_at(plan, gap));
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (nt_plan_hold_gap(plan, term) < reach)
            more = fmax(more, more_stiffness_at(plan, nt_plan_hold_gap(plan, term) * (1.0 + 1e-12)));
    return more;
}

/* How much larger the share of contact is than its own error, at most 1 + T/S.
 * Where contact without adhesion begins the others are held: X = X_c + their sum, 0 <= X_c <= P. If that pushes,
 * max(X_c, S)/max(X, S) is largest at either end of X_c. */
static double more_than_contact(const nt_plan *plan, const nt_scene *scene)
{
    if (plan->quantity == NT_QUANTITY_STIFFNESS)
        return more_stiffness(plan);
    if (plan->quantity != NT_QUANTITY_FORCE)
        return 1.0;
    const double pull = opposing(plan), sharpest = plan->radii ? plan->radii->minimum / plan->contact.radius : 1.0;
    const double push = nt_plan_beside_at(plan, 0.0).F * fmin(sharpest, 1.0), S = plan->scale;
    if (plan->source != NT_ADHESION_NONE || pull > 0.0)
        return 1.0 + nt_plan_share(plan, pull);
    const double load = fmax(scene->range.maximum_load, S);
    return fmax(S / fmax(push, S), load / (load + push));
}

/* A form other than the fullest of a contact without adhesion, which has no folds. */
static void offer_simpler(const nt_plan *plan, nt_plan_options *options, nt_form form, double more)
{
    const double error = plan->quantity == NT_QUANTITY_FOLDS ? 0.0 : nt_plan_contact_distance(plan, form);
    offer(plan, options, form, more * NT_SAMPLED * error + rounding(plan, more));
}

static void offer_shape(const nt_plan *plan, nt_plan_options *options, double more)
{
    const nt_shape_kind kind = plan->shape.kind;
    if (kind == NT_SHAPE_SPHERE || kind == NT_SHAPE_BLUNTED)
        offer_simpler(plan, options, NT_FORM_PARABOLOID, more);
    if (kind == NT_SHAPE_SPHERE && plan->largest_indentation < plan->shape.radius)
        offer_simpler(plan, options, NT_FORM_SERIES, more);
    offer(plan, options, NT_FORM_SHAPE, rounding(plan, more) + plan->curvature_error);
    offer_local(plan, options, more);
}

/* Never touched: nothing is computed; the radii of places are for the other terms, which follow them. */
static void offer_none(nt_plan *plan, nt_plan_options *options, double beside)
{
    const int exact = plan->source != NT_ADHESION_NONE && !plan->bank;
    plan->terms[NT_PLAN_CONTACT].force = 0.0;
    plan->curvature_error = curved_laws(plan, beside);
    offer(plan, options, NT_FORM_OFF, plan->curvature_error);
    if (nt_plan_is_curved(plan))
        offer(plan, options, exact ? NT_FORM_LOCAL_EXACT : NT_FORM_LOCAL, ROUNDING);
    for (int i = 0; i < options->count[NT_PLAN_CONTACT]; ++i) /* what is left: the way there and back */
        options->option[NT_PLAN_CONTACT][i].cost = options->option[NT_PLAN_CONTACT][i].latency = NOTHING;
}

static void offer_all(nt_plan *plan, const nt_scene *scene, nt_plan_options *options, double beside)
{
    const double more = more_than_contact(plan, scene);
    const nt_form full = nt_plan_contact_form(plan);
    if (full == NT_FORM_EXACT)
        nt_plan_rivals_of(plan);
    if (!plan->visits_contact) {
        offer_none(plan, options, beside);
        return;
    }
    plan->terms[NT_PLAN_CONTACT].force = scene->range.maximum_load;
    plan->curvature_error = curved_contact(plan, more) + curved_laws(plan, beside);
    if (plan->properties) /* they are there to be felt */
        offer_local(plan, options, more);
    else if (full == NT_FORM_EXACT)
        offer_maugis(plan, options, more);
    else if (full == NT_FORM_JKR)
        offer(plan, options, full, rounding(plan, more));
    else
        offer_shape(plan, options, more);
}

static nt_form full_form(const void *law)
{
    return nt_plan_contact_form(law);
}

static nt_law_value eval(const void *law, nt_form form, double gap)
{
    return nt_plan_contact_eval(law, form, -gap);
}

static void warn(nt_plan *plan, const nt_scene *scene)
{
    const nt_contact_validity *v = &plan->validity;
    const struct {
        unsigned outside;
        nt_plan_warning warning;
    } limits[] = {
        {NT_OUTSIDE_RADIUS_RATIO,
         {"contact radius over tip radius at the largest load", "", v->radius_ratio, NT_VALID_RADIUS_RATIO}},
        {NT_OUTSIDE_SLOPE,
         {"slope of the tip at the edge of contact at the largest load", "", v->slope, NT_VALID_SLOPE}},
        {NT_OUTSIDE_STRAIN, {"strain at the largest load", "", v->strain, NT_VALID_STRAIN}},
        {NT_OUTSIDE_THICKNESS,
         {"contact radius over thickness of the sample at the largest load", "", v->thickness_ratio,
          NT_VALID_THICKNESS_RATIO}},
    };
    for (int i = 0; i < 4 && plan->terms[NT_PLAN_CONTACT].form != NT_FORM_OFF; ++i)
        if (v->outside & limits[i].outside &&
            !(limits[i].outside == NT_OUTSIDE_THICKNESS && nt_plan_solves_layer(plan)))
            nt_plan_add_warning(plan, limits[i].warning);
    nt_capillary_warn(plan, scene);
}

static int facts(const nt_scene *scene, nt_term_fact *out)
{
    const nt_adhesion *adhesion = &scene->adhesion;
    const int meniscus = nt_scene_adhesion_source(scene) == NT_ADHESION_MENISCUS;
    const int by_energies = adhesion->given == NT_ADHESION_GIVEN_ENERGIES;
    out[0] = (nt_term_fact){adhesion->given == NT_ADHESION_GIVEN_PULL_OFF,
                            "measured pull-off force, not used: the adhesion is given otherwise", "N",
                            adhesion->pull_off_force};
    out[1] = (nt_term_fact){!(meniscus && by_energies), "surface energy of the tip, not used: water holds", "J/m^2",
                            adhesion->tip_surface_energy};
    out[2] =
        (nt_term_fact){meniscus, "meniscus radius, not used: there is no meniscus", "m", scene->medium.meniscus_radius};
    return 3;
}

/* Captured inside the capture gap, let go beyond the release gap; what is lost at either is dissipated. The state is
 * whether it is attached. */
static nt_term_step advance(const void *law, void *state, const nt_place *place, double gap, double dt)
{
    (void)dt; /* it has no speed */
    const nt_plan *plan = law;
    int *attached = state;
    const int before = *attached;
    nt_term_step step = {0.0, 0.0};
    *attached = nt_plan_is_attached(plan, before, place, gap);
    if (plan->terms[NT_PLAN_CONTACT].form == NT_FORM_OFF)
        return step;
    if (*attached != before) {
        const double where =
            *attached ? nt_plan_capture_gap(plan, place) : nt_plan_last_hold(nt_plan_release_gap(plan, place));
        const double U = nt_plan_contact_at(plan, place, where).law.U + nt_plan_rise(plan, place, where);
        step.dissipated = fmax(0.0, *attached ? -U : U);
    }
    return step;
}

const nt_term_row nt_term_contact = {
    .words = {"contact", "contact", "Maugis-Dugdale, JKR, or the law of the shape without adhesion", NULL, forms, FORMS,
              0},
    .full_form = full_form,
    .eval = eval,
    .offer = offer_all,
    .form_of = form_of,
    .warn = warn,
    .facts = facts,
    .state_size = sizeof(int),
    .advance = advance,
};
