/* SPDX-License-Identifier: BSD-3-Clause
 * What is not quite right of an adhesive contact with laws around it: where it is, since their pressure moves the
 * surface by u, and its w, of which the tail pulls a part that is known to an error. Folds and radius move with both,
 * the force most beside the folds, where it goes as a root. */
#include <math.h>

#include "internal/contact.h"
#include "scene/deformation/deform.h"
#include "scene/terms/term.h"

#define INSIDE_FOLD 0.2 /* of the range of adhesion: nearer, the loss over that range tells more */
#define MOST_OF_W 0.5   /* share of w that may be wrong */
#define OF_TABLE 0.04   /* of a table's bound: what its last force errs by, its best; far from a jump (plan_pairs.py) */
#define SAFE 0.05       /* the same beside a jump, of 1 - e/e_c */
#define LITTLE 0.1      /* of that bound: what is lost beside the folds */
#define FARTHEST_DOUBT 0.02 /* of the release gap */

/* Laws around a contact that are no tail: where they are held, and their net force at a gap [N]. */
static nt_elastic_sum others_at_hold(const nt_plan *plan)
{
    nt_elastic_sum s = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0};
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (!nt_term_rows[term]->words.tail && nt_term_rows[term]->pressure) {
            const double F = nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), 0.0).F;
            s.F += F;
            s.all_F += fabs(F);
        }
    return s;
}

static double others_at(const nt_plan *plan, double gap)
{
    double F = 0.0;
    for (int term = NT_PLAN_CONTACT + 1; term < NT_PLAN_TERMS; ++term)
        if (!nt_term_rows[term]->words.tail && nt_term_rows[term]->pressure)
            F += nt_plan_law_eval(plan, term, nt_plan_full_form(plan, term), gap).F;
    return F;
}

static double shift_by(const nt_plan *plan, double u, double more)
{
    if (more > MOST_OF_W)
        return INFINITY;
    return (u + more * fabs(plan->release_gap)) * nt_plan_largest_unit(plan, NT_QUANTITY_FOLDS);
}

static double shift_of(const nt_plan *plan, int tails)
{
    return shift_by(plan, nt_elastic_under(plan, 0), tails ? nt_elastic_more_of_w(plan) : 0.0);
}

double nt_plan_rigid_shift(const nt_plan *plan)
{
    if (plan->source == NT_ADHESION_NONE || plan->deformation.holds)
        return 0.0;
    if (plan->deformation.count > 0)
        return shift_by(plan, nt_elastic_under(plan, 0), plan->deformation.doubt);
    return shift_of(plan, 1);
}

/* Of an adhesive contact with another w, at an indentation; NaN beyond its fold. */
static nt_law_value contact_with(const nt_plan *plan, double more, double indentation)
{
    nt_contact contact = plan->contact;
    contact.work_of_adhesion *= 1.0 + more;
    contact.cohesive_stress *= 1.0 + more;
    nt_maugis maugis;
    nt_law_value value = {NAN, NAN, NAN, NAN};
    if (nt_maugis_init(&maugis, &contact) == NT_OK)
        (void)nt_maugis_eval(&maugis, indentation, NT_BRANCH_STABLE, &value, NULL);
    return value;
}

/* The force of the contact with w less by what some force at hold takes of it, and without [N]; NaN: nothing holds. */
static double force_taken(const nt_plan *plan, double taken, double indentation, double alone)
{
    const double full = 2.0 * NT_PI * plan->contact.radius * plan->contact.work_of_adhesion;
    return contact_with(plan, -taken / full, indentation).F - alone;
}

/* A contact that is pulled out has a neck, and beside it the gap is far less than that of undeformed bodies: laws of
 * short range act there in full, as a part of w. By how much the force is off then, at most [N]. Laws that take all of
 * w reach far: only what they grow by from the undeformed gap to the neck's is not in the sum already. */
static double error_of_neck(const nt_plan *plan)
{
    enum { SAMPLES = 48 };
    const nt_elastic_sum held = others_at_hold(plan);
    const double beside = NT_ELASTIC_BESIDE * shift_of(plan, 0) + nt_plan_away_from_folds(plan);
    const double fold = beside - plan->release_gap;
    double worst = 0.0;
    if (held.all_F == 0.0 || nt_plan_contact_form(plan) != NT_FORM_EXACT)
        return 0.0;
    for (int i = 0; i <= SAMPLES && fold < 0.0; ++i) {
        const double t = (double)i / SAMPLES, d = fold * (1.0 - t * t * t);
        const nt_law_value alone = contact_with(plan, 0.0, d);
        if (!(alone.a > 0.0))
            continue;
        const double others = others_at(plan, -d);
        double off = force_taken(plan, held.F, d, alone.F) - others;
        if (isnan(off))
            off = force_taken(plan, held.F - others, d, alone.F);
        worst = fmax(worst, isnan(off) ? (double)INFINITY : fabs(off));
    }
    return NT_SAMPLED * worst;
}

