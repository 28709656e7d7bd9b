/* SPDX-License-Identifier: BSD-3-Clause
 * A bow (interference over a long range) and a squeeze film (the fluid under the lever) look like the foot of a soft
 * contact, which moves by much under a small force. Fitted to means of the free approach in front of contact: a line,
 * with a bow, with A/(z - pole), with both. Each term costs `price` of chi^2. What the models that remain likely differ
 * by at the contact is uncertain. */
#include "curves/bend.h"

#include <math.h>
#include <string.h>

#include "curves/parts.h"
#include "curves/robust.h"

enum { BLOCKS = 120, BLOCK = 8, LEAST_BLOCKS = 16, TERMS = 4, POLES = 10 }; /* BLOCK: points, at least */
enum { LINE = 2, BOW = 2, FILM = 3 };                /* terms of a line; the places of the others */
static const double price = 9.0;                     /* three standard deviations */
static const double nearest = 0.01, farthest = 0.35; /* of the free travel: distances of the pole */
static const double doubt = 2.0;                     /* of chi^2 for a term, where only doubts are weighed (Akaike) */
static const double likely = 0.02;                   /* least weight of a model that counts */
static const double plausible = 0.05;                /* likelihood of a film that counts */
static const double deep = 8.0; /* times the visible force: there the indentation is 4 times that at the visible one, */
static const double foot_part = 0.33; /* so that contact begins about a third of the way between them further out; */
static const double clear_part = 0.7; /* of the way: surely outside */
static const double least_free = 0.5; /* of the travel: a bow of less is slow noise, and huge where it is continued */

/* Means of equal blocks of the free part, x from its middle in halves of its length. */
typedef struct means {
    double z[BLOCKS], x[BLOCKS], force[BLOCKS];
    int count;
    double middle, half;                                 /* [m] */
    double foot;                                         /* x where contact begins */
    double line[2];                                      /* least squares: level [N], slope over x [N] */
    double rest[BLOCKS];                                 /* of it */
    double normal[TERMS * TERMS], right[TERMS], squares; /* sums over the blocks, of line and bow, and of the rest */
} means;

/* A law of the free part: terms it has, and what they came to. */
typedef struct shape {
    int bow, film;
    double scale; /* of the pole before the first point [m] */
    double value[TERMS], squares, start;
    double normal[TERMS * TERMS];
} shape;

/* Sums that do not depend on the pole, over what a line leaves, so that squares can be subtracted from each other. */
static void sum_up(means *m)
{
    double x = 0.0, force = 0.0, spread = 0.0, product = 0.0;
    for (int b = 0; b < m->count; b++) {
        x += m->x[b] / m->count;
        force += m->force[b] / m->count;
    }
    for (int b = 0; b < m->count; b++) {
        spread += (m->x[b] - x) * (m->x[b] - x);
        product += (m->x[b] - x) * (m->force[b] - force);
    }
    m->line[1] = product / spread;
    m->line[0] = force - m->line[1] * x;
    for (int b = 0; b < m->count; b++) {
        const double row[BOW + 1] = {1.0, m->x[b], m->x[b] * m->x[b] - 1.0 / 3.0};
        m->rest[b] = m->force[b] - m->line[0] - m->line[1] * m->x[b];
        m->squares += m->rest[b] * m->rest[b];
        for (int i = 0; i <= BOW; i++) {
            m->right[i] += row[i] * m->rest[b];
            for (int j = 0; j <= i; j++)
                m->normal[i * TERMS + j] += row[i] * row[j];
        }
    }
}

static means means_of(const nt_curve_branch *branch, long first)
{
    const long points = branch->count - first;
    means m = {.count = points / BLOCK < BLOCKS ? (int)(points / BLOCK) : BLOCKS};
    m.half = 0.5 * (branch->z[branch->count - 1] - branch->z[first]);
    m.middle = branch->z[first] + m.half;
    for (int b = 0; b < m.count; b++) {
        const long from = first + b * points / m.count, end = first + (b + 1) * points / m.count;
        double z = 0.0, force = 0.0;
        for (long i = from; i < end; i++) {
            z += branch->z[i];
            force += branch->force[i];
        }
        m.z[b] = z / (double)(end - from);
        m.force[b] = force / (double)(end - from);
        m.x[b] = (m.z[b] - m.middle) / m.half;
    }
    sum_up(&m);
    return m;
}

/* Of a film, 1 at the foot. */
static double film_at(const shape *law, const means *m, double x)
{
    const double scale = law->scale / m->half, away = x - m->foot;
    return away > 0.0 ? scale / (away + scale) : 1.0;
}

