/* SPDX-License-Identifier: BSD-3-Clause
 * A contact with the radius of each place: where it lets go there, and what others need to know of all places. */
#include <math.h>

#include "scene/parts.h"

static double local_release_gap(const nt_plan *plan, double radius)
{
    nt_contact contact = plan->contact;
    contact.radius = radius;
    return -nt_maugis_bank_grip_indentation(plan->bank, &contact);
}

double nt_plan_release_gap(const nt_plan *plan, double radius)
{
    const int local = plan->terms[NT_PLAN_CONTACT].form == NT_FORM_LOCAL;
    return local ? local_release_gap(plan, radius) : plan->release_gap;
}

double nt_plan_curvature_shift(const nt_plan *plan)
{
    if (!plan->radii || !plan->bank || nt_plan_contact_form(plan) != NT_FORM_EXACT)
        return 0.0;
    return fmax(fabs(local_release_gap(plan, plan->radii->minimum) - plan->release_gap),
                fabs(local_release_gap(plan, plan->radii->maximum) - plan->release_gap));
}

double nt_plan_bank_shift(const nt_plan *plan)
{
    if (nt_plan_contact_form(plan) != NT_FORM_EXACT)
        return 0.0;
    const double ratio = fmax(1.0, plan->radii->maximum / plan->contact.radius);
    return plan->bank->accuracy.fold_shift * plan->maugis.indentation_scale * cbrt(ratio);
}

double nt_plan_last_hold(double release_gap)
{
    return release_gap - 1e-12 * fabs(release_gap);
}

/* Stiffness where the contact carries `load` at a radius: bracketed upwards from first touch, then bisected. */
static double stiffness_at(const nt_plan *plan, double radius, double load)
{
    double low = 0.0, high = plan->largest_indentation;
    for (int i = 0; i < 64 && nt_plan_local_eval(plan, radius, high).law.F < load; ++i) {
        low = high;
        high *= 2.0;
    }
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        if (nt_plan_local_eval(plan, radius, middle).law.F < load)
            low = middle;
        else
            high = middle;
    }
    return nt_plan_local_eval(plan, radius, high).law.k;
}

/* Pull-off and attraction grow with the radius, no faster than it; stiffness at a load, too. */
void nt_plan_local_facts(nt_plan *plan, double maximum_load)
{
    const double bluntest = plan->radii->maximum, ratio = fmax(1.0, bluntest / plan->contact.radius);
    plan->largest_pull_off_force *= ratio;
    plan->minimum_spring *= ratio;
    plan->maximum_stiffness = fmax(plan->maximum_stiffness, stiffness_at(plan, bluntest, maximum_load));
    plan->bound.fold_shift = nt_plan_bank_shift(plan);
}
