/* SPDX-License-Identifier: BSD-3-Clause
 * The squeeze film between lever and sample: it repels on the approach and holds on the retraction, A/(z - pole) over
 * the line of the free lever. Its foot of many nanometres looks like adhesion otherwise. */
#include "curves/film.h"

#include <math.h>

#include "core/same_bits.h"
#include "curves/parts.h"
#include "curves/robust.h"

enum { TERMS = 3, BLOCKS = 200, OUTWARDS = 6 };
static const double odd_least = 0.4, odd_most = 2.5; /* of minus the approach's strength, on the retraction */
static const double unseen = 8.0; /* times the visible force: more of a film would be evident further out */
static const double firm = 0.2;   /* of the load: from there on contact is more than a film */

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

/* The sum of squares left over, the values and the variance of the last of them (Cholesky); NaN: it is singular. */
static double solve(const sums *s, double value[TERMS], double *variance)
{
    double lower[TERMS][TERMS] = {{0.0}}, y[TERMS], left = s->squares;
    for (int i = 0; i < TERMS; i++) {
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
    for (int i = TERMS - 1; i >= 0; i--) {
        value[i] = y[i];
        for (int k = i + 1; k < TERMS; k++)
            value[i] -= lower[k][i] * value[k];
        value[i] /= lower[i][i];
    }
    *variance = 1.0 / (lower[TERMS - 1][TERMS - 1] * lower[TERMS - 1][TERMS - 1]);
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

double nt_curve_film_at(const nt_curve_bend *film, double z)
{
    return film->film != 0.0 ? film->film / (fmax(z, film->nearest) - film->pole) : 0.0;
}

int nt_curve_film_is_odd(const nt_curve_bend *film, const double *z, const double *force, long count, double start)
{
    long first = 0;
    while (first < count && z[first] < fmax(start, film->nearest))
        first++;
    if (count - first < 4 * NT_CURVE_FEWEST)
        return 0;
    const means m = means_of(z + first, force + first, count - first);
    const double scale = film->nearest - film->pole;
    const sums s = over(&m, scale, film->pole);
    double value[TERMS] = {0.0}, variance = 0.0;
    const double left = solve(&s, value, &variance);
    if (isnan(left))
        return 0;
    const double sigma = sqrt(variance * left / (double)m.count), own = -value[TERMS - 1] * scale;
    const double doubt = 3.0 * sigma * scale;
    return own > odd_least * film->film && own < odd_most * film->film && own > doubt;
}

/* Where the load's upper part says that contact begins (Hertz): z + F/k over F^(2/3) is a line, over F alone about one.
 */
static double contact_of(const nt_curve_branch *approach)
{
    const double most = nt_curve_highest(approach->force, approach->count);
    double n = 0.0, x = 0.0, z = 0.0, xx = 0.0, xz = 0.0;
    for (long i = 0; i < approach->count; i++) {
        if (!(approach->force[i] > fmax(firm * most, approach->visible)))
            continue;
        const double root = cube_root(approach->force[i] / most), power = root * root;
        n += 1.0;
        x += power;
        z += approach->z[i];
        xx += power * power;
        xz += power * approach->z[i];
    }
    const double spread = n * xx - x * x;
    return spread > 0.0 ? (z * xx - x * xz) / spread : -(double)INFINITY;
}

/* How much the approach repels from z on outwards, out of contact, at most what a film could [N]. */
static double repels(const nt_curve_branch *approach, double z)
{
    const long low = nt_curve_first_from(approach, z);
    const long end = low + OUTWARDS < approach->count ? low + OUTWARDS : approach->count;
    double sum = 0.0;
    for (long i = low; i < end; i++)
        sum += (approach->force[i] + nt_curve_film_at(&approach->baseline.bend, approach->z[i])) / (double)(end - low);
    return fmin(fmax(sum, 0.0), unseen * approach->visible);
}

double nt_curve_held_beyond_film(double depth, double doubt, const nt_curve_reading *reading)
{
    const nt_curve_branch *approach = &reading->approach, *retract = &reading->retract;
    const long block = retract->count / BLOCKS + 1;
    const double contact = contact_of(approach);
    double most = depth - repels(approach, fmax(retract->z[retract->lowest], contact)), torn = 0.0;
    for (int row = 0; row < reading->ruptures; row++) {
        const nt_curve_rupture *rupture = &reading->rupture[row];
        most = fmax(most, rupture->force - repels(approach, fmax(rupture->z, contact)));
        torn = fmax(torn, rupture->step); /* no film tears */
    }
    for (long first = retract->lowest; first + block <= retract->count; first += block) {
        double sum = 0.0;
        for (long i = first; i < first + block; i++)
            sum -= retract->force[i];
        const double mean = sum / (double)block;
        if (mean > most)
            most = fmax(most, mean - repels(approach, fmax(retract->z[first], contact)));
    }
    return fmax(most - doubt, torn);
}
