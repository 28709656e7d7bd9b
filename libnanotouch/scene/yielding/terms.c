/* SPDX-License-Identifier: BSD-3-Clause
 * The pressures of all terms of a plan, summed, and what yields to them. */
#include <math.h>

#include "scene/terms/term.h"
#include "scene/yielding/yield.h"

#define STEP 1e-4  /* of a gap: differences */
#define FADED 1e-6 /* of what a law is at half the gap: it ends without a kink */

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

static int acts(const nt_yield_terms *in, int term)
{
    const nt_term_row *row = nt_term_rows[term];
    return row->pressure && nt_plan_full_form(in->plan, term) != NT_FORM_OFF && !(in->around && row->words.tail);
}

static nt_pressure terms_at(const void *context, double gap)
{
    const nt_yield_terms *in = context;
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

/* Where a term ends, as a brush does, and does not only fade, from where the bodies touch [m]; 0 if it goes on. */
static double end_of(const nt_yield_terms *in, int term)
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

nt_yield_sample nt_yield_sample_of(const nt_yield_terms *in, const nt_scene *scene, double farthest)
{
    const nt_plan *plan = in->plan;
    const nt_specimen *s = &scene->sample;
    const double compliance = (1.0 - s->poisson_ratio * s->poisson_ratio) / s->youngs_modulus;
    nt_yield_sample sample = {.radius = plan->contact.radius,
                              .modulus = plan->contact.effective_modulus,
                              .thickness = s->thickness,
                              .poisson_ratio = s->poisson_ratio,
                              .share = compliance * plan->contact.effective_modulus,
                              .law = terms_at,
                              .context = in,
                              .pole = -in->hold};
    const nt_elastic_sum far = nt_elastic_sum_at(plan, farthest);
    sample.length = far.all_F / far.all_k;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        const double end = end_of(in, term);
        if (end > 0.0 && sample.end_count < NT_YIELD_ENDS)
            sample.ends[sample.end_count++] = end;
    }
    return sample;
}
