/* SPDX-License-Identifier: BSD-3-Clause
 * What it errs by that terms beside contact add on the undeformed gap, where the sample yields (docs/yielding.md).
 *
 * e = k^(3/2)/(E* sqrt(2 R F)), F and k the sums of |F| and |k| of the terms on the undeformed gap, is the deformation
 * under their pressure over its range, as Tabor's number is for adhesion. Beside contact the sum is off by at most
 * 1.025 e/sqrt(2 pi) of F; where something pulls, by 1/sqrt(1 - e/e_c) more, up to the jump at e_c. In contact the
 * pressure around it moves the surface there by u, so that the force falls by k_c u, and by no more than half of F. */
#include <math.h>

#include "scene/terms/term.h"
#include "scene/yield.h"

#define BESIDE 0.409  /* 1.025/sqrt(2 pi) */
#define JUMP 0.55     /* e_c: 0.56 of a pressure as 1/g^3, 0.81 of an exponential */
#define SLOPE 3.0     /* the stiffness is off by so much more than the force, at most */
#define UNDER 0.593   /* u E* sqrt(2 R l)/F under a pressure of range l, at most */
#define HALF 0.55     /* of F, in deep contact */
#define GAPS 1.1      /* ratio of gaps that are looked at */
#define NEAREST 1e-13 /* [m] */
#define FARTHEST 1e-2 /* [m] */
#define DEEPER 1.05   /* than the largest load */

nt_elastic_sum nt_elastic_sum_at(const nt_plan *plan, double gap)
{
    nt_elastic_sum s = {0.0, 0.0, 0.0, 0.0, 0};
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        if (!nt_term_rows[term]->pressure) /* does not press on the sample, as a charge in it */
            continue;
        const nt_law_value value = nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), gap);
        s.F += value.F;
        s.k += value.k;
        s.all_F += fabs(value.F);
        s.all_k += fabs(value.k);
        s.pulls |= value.F < 0.0;
    }
    return s;
}

static double number_of(const nt_plan *plan, const nt_elastic_sum *s)
{
    if (!(s->all_F > 0.0 && s->all_k > 0.0))
        return 0.0;
    return s->all_k * sqrt(s->all_k / s->all_F) / (plan->contact.effective_modulus * sqrt(2.0 * plan->contact.radius));
}

/* What rigid bodies err by, over the sum of |F|; infinite beyond a jump. */
static double share_of(const nt_plan *plan, const nt_elastic_sum *s)
{
    const double e = number_of(plan, s);
    if (!s->pulls)
        return BESIDE * e;
    return e < JUMP ? BESIDE * e / sqrt(1.0 - e / JUMP) : (double)INFINITY;
}

/* The same as a share of the demand. */
double nt_elastic_error(const nt_plan *plan, const nt_elastic_sum *s)
{
    const double share = share_of(plan, s);
    if (share == 0.0)
        return 0.0;
    if (plan->demand.quantity == NT_QUANTITY_STIFFNESS)
        return SLOPE * share * s->all_k / fmax(fabs(s->k), plan->scale);
    return share * s->all_F / fmax(fabs(s->F), plan->scale);
}

double nt_elastic_hold(const nt_plan *plan)
{
    double hold = 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (nt_plan_full_form(plan, term) != NT_FORM_OFF)
            hold = fmax(hold, nt_plan_hold_gap(plan, term));
    return hold;
}

/* By how much the pressure around a contact moves the surface there, at most [m]; of the force just outside it. */
static double under(const nt_plan *plan, nt_law_value value)
{
    if (value.F == 0.0 || value.k == 0.0)
        return 0.0;
    const double width = sqrt(2.0 * plan->contact.radius * fabs(value.F / value.k));
    return UNDER * fabs(value.F) / (plan->contact.effective_modulus * width);
}

