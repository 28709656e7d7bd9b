/* SPDX-License-Identifier: BSD-3-Clause
 * Cuts the force of a plan into cubics.
 *
 * Each piece is Hermite's cubic between two gaps. It is halved until it errs by no more than is allowed: in single
 * precision, at gaps that crowd at both of its ends, so that what bends next to a fold is seen. Where force or slope
 * jump, no piece is narrow enough: there one of some steps of a float stands, and the bound begins behind it. */
#include <float.h>
#include <math.h>

#include "core/problem.h"
#include "internal/contact.h"
#include "nanotouch/advanced/force_table.h"
#include "scene/parts.h"

#define SHARE 0.1       /* of the demand that the table may err by */
#define FINEST 4e-6     /* what single precision can keep [-] */
#define NARROWEST 1e-15 /* a width that no cubic needs to be below [m] ... */
#define STEPS 0x1p-19f  /* ... nor below 16 steps of a float at the gap */
#define FAR 1e-3f       /* a force that is felt beyond this is none of a tip [m] */
#define SMALLEST 1e-24  /* forces whose cubics single precision holds [N] */
#define LARGEST 1e9     /* [N] */
enum { WITHIN = 20, CROWD = 24, SPECIAL_MAX = 2 * NT_PLAN_TERMS + 12 };

/* What is being made. */
typedef struct making {
    nt_force_table *table;
    nt_force_piece *pieces; /* the table's, to be written */
    int capacity, count;
    const nt_plan *plan;
    int attached;                /* which history */
    double accuracy;             /* [-] */
    double special[SPECIAL_MAX]; /* gaps where something may bend, rising [m] */
    int specials;
    int has_holes; /* gaps at which the plan has no force */
} making;

static nt_law_value truth(const making *m, double gap)
{
    const nt_interaction_state state = {.attached = m->attached};
    return nt_interaction_eval_gap(m->plan, &state, NULL, gap);
}

/* Hermite's cubic; where a slope is infinite, that of the chord. */
static nt_force_piece piece_between(const making *m, float from, float to)
{
    const double width = (double)to - (double)from;
    const nt_law_value left = truth(m, from), right = truth(m, to);
    const double rise = right.F - left.F, a = -left.k * width, b = -right.k * width;
    const double begins = isfinite(a) && fabs(a) < LARGEST ? a : rise,
                 ends = isfinite(b) && fabs(b) < LARGEST ? b : rise;
    return (nt_force_piece){
        from,
        (float)(1.0 / width),
        {(float)left.F, (float)begins, (float)(3.0 * rise - 2.0 * begins - ends), (float)(begins + ends - 2.0 * rise)}};
}

/* What single precision may err by between the gaps that are looked at: half of FLT_EPSILON in each of some four steps.
 */
static double rounding_of(const nt_force_piece *piece)
{
    const float *c = piece->cubic;
    return 2.0 * (double)FLT_EPSILON * (double)(fabsf(c[0]) + fabsf(c[1]) + fabsf(c[2]) + fabsf(c[3]));
}

static double error_at(const making *m, const nt_force_piece *piece, float gap)
{
    const nt_force_table one = {.pieces = piece,
                                .contact = m->attached,
                                .apart = !m->attached,
                                .capture_gap = m->attached ? INFINITY : -INFINITY,
                                .farthest = INFINITY};
    int attached = m->attached;
    const double found = (double)nt_force_table_eval(&one, &attached, gap).force, force = truth(m, gap).F;
    return (fabs(found - force) + rounding_of(piece)) / fmax(fabs(force), (double)m->table->scale);
}

/* The largest error on the way from one gap to another: evenly, and ever nearer to both ends. NaN where there is no
 * force. */
