/* SPDX-License-Identifier: BSD-3-Clause
 * What others need to know of a scene, with everything on: pull-off force, the spring that does not jump in, the energy
 * that each jump costs. */
#include <math.h>

#include "scene/terms/term.h"

/* Everything on, in a polished tier. */
static nt_law_value full_eval(const nt_plan *plan, int attached, double gap)
{
    nt_law_value sum = {0.0, 0.0, 0.0, 0.0};
    if (attached && !plan->deformation.holds)
        sum = nt_plan_contact_eval(plan, nt_plan_contact_truth(plan), -gap);
    const nt_law_value around = nt_plan_around(plan, attached, gap);
    sum.U += around.U;
    sum.F += around.F;
    sum.k += around.k;
    return sum;
}

/* Gaps from `first` to `last`, in even steps or in even ratios. */
typedef struct sweep {
    double first, last;
    int in_ratios;
} sweep;

static double gap_of(const sweep *s, double t)
{
    return s->in_ratios ? s->first * pow(s->last / s->first, t) : s->first + t * (s->last - s->first);
}

/* The largest value above 0 in a sweep: sampled, then refined by golden sections around the largest sample. */
static double largest_of(const nt_plan *plan, nt_plan_gap_law *law, sweep s)
{
    enum { SAMPLES = 96 };
    double best = 0.0, where = 0.0;
    for (int i = 0; i <= SAMPLES; ++i) {
        const double value = law(plan, gap_of(&s, (double)i / SAMPLES));
        if (value > best) {
            best = value;
            where = (double)i / SAMPLES;
        }
    }
    double low = fmax(where - 1.0 / SAMPLES, 0.0), high = fmin(where + 1.0 / SAMPLES, 1.0);
    for (int i = 0; i < 32 && best > 0.0; ++i) {
        const double left = high - 0.6180339887498949 * (high - low), right = low + 0.6180339887498949 * (high - low);
        const double value_left = law(plan, gap_of(&s, left)), value_right = law(plan, gap_of(&s, right));
        best = fmax(best, fmax(value_left, value_right));
        if (value_left > value_right)
            high = right;
        else
            low = left;
    }
    return best;
}

double nt_plan_largest_at_edges(const nt_plan *plan, nt_plan_gap_law *law, double first, double last)
{
    enum { PARTS = 4 };
    double best = 0.0;
    for (int term = 0; term < NT_PLAN_TERMS; ++term) {
        const double *gaps = NULL;
        const int count = nt_term_rows[term]->edges ? nt_term_rows[term]->edges(nt_term_law(plan, term), &gaps) : 0;
        sweep around = {0.0, 0.0, 0};
        for (int i = 1; i < count; ++i)
            for (int j = 0; j < PARTS; ++j) {
                const double width = (gaps[i] - gaps[i - 1]) / PARTS, gap = gaps[i - 1] + j * width;
                const double value = gap >= first && gap <= last ? law(plan, gap) : 0.0;
                if (value > best) {
                    best = value;
                    around = (sweep){fmax(gap - width, first), fmin(gap + width, last), 0};
                }
            }
        if (around.last > 0.0)
            best = fmax(best, largest_of(plan, law, around));
    }
    return best;
}

/* On the way out: in contact as far as the release gap, then apart. */
static double pull_out(const nt_plan *plan, double gap)
{
    return -full_eval(plan, gap <= plan->release_gap, gap).F;
}

/* How steeply attraction grows on the way in: apart as far as the capture gap, then in contact. */
static double growth_in(const nt_plan *plan, double gap)
{
    return -full_eval(plan, gap <= plan->capture_gap, gap).k;
}

#define NEAREST 1e-13 /* sweeps in ratios begin here [m] */

/* The strongest pull in contact: from the release gap to where contact alone carries no load, since below gap 0 nothing
 * else changes; in ratios, too, for terms that change within a nanometre. */
static double strongest_hold(const nt_plan *plan)
{
    const double release = plan->release_gap;
    double deepest = -3.0 * (plan->source == NT_ADHESION_NONE ? plan->contact.radius : fmax(release, 1e-15));
    if (plan->deformation.holds)
        deepest = plan->deformation.last;
    else if (nt_plan_contact_form(plan) == NT_FORM_EXACT)
        deepest = -plan->maugis.folds.zero_load_indentation * plan->maugis.indentation_scale;
    double best = fmax(largest_of(plan, pull_out, (sweep){deepest, release, 0}), pull_out(plan, release));
    if (release > NEAREST)
        best = fmax(best, largest_of(plan, pull_out, (sweep){NEAREST, release, 1}));
    for (int term = 0; term < NT_PLAN_TERMS; ++term) /* the force has a corner there; contact's is first touch */
        best = fmax(best, pull_out(plan, fmin(nt_plan_hold_gap(plan, term), release)));
    return fmax(best, nt_plan_largest_at_edges(plan, pull_out, deepest, release));
}

