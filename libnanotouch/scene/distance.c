/* SPDX-License-Identifier: BSD-3-Clause
 * How far apart two laws of contact are over a scene's range, and the scale S that a plan's errors are measured by. */
#include <math.h>

#include "internal/contact.h"
#include "scene/deformation/deform.h"
#include "scene/parts.h"

double nt_plan_pick(nt_law_value value, nt_quantity quantity)
{
    return quantity == NT_QUANTITY_STIFFNESS ? value.k : quantity == NT_QUANTITY_RADIUS ? value.a : value.F;
}

void nt_plan_visit(nt_plan *plan, const nt_scene *scene)
{
    const double nearest = scene->range.minimum_gap;
    plan->visits_contact = nearest <= fmax(nt_plan_contact_reach(plan), 0.0);
    plan->visited_pull = plan->visited_push = plan->visited_stiffness = 0.0;
    for (double gap = NT_DEFORM_FARTHEST; !plan->visits_contact && gap > nearest;) {
        gap = fmax(nt_elastic_nearer(plan, gap), nearest);
        const nt_law_value beside = nt_plan_beside_at(plan, gap);
        plan->visited_pull = fmax(plan->visited_pull, -beside.F);
        plan->visited_push = fmax(plan->visited_push, beside.F);
        plan->visited_stiffness = fmax(plan->visited_stiffness, fabs(beside.k));
    }
    plan->visited_pull = nt_plan_known_pull(plan, plan->visited_pull);
}

/* What pulls on small forces: everything on, or contact alone, which repulsion may hide; 0 where nothing does. */
static double pull_of(const nt_plan *plan)
{
    if (!plan->visits_contact)
        return plan->visited_pull;
    return fmax(plan->contact_pull, nt_plan_contact_pull_off(plan));
}

/* What small forces are measured by where nothing pulls. */
#define SMALL_LOAD 1e-3 /* of the largest load */

#define STRICTEST 1e-12 /* demand that can be kept at all: below it no force is too small to be felt */

/* From here on the bound holds, in release gaps: nearer, k errs by half of what rounding and interpolation do to the
 * place of its fold over the distance to it. */
#define AWAY_FROM_FOLDS 1e-4

/* The contact radius at the largest load [m]. A sample that deforms has a round tip, and no law of contact at a depth.
 */
static double largest_radius(const nt_plan *plan)
{
    if (plan->shape.kind == NT_SHAPE_PARABOLOID || plan->shape.kind == NT_SHAPE_SPHERE)
        return plan->contact.radius * plan->validity.radius_ratio;
    return nt_plan_contact_eval(plan, nt_plan_contact_form(plan), plan->largest_indentation).a;
}

/* What forces are measured by that are not contact's own: the pull, and where nothing pulls to speak of, a part of the
 * largest load. Out of contact that is the push at the smallest gap, if it is less. */
static double scale_of_force(const nt_plan *plan, double maximum_load)
{
    const double pull = pull_of(plan), push = fmin(plan->visited_push, maximum_load);
    const double apart = fmax(pull, SMALL_LOAD * push);
    if (plan->visits_contact || !(apart > 0.0))
        return pull > 0.0 ? pull : SMALL_LOAD * maximum_load;
    return apart;
}

double nt_plan_scale_of(const nt_plan *plan, double maximum_load)
{
    const int maugis = nt_plan_contact_form(plan) == NT_FORM_EXACT;
    const nt_maugis *m = &plan->maugis;
    const double accuracy = plan->accuracy;
    switch (plan->quantity) {
    case NT_QUANTITY_STIFFNESS:
        if (plan->visited_stiffness > 0.0)
            return plan->visited_stiffness;
        return maugis ? m->load_scale / m->indentation_scale : plan->maximum_stiffness;
    case NT_QUANTITY_RADIUS:
        return maugis ? m->folds.zero_load_radius * m->radius_scale : largest_radius(plan);
    case NT_QUANTITY_FOLDS:
        return fmax(fabs(plan->release_gap), plan->length);
    default:
        return fmax(scale_of_force(plan, maximum_load),
                    accuracy >= STRICTEST ? plan->demand.force_floor / accuracy : 0.0);
    }
}

double nt_plan_force_scale(const nt_plan *plan, double maximum_load)
{
    const int felt = plan->quantity == NT_QUANTITY_FORCE;
    if (nt_plan_contact_form(plan) == NT_FORM_EXACT && plan->visits_contact) {
        const double own = nt_maugis_pull_off_force(&plan->maugis);
        return felt ? fmin(plan->scale, own) : own;
    }
    return felt ? plan->scale : scale_of_force(plan, maximum_load);
}

typedef nt_law_value contact_law(const nt_plan *plan, double indentation);

static nt_law_value full_at(const nt_plan *plan, double indentation)
{
    return nt_plan_contact_eval(plan, nt_plan_contact_truth(plan), indentation);
}

static nt_law_value hertz_at(const nt_plan *plan, double indentation)
{
    return nt_plan_contact_eval(plan, NT_FORM_PARABOLOID, indentation);
}

