/* SPDX-License-Identifier: BSD-3-Clause
 * The pressures of all terms of a plan, summed, and what deforms under them; the terms themselves on undeformed bodies.
 */
#include <math.h>

#include "scene/deformation/deform.h"
#include "scene/terms/term.h"

#define STEP 1e-4     /* of a gap: differences */
#define FADED 1e-6    /* of what a law is at half the gap: it ends without a kink */
#define GAPS 1.1      /* ratio of gaps that are looked at */
#define NEAREST 1e-12 /* of them, where laws are not held [m] */
#define PARTS 4.0     /* of a piece of a law of one's own */
#define PIECES 4      /* of such a law, which one step of a table may pass: its narrowest part has more */

/* The piece of a law of one's own that a gap lies in, of which it is the end or within: its ends [m]. */
static int piece_of(const nt_plan *plan, int term, double gap, double ends[2])
{
    const nt_term_row *row = nt_term_rows[term];
    const double *gaps = NULL;
    const int count = row->edges ? row->edges(nt_term_law(plan, term), &gaps) : 0;
    int low = 0, high = count - 1;
    if (count < 2 || !(gap > gaps[low] && gap <= gaps[high]))
        return 0;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        *(gap > gaps[middle] ? &low : &high) = middle;
    }
    ends[0] = gaps[low];
    ends[1] = gaps[high];
    return 1;
}

double nt_elastic_nearer(const nt_plan *plan, double gap)
{
    double nearer = gap / GAPS, ends[2];
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (piece_of(plan, term, gap, ends)) {
            const double part = (ends[1] - ends[0]) / PARTS;
            nearer = fmax(nearer, ends[0] + (ceil((gap - ends[0]) / part - STEP) - 1.0) * part);
        }
    return nearer;
}

nt_law_value nt_elastic_sizes(const nt_plan *plan, int term, double gap)
{
    const nt_law_value value = nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), gap);
    nt_law_value most = {.F = fabs(value.F), .k = fabs(value.k)};
    double ends[2];
    if (piece_of(plan, term, gap, ends)) {
        most.F = fmax(most.F, nt_plan_law_limit(plan, term, ends[1], NT_QUANTITY_FORCE));
        most.k = fmax(most.k, nt_plan_law_limit(plan, term, ends[1], NT_QUANTITY_STIFFNESS));
    }
    return most;
}

/* Up to where no part of it is larger. */
nt_law_value nt_elastic_most(const nt_plan *plan, int term, double gap)
{
    const nt_form form = nt_plan_full_form(plan, term);
    nt_law_value most = nt_elastic_sizes(plan, term, gap);
    for (double g = fmax(gap, NEAREST); g < NT_DEFORM_FARTHEST; g *= GAPS) {
        const double all_F = nt_plan_law_limit(plan, term, g, NT_QUANTITY_FORCE);
        const double all_k = nt_plan_law_limit(plan, term, g, NT_QUANTITY_STIFFNESS);
        if (nt_term_rows[term]->edges || !(all_F > most.F || all_k > most.k))
            break;
        const nt_law_value there = nt_plan_law_eval(plan, term, form, g * GAPS);
        most.F = fmax(most.F, fabs(there.F));
        most.k = fmax(most.k, fabs(there.k));
    }
    return most;
}

nt_elastic_sum nt_elastic_sum_at(const nt_plan *plan, double gap)
{
    nt_elastic_sum s = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0};
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        if (!nt_term_rows[term]->pressure) /* does not press on the sample, as a charge in it */
            continue;
        const nt_law_value value = nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), gap);
        const nt_law_value most = nt_elastic_sizes(plan, term, gap);
        s.F += value.F;
        s.k += value.k;
        s.here_F += fabs(value.F);
        s.here_k += fabs(value.k);
        s.all_F += most.F;
        s.all_k += most.k;
        s.pulls |= value.F < 0.0 || value.k < 0.0;
    }
    return s;
}

double nt_elastic_hold(const nt_plan *plan)
{
    double hold = 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (nt_plan_full_form(plan, term) != NT_FORM_OFF)
            hold = fmax(hold, nt_plan_hold_gap(plan, term));
    return hold;
}

