/* SPDX-License-Identifier: BSD-3-Clause
 * What others need to know of a scene, with everything on: pull-off force, the spring that does not jump in, the energy
 * that each jump costs. */
#include <math.h>

#include "scene/parts.h"

/* Everything on, in a polished tier. */
static nt_law_value full_eval(const nt_plan *plan, int attached, double gap)
{
    nt_law_value sum = {0.0, 0.0, 0.0, 0.0};
    if (attached) {
        const nt_form form = nt_plan_contact_form(plan);
        sum = nt_plan_contact_eval(plan, form == NT_FORM_EXACT ? NT_FORM_POLISHED : form, -gap);
    }
    for (int term = NT_PLAN_VDW; term < NT_PLAN_TERMS; ++term) {
        const nt_law_value value = nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), gap);
        sum.U += value.U;
        sum.F += value.F;
        sum.k += value.k;
    }
    return sum;
}

/* The strongest pull on the attached branch: sampled between the release gap and twice that depth, then refined. */
static double strongest_pull(const nt_plan *plan)
{
    enum { SAMPLES = 96 };
    const double reach = plan->source == NT_ADHESION_NONE ? plan->contact.radius : fmax(plan->release_gap, 1e-15);
    double deepest = -3.0 * reach;
    if (nt_plan_contact_form(plan) == NT_FORM_EXACT)
        deepest = -fmax(reach, 3.0 * fabs(plan->maugis.folds.zero_load_indentation * plan->maugis.indentation_scale));
    const double step = (plan->release_gap - deepest) / SAMPLES;
    double best = 0.0, where = plan->capture_gap;
    const double corners[] = {0.0, plan->capture_gap, plan->release_gap};
    for (int i = 0; i < SAMPLES + 3; ++i) {
        const double gap = i < SAMPLES ? deepest + i * step : corners[i - SAMPLES];
        const double pull = -full_eval(plan, 1, gap).F;
        if (pull > best) {
            best = pull;
            where = gap;
        }
    }
    double low = where - step, high = fmin(where + step, plan->release_gap);
    for (int i = 0; i < 48; ++i) { /* golden section */
        const double left = high - 0.6180339887498949 * (high - low), right = low + 0.6180339887498949 * (high - low);
        const double pull_left = -full_eval(plan, 1, left).F, pull_right = -full_eval(plan, 1, right).F;
        best = fmax(best, fmax(pull_left, pull_right));
        if (pull_left > pull_right)
            high = right;
        else
            low = left;
    }
    return best;
}

/* The steepest growth of attraction on approach [N/m]; infinite where the force jumps by more than is demanded (the
 * range of a Dugdale stress always begins with a small fold, P = 128 lambda^3/(9 pi) pi w R). */
static double steepest_pull(const nt_plan *plan)
{
    const double jump = full_eval(plan, 1, plan->capture_gap).F - full_eval(plan, 0, plan->capture_gap).F;
    if (fabs(jump) > fmax(plan->demand.relative_accuracy, 1e-6) * plan->pull_off_force)
        return INFINITY;
    double steepest = 0.0;
    for (double gap = 1e-2; gap > fmax(plan->capture_gap, 1e-13); gap *= 0.9)
        steepest = fmax(steepest, -full_eval(plan, 0, gap).k);
    for (int i = 0; i <= 64; ++i) { /* inside the range of adhesion, and a little into contact */
        const double gap = plan->capture_gap * (1.0 - i / 32.0);
        steepest = fmax(steepest, -full_eval(plan, 1, gap).k);
    }
    const double holds[] = {plan->laws.vdw.minimum_gap, plan->laws.electrostatic.minimum_gap};
    for (int i = 0; i < 2; ++i) /* it is steepest just outside the gaps where terms are held */
        if (holds[i] > plan->capture_gap)
            steepest = fmax(steepest, -full_eval(plan, 0, holds[i] * (1.0 + 1e-12)).k);
    return steepest;
}

nt_status nt_plan_facts(nt_plan *plan)
{
    plan->pull_off_force = plan->largest_pull_off_force = strongest_pull(plan);
    plan->minimum_spring = steepest_pull(plan);
    if (plan->source != NT_ADHESION_NONE) {
        const nt_form form = nt_plan_contact_form(plan) == NT_FORM_EXACT ? NT_FORM_POLISHED : NT_FORM_JKR;
        plan->capture_energy = fmax(0.0, -nt_plan_contact_eval(plan, form, -plan->capture_gap).U);
        plan->release_energy = fmax(0.0, nt_plan_contact_eval(plan, form, -nt_plan_last_hold(plan->release_gap)).U);
    }
    return isfinite(plan->pull_off_force) ? NT_OK : NT_E_NOT_FINITE;
}

/* Of effective radius to the tip's own, where the plan follows it. */
static double largest_ratio(const nt_plan *plan)
{
    return nt_form_is_local(plan->terms[NT_PLAN_CONTACT].form) ? nt_plan_largest_ratio(plan) : 1.0;
}

/* A bound of |F| at this gap and all larger ones, whatever the history. */
static double force_limit(const nt_plan *plan, double gap)
{
    double sum = 0.0;
    for (int term = NT_PLAN_VDW; term < NT_PLAN_TERMS; ++term)
        if (plan->terms[term].form != NT_FORM_OFF)
            sum += fmax(nt_plan_law_limit(plan, term, gap, NT_QUANTITY_FORCE),
                        fabs(nt_plan_law_eval(plan, term, plan->terms[term].form, gap).F));
    return sum * largest_ratio(plan);
}

double nt_plan_cutoff_gap(const nt_plan *plan, double force)
{
    const double release = nt_plan_release_gap(plan, plan->contact.radius * largest_ratio(plan));
    double low = fmax(fmax(release, plan->capture_gap), 0.0), high = fmax(2.0 * low, 1e-9);
    if (!(force >= 0.0))
        return NAN;
    if (force_limit(plan, low) <= force)
        return low;
    while (force_limit(plan, high) > force) {
        low = high;
        high *= 2.0;
        if (high > 1e3)
            return INFINITY;
    }
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        if (force_limit(plan, middle) > force)
            low = middle;
        else
            high = middle;
    }
    return high;
}

double nt_plan_stable_step(const nt_plan *plan, double mass)
{
    double stiffest = plan->maximum_stiffness;
    for (int term = NT_PLAN_VDW; term < NT_PLAN_TERMS; ++term)
        if (plan->terms[term].form != NT_FORM_OFF)
            stiffest += largest_ratio(plan) * nt_plan_law_limit(plan, term, 0.0, NT_QUANTITY_STIFFNESS);
    return 2.0 * sqrt(mass / stiffest);
}