static nt_law_value dmt_at(const nt_plan *plan, double indentation)
{
    return nt_dmt_eval(&plan->contact, indentation);
}

static nt_law_value jkr_at(const nt_plan *plan, double indentation)
{
    nt_law_value value = {0.0, 0.0, 0.0, 0.0};
    (void)nt_jkr_eval(&plan->contact, indentation, NT_BRANCH_STABLE, &value);
    return value;
}

static nt_law_value sharpest_at(const nt_plan *plan, double indentation)
{
    const nt_contact contact = nt_plan_contact_of_radius(plan, plan->radii->minimum);
    return nt_plan_local_eval(plan, NT_FORM_LOCAL_EXACT, &contact, indentation).law;
}

static nt_law_value bluntest_at(const nt_plan *plan, double indentation)
{
    const nt_contact contact = nt_plan_contact_of_radius(plan, plan->radii->maximum);
    return nt_plan_local_eval(plan, NT_FORM_LOCAL_EXACT, &contact, indentation).law;
}

/* The difference between two laws of contact over max(|truth|, scale). S is that of the demanded quantity; of a force
 * that is not the one demanded, the pull-off force. `other` NULL: contact in a form. */
typedef struct rivals {
    contact_law *truth, *other;
    nt_quantity quantity;
    nt_form form;
} rivals;

static nt_law_value other_at(const nt_plan *plan, const rivals *laws, double indentation)
{
    return laws->other ? laws->other(plan, indentation) : nt_plan_contact_eval(plan, laws->form, indentation);
}

static double difference(const nt_plan *plan, const rivals *laws, double indentation)
{
    const double scale = laws->quantity == plan->quantity ? plan->scale : pull_of(plan);
    const double truth = nt_plan_pick(laws->truth(plan, indentation), laws->quantity);
    const double other = nt_plan_pick(other_at(plan, laws, indentation), laws->quantity);
    return isnan(other) ? (double)INFINITY : fabs(other - truth) / fmax(fabs(truth), scale); /* it refuses */
}

/* The largest of it over all indentations from the release gap to the largest load; denser near the fold, where they
 * differ most. `lowest`: nothing below this is visited. */
static double distance(const nt_plan *plan, const rivals *laws, double lowest)
{
    enum { SAMPLES = 96 };
    const double fold = -plan->release_gap, deepest = plan->largest_indentation;
    double largest = 0.0;
    for (int i = 1; i <= SAMPLES; ++i) {
        const double t = (double)i / SAMPLES, d = fold + t * t * (deepest - fold);
        if (d >= lowest)
            largest = fmax(largest, difference(plan, laws, d));
    }
    return largest;
}

double nt_plan_contact_distance(const nt_plan *plan, nt_form form)
{
    const rivals laws = {.truth = full_at, .quantity = plan->quantity, .form = form};
    const double begins = nt_plan_away_from_folds(plan) - plan->release_gap;
    return fmax(distance(plan, &laws, -INFINITY), difference(plan, &laws, begins));
}

double nt_plan_away_from_folds(const nt_plan *plan)
{
    const double longest = fmax(fabs(plan->release_gap), plan->length);
    return plan->source == NT_ADHESION_NONE ? 0.0
                                            : AWAY_FROM_FOLDS * longest * nt_plan_largest_unit(plan, NT_QUANTITY_FOLDS);
}

/* Stiffness and radius begin as roots of the distance to the fold or to first touch, which move with the radius: they
 * differ most where the bound begins. */
static double curvature_distance(const nt_plan *plan, const rivals *laws)
{
    if (laws->quantity == NT_QUANTITY_FORCE)
        return distance(plan, laws, -INFINITY);
    const double begins = 2.0 * nt_plan_curvature_shift(plan) + nt_plan_away_from_folds(plan);
    const double fold = begins - plan->release_gap;
    const double touch = begins + plan->maugis.folds.touch_indentation * plan->maugis.indentation_scale;
    const double largest = fmax(distance(plan, laws, fold), difference(plan, laws, fold));
    return touch > fold ? fmax(largest, difference(plan, laws, touch)) : largest;
}

double nt_plan_curvature_distance(const nt_plan *plan)
{
    const nt_quantity quantity = plan->quantity;
    return fmax(curvature_distance(plan, &(rivals){.truth = sharpest_at, .other = full_at, .quantity = quantity}),
                curvature_distance(plan, &(rivals){.truth = bluntest_at, .other = full_at, .quantity = quantity}));
}

void nt_plan_rivals_of(nt_plan *plan)
{
    const double last = 0.9 * plan->maugis.folds.pull_off_indentation * plan->maugis.indentation_scale;
    plan->rivals.hertz = distance(plan, &(rivals){.truth = full_at, .other = hertz_at}, 0.0);
    plan->rivals.dmt = distance(plan, &(rivals){.truth = full_at, .other = dmt_at}, 0.0);
    plan->rivals.jkr = distance(plan, &(rivals){.truth = full_at, .other = jkr_at}, last);
}
