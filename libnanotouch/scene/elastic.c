/* SPDX-License-Identifier: BSD-3-Clause
 * What it errs by that terms beside contact add on the undeformed gap, where the sample deforms (docs/deformation.md).
 *
 * e = k^(3/2)/(E* sqrt(2 R F)), F and k the sums of |F| and |k| of the terms on the undeformed gap, is the deformation
 * under their pressure over its range, as Tabor's number is for adhesion. Beside contact the sum is off by at most
 * 1.025 e/sqrt(2 pi) of F; where something pulls, by 1/sqrt(1 - e/e_c) more, up to the jump at e_c. In contact the
 * pressure around it moves the surface there by u, so that the force falls by k_c u, and by no more than half of F.
 * Folds and contact radius of an adhesive contact are moved by that u, and by what the tail, which is taken out of w,
 * pulls more. Over a surface all is that of the softest place; F and k grow with the radius there, e and u as its root.
 */
#include <math.h>

#include "scene/deformation/deform.h"
#include "scene/terms/term.h"

#define BESIDE 0.409  /* 1.025/sqrt(2 pi) */
#define UNDER 0.637   /* u E* sqrt(2 R l)/F, at most: 2/pi, of a pressure that is even over l */
#define WIDER 0.3     /* u grows by so much e */
#define DEEPER_BY 1.1 /* ratio of indentations that are looked at */
#define NEAREST 1e-13 /* [m] */
#define FARTHEST 1e-2 /* [m] */
#define DEEPER 1.05   /* than the largest load */

static double number_of(const nt_plan *plan, const nt_elastic_sum *s)
{
    if (!(s->all_F > 0.0 && s->all_k > 0.0))
        return 0.0;
    return s->all_k * sqrt(s->all_k / s->all_F) / (plan->contact.effective_modulus * sqrt(2.0 * plan->contact.radius));
}

/* Where the surface is bluntest: F, k and the error in them grow with the radius, e as its root. */
double nt_elastic_bluntest(const nt_plan *plan)
{
    return nt_plan_is_curved(plan) ? nt_plan_largest_ratio(plan) : 1.0;
}

/* What rigid bodies err by, over the sum of |F|, where e is largest; infinite beyond a jump. */
static double share_of(const nt_plan *plan, const nt_elastic_sum *s)
{
    const double e = number_of(plan, s) * sqrt(nt_elastic_bluntest(plan));
    if (!s->pulls)
        return BESIDE * e;
    return e < NT_ELASTIC_JUMP ? BESIDE * e / sqrt(1.0 - e / NT_ELASTIC_JUMP) : (double)INFINITY;
}

/* The same as a share of the demand. */
double nt_elastic_error(const nt_plan *plan, const nt_elastic_sum *s)
{
    const double share = share_of(plan, s), scale = plan->scale, ratio = nt_elastic_bluntest(plan);
    if (share == 0.0)
        return 0.0;
    if (plan->quantity == NT_QUANTITY_STIFFNESS)
        return NT_ELASTIC_SLOPE * share * ratio * s->all_k / fmax(ratio * fabs(s->k), scale);
    return share * ratio * s->all_F / fmax(ratio * fabs(s->F), scale);
}

double nt_plan_jump_gap(const nt_plan *plan)
{
    double gap = FARTHEST;
    while (gap > NEAREST) {
        const double next = nt_elastic_nearer(plan, gap);
        const nt_elastic_sum s = nt_elastic_sum_at(plan, next);
        if (isinf(share_of(plan, &s)))
            break;
        gap = next;
    }
    return gap;
}

/* By how much the pressure around a contact moves the surface there, at most [m]; of the force just outside it. */
static double under(const nt_plan *plan, nt_law_value most)
{
    if (most.F == 0.0 || most.k == 0.0)
        return 0.0;
    const double width = sqrt(2.0 * plan->contact.radius * (most.F / most.k));
    return UNDER * most.F / (plan->contact.effective_modulus * width);
}

/* The sum of that over the terms; with tails or without [m]. Under the apex, where contact takes hold, it grows with e,
 * up to e^2 l/8 of a pressure that is Hertz' own. */
double nt_elastic_under(const nt_plan *plan, int tails)
{
    double u = 0.0;
    nt_elastic_sum s = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0};
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term) {
        if (!nt_term_rows[term]->pressure || (nt_term_rows[term]->words.tail && !tails))
            continue;
        const double hold = nt_plan_hold_gap(plan, term) * (1.0 + 1e-12);
        const nt_law_value most = nt_elastic_most(plan, term, hold);
        u += under(plan, most);
        s.all_F += most.F;
        s.all_k += most.k;
    }
    return u * sqrt(nt_elastic_bluntest(plan)) * (1.0 + WIDER * number_of(plan, &s) * sqrt(nt_elastic_bluntest(plan)));
}

/* Without adhesion, as a share of the demand: sqrt(d) - sqrt(d - u) is largest where contact would begin. */
static double radius_at(const nt_plan *plan, double u)
{
    const double blunter = sqrt(nt_elastic_bluntest(plan));
    return u > 0.0 ? nt_plan_contact_eval(plan, nt_plan_contact_form(plan), u).a * blunter / plan->scale : 0.0;
}

/* The same where the largest load is reached before the bodies touch, at a gap: the surface is pushed so far that
 * undeformed bodies would. */
static double radius_before_contact(const nt_plan *plan, double gap)
{
    double u = 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (nt_term_rows[term]->pressure)
            u += under(plan, nt_elastic_most(plan, term, gap));
    return radius_at(plan, u * sqrt(nt_elastic_bluntest(plan)) - gap);
}