/* The terms of a law at x; where it has none of a kind, 0. */
static void row_of(const shape *law, const means *m, double x, double row[TERMS])
{
    row[0] = 1.0;
    row[1] = x;
    row[BOW] = law->bow ? x * x - 1.0 / 3.0 : 0.0;
    row[FILM] = law->film ? film_at(law, m, x) : 0.0;
}

/* Leaves the normal equations of a law in law->normal and in right; a term that it lacks stays 0. */
static void equations(shape *law, const means *m, double right[TERMS])
{
    for (int i = 0; i < TERMS * TERMS; i++)
        law->normal[i] = m->normal[i];
    for (int i = 0; i < TERMS; i++)
        right[i] = m->right[i];
    double *film = law->normal + FILM * TERMS;
    for (int b = 0; law->film && b < m->count; b++) {
        const double x = m->x[b], term = film_at(law, m, x);
        film[0] += term;
        film[1] += term * x;
        film[BOW] += term * (x * x - 1.0 / 3.0);
        film[FILM] += term * term;
        right[FILM] += term * m->rest[b];
    }
    if (!law->bow)
        law->normal[BOW * TERMS] = law->normal[BOW * TERMS + 1] = film[BOW] = right[BOW] = 0.0;
    if (!law->bow)
        law->normal[BOW * TERMS + BOW] = 1.0;
    if (!law->film)
        film[FILM] = 1.0;
}

static void fit(shape *law, const means *m)
{
    double right[TERMS], value[TERMS], factor[TERMS * TERMS];
    equations(law, m, right);
    for (int i = 0; i < TERMS * TERMS; i++)
        factor[i] = law->normal[i];
    for (int i = 0; i < TERMS; i++)
        value[i] = right[i];
    law->squares = INFINITY;
    if (!nt_curve_solve(factor, value, TERMS) || (law->film && !(value[FILM] > 0.0)))
        return;
    law->squares = m->squares;
    for (int i = 0; i < TERMS; i++) {
        law->squares -= value[i] * right[i];
        law->value[i] = value[i] + (i < LINE ? m->line[i] : 0.0);
    }
}

static double at(const shape *law, const means *m, double x)
{
    double row[TERMS], sum = 0.0;
    row_of(law, m, x, row);
    for (int i = 0; i < TERMS; i++)
        sum += row[i] * law->value[i];
    return sum;
}

/* Of the law at x, in variances of a block's mean. */
static double variance_at(const shape *law, const means *m, double x)
{
    double factor[TERMS * TERMS], row[TERMS], moved[TERMS], sum = 0.0;
    row_of(law, m, x, row);
    for (int i = 0; i < TERMS * TERMS; i++)
        factor[i] = law->normal[i];
    for (int i = 0; i < TERMS; i++)
        moved[i] = row[i];
    if (!nt_curve_solve(factor, moved, TERMS))
        return 0.0;
    for (int i = 0; i < TERMS; i++)
        sum += row[i] * moved[i];
    return sum;
}

/* The best law with the terms asked. */
static shape best_law(const means *m, int bow, int film)
{
    shape best = {.bow = bow, .film = film, .squares = INFINITY};
    for (int i = 0; i < (film ? POLES : 1); i++) {
        shape tried = {.bow = bow, .film = film};
        tried.scale = 2.0 * m->half * nearest * pow(farthest / nearest, (double)i / (POLES - 1));
        fit(&tried, m);
        best = tried.squares < best.squares ? tried : best;
    }
    return best;
}

/* By how much the blocks that a law leaves hang together. */
static double worth_of(const shape *law, const means *m)
{
    double rest[BLOCKS];
    for (int b = 0; b < m->count; b++)
        rest[b] = m->force[b] - at(law, m, m->x[b]);
    return nt_curve_residual_correlation(rest, m->count);
}

/* What is not known at the foot. */
typedef struct doubts {
    double variance; /* of the force, with what other likely laws differ by [N^2] */
    double film;     /* how likely there is a film, 0 to 1 */
    double squared;  /* its force, squared, times that [N^2] */
} doubts;

