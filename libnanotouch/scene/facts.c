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

/* Gaps from `first` to `last`, in even steps or in even ratios. */
typedef struct sweep {
    double first, last;
    int in_ratios;
} sweep;

/* The pull on the way out at t in 0..1 of a sweep: in contact as far as the release gap, then apart. */
static double pull_at(const nt_plan *plan, const sweep *s, double t)
{
    const double gap = s->in_ratios ? s->first * pow(s->last / s->first, t) : s->first + t * (s->last - s->first);
    return -full_eval(plan, gap <= plan->release_gap, gap).F;
}

/* The strongest pull of a sweep: sampled, then refined by golden sections around the strongest sample. */
static double strongest_of(const nt_plan *plan, const sweep *s)
{
    enum { SAMPLES = 96 };
    double best = 0.0, where = 0.0;
    for (int i = 0; i <= SAMPLES; ++i) {
        const double pull = pull_at(plan, s, (double)i / SAMPLES);
        if (pull > best) {
            best = pull;
            where = (double)i / SAMPLES;
        }
    }
    double low = fmax(where - 1.0 / SAMPLES, 0.0), high = fmin(where + 1.0 / SAMPLES, 1.0);
    for (int i = 0; i < 32 && best > 0.0; ++i) {
        const double left = high - 0.6180339887498949 * (high - low), right = low + 0.6180339887498949 * (high - low);
        const double pull_left = pull_at(plan, s, left), pull_right = pull_at(plan, s, right);
        best = fmax(best, fmax(pull_left, pull_right));
        if (pull_left > pull_right)
            high = right;
        else
            low = left;
    }
    return best;
}

/* In contact, from the release gap to twice that depth; in ratios, too, for terms that change within a nanometre. */
static double strongest_hold(const nt_plan *plan)
{
    const double release = plan->release_gap;
    const double reach = plan->source == NT_ADHESION_NONE ? plan->contact.radius : fmax(release, 1e-15);
    double deepest = -3.0 * reach;
    if (nt_plan_contact_form(plan) == NT_FORM_EXACT)
        deepest = -fmax(reach, 3.0 * fabs(plan->maugis.folds.zero_load_indentation * plan->maugis.indentation_scale));
    const sweep sweeps[] = {
        {deepest, release, 0}, {fmin(1e-13, release), release, release > 1e-13}, {-1e-13, deepest, 1}};
    const double corners[] = {0.0, fmin(plan->capture_gap, release), release, fmin(plan->laws.vdw.minimum_gap, release),
                              fmin(plan->laws.electrostatic.minimum_gap, release)};
    double best = 0.0;
    for (int i = 0; i < 5; ++i)
        best = fmax(best, -full_eval(plan, 1, corners[i]).F);
    for (int i = 0; i < 3; ++i)
        best = fmax(best, strongest_of(plan, &sweeps[i]));
    return best;
}

/* Out of contact, where a barrier may leave a second minimum. */
static double strongest_apart(const nt_plan *plan)
{
    const double nearest = fmax(plan->release_gap * (1.0 + 1e-12), 1e-13);
    const sweep out = {nearest, 1e-2, 1};
    return strongest_of(plan, &out);
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
    plan->contact_pull = strongest_hold(plan);
    plan->pull_off_force = plan->largest_pull_off_force = fmax(plan->contact_pull, strongest_apart(plan));
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
