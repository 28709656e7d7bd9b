/* SPDX-License-Identifier: BSD-3-Clause
 * A bow (interference over a long range) and a squeeze film (the fluid under the lever) look like the foot of a soft
 * contact, which moves by much under a small force, and like adhesion. Fitted to means of the free parts: a line, with
 * a bow, with A/(z - pole), with both. On the retraction the bow is the same and the film has the other sign, so that
 * a free tail tells one from the other. Each term costs `price` of chi^2. What the laws that remain likely differ by
 * is uncertain. */
#include "curves/free_law.h"

#include <math.h>

#include "core/variants.h"
#include "curves/robust.h"
#include "internal/curves.h"

enum { POLES = 10, LAWS = 4 };
static const double price = 9.0;                     /* three standard deviations */
static const double nearest = 0.01, farthest = 0.35; /* of the free travel: distances of the pole */
static const double doubt = 2.0;                     /* of chi^2 for a term, where only doubts are weighed (Akaike) */
static const double likely = 0.02;                   /* least weight of a law that counts */
static const double contradiction = 16.0; /* of chi^2, by which one bow and one film on both branches may be worse */
static const double shown = 4.0;          /* of chi^2, by which a film has to describe the tail better: two sigma */
static const double distinct = 1e-9;      /* of 1 - correlation^2 of bow and film: less is rounding */

static void line_of(const double x[], const double y[], const nt_free_means *m, double line[2])
{
    double mean = 0.0, product = 0.0;
    for (int b = 0; b < m->count; b++) {
        mean += y[b] / m->count;
        product += (x[b] - m->mean) * y[b];
    }
    line[1] = product / m->spread;
    line[0] = mean - line[1] * m->mean;
}

/* Sums that do not depend on the pole. */
static void sum_up(const double force[], nt_free_means *m)
{
    for (int b = 0; b < m->count; b++)
        m->mean += m->x[b] / m->count;
    for (int b = 0; b < m->count; b++) {
        m->spread += (m->x[b] - m->mean) * (m->x[b] - m->mean);
        m->bow[b] = m->x[b] * m->x[b];
    }
    line_of(m->x, force, m, m->line);
    line_of(m->x, m->bow, m, m->bow_line);
    for (int b = 0; b < m->count; b++) {
        m->rest[b] = force[b] - m->line[0] - m->line[1] * m->x[b];
        m->bow[b] -= m->bow_line[0] + m->bow_line[1] * m->x[b];
        m->squares += m->rest[b] * m->rest[b];
        m->bow_rest += m->bow[b] * m->rest[b];
        m->bow_bow += m->bow[b] * m->bow[b];
    }
}

nt_free_means nt_free_means_of(const nt_curve_branch *branch, long first, const nt_free_record *frame)
{
    const long points = branch->count - first;
    nt_free_means m = {.count = points < (long)NT_FREE_BLOCK * NT_FREE_BLOCKS ? (int)(points / NT_FREE_BLOCK)
                                                                              : NT_FREE_BLOCKS};
    double force[NT_FREE_BLOCKS] = {0.0};
    for (int b = 0; b < m.count; b++) {
        const long from = first + b * points / m.count, end = first + (b + 1) * points / m.count;
        double z = 0.0, sum = 0.0;
        for (long i = from; i < end; i++) {
            z += branch->z[i];
            sum += branch->force[i];
        }
        m.x[b] = (z / (double)(end - from) - frame->middle) / frame->half;
        force[b] = sum / (double)(end - from);
    }
    sum_up(force, &m);
    return m;
}

static double film_at(double scale, double foot, double x)
{
    return x > foot ? scale / (x - foot + scale) : 1.0;
}

/* Sums of a film of 1, over its line, with itself, with bow and rest. */
typedef struct film_sums {
    double line[2], film_film, film_bow, film_rest;
} film_sums;

