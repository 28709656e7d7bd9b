/* SPDX-License-Identifier: BSD-3-Clause
 * The motion that a lever comes to on its way down or up: along a stable branch to the target, or to the branch's end,
 * where it goes over to the one of the largest amplitude at that height. */
#include <math.h>
#include <stddef.h>

#include "motion.h"
#include "scan/balance.h"

#define CUT 1e-12 /* in the depth [m] */
#define NEAR 0.02 /* in the swing, over it */
enum { BRANCHES_MAX = 16 };

/* A run of stable points; heights grow or fall along it. */
typedef struct branch {
    int low, high; /* its points of least and largest height */
} branch;

typedef struct search {
    const nt_balance_curve *curve;
    const nt_balance_target *target;
    double sign; /* of heights and targets: 1 lowered, -1 lifted */
    branch all[BRANCHES_MAX];
    int count;
} search;

static double height_of(const search *s, int i)
{
    return s->sign * s->curve->at[i].base_height;
}

static double aim_of(const search *s, int i)
{
    const nt_balance_point *at = &s->curve->at[i];
    const double value = s->target->aim == NT_AIM_HEIGHT      ? at->base_height
                         : s->target->aim == NT_AIM_AMPLITUDE ? at->amplitude
                                                              : at->phase;
    return s->sign * (value - s->target->value);
}

static void find_branches(search *s)
{
    const nt_balance_point *at = s->curve->at;
    for (int i = 0; i < s->curve->count && s->count < BRANCHES_MAX;) {
        int end = i;
        while (at[i].stable && end + 1 < s->curve->count && at[end + 1].stable && at[end + 1].piece == at[i].piece)
            end++;
        if (at[i].stable && end > i) {
            const int falls = height_of(s, end) < height_of(s, i);
            s->all[s->count++] = (branch){falls ? end : i, falls ? i : end};
        }
        i = end + 1;
    }
}

/* The point of a branch whose height is the first at or below this one, on the way down. */
static int point_at(const search *s, const branch *on, double height)
{
    const int step = on->low > on->high ? 1 : -1;
    int i = on->high;
    while (i != on->low && height_of(s, i) > height)
        i += step;
    return i;
}

/* Whether a branch begins where another one is cut: something takes hold there, and takes next to nothing. */
static int goes_on(const search *s, const branch *from, const branch *one)
{
    const nt_balance_point *end = &s->curve->at[from->low], *begin = &s->curve->at[one->high];
    return fabs(end->depth - begin->depth) < CUT && fabs(end->swing - begin->swing) < NEAR * end->swing;
}

/* The branch below the end of another one: that which goes on there, else of those at its height the one of largest
 * amplitude, else the highest. */
static const branch *next_branch(const search *s, const branch *from)
{
    const double end = height_of(s, from->low);
    const branch *best = NULL;
    double most = -HUGE_VAL;
    for (int i = 0; i < s->count; i++) {
        const branch *one = &s->all[i];
        if (one == from || !(height_of(s, one->low) < end))
            continue;
        if (goes_on(s, from, one))
            return one;
        const int reaches = height_of(s, one->high) >= end;
        const double rank =
            reaches ? 1.0 + s->curve->at[point_at(s, one, end)].amplitude : height_of(s, one->high) - 1.0;
        if (rank > most) {
            most = rank;
            best = one;
        }
    }
    return best;
}

/* The neighbours between which the target is met; 0: none. */
static int meet(const search *s, int *above, int *below)
{
    const branch *on = NULL;
    for (int i = 0; i < s->count; i++)
        if (on == NULL || height_of(s, s->all[i].high) > height_of(s, on->high))
            on = &s->all[i];
    int at = on != NULL ? on->high : -1;
    for (int n = 0; on != NULL && n < BRANCHES_MAX; n++) {
        const int step = on->low > on->high ? 1 : -1;
        const int down = aim_of(s, at) > 0.0, way = down ? step : -step, end = down ? on->low : on->high;
        for (; at != end; at += way)
            if ((aim_of(s, at + way) > 0.0) != down) {
                *above = down ? at : at + way;
                *below = down ? at + way : at;
                return 1;
            }
        if (!down)
            return 0; /* pulled back up to the target the lever leaves this branch, and comes again */
        const branch *next = next_branch(s, on);
        at = next != NULL ? point_at(s, next, height_of(s, on->low)) : -1;
        on = next;
    }
    return 0;
}

/* From one harmonic to more: all at once do not find together. Where more of them find none, or only the motion on the
 * other side of the resonance, what fewer have found stays. */
static nt_status refine(const nt_balance *balance, const nt_balance_target *target, nt_balance_state *state,
                        nt_balance_value *met)
{
    nt_balance some = *balance;
    some.harmonics = 1;
    const nt_status status = nt_balance_solve(&some, target, state, met);
    long evaluations = met->evaluations;
    while (status == NT_OK && !nt_motion_keeps(balance, met) && some.harmonics < balance->harmonics) {
        some.harmonics = some.harmonics * 2 < balance->harmonics ? some.harmonics * 2 : balance->harmonics;
        nt_balance_state next = *state;
        nt_balance_value more;
        if (nt_balance_solve(&some, target, &next, &more) != NT_OK || fabs(more.phase - met->phase) > SAME ||
            !more.stable)
            continue;
        evaluations += more.evaluations;
        *state = next;
        *met = more;
    }
    met->evaluations = evaluations;
    return status;
}

nt_status nt_balance_find(const nt_balance *balance, const nt_balance_curve *curve, const nt_balance_target *target,
                          nt_balance_state *state, nt_balance_value *value)
{
    if (balance == NULL || curve == NULL || target == NULL || state == NULL || value == NULL)
        return NT_E_ARGUMENT;
    search s = {.curve = curve, .target = target, .sign = target->lifted ? -1.0 : 1.0};
    int above, below;
    find_branches(&s);
    if (!meet(&s, &above, &below))
        return NT_E_NO_CONVERGENCE;
    const nt_balance_point *a = &curve->at[above], *b = &curve->at[below];
    const double share = aim_of(&s, above) / (aim_of(&s, above) - aim_of(&s, below));
    nt_balance_state at = {.swing = a->swing + share * (b->swing - a->swing),
                           .depth = a->depth + share * (b->depth - a->depth)};
    nt_balance_value met = {0};
    const nt_status status = refine(balance, target, &at, &met);
    if (status != NT_OK || !met.stable)
        return NT_E_NO_CONVERGENCE;
    *state = at;
    *value = met;
    return NT_OK;
}

nt_tapping_state nt_balance_moment(const nt_balance *balance, const nt_balance_state *state,
                                   const nt_balance_value *value)
{
    const nt_tapping *t = balance->lever;
    nt_tapping_state at = {.position = value->mean + state->swing * cos(state->lag),
                           .speed = t->ratio * state->swing * sin(state->lag)};
    for (int n = 2; n <= value->harmonics; n++) {
        const double c = cos(n * state->lag), s = -sin(n * state->lag);
        at.position += state->real[n] * c - state->imaginary[n] * s;
        at.speed -= t->ratio * n * (state->real[n] * s + state->imaginary[n] * c);
    }
    const double ground = balance->place != NULL ? balance->place->surface.z : 0.0;
    if (at.speed > 0.0) /* on the way up what has taken hold may hold */
        nt_interaction_advance_gap(balance->plan, &at.contact, balance->place, value->lowest_gap);
    nt_interaction_advance_gap(balance->plan, &at.contact, balance->place,
                               value->base_height - ground + t->cosine * at.position);
    at.contact.dissipated = 0.0;
    return at;
}