/* The likeliest law of the free part. */
static shape judge(const means *m, doubts *left_open)
{
    shape laws[] = {best_law(m, 0, 0), best_law(m, 1, 0), best_law(m, 0, 1), best_law(m, 1, 1)};
    const int terms[] = {2, 3, 4, 5}, many = 4; /* the place of the pole is one */
    double least = INFINITY, best = INFINITY, closest = INFINITY, total = 0.0;
    int chosen = 0;
    for (int i = 0; i < many; i++)
        least = fmin(least, laws[i].squares / (m->count - terms[i]));
    const double worth = worth_of(laws[3].squares < (double)INFINITY ? &laws[3] : &laws[1], m);
    for (int i = 0; i < many; i++) {
        const double left = laws[i].squares / (least * worth);
        closest = fmin(closest, left + doubt * terms[i]);
        if (left + price * terms[i] < best) {
            best = left + price * terms[i];
            chosen = i;
        }
    }
    const double there = at(&laws[chosen], m, m->foot);
    *left_open = (doubts){0.0, 0.0, 0.0};
    for (int i = 0; i < many; i++) {
        const double weight = exp(0.5 * (closest - laws[i].squares / (least * worth) - doubt * terms[i]));
        if (i != chosen && !(weight > likely))
            continue;
        const double off = at(&laws[i], m, m->foot) - there;
        left_open->variance += weight * (off * off + variance_at(&laws[i], m, m->foot) * least * worth);
        total += weight;
        if (laws[i].film) {
            left_open->film += weight;
            left_open->squared += weight * laws[i].value[FILM] * laws[i].value[FILM];
        }
    }
    left_open->variance /= total;
    left_open->film /= total;
    left_open->squared /= total;
    return laws[chosen];
}

static void add_to(nt_curve_baseline *baseline, const shape *law, const means *m)
{
    const double shift = (baseline->z_mean - m->middle) / m->half, bow = law->bow ? law->value[BOW] : 0.0;
    baseline->force += law->value[0] + law->value[1] * shift + bow * (shift * shift - 1.0 / 3.0);
    baseline->slope += (law->value[1] + 2.0 * bow * shift) / m->half;
    baseline->bend.bow = bow / (m->half * m->half);
    if (law->film) {
        baseline->bend.nearest = m->middle + m->foot * m->half;
        baseline->bend.pole = baseline->bend.nearest - law->scale;
        baseline->bend.film = law->value[FILM] * law->scale;
    }
}

double nt_curve_bend_at(const nt_curve_bend *bend, double z, double x)
{
    const double film = bend->film != 0.0 ? bend->film / (fmax(z, bend->nearest) - bend->pole) : 0.0;
    return film + bend->bow * x * x;
}

/* The last point whose force reaches a level; -1 without one. */
static long last_above(const nt_curve_branch *branch, double level)
{
    long last = -1;
    for (long i = 0; i < branch->count; i++)
        last = fabs(branch->force[i]) > level ? i : last;
    return last;
}

/* What a film does in contact is not measured: its force there may be off by all of it. The free points beside the
 * contact would say that it is known, so a law without attraction is not fitted to them. */
static void doubt_level(const doubts *left_open, nt_curve_branch *approach)
{
    const long touching = last_above(approach, approach->visible) + 1;
    if (left_open->film < plausible)
        return;
    approach->baseline.force_variance += left_open->squared;
    if (touching >= NT_CURVE_FEWEST && touching < approach->repulsive)
        approach->repulsive = touching;
}

/* Leaves a bent baseline unless there is a snap-in, whose own forces reach far out and look like a bow. */
static void take_off(const nt_curve_segment *segment, const shape *law, const means *m, double *work[2],
                     nt_curve_branch *approach)
{
    double *kept = work[0], *room = work[1];
    const long count = approach->count;
    nt_curve_baseline bent = approach->baseline;
    add_to(&bent, law, m);
    const nt_curve_branch straight = *approach;
    nt_curve_read_events(segment, &bent, straight.noise, room, approach);
    if (straight.dips && approach->dips) {
        *approach = straight;
        return;
    }
    memcpy(kept, room, 2 * (size_t)count * sizeof *room);
    approach->z = kept;
    approach->force = kept + count;
}

void nt_curve_unbend(const nt_curve_segment *segment, double *kept, double *room, nt_curve_branch *approach)
{
    const long count = approach->count, seen = last_above(approach, approach->visible);
    const long deeper = last_above(approach, deep * approach->visible);
    long first = seen + 1;
    if (deeper < 0)
        return;
    const double step = approach->z[seen] - approach->z[deeper], foot = approach->z[seen] + foot_part * step;
    while (first < count && approach->z[first] < approach->z[seen] + clear_part * step)
        first++;
    const double all = approach->z[count - 1] - approach->z[0];
    if (count - first < LEAST_BLOCKS * BLOCK || approach->z[count - 1] - approach->z[first] < least_free * all)
        return;
    means m = means_of(approach, first);
    m.foot = (foot - m.middle) / m.half;
    doubts left_open;
    const shape chosen = judge(&m, &left_open);
    approach->baseline.force_variance = fmax(approach->baseline.force_variance, left_open.variance);
    const int snaps_in = approach->dips;
    if (chosen.bow || chosen.film)
        take_off(segment, &chosen, &m, (double *[2]){kept, room}, approach);
    if (!snaps_in)
        doubt_level(&left_open, approach);
}