static double error_of(const making *m, const nt_force_piece *piece, float from, float to)
{
    double largest = 0.0;
    for (int i = -2 * CROWD; i < WITHIN; ++i) {
        const double near = ldexp(1.0, -(i + 2 * CROWD) / 2 - 1);
        const double u = i >= 0 ? (i + 0.5) / WITHIN : i % 2 ? 1.0 - near : near;
        const float gap = (float)((double)from + u * ((double)to - (double)from));
        if (gap < from || gap >= to)
            continue;
        const double error = error_at(m, piece, gap);
        if (!(error <= largest))
            largest = error;
        if (isnan(error))
            return error;
    }
    return largest;
}

static double narrowest_at(float gap)
{
    return fmax(NARROWEST, (double)(fabsf(gap) * STEPS));
}

static double to_special(const making *m, double gap)
{
    double nearest = INFINITY;
    for (int i = 0; i < m->specials; ++i)
        nearest = fmin(nearest, fabs(gap - m->special[i]));
    return nearest;
}

/* The next piece from `from`, of at most `width`, that errs by little enough; its end. */
static float cut(making *m, float from, double *width, float end)
{
    for (;; *width *= 0.5) {
        const double least = narrowest_at(from);
        const double wanted = fmax(*width, least);
        const float to = (double)end - (double)from <= 1.5 * wanted ? end : (float)((double)from + wanted);
        nt_force_piece piece = piece_between(m, from, to);
        const double error = error_of(m, &piece, from, to);
        if (!(error <= m->accuracy) && wanted > least)
            continue;
        m->has_holes |= isnan(error);
        if (!(error <= m->accuracy)) {
            /* no point of the piece is farther from all specials */
            const double away = 0.5 * (to_special(m, from) + to_special(m, to) + (double)to - (double)from);
            m->table->fold_distance = fmaxf(m->table->fold_distance, (float)(away * 1.001));
        } else {
            m->table->bound = fmaxf(m->table->bound, (float)error);
        }
        m->pieces[m->count++] = piece;
        *width = 2.0 * wanted;
        return to;
    }
}

/* All pieces of a history between two gaps. NT_E_CAPACITY. */
static nt_status cut_all(making *m, float from, float to)
{
    for (int i = 0; i <= m->specials && from < to; ++i) {
        const float end = i < m->specials && m->special[i] < (double)to ? (float)m->special[i] : to;
        for (double width = (double)end - (double)from; from < end;) {
            if (m->count == m->capacity)
                return NT_E_CAPACITY;
            from = cut(m, from, &width, end);
        }
    }
    return NT_OK;
}

static void add_special(making *m, double gap)
{
    int at = m->specials;
    if (!isfinite(gap) || at == SPECIAL_MAX)
        return;
    for (; at > 0 && m->special[at - 1] > gap; --at)
        m->special[at] = m->special[at - 1];
    m->special[at] = gap;
    ++m->specials;
}

static void find_specials(making *m)
{
    const nt_plan *plan = m->plan;
    const double more[] = {0.0,
                           plan->capture_gap,
                           plan->release_gap,
                           plan->deformation.touch,
                           plan->deformation.first,
                           plan->deformation.hold,
                           plan->deformation.release};
    for (size_t i = 0; i < sizeof more / sizeof *more - (plan->deformation.count > 0 ? 0 : 4); ++i)
        add_special(m, more[i]);
    for (int term = 0; term < NT_PLAN_TERMS; ++term)
        if (term != NT_PLAN_CONTACT)
            add_special(m, nt_plan_hold_gap(plan, term));
}

static float at_most(double gap)
{
    const float near = (float)gap;
    return (double)near > gap ? nextafterf(near, -INFINITY) : near;
}

static nt_status refuse(nt_problem *problem, nt_problem_code why, nt_status status)
{
    (void)nt_problem_refuse(problem, (nt_problem){.code = why});
    return status;
}

/* By how much a plan's own table of Maugis' contact may jump between two cells: no sample of them sees all. */
static double jump_of(const nt_plan *plan, double scale)
{
    if (plan->terms[NT_PLAN_CONTACT].form != NT_FORM_TABLE)
        return 0.0;
    const double share = fmax(1.0, nt_maugis_pull_off_force(&plan->maugis) / scale);
    return 2.0 * plan->table.accuracy[NT_TIER_TABLE].force_error * share;
}