/* Out of contact, where a barrier may leave a second minimum. */
static double strongest_apart(const nt_plan *plan)
{
    const double first = fmax(plan->release_gap * (1.0 + 1e-12), NEAREST);
    return fmax(largest_of(plan, pull_out, (sweep){first, 1e-2, 1}),
                nt_plan_largest_at_edges(plan, pull_out, first, INFINITY));
}

/* The steepest growth of attraction on approach [N/m]; infinite where the force jumps by more than is demanded (the
 * range of a Dugdale stress always begins with a small fold, P = 128 lambda^3/(9 pi) pi w R). */
static double steepest_pull(const nt_plan *plan)
{
    const double capture = plan->capture_gap, outside = 1.0 + 1e-12;
    const double jump = full_eval(plan, 1, capture).F - full_eval(plan, 0, capture).F;
    if (fabs(jump) > fmax(plan->accuracy, 1e-6) * plan->pull_off_force)
        return INFINITY;
    /* apart; inside the range of adhesion, and as far into contact; it is steepest just outside the gaps where terms
     * are held */
    double steepest = largest_of(plan, growth_in, (sweep){fmax(capture * outside, NEAREST), 1e-2, 1});
    if (capture > NEAREST)
        steepest = fmax(fmax(steepest, largest_of(plan, growth_in, (sweep){-capture, capture, 0})),
                        largest_of(plan, growth_in, (sweep){NEAREST, capture, 1}));
    for (int term = 0; term < NT_PLAN_TERMS; ++term)
        steepest = fmax(steepest, growth_in(plan, nt_plan_hold_gap(plan, term) * outside));
    return fmax(steepest, nt_plan_largest_at_edges(plan, growth_in, -capture, INFINITY));
}

/* By which U in contact lies above that apart [J]. */
static double energy_of_contact(const nt_plan *plan, double gap)
{
    const double contact =
        plan->deformation.holds ? 0.0 : nt_plan_contact_eval(plan, nt_plan_contact_truth(plan), -gap).U;
    return contact + nt_plan_rise(plan, NULL, gap);
}

double nt_plan_known_pull(const nt_plan *plan, double pull)
{
    return pull > nt_plan_table_error(plan, NT_QUANTITY_FORCE) ? pull : 0.0;
}

nt_status nt_plan_facts(nt_plan *plan)
{
    plan->contact_pull = nt_plan_known_pull(plan, strongest_hold(plan));
    plan->pull_off_force = plan->largest_pull_off_force =
        fmax(plan->contact_pull, nt_plan_known_pull(plan, strongest_apart(plan)));
    plan->minimum_spring = steepest_pull(plan);
    if (plan->source != NT_ADHESION_NONE) {
        plan->capture_energy = fmax(0.0, -energy_of_contact(plan, plan->capture_gap));
        plan->release_energy = fmax(0.0, energy_of_contact(plan, nt_plan_last_hold(plan->release_gap)));
    }
    return isfinite(plan->pull_off_force) ? NT_OK : NT_E_NOT_FINITE;
}

/* Of effective radius to the tip's own, where the plan follows it. */
static double largest_ratio(const nt_plan *plan)
{
    return nt_plan_follows(plan) ? nt_plan_largest_ratio(plan) : 1.0;
}

#define BULGED 2.5 /* times as much a surface pulls that bulges, at most, before it jumps (docs/deformation.md) */

/* A bound of |F| at this gap and all larger ones, whatever the history. */
static double force_limit(const nt_plan *plan, double gap)
{
    double sum = 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (plan->terms[term].form != NT_FORM_OFF)
            sum += fmax(nt_plan_law_limit(plan, term, gap, NT_QUANTITY_FORCE),
                        fabs(nt_plan_law_eval(plan, term, plan->terms[term].form, gap).F));
    if (plan->deformation.count > 0 && gap < plan->deformation.first)
        sum *= BULGED;
    return sum * largest_ratio(plan);
}

double nt_plan_cutoff_gap(const nt_plan *plan, double force)
{
    const double release = nt_plan_farthest_release(plan);
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
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (plan->terms[term].form != NT_FORM_OFF)
            stiffest += largest_ratio(plan) * nt_plan_law_limit(plan, term, 0.0, NT_QUANTITY_STIFFNESS);
    return 2.0 * sqrt(mass / stiffest);
}
