/* SPDX-License-Identifier: BSD-3-Clause
 * The squeeze film between lever and sample: it repels on the approach and holds on the retraction, A/(z - pole) over
 * the line of the free lever. Its foot of many nanometres looks like adhesion otherwise. */
#include "curves/film.h"

#include <math.h>

enum { GRID = 8, TERMS = 3, BLOCKS = 200 };
static const double nearest = 0.01, farthest = 0.35; /* of the free travel: distances of the pole */
static const double evident = 9.0;                   /* gain of chi^2, correlation of the noise counted */
static const double odd_least = 0.4, odd_most = 2.5; /* of minus the approach's strength, on the retraction */

/* Normal equations of a line and A/(z - pole), x from -1 to 1. */
typedef struct sums {
    double matrix[TERMS][TERMS], right[TERMS], squares;
} sums;

static void add(sums *s, const double row[TERMS], double force)
{
    for (int i = 0; i < TERMS; i++) {
        for (int j = 0; j <= i; j++)
            s->matrix[i][j] += row[i] * row[j];
        s->right[i] += row[i] * force;
    }
    s->squares += force * force;
}

/* The sum of squares left over with the first `terms` of them, their values in value (Cholesky). */
static double solve(const sums *s, int terms, double value[TERMS], double *variance)
{
    double lower[TERMS][TERMS] = {{0.0}}, y[TERMS], left = s->squares;
    for (int i = 0; i < terms; i++) {
        for (int j = 0; j <= i; j++) {
            double sum = s->matrix[i][j];
            for (int k = 0; k < j; k++)
                sum -= lower[i][k] * lower[j][k];
            if (i == j && !(sum > 1e-12 * s->matrix[i][i]))
                return NAN;
            lower[i][j] = i == j ? sqrt(sum) : sum / lower[j][j];
        }
        y[i] = s->right[i];
        for (int k = 0; k < i; k++)
            y[i] -= lower[i][k] * y[k];
        y[i] /= lower[i][i];
        left -= y[i] * y[i];
    }
    for (int i = terms - 1; i >= 0; i--) {
        value[i] = y[i];
        for (int k = i + 1; k < terms; k++)
            value[i] -= lower[k][i] * value[k];
        value[i] /= lower[i][i];
    }
    *variance = 1.0 / (lower[terms - 1][terms - 1] * lower[terms - 1][terms - 1]);
    return left;
}

/* Means of about equal blocks of a branch's points. */
typedef struct means {
    double z[BLOCKS], force[BLOCKS];
    long count;
    double first, length; /* z of the first point, and from there to the last [m] */
    double size;          /* points of a block */
} means;

static means means_of(const double *z, const double *force, long count)
{
    means m = {.count = count < BLOCKS ? count : BLOCKS, .first = z[0], .length = z[count - 1] - z[0]};
    m.size = (double)count / (double)m.count;
    for (long b = 0; b < m.count; b++) {
        const long from = b * count / m.count, end = (b + 1) * count / m.count;
        double height = 0.0, sum = 0.0;
        for (long i = from; i < end; i++) {
            height += z[i];
            sum += force[i];
        }
        m.z[b] = height / (double)(end - from);
        m.force[b] = sum / (double)(end - from);
    }
    return m;
}

/* Sums over the blocks; the third term is scale/(z - pole), about 1 at the first. */
static sums over(const means *m, double scale, double pole)
{
    sums s = {{{0.0}}, {0.0}, 0.0};
    for (long b = 0; b < m->count; b++) {
        const double row[TERMS] = {1.0, 2.0 * (m->z[b] - m->first) / m->length - 1.0, scale / (m->z[b] - pole)};
        add(&s, row, m->force[b]);
    }
    return s;
}

double nt_curve_film_at(const nt_curve_film *film, double z)
{
    const double above = fmax(z, film->contact) - film->pole;
    return film->strength > 0.0 && above > 0.0 ? film->strength / above : 0.0;
}

/* How much more the mean of the blocks that the film is seen in scatters than that of independent ones. */
static double correlation(const nt_curve_branch *branch, const sums *s, double size)
{
    const nt_curve_noise *noise = &branch->baseline.noise;
    const double *film = s->matrix[TERMS - 1], n = film[0] * film[0] / film[TERMS - 1], white = noise->white / size;
    return white > 0.0 ? (white + n * noise->flicker) / (white + noise->flicker) : 1.0;
}

nt_curve_film nt_curve_find_film(const nt_curve_branch *approach)
{
    nt_curve_film best = {0.0, 0.0, 0.0, 0.0};
    long first = approach->repulsive > approach->lowest ? approach->repulsive : 0;
    const double *z = approach->z, *force = approach->force;
    for (long i = 0; i < approach->count; i++)
        if (force[i] > approach->visible)
            first = i + 1;
    if (approach->count - first < 4 * NT_CURVE_FEWEST || approach->dips)
        return best;
    const means m = means_of(z + first, force + first, approach->count - first);
    double least = INFINITY;
    for (int i = 0; i < GRID; i++) {
        const double scale = m.length * nearest * pow(farthest / nearest, (double)i / (GRID - 1));
        const double pole = m.first - scale;
        const sums s = over(&m, scale, pole);
        double value[TERMS], line[TERMS], variance, ignored;
        const double left = solve(&s, TERMS, value, &variance), straight = solve(&s, TERMS - 1, line, &ignored);
        const double scatter = left / (double)(m.count - TERMS) * correlation(approach, &s, m.size);
        if (left < least && (straight - left) / scatter > evident && value[TERMS - 1] > 0.0) {
            least = left;
            best = (nt_curve_film){value[TERMS - 1] * scale, pole, m.first, sqrt(variance * scatter) * scale};
        }
    }
    return best;
}

int nt_curve_film_is_odd(const nt_curve_film *film, const double *z, const double *force, long count, double start)
{
    long first = 0;
    while (first < count && z[first] < fmax(start, film->contact))
        first++;
    if (count - first < 4 * NT_CURVE_FEWEST)
        return 0;
    const means m = means_of(z + first, force + first, count - first);
    const double scale = film->contact - film->pole;
    const sums s = over(&m, scale, film->pole);
    double value[TERMS], variance;
    const double left = solve(&s, TERMS, value, &variance);
    const double sigma = sqrt(variance * left / (double)m.count), own = -value[TERMS - 1] * scale;
    const double doubt = 3.0 * sigma * scale;
    return own > odd_least * film->strength && own < odd_most * film->strength && own > doubt;
}