/* Whether a law is one of the tip and not of flats. */
static int is_of_tip(const nt_plan *plan, int term, double gap)
{
    const nt_form form = nt_plan_full_form(plan, term);
    return (form == NT_FORM_SPHERE || form == NT_FORM_TIP) && gap * (1.0 - STEP) > nt_plan_hold_gap(plan, term);
}

/* That of the whole tip, as rigid bodies have it: p = k/(2 pi R). */
static nt_pressure pressure_of_tip(const nt_plan *plan, int term, double gap)
{
    const double per_area = 2.0 * NT_PI * plan->contact.radius, step = STEP * gap;
    const nt_form form = nt_plan_full_form(plan, term);
    const nt_law_value here = nt_plan_law_eval(plan, term, form, gap);
    const double far = nt_plan_law_eval(plan, term, form, gap + step).k;
    const double near = nt_plan_law_eval(plan, term, form, gap - step).k;
    return (nt_pressure){here.F / per_area, here.k / per_area, (far - near) / (2.0 * step * per_area)};
}

static int acts(const nt_deform_terms *in, int term)
{
    const nt_term_row *row = nt_term_rows[term];
    return row->pressure && nt_plan_full_form(in->plan, term) != NT_FORM_OFF && !(in->around && row->words.tail);
}

static nt_pressure terms_at(const void *context, double gap)
{
    const nt_deform_terms *in = context;
    nt_pressure all = {0.0, 0.0, 0.0};
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (acts(in, term)) {
            const nt_pressure p = is_of_tip(in->plan, term, gap + in->hold)
                                      ? pressure_of_tip(in->plan, term, gap + in->hold)
                                      : nt_term_rows[term]->pressure(nt_term_law(in->plan, term), gap + in->hold);
            all.energy += p.energy;
            all.pressure += p.pressure;
            all.slope += p.slope;
        }
    return all;
}

/* The gap under the apex that a step from a gap may reach: as far inwards as it passes few pieces of a law. */
static double reach(const void *context, double gap)
{
    const nt_deform_terms *in = context;
    double nearest = -INFINITY;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        const double *gaps = NULL;
        const nt_term_row *row = nt_term_rows[term];
        int i = acts(in, term) && row->edges ? row->edges(nt_term_law(in->plan, term), &gaps) : 0;
        while (i > 0 && gaps[i - 1] >= gap + in->hold)
            --i;
        if (i >= PIECES)
            nearest = fmax(nearest, gaps[i - PIECES] - in->hold);
    }
    return nearest;
}

/* Where a term ends, as a brush does, and does not only fade, from where the bodies touch [m]; 0 if it goes on. */
static double end_of(const nt_deform_terms *in, int term)
{
    const nt_term_row *row = nt_term_rows[term];
    double low = fmax(in->hold, 1e-11), high = 1e-5;
    if (!acts(in, term) || row->pressure(nt_term_law(in->plan, term), high).energy != 0.0)
        return 0.0;
    for (int i = 0; i < 100; ++i) {
        const double middle = sqrt(low * high);
        *(row->pressure(nt_term_law(in->plan, term), middle).energy == 0.0 ? &high : &low) = middle;
    }
    const double inside = row->pressure(nt_term_law(in->plan, term), 0.9 * high).pressure;
    const double deeper = row->pressure(nt_term_law(in->plan, term), 0.5 * high).pressure;
    return fabs(inside) > FADED * fabs(deeper) ? high - in->hold : 0.0;
}

nt_deform_sample nt_deform_sample_of(const nt_deform_terms *in, const nt_scene *scene, double farthest)
{
    const nt_plan *plan = in->plan;
    const nt_specimen *s = &scene->sample;
    const double compliance = (1.0 - s->poisson_ratio * s->poisson_ratio) / s->youngs_modulus;
    nt_deform_sample sample = {.radius = plan->contact.radius,
                               .modulus = plan->contact.effective_modulus,
                               .thickness = s->thickness,
                               .poisson_ratio = s->poisson_ratio,
                               .share = compliance * plan->contact.effective_modulus,
                               .law = terms_at,
                               .reach = reach,
                               .context = in,
                               .pole = -in->hold};
    const nt_elastic_sum far = nt_elastic_sum_at(plan, farthest);
    sample.length = far.here_F / far.here_k;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        const double end = end_of(in, term);
        if (end > 0.0 && sample.end_count < NT_DEFORM_ENDS)
            sample.ends[sample.end_count++] = end;
    }
    return sample;
}