/* They press the surface away by u: sqrt(d) - sqrt(d - u) is largest where contact would begin, for stiffness, too. */
double nt_plan_press_error(const nt_plan *plan)
{
    const double u = nt_elastic_under(plan, 1);
    if (plan->quantity != NT_QUANTITY_STIFFNESS || !(u > 0.0) || plan->source != NT_ADHESION_NONE)
        return 0.0;
    const double k = nt_plan_contact_eval(plan, nt_plan_contact_form(plan), u).k;
    return fmin(k, plan->maximum_stiffness) * sqrt(nt_elastic_bluntest(plan)) / plan->scale;
}

/* In contact without adhesion: a force that is less by k_c u, a radius that is that of an indentation less u. */
static double error_in_contact(const nt_plan *plan)
{
    const nt_elastic_sum touching = nt_elastic_sum_at(plan, 0.0);
    const double u = nt_elastic_under(plan, 1), ratio = nt_elastic_bluntest(plan);
    double worst = 0.0;
    if (plan->quantity == NT_QUANTITY_RADIUS)
        return radius_at(plan, u);
    for (double d = NEAREST; d < plan->largest_indentation && u > 0.0; d *= DEEPER_BY) {
        const nt_law_value contact = nt_plan_contact_eval(plan, nt_plan_contact_form(plan), d);
        const double lost = fmin(sqrt(ratio) * contact.k * u, NT_ELASTIC_HALF * ratio * touching.all_F);
        const double error = plan->quantity == NT_QUANTITY_STIFFNESS
                                 ? NT_ELASTIC_SLOPE * fmin(lost / d, contact.k) / fmax(contact.k, plan->scale)
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

/* By which share of w the tail pulls more than on a surface that keeps still. */
double nt_elastic_more_of_w(const nt_plan *plan)
{
    const double hold = plan->capture_gap * (1.0 + 1e-12);
    const nt_elastic_sum s = nt_elastic_sum_at(plan, hold);
    double tail = 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (nt_term_rows[term]->words.tail)
            tail += fabs(nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), hold).F);
    if (tail == 0.0)
        return 0.0;
    return share_of(plan, &s) * tail / (2.0 * NT_PI * plan->contact.radius * plan->contact.work_of_adhesion);
}

double nt_plan_deform_touch(const nt_plan *plan)
{
    const nt_deform_table *table = plan->relief.count > 0 ? plan->relief.table[0] : &plan->deformation;
    const int touches = table->count > 0 && plan->source == NT_ADHESION_NONE && !isinf(table->touch);
    if (touches && plan->relief.count > 0 && plan->quantity == NT_QUANTITY_STIFFNESS)
        return 2.0 * plan->deformation.jump_error; /* where the laws are held, k jumps */
    if (!touches || plan->quantity != NT_QUANTITY_RADIUS || !(plan->bound.force_error > 0.0))
        return 0.0;
    const double root = 0.5 * plan->deformation.jump_error / plan->bound.force_error;
    return root * root * plan->contact.radius / (plan->scale * plan->scale) + plan->deformation.jump_error;
}

/* Beside contact there is no radius and, but for a jump, no fold. */
static double error_of(const nt_plan *plan, double worst)
{
    const nt_quantity quantity = plan->quantity;
    if (quantity == NT_QUANTITY_FORCE || quantity == NT_QUANTITY_STIFFNESS)
        return worst;
    return isinf(worst) ? worst : 0.0;
}

double nt_plan_rigid_error(nt_plan *plan, const nt_scene *scene)
{
    const double nearest = scene->range.minimum_gap;
    const double outside = nt_elastic_hold(plan) * (1.0 + 1e-12);
    double worst = 0.0, reached = 0.0;
    nt_elastic_sum most = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0};
    plan->elastic_number = 0.0;
    const double last = fmax(fmax(nearest, outside), NEAREST);
    const double load = DEEPER * scene->range.maximum_load;
    const int is_radius = plan->quantity == NT_QUANTITY_RADIUS && plan->source == NT_ADHESION_NONE;
    int touches = plan->source == NT_ADHESION_NONE && nearest <= 0.0;
    for (double gap = FARTHEST; gap > last && touches >= 0;) {
        double next = fmax(nt_elastic_nearer(plan, gap), last);
        if (nt_elastic_sum_at(plan, next).F > load) { /* closer than any load comes */
            reached = next = where_force_is(plan, load, next, gap);
            touches = -1;
        }
        nt_elastic_sum s = nt_elastic_sum_at(plan, next);
        s.all_F = most.all_F = fmax(s.all_F, most.all_F); /* what cancels here presses farther out */
        s.all_k = most.all_k = fmax(s.all_k, most.all_k);
        worst = fmax(worst, nt_elastic_error(plan, &s));
        plan->elastic_number = fmax(plan->elastic_number, number_of(plan, &s));
        gap = next;
    }
    worst = error_of(plan, worst);
    if (touches > 0 && plan->quantity != NT_QUANTITY_FOLDS)
        worst = fmax(worst, error_in_contact(plan));
    if (touches < 0 && is_radius)
        worst = fmax(worst, radius_before_contact(plan, reached));
    const int adheres = plan->source != NT_ADHESION_NONE && plan->visits_contact;
    plan->around_error = adheres ? nt_plan_around_error(plan, 1) : 0.0;
    if (adheres && plan->quantity == NT_QUANTITY_FORCE && isfinite(worst))
        worst = fmax(worst, nt_plan_tail_error(plan));
    return worst;
}
