/* SPDX-License-Identifier: BSD-3-Clause
 * A contact with the radius of each place: where it lets go there, and what others need to know of all places. */
#include <math.h>

#include "scene/parts.h"

double nt_plan_release_gap(const nt_plan *plan, double radius)
{
    if (plan->terms[NT_PLAN_CONTACT].form != NT_FORM_LOCAL)
        return plan->release_gap;
    nt_contact contact = plan->contact;
    contact.radius = radius;
    return -nt_maugis_bank_grip_indentation(plan->bank, &contact);
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
    plan->pull_off_force *= ratio;
    plan->minimum_spring *= ratio;
    plan->maximum_stiffness = fmax(plan->maximum_stiffness, stiffness_at(plan, bluntest, maximum_load));
    if (plan->source == NT_ADHESION_NONE)
        return;
    nt_contact contact = plan->contact;
    contact.radius = bluntest;
    nt_maugis maugis;
    if (nt_maugis_init(&maugis, &contact) == NT_OK)
        plan->bound.fold_shift = plan->bank->accuracy.fold_shift * maugis.indentation_scale;
}