/* In contact without adhesion. */
static double error_in_contact(const nt_plan *plan)
{
    const double hold = nt_elastic_hold(plan) * (1.0 + 1e-12);
    const nt_elastic_sum touching = nt_elastic_sum_at(plan, 0.0);
    double u = 0.0, worst = 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        const nt_law_value value = nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), hold);
        u += under(plan, value);
    }
    for (double d = NEAREST; d < plan->largest_indentation && u > 0.0; d *= GAPS) {
        const nt_law_value contact = nt_plan_contact_eval(plan, nt_plan_contact_form(plan), d);
        const double lost = fmin(contact.k * u, HALF * touching.all_F);
        const double error = plan->demand.quantity == NT_QUANTITY_STIFFNESS
                                 ? SLOPE * fmin(lost / d, contact.k) / fmax(contact.k, plan->scale)
                                 : lost / fmax(fabs(contact.F + touching.F), plan->scale);
        worst = fmax(worst, error);
    }
    return worst;
}

/* Between two gaps, of which the nearer one pushes more. */
static double where_force_is(const nt_plan *plan, double force, double nearer, double farther)
{
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (nearer + farther);
        *(nt_elastic_sum_at(plan, middle).F > force ? &nearer : &farther) = middle;
    }
    return nearer;
}

/* Of what is no tail, around an adhesive contact. */
static double error_around(const nt_plan *plan)
{
    double u = 0.0, all = 0.0;
    if (plan->demand.quantity != NT_QUANTITY_FORCE && plan->demand.quantity != NT_QUANTITY_STIFFNESS)
        return 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        if (nt_term_rows[term]->words.tail || !nt_term_rows[term]->pressure)
            continue;
        const nt_form form = nt_plan_full_form(plan, term);
        all += fabs(nt_plan_law_eval(plan, term, form, 0.0).F);
        u += under(plan, nt_plan_law_eval(plan, term, form, nt_plan_hold_gap(plan, term) * (1.0 + 1e-12)));
    }
    const double lost = fmin(plan->maximum_stiffness * u, HALF * all);
    return plan->demand.quantity == NT_QUANTITY_STIFFNESS ? SLOPE * lost / plan->length / plan->scale
                                                          : lost / plan->scale;
}

/* Of a radius or a fold nothing is known beside a jump: what is, is that of contact alone. */
static double error_of(const nt_plan *plan, double worst)
{
    const nt_quantity quantity = (nt_quantity)(int)plan->demand.quantity;
    if (quantity == NT_QUANTITY_FORCE || quantity == NT_QUANTITY_STIFFNESS)
        return worst;
    return plan->source != NT_ADHESION_NONE && isinf(worst) ? worst : 0.0;
}

double nt_plan_rigid_error(nt_plan *plan, const nt_scene *scene)
{
    const double nearest = scene->range.minimum_gap;
    const double outside = nt_elastic_hold(plan) * (1.0 + 1e-12);
    double worst = 0.0;
    plan->elastic_number = 0.0;
    const double last = fmax(fmax(nearest, outside), NEAREST), load = DEEPER * scene->range.maximum_load;
    int touches = plan->source == NT_ADHESION_NONE && nearest <= 0.0;
    for (double gap = FARTHEST; gap > last && touches >= 0;) {
        double next = fmax(gap / GAPS, last);
        if (nt_elastic_sum_at(plan, next).F > load) { /* closer than any load comes */
            next = where_force_is(plan, load, next, gap);
            touches = -1;
        }
        const nt_elastic_sum s = nt_elastic_sum_at(plan, next);
        worst = fmax(worst, nt_elastic_error(plan, &s));
        plan->elastic_number = fmax(plan->elastic_number, number_of(plan, &s));
        gap = next;
    }
    if (touches > 0)
        worst = fmax(worst, error_in_contact(plan));
    plan->around_error = plan->source != NT_ADHESION_NONE && nearest <= 0.0 ? error_around(plan) : 0.0;
    return error_of(plan, worst);
}
