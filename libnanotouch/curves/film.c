/* SPDX-License-Identifier: BSD-3-Clause
 * The squeeze film between lever and sample: it repels on the approach and holds on the retraction, A/(z - pole) over
 * the line of the free lever. Its foot of many nanometres looks like adhesion otherwise. */
#include "curves/film.h"

#include <math.h>

enum { GRID = 8, TERMS = 3 };
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
        for (int j = 0; j < TERMS; j++)
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

/* Sums over points from first on; the third term is scale/(z - pole), about 1 at the first. */
static sums over(const double *z, const double *force, const nt_film_range *range, double pole)
{
    sums s = {{{0.0}}, {0.0}, 0.0};
    const double length = z[range->end - 1] - z[range->first];
    for (long i = range->first; i < range->end; i++) {
        const double row[TERMS] = {1.0, 2.0 * (z[i] - z[range->first]) / length - 1.0, range->scale / (z[i] - pole)};
        add(&s, row, force[i]);
    }
    return s;
}

double nt_curve_film_at(const nt_curve_film *film, double z)
{
    const double above = fmax(z, film->contact) - film->pole;
    return film->strength > 0.0 && above > 0.0 ? film->strength / above : 0.0;
}

/* How much more the mean of the points that the film is seen in scatters than that of independent ones. */
static double correlation(const nt_curve_branch *branch, const sums *s)
{
    const nt_curve_noise *noise = &branch->baseline.noise;
    const double n = s->matrix[0][TERMS - 1] * s->matrix[0][TERMS - 1] / s->matrix[TERMS - 1][TERMS - 1];
    return noise->white > 0.0 ? 1.0 + n * noise->flicker / noise->white : 1.0;
}

nt_curve_film nt_curve_find_film(const nt_curve_branch *approach)
{
    nt_curve_film best = {0.0, 0.0, 0.0, 0.0};
    long first = approach->repulsive > approach->lowest ? approach->repulsive : 0;
    const double *z = approach->z, *force = approach->force;
    for (long i = 0; i < approach->count; i++)
        if (force[i] > approach->visible)
            first = i + 1;
    nt_film_range range = {first, approach->count, 0.0};
    if (range.end - range.first < 4 * NT_CURVE_FEWEST || approach->dips)
        return best;
    const double travel = z[range.end - 1] - z[first];
    double least = INFINITY;
    for (int i = 0; i < GRID; i++) {
        range.scale = travel * nearest * pow(farthest / nearest, (double)i / (GRID - 1));
        const double pole = z[first] - range.scale;
        const sums s = over(z, force, &range, pole);
        double value[TERMS], line[TERMS], variance, ignored;
        const double left = solve(&s, TERMS, value, &variance), straight = solve(&s, TERMS - 1, line, &ignored);
        const double scatter = left / (double)(range.end - range.first - TERMS);
        const double gain = (straight - left) / (scatter * correlation(approach, &s));
        if (left < least && gain > evident && value[TERMS - 1] > 0.0) {
            least = left;
            best = (nt_curve_film){value[TERMS - 1] * range.scale, pole, z[first],
                                   sqrt(variance * scatter * correlation(approach, &s)) * range.scale};
        }
    }
    return best;
}

int nt_curve_film_is_odd(const nt_curve_film *film, const double *z, const double *force, long count, double start)
{
    long first = 0;
    while (first < count && z[first] < fmax(start, film->contact))
        first++;
    nt_film_range range = {first, count, film->contact - film->pole};
    if (count - first < 4 * NT_CURVE_FEWEST)
        return 0;
    const sums s = over(z, force, &range, film->pole);
    double value[TERMS], variance;
    const double left = solve(&s, TERMS, value, &variance);
    const double sigma = sqrt(variance * left / (double)(count - first)), own = -value[TERMS - 1] * range.scale;
    const double doubt = 3.0 * sigma * range.scale;
    return own > odd_least * film->strength && own < odd_most * film->strength && own > doubt;
}