/* One of 2 DEPTHS + 1 indentations, from so far inside the fold to the largest load: they crowd there and `beside`
 * first touch, since stiffness and radius go as roots there. */
enum { DEPTHS = 48 };
static double depth_at(const nt_plan *plan, double inside, double beside, int i)
{
    const double fold = inside - plan->release_gap;
    const double touch = fmax(plan->maugis.folds.touch_indentation * plan->maugis.indentation_scale + beside, fold);
    const double t = fabs((double)i / DEPTHS - 1.0), deepest = fmax(plan->largest_indentation, touch), s = 1.0 - t;
    const double before = fmax(touch - 2.0 * beside, fold);
    return i < DEPTHS ? fold + s * s * s * (before - fold) : touch + t * t * t * (deepest - touch);
}

/* What is not quite right of an adhesive contact: where it is, by u [m], and its w, by a share that the tail pulls more
 * or less. The contact with it and with more and less w. */
typedef struct nt_elastic_doubt {
    double u, more;
    int known; /* 0: there is no such contact */
    nt_maugis as, wider, narrower;
} doubt;

static doubt doubt_of(const nt_plan *plan, double u, double more)
{
    doubt of = {.u = u, .more = more, .known = nt_plan_contact_form(plan) == NT_FORM_EXACT, .as = plan->maugis};
    for (int wider = 0; wider < 2 && of.known; ++wider) {
        nt_contact contact = plan->contact;
        contact.work_of_adhesion *= wider ? 1.0 + more : 1.0 - more;
        contact.cohesive_stress *= wider ? 1.0 + more : 1.0 - more;
        of.known = nt_maugis_init(wider ? &of.wider : &of.narrower, &contact) == NT_OK;
    }
    return of;
}

/* By how much a value is off at an indentation. A force that gives way is not more than half lost by u. What w has less
 * of the tail pulls more: as much inside the gap where adhesion takes hold, between that and nothing in a neck. */
static double off_at(const nt_plan *plan, const doubt *of, double d, double u)
{
    const nt_quantity quantity = plan->quantity;
    const int is_force = quantity == NT_QUANTITY_FORCE;
    nt_law_value as = {NAN, NAN, NAN, NAN}, wider = as, narrower = as;
    (void)nt_maugis_eval(&of->as, d, NT_BRANCH_STABLE, &as, NULL);
    const double moved = is_force && as.k > 0.0 ? 0.0 : u;
    (void)nt_maugis_eval(&of->wider, d + moved, NT_BRANCH_STABLE, &wider, NULL);
    (void)nt_maugis_eval(&of->narrower, d - moved, NT_BRANCH_STABLE, &narrower, NULL);
    const double value = nt_plan_pick(as, quantity);
    const double up = nt_plan_pick(wider, quantity) - value, down = value - nt_plan_pick(narrower, quantity);
    const double tail = is_force ? 2.0 * NT_PI * plan->contact.radius * plan->contact.work_of_adhesion * of->more : 0.0;
    double off = fmax(fabs(up + tail), fabs(down + tail));
    if (-d > plan->capture_gap)
        off = fmax(off, fmax(fabs(up), fabs(down)));
    return off / fmax(fabs(value), plan->scale);
}

/* The largest of it from where the bound begins, `beside` fold and first touch. Of stiffness the u nearer to the fold
 * is told by what is lost over that range. */
static double error_in_doubt(const nt_plan *plan, const doubt *of, double beside)
{
    const nt_quantity quantity = plan->quantity;
    const double inside = quantity == NT_QUANTITY_STIFFNESS ? INSIDE_FOLD * plan->length : 0.0;
    double worst = 0.0;
    for (int i = 0; i <= 2 * DEPTHS; ++i) {
        const double d = depth_at(plan, beside, beside, i);
        worst = fmax(worst, off_at(plan, of, d, d + plan->release_gap < inside ? 0.0 : of->u));
    }
    return NT_SAMPLED * worst *
           (quantity == NT_QUANTITY_RADIUS ? nt_plan_largest_unit(plan, quantity) : nt_elastic_bluntest(plan));
}

/* What the pressure around an adhesive contact and a w that is not quite right do to it. Of force the latter is what
 * the tail pulls more, and a part of what laws on the undeformed gap err by. */
static double error_of_contact(const nt_plan *plan, double u, double more)
{
    const nt_quantity quantity = plan->quantity;
    const double moved = shift_by(plan, u, more), beside = NT_ELASTIC_BESIDE * moved + nt_plan_away_from_folds(plan);
    if (u == 0.0 && more == 0.0)
        return 0.0;
    const doubt of = doubt_of(plan, u, more);
    if (!of.known || isinf(moved))
        return quantity == NT_QUANTITY_RADIUS || (isinf(moved) && quantity != NT_QUANTITY_FORCE) ? (double)INFINITY
                                                                                                 : 0.0;
    return error_in_doubt(plan, &of, beside);
}