NT_VARIANTS static film_sums film_over(const nt_free_means *m, double scale, double foot)
{
    film_sums s = {{0.0, 0.0}, 0.0, 0.0, 0.0};
    double all[NT_LANES] = {0.0}, over_x[NT_LANES] = {0.0}, itself[NT_LANES] = {0.0}, bow[NT_LANES] = {0.0},
           rest[NT_LANES] = {0.0};
    if (m->count == 0)
        return s;
    const double mean = m->mean;
    for (long b = 0; b < m->count; b += NT_LANES)
        for (int j = 0, n = nt_lanes_from(b, m->count); j < n; j++) {
            const double away = m->x[b + j] - foot, film = scale / ((away > 0.0 ? away : 0.0) + scale);
            all[j] += film;
            over_x[j] += film * (m->x[b + j] - mean);
            itself[j] += film * film;
            bow[j] += film * m->bow[b + j];
            rest[j] += film * m->rest[b + j];
        }
    const double sum = nt_lanes_sum(all), product = nt_lanes_sum(over_x);
    s.line[1] = product / m->spread;
    s.line[0] = sum / m->count - s.line[1] * m->mean;
    s.film_film = nt_lanes_sum(itself) - sum * sum / m->count - product * s.line[1];
    s.film_bow = nt_lanes_sum(bow);
    s.film_rest = nt_lanes_sum(rest);
    return s;
}

/* Normal equations of bow and film, all else taken off. */
typedef struct equations {
    double bow_bow, film_bow, film_film, bow_rest, film_rest, squares;
} equations;

static equations add(const nt_free_means *m, const film_sums *s, double sign, equations to)
{
    return (equations){to.bow_bow + m->bow_bow,   to.film_bow + sign * s->film_bow,   to.film_film + s->film_film,
                       to.bow_rest + m->bow_rest, to.film_rest + sign * s->film_rest, to.squares + m->squares};
}

/* Fills what the terms come to; 0 where they cannot be told apart. */
static int solve(const equations *e, nt_free_law *law)
{
    const double det = law->has_bow && law->has_film ? e->bow_bow * e->film_film - e->film_bow * e->film_bow : 0.0;
    law->squares = INFINITY;
    if (law->has_bow && law->has_film) {
        if (!(det > distinct * e->bow_bow * e->film_film))
            return 0;
        law->bow_variance = e->film_film / det;
        law->film_variance = e->bow_bow / det;
        law->covariance = -e->film_bow / det;
    } else if (law->has_bow)
        law->bow_variance = 1.0 / e->bow_bow;
    else if (law->has_film)
        law->film_variance = 1.0 / e->film_film;
    law->bow = law->bow_variance * e->bow_rest + law->covariance * e->film_rest;
    law->film = law->covariance * e->bow_rest + law->film_variance * e->film_rest;
    law->squares = e->squares - law->bow * e->bow_rest - law->film * e->film_rest;
    return 1;
}

/* The best law of each kind, index bow + 2 film. */
static void fit(const nt_free_record *r, nt_free_law best[LAWS])
{
    const film_sums none = {{0.0, 0.0}, 0.0, 0.0, 0.0};
    const equations start = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    const equations plain = add(&r->tail, &none, 1.0, add(&r->approach, &none, 1.0, start));
    for (int kind = 0; kind < LAWS; kind++)
        best[kind] = (nt_free_law){.has_bow = kind & 1, .has_film = kind >> 1, .squares = INFINITY};
    solve(&plain, best);
    solve(&plain, best + 1);
    for (int i = 0; i < POLES; i++) {
        const double scale = 2.0 * nearest * pow(farthest / nearest, (double)i / (POLES - 1));
        const film_sums s = film_over(&r->approach, scale, r->foot), back = film_over(&r->tail, scale, r->foot);
        const equations e = add(&r->tail, &back, -1.0, add(&r->approach, &s, 1.0, start));
        for (int kind = 2; kind < LAWS; kind++) {
            nt_free_law tried = {.has_bow = kind & 1, .has_film = 1, .scale = scale};
            for (int k = 0; k < 2; k++) {
                tried.film_line[k] = s.line[k];
                tried.film_back[k] = back.line[k];
            }
            if (solve(&e, &tried) && tried.film > 0.0 && tried.squares < best[kind].squares)
                best[kind] = tried;
        }
    }
}

