/* SPDX-License-Identifier: BSD-3-Clause
 * A contact with the radius of each place: where it lets go there, and what others need to know of all places. */
#include <math.h>

#include "core/same_bits.h"
#include "internal/contact.h"
#include "internal/maugis.h"
#include "internal/plan.h"
#include "scene/deformation/deform.h"
#include "scene/parts.h"

double nt_plan_release_gap(const nt_plan *plan, const nt_place *place)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    if (place && plan->relief.count > 0 && plan->deformation.holds)
        return nt_deform_relief_fold(plan, place->radius.radius, 1);
    if (!nt_form_is_local(form))
        return plan->release_gap;
    const nt_contact contact = nt_plan_contact_of_place(plan, place);
    return nt_plan_local_release_gap(plan, form, &contact);
}

double nt_plan_largest_ratio(const nt_plan *plan)
{
    return plan->radii ? fmax(1.0, plan->radii->maximum / plan->contact.radius) : 1.0;
}

double nt_plan_contact_reach(const nt_plan *plan)
{
    double reach = fmax(plan->capture_gap, plan->release_gap);
    for (int corner = NT_CORNER_BLUNT; corner < NT_CORNERS && nt_plan_varies(plan); corner += 2) {
        const nt_contact contact = nt_plan_contact_of_corner(plan, corner);
        reach = fmax(reach, nt_plan_local_release_gap(plan, NT_FORM_LOCAL_EXACT, &contact));
    }
    return reach;
}

double nt_plan_curvature_shift(const nt_plan *plan)
{
    if (!plan->radii || nt_plan_contact_form(plan) != NT_FORM_EXACT)
        return 0.0;
    const nt_contact sharp = nt_plan_contact_of_radius(plan, plan->radii->minimum);
    const nt_contact blunt = nt_plan_contact_of_radius(plan, plan->radii->maximum);
    const double sharpest = nt_plan_local_release_gap(plan, NT_FORM_LOCAL_EXACT, &sharp);
    const double bluntest = nt_plan_local_release_gap(plan, NT_FORM_LOCAL_EXACT, &blunt);
    return fmax(fabs(sharpest - plan->release_gap), fabs(bluntest - plan->release_gap));
}

int nt_plan_is_curved(const nt_plan *plan)
{
    const double R = plan->contact.radius;
    return plan->radii && nt_plan_has_local_form(plan) && (plan->radii->minimum != R || plan->radii->maximum != R);
}

/* The least and the largest lambda = 2 sigma0 (R/(pi w K^2))^(1/3), sigma0 ~ w, of all places. */
static void lambdas_of(const nt_plan *plan, double lambda[2])
{
    const nt_contact rigid = nt_plan_contact_of_corner(plan, NT_CORNER_STIFF);
    const nt_contact soft = nt_plan_contact_of_corner(plan, NT_CORNER_BLUNT | NT_CORNER_STICKY);
    lambda[0] = nt_maugis_lambda(&rigid);
    lambda[1] = nt_maugis_lambda(&soft);
}

int nt_plan_wants_bank(const nt_plan *plan, nt_maugis_bank_options *options)
{
    if (!nt_plan_varies(plan) || nt_plan_contact_form(plan) != NT_FORM_EXACT)
        return 0;
    double lambda[2];
    lambdas_of(plan, lambda);
    const double accuracy = plan->accuracy, least = plan->least.radius / plan->contact.radius;
    /* reduced by (pi^2 w^2 R/K^2)^(1/3) of the sharpest place, where the same load goes deeper */
    const double deepest = plan->largest_indentation / plan->maugis.indentation_scale / cube_root(least * least);
    const double first = fmin(fmax(floor(log10(lambda[0] / 1.5)), -15.0), 14.0);
    const double last = fmin(fmax(ceil(log10(lambda[1] * 1.5)), first + 1.0), 15.0);
    *options = nt_maugis_bank_defaults();
    options->lambda_min = pow(10.0, first);
    options->lambda_max = pow(10.0, last);
    options->largest_indentation = pow(10.0, fmin(fmax(ceil(log10(deepest)), 2.0), 5.0));
    options->panels_per_octave = options->cells_per_octave = accuracy > 0.0 && accuracy < 1e-4 ? 8 : 4;
    return 1;
}

static nt_bank_error bank_error(const nt_plan *plan)
{
    double lambda[2];
    lambdas_of(plan, lambda);
    return nt_maugis_bank_error(plan->bank, lambda[0], lambda[1]);
}

#define AWAY_FROM_FOLDS 1e-4 /* reduced: nearer to them the bank has not been measured (contact/maugis/bank.c) */

/* How much more than the plan's own contact one of its own radius can pull. */
static double most_of(const nt_plan *plan)
{
    const double w = plan->most.work_of_adhesion / plan->contact.work_of_adhesion;
    return plan->properties ? 4.0 / 3.0 * w : 1.0;
}

/* The bank's errors are over what its own place has for a scale, and S is that of the plan's own contact: its pull-off
 * force, or its units of stiffness and radius. From the tip's own radius to the bluntest the pull-off force grows no
 * faster than R, with w no faster than w, and from soft to stiff by no more than 4/3 (JKR to DMT). */
double nt_plan_bank_error(const nt_plan *plan, nt_quantity quantity)
{
    const nt_bank_error error = bank_error(plan);
    const double pull = nt_plan_largest_ratio(plan) * most_of(plan) * nt_maugis_pull_off_force(&plan->maugis);
    const double half_shift = 0.5 * error.fold_shift / AWAY_FROM_FOLDS;
    switch (quantity) {
    case NT_QUANTITY_STIFFNESS:
        return (error.stiffness + half_shift) * nt_plan_largest_unit(plan, quantity);
    case NT_QUANTITY_RADIUS:
        return error.radius * nt_plan_largest_unit(plan, quantity);
    case NT_QUANTITY_FOLDS:
        return nt_plan_bank_shift(plan) / plan->scale;
    default:
        return error.force * fmax(1.0, pull / plan->scale);
    }
}

double nt_plan_bank_shift(const nt_plan *plan)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    if (form == NT_FORM_LOCAL_EXACT || plan->source == NT_ADHESION_NONE)
        return 0.0;
    return bank_error(plan).fold_shift * plan->maugis.indentation_scale * nt_plan_largest_unit(plan, NT_QUANTITY_FOLDS);
}

double nt_plan_last_hold(double release_gap)
{
    return release_gap - 1e-12 * fabs(release_gap);
}

/* Pull-off and attraction grow with the radius, no faster than it; stiffness at a load, too, as with modulus and
 * adhesion. */
void nt_plan_local_facts(nt_plan *plan, double maximum_load)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    const nt_contact stiffest = nt_plan_contact_of_corner(plan, NT_CORNERS - 1);
    const double ratio = nt_plan_largest_ratio(plan);
    const double depth = nt_plan_local_depth(plan, form, &stiffest, maximum_load);
    plan->largest_pull_off_force *= ratio;
    plan->minimum_spring *= ratio;
    plan->maximum_stiffness = fmax(plan->maximum_stiffness, nt_plan_local_eval(plan, form, &stiffest, depth).law.k);
    plan->bound.fold_shift = nt_plan_bank_shift(plan);
}