/* Where the table ends; and its scale. A plan without contact is apart everywhere. */
static void measure(making *m)
{
    const nt_plan *plan = m->plan;
    nt_force_table *t = m->table;
    const int touches = plan->terms[NT_PLAN_CONTACT].form != NT_FORM_OFF;
    const double load = fabs(truth(m, -plan->largest_indentation).F);
    t->scale = (float)(plan->quantity == NT_QUANTITY_FORCE ? plan->scale : nt_plan_force_scale(plan, load));
    t->capture_gap = touches ? at_most(plan->capture_gap) : -INFINITY;
    t->release_gap = touches ? at_most(fmax(plan->capture_gap, plan->release_gap)) : -INFINITY;
    t->farthest = (float)nt_plan_cutoff_gap(plan, 0.5 * m->accuracy * (double)t->scale);
    t->bound = (float)(0.5 * m->accuracy); /* of what is left out beyond */
}

/* Both histories. */
static nt_status cut_table(making *m, float deepest)
{
    nt_force_table *t = m->table;
    const int touches = isfinite(t->capture_gap);
    nt_status status = touches ? cut_all(m, deepest, t->release_gap) : NT_OK;
    t->contact = m->count;
    m->attached = 0;
    if (status == NT_OK)
        status = cut_all(m, touches ? nextafterf(t->capture_gap, INFINITY) : deepest, t->farthest);
    if (status == NT_OK && m->count == 0) /* nothing is felt anywhere: a table has one piece at least */
        m->pieces[m->count++] = (nt_force_piece){deepest, 1.0f, {0.0f}};
    t->apart = m->count - t->contact;
    t->bound = (float)(NT_SAMPLED * (double)t->bound + jump_of(m->plan, (double)t->scale));
    return status;
}

nt_status nt_force_table_make(nt_force_table *table, nt_force_piece *pieces, int capacity, const nt_plan *plan,
                              nt_problem *problem)
{
    if (!table || !pieces || !plan || capacity < 1)
        return NT_E_ARGUMENT;
    nt_force_table made = {.pieces = pieces};
    making m = {&made, pieces, capacity, 0, plan, 1, FINEST, {0.0}, 0, 0};
    if (plan->quantity == NT_QUANTITY_FORCE)
        m.accuracy = fmax(SHARE * plan->accuracy, FINEST);
    if (plan->surface)
        return refuse(problem, NT_PROBLEM_FORCE_TABLE_SURFACE, NT_E_RANGE);
    if (plan->history == NT_HISTORY_DENTS)
        return refuse(problem, NT_PROBLEM_FORCE_TABLE_DENTS, NT_E_RANGE);
    if (plan->history == NT_HISTORY_RELAXES)
        return refuse(problem, NT_PROBLEM_FORCE_TABLE_RELAXES, NT_E_RANGE);
    measure(&m);
    const float deepest = (float)-plan->largest_indentation;
    const double largest = fabs(truth(&m, (double)deepest).F);
    if (!((double)made.scale >= SMALLEST && (double)made.scale <= LARGEST && largest <= LARGEST))
        return refuse(problem, NT_PROBLEM_FORCE_TABLE_SINGLE, NT_E_RANGE);
    if (!(made.farthest <= FAR))
        return refuse(problem, NT_PROBLEM_FORCE_TABLE_FAR, NT_E_RANGE);
    find_specials(&m);
    const nt_status status = cut_table(&m, deepest);
    if (status != NT_OK)
        return refuse(problem, NT_PROBLEM_FORCE_TABLE_PIECES, status);
    if (m.has_holes)
        return refuse(problem, NT_PROBLEM_FORCE_TABLE_HOLES, NT_E_NO_SOLUTION);
    *table = made;
    return NT_OK;
}