double nt_plan_tail_error(const nt_plan *plan)
{
    return error_of_contact(plan, 0.0, nt_elastic_more_of_w(plan));
}

/* A tail that goes on into contact from a table pulls so much of w, but for what the table errs by there. Stiffness,
 * radius and force go as roots beside fold and first touch: as far from them as that comes to little. */
double nt_plan_doubt_share(nt_plan *plan, double of_table, double error)
{
    const double pull = 2.0 * NT_PI * plan->contact.radius * plan->contact.work_of_adhesion;
    const int is_felt = plan->quantity != NT_QUANTITY_FOLDS;
    plan->deformation.doubt = plan->deformation.beside = 0.0;
    if (plan->deformation.jumps || plan->deformation.holds || !(nt_plan_deform_share(plan) > 0.0))
        return 0.0;
    const double from_jump = fmax(1.0 - plan->elastic_number / NT_ELASTIC_JUMP, SAFE);
    plan->deformation.doubt = OF_TABLE / sqrt(from_jump) * of_table * nt_plan_force_scale(plan, 0.0) / pull;
    if (plan->deformation.touch > plan->capture_gap * (1.0 + 1e-9)) /* w as rigid bodies have it: laws.c */
        plan->deformation.doubt += nt_elastic_more_of_w(plan);
    if (!plan->visits_contact)
        return 0.0;
    const doubt of = doubt_of(plan, 0.0, plan->deformation.doubt);
    const double fold = shift_by(plan, 0.0, plan->deformation.doubt),
                 farthest = FARTHEST_DOUBT * fabs(plan->release_gap);
    double beside = NT_ELASTIC_BESIDE * fold + nt_plan_away_from_folds(plan);
    double off = is_felt && of.known ? error_in_doubt(plan, &of, beside) : 0.0;
    while (off > LITTLE * error && beside < farthest) {
        beside = fmin(2.0 * beside, farthest);
        off = error_in_doubt(plan, &of, beside);
    }
    plan->deformation.beside = beside;
    return off;
}

/* What the pressure around a contact loses of the force there, k_c u, as a share of the demand: with 2 E* a of a flat
 * punch for k_c where that is more than its own. Where places differ, all of the largest k_c over the scale. */
static double error_of_pressed(const nt_plan *plan)
{
    const double u = nt_elastic_under(plan, 0), most = NT_ELASTIC_HALF * others_at_hold(plan).all_F;
    const double own = plan->maximum_stiffness * u;
    double worst = 0.0;
    if (nt_elastic_bluntest(plan) > 1.0 || plan->properties || nt_plan_contact_form(plan) != NT_FORM_EXACT)
        return fmin(own, most) * nt_elastic_bluntest(plan) / plan->scale;
    for (int i = 0; i <= 2 * DEPTHS; ++i) {
        const double d = depth_at(plan, 0.0, 0.0, i);
        nt_law_value as = {NAN, NAN, NAN, NAN};
        if (nt_maugis_eval(&plan->maugis, d, NT_BRANCH_STABLE, &as, NULL) != NT_OK)
            continue;
        const double k = fmax(as.k, 2.0 * plan->contact.effective_modulus * as.a);
        const double sum = as.F + nt_plan_beside_at(plan, -d).F;
        worst = fmax(worst, fmin(k * u, most) / fmax(fabs(sum), plan->scale));
    }
    return fmin(NT_SAMPLED * worst, most / plan->scale);
}

double nt_plan_around_error(const nt_plan *plan, int tails)
{
    const nt_quantity quantity = plan->quantity;
    if (quantity == NT_QUANTITY_FOLDS)
        return shift_of(plan, tails) / plan->scale;
    const double more = tails && quantity != NT_QUANTITY_FORCE ? nt_elastic_more_of_w(plan) : 0.0;
    const double moved = error_of_contact(plan, nt_elastic_under(plan, 0), more);
    if (quantity == NT_QUANTITY_RADIUS)
        return moved;
    const double neck = error_of_neck(plan) * nt_elastic_bluntest(plan);
    if (quantity == NT_QUANTITY_FORCE)
        return fmax(fmax(error_of_pressed(plan), neck / plan->scale), moved);
    const double pressed =
        fmin(plan->maximum_stiffness * nt_elastic_under(plan, 0), NT_ELASTIC_HALF * others_at_hold(plan).all_F);
    const double lost = fmax(pressed * nt_elastic_bluntest(plan), neck);
    return fmax(NT_ELASTIC_SLOPE * lost / plan->length / plan->scale, moved);
}
