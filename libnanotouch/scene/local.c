/* SPDX-License-Identifier: BSD-3-Clause
 * A contact with the radius of each place: where it lets go there, and what others need to know of all places. */
#include <math.h>

#include "scene/parts.h"

double nt_plan_release_gap(const nt_plan *plan, double radius)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    return nt_form_is_local(form) ? nt_plan_local_release_gap(plan, form, radius) : plan->release_gap;
}

double nt_plan_largest_ratio(const nt_plan *plan)
{
    return plan->radii ? fmax(1.0, plan->radii->maximum / plan->contact.radius) : 1.0;
}

double nt_plan_curvature_shift(const nt_plan *plan)
{
    if (!plan->radii || nt_plan_contact_form(plan) != NT_FORM_EXACT)
        return 0.0;
    const double sharpest = nt_plan_local_release_gap(plan, NT_FORM_LOCAL_EXACT, plan->radii->minimum);
    const double bluntest = nt_plan_local_release_gap(plan, NT_FORM_LOCAL_EXACT, plan->radii->maximum);
    return fmax(fabs(sharpest - plan->release_gap), fabs(bluntest - plan->release_gap));
}

int nt_plan_is_curved(const nt_plan *plan)
{
    const double R = plan->contact.radius;
    return plan->radii && nt_plan_has_local_form(plan) && (plan->radii->minimum != R || plan->radii->maximum != R);
}

int nt_plan_wants_bank(const nt_plan *plan, nt_maugis_bank_options *options)
{
    if (!nt_plan_is_curved(plan) || nt_plan_contact_form(plan) != NT_FORM_EXACT)
        return 0;
    const double R = plan->contact.radius, accuracy = plan->demand.relative_accuracy;
    const double least = plan->radii->minimum / R, largest = plan->radii->maximum / R;
    /* reduced by (pi^2 w^2 R/K^2)^(1/3) of the sharpest place, where the same load goes deeper */
    const double deepest = plan->largest_indentation / plan->maugis.indentation_scale / cbrt(least * least);
    const double first = fmin(fmax(floor(log10(plan->lambda * cbrt(least) / 1.5)), -15.0), 14.0);
    const double last = fmin(fmax(ceil(log10(plan->lambda * cbrt(largest) * 1.5)), first + 1.0), 15.0);
    *options = nt_maugis_bank_defaults();
    options->lambda_min = pow(10.0, first);
    options->lambda_max = pow(10.0, last);
    options->largest_indentation = pow(10.0, fmin(fmax(ceil(log10(deepest)), 2.0), 5.0));
    options->panels_per_octave = options->cells_per_octave = accuracy > 0.0 && accuracy < 1e-4 ? 8 : 4;
    return 1;
}

/* Over the lambdas of the surface, lambda ~ R^(1/3). */
static nt_bank_error bank_error(const nt_plan *plan)
{
    const double R = plan->contact.radius;
    return nt_maugis_bank_error(plan->bank, plan->lambda * cbrt(plan->radii->minimum / R),
                                plan->lambda * cbrt(plan->radii->maximum / R));
}

#define AWAY_FROM_FOLDS 1e-4 /* reduced: nearer to them the bank has not been measured (contact/maugis_bank.c) */

/* The bank's errors are over what its own place has for a scale. From the tip's own radius to the bluntest the pull-off
 * force grows no faster than R; the units of stiffness and radius as R^(2/3), and S is at least these of R. */
double nt_plan_bank_error(const nt_plan *plan, nt_quantity quantity)
{
    const nt_bank_error error = bank_error(plan);
    const double pull = nt_plan_largest_ratio(plan) * nt_maugis_pull_off_force(&plan->maugis);
    const double half_shift = 0.5 * error.fold_shift / AWAY_FROM_FOLDS;
    switch (quantity) {
    case NT_QUANTITY_STIFFNESS:
        return (error.stiffness + half_shift) * cbrt(nt_plan_largest_ratio(plan) * nt_plan_largest_ratio(plan));
    case NT_QUANTITY_RADIUS:
        return error.radius * cbrt(nt_plan_largest_ratio(plan) * nt_plan_largest_ratio(plan));
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
    return bank_error(plan).fold_shift * plan->maugis.indentation_scale * cbrt(nt_plan_largest_ratio(plan));
}

double nt_plan_last_hold(double release_gap)
{
    return release_gap - 1e-12 * fabs(release_gap);
}

/* Stiffness where the contact carries `load` at a radius: bracketed upwards from first touch, then bisected. */
static double stiffness_at(const nt_plan *plan, double radius, double load)
{
    const nt_form form = plan->terms[NT_PLAN_CONTACT].form;
    double low = 0.0, high = plan->largest_indentation;
    for (int i = 0; i < 64 && nt_plan_local_eval(plan, form, radius, high).law.F < load; ++i) {
        low = high;
        high *= 2.0;
    }
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        if (nt_plan_local_eval(plan, form, radius, middle).law.F < load)
            low = middle;
        else
            high = middle;
    }
    return nt_plan_local_eval(plan, form, radius, high).law.k;
}

/* Pull-off and attraction grow with the radius, no faster than it; stiffness at a load, too. */
void nt_plan_local_facts(nt_plan *plan, double maximum_load)
{
    const double bluntest = plan->radii->maximum, ratio = nt_plan_largest_ratio(plan);
    plan->largest_pull_off_force *= ratio;
    plan->minimum_spring *= ratio;
    plan->maximum_stiffness = fmax(plan->maximum_stiffness, stiffness_at(plan, bluntest, maximum_load));
    plan->bound.fold_shift = nt_plan_bank_shift(plan);
}