/* What bow and film leave of one branch, each its own [N^2]. */
static double squares_alone(const nt_free_means *m, double scale, double foot)
{
    const film_sums s = film_over(m, scale, foot);
    const equations e = add(m, &s, 1.0, (equations){0.0, 0.0, 0.0, 0.0, 0.0, 0.0});
    nt_free_law both = {.has_bow = 1, .has_film = 1}, bow = {.has_bow = 1};
    if (solve(&e, &both))
        return both.squares;
    solve(&e, &bow);
    return bow.squares;
}

void nt_free_even(const nt_free_law *law, const nt_free_record *r, int of_tail, double even[3])
{
    const nt_free_means *m = of_tail ? &r->tail : &r->approach;
    const double *film = of_tail ? law->film_back : law->film_line, strength = of_tail ? -law->film : law->film;
    for (int i = 0; i < 2; i++)
        even[i] = m->line[i] - law->bow * m->bow_line[i] - strength * film[i];
    even[2] = law->bow;
}

double nt_free_film_at(const nt_free_law *law, const nt_free_record *r, double x)
{
    return law->has_film ? law->film * film_at(law->scale, r->foot, x) : 0.0;
}

/* Its force at the contact; 0 where it is the foot of the contact [N]. */
static double film_of(const nt_free_law *law)
{
    return law->has_film ? law->film : 0.0;
}

/* Of the free approach [N]. */
static double law_at(const nt_free_law *law, const nt_free_record *r, double x)
{
    double even[3];
    nt_free_even(law, r, 0, even);
    return even[0] + (even[1] + even[2] * x) * x + nt_free_film_at(law, r, x);
}

/* A term of 1 over its line through the approach. */
static double over_line(double term, const double line[2], double x)
{
    return term - line[0] - line[1] * x;
}

/* Of the law at x, in variances of a block's mean. */
static double variance_at(const nt_free_law *law, const nt_free_record *r, double x)
{
    const nt_free_means *m = &r->approach;
    const double bow = over_line(x * x, m->bow_line, x), away = x - m->mean;
    const double film = law->has_film ? over_line(film_at(law->scale, r->foot, x), law->film_line, x) : 0.0;
    return 1.0 / m->count + away * away / m->spread + bow * bow * law->bow_variance +
           2.0 * bow * film * law->covariance + film * film * law->film_variance;
}

/* By how much the blocks that a law leaves hang together. */
static double worth_of(const nt_free_law *law, const nt_free_record *r)
{
    double rest[NT_FREE_BLOCKS];
    const nt_free_means *m = &r->approach;
    for (int b = 0; b < m->count; b++)
        rest[b] = m->line[0] + m->line[1] * m->x[b] + m->rest[b] - law_at(law, r, m->x[b]);
    return nt_curve_residual_correlation(rest, m->count);
}

/* Sums over the likely laws, each by its weight. */
static nt_curve_bend_doubts doubts_of(const nt_free_law laws[], const double weight[], const nt_free_law *chosen,
                                      const nt_free_record *r, double block)
{
    nt_curve_bend_doubts open = {.middle = r->middle, .half = r->half};
    const double there = law_at(chosen, r, r->foot);
    for (int i = 0; i < LAWS; i++) {
        if (!(weight[i] > 0.0))
            continue;
        const nt_free_law *law = laws + i;
        const double off = law_at(law, r, r->foot) - there, bow = law->bow - chosen->bow;
        const double film = film_of(law), over = film - film_of(chosen);
        open.level += weight[i] * (off * off + variance_at(law, r, r->foot) * block);
        open.bow_sigma += weight[i] * (bow * bow + law->bow_variance * block);
        open.film_sigma += weight[i] * (over * over + law->film_variance * block);
        open.film += law->has_film ? weight[i] : 0.0;
        open.film_force += weight[i] * film * film;
    }
    open.bow_sigma = sqrt(open.bow_sigma) / (r->half * r->half);
    open.film_sigma = sqrt(open.film_sigma);
    open.film_force = sqrt(open.film_force);
    return open;
}

/* Weighs the laws; returns the chosen one. */
static int weigh(const nt_free_law laws[LAWS], double block, double weight[LAWS])
{
    static const double terms[LAWS] = {2.0, 3.0, 4.0, 5.0}; /* the place of the pole is one */
    double best = INFINITY, closest = INFINITY, total = 0.0;
    int chosen = 0;
    for (int i = 0; i < LAWS; i++) {
        const double left = laws[i].squares / block;
        closest = fmin(closest, left + doubt * terms[i]);
        if (left + price * terms[i] < best) {
            best = left + price * terms[i];
            chosen = i;
        }
    }
    for (int i = 0; i < LAWS; i++) {
        weight[i] = exp(0.5 * (closest - laws[i].squares / block - doubt * terms[i]));
        weight[i] = i == chosen || weight[i] > likely ? weight[i] : 0.0;
        total += weight[i];
    }
    for (int i = 0; i < LAWS; i++)
        weight[i] /= total;
    return chosen;
}

/* Variance of a block's mean, as the laws leave it. */
static double block_variance(const nt_free_law laws[LAWS], const nt_free_record *r)
{
    const int blocks = r->approach.count + (r->tail.count ? r->tail.count - 2 : 0);
    double least = INFINITY;
    for (int i = 0; i < LAWS; i++)
        least = fmin(least, laws[i].squares / (blocks - 2 - i));
    return least * worth_of(laws[3].squares < (double)INFINITY ? laws + 3 : laws + 1, r);
}

/* Whether one bow and one film are much worse for both branches than each its own. */
static int contradict(const nt_free_law laws[LAWS], double block, const nt_free_record *r)
{
    const double scale = laws[3].squares < (double)INFINITY ? laws[3].scale : 2.0 * nearest;
    const double apart = squares_alone(&r->approach, scale, r->foot) + squares_alone(&r->tail, scale, r->foot);
    return fmin(laws[3].squares, laws[1].squares) - apart > contradiction * block;
}

/* Whether a law's film describes the tail by itself better than none. */
static int tail_shows(const nt_free_law *law, double block, const nt_free_record *r)
{
    const film_sums back = film_over(&r->tail, law->scale, r->foot);
    const equations e = add(&r->tail, &back, -1.0, (equations){0.0, 0.0, 0.0, 0.0, 0.0, 0.0});
    nt_free_law own = {.has_bow = law->has_bow, .has_film = 1};
    return r->tail.count && solve(&e, &own) && own.film_variance > 0.0 &&
           law->film * (2.0 * own.film - law->film) > shown * own.film_variance * block;
}

/* A film that decays over the least distance tried or less is the soft foot of a contact, unless the tail shows it.
 * The foot keeps its place in the fits, so that it bends nothing else, but nothing of it is taken off. */
static void leave_foot(nt_free_law laws[LAWS], int chosen, double block, const nt_free_record *r)
{
    if (!laws[chosen].has_film || laws[chosen].scale > 2.0 * nearest || tail_shows(laws + chosen, block, r))
        return;
    for (int i = 0; i < LAWS; i++)
        laws[i].has_film = 0;
}

nt_free_law nt_free_judge(const nt_free_record *record, nt_curve_bend_doubts *left_open)
{
    nt_free_law laws[LAWS];
    double weight[LAWS];
    nt_free_record judged = *record;
    fit(&judged, laws);
    double block = block_variance(laws, &judged);
    if (judged.tail.count && contradict(laws, block, &judged)) {
        judged.tail.count = 0;
        judged.tail.bow_bow = judged.tail.bow_rest = judged.tail.squares = 0.0;
        fit(&judged, laws);
        block = block_variance(laws, &judged);
    }
    const int chosen = weigh(laws, block, weight);
    leave_foot(laws, chosen, block, &judged);
    *left_open = doubts_of(laws, weight, laws + chosen, &judged, block);
    laws[chosen].confirmed = judged.tail.count > 0;
    return laws[chosen];
}
