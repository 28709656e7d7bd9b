/* SPDX-License-Identifier: BSD-3-Clause
 * Where a branch comes out of contact, by several published methods. All take a branch from its largest force outwards,
 * its baseline taken off. */
#include <math.h>

#include "core/same_bits.h"
#include "curves/curves.h"
#include "curves/parts.h"
#include "curves/robust.h"

enum {
    CANDIDATES = 17, /* of the place where two lines meet, in each of */
    ROUNDS = 4,      /* rounds, each of which narrows it by 8 */
    LEAST_BLOCKS = 8
};
static const double steep = 5.0;      /* standard deviations of the baseline's own slope */
static const double lower_half = 0.5; /* of the load, where contact has begun and is still the same contact */

/* From the largest force outwards: z grows, force is over the baseline. */
typedef struct outward {
    const double *z, *force;
    long count, crossing; /* the first point at or below the level where contact is taken to end */
    double visible, stiffness;
} outward;

typedef struct line {
    double slope, level; /* at x = 0 */
} line;

/* Least squares of y over x from x0; NaN where all x are the same. */
static line line_through(const double x[], double x0, const double y[], long count)
{
    double x_mean = 0.0, y_mean = 0.0, spread = 0.0, product = 0.0;
    for (long i = 0; i < count; i++) {
        x_mean += x[i] - x0;
        y_mean += y[i];
    }
    x_mean /= (double)count;
    y_mean /= (double)count;
    for (long i = 0; i < count; i++) {
        spread += (x[i] - x0 - x_mean) * (x[i] - x0 - x_mean);
        product += (x[i] - x0 - x_mean) * (y[i] - y_mean);
    }
    const double slope = product / spread;
    return (line){slope, y_mean - slope * x_mean};
}

static long load_start(const outward *branch)
{
    long start = 0;
    for (long i = 0; i < branch->crossing; i++)
        start = branch->force[i] > lower_half * branch->force[0] ? i : start;
    return start;
}

static double line_down(const outward *branch)
{
    const long start = load_start(branch), count = branch->crossing - start;
    if (count < 4)
        return NAN;
    const line found = line_through(branch->z + start, branch->z[start], branch->force + start, count);
    return found.slope < 0.0 ? branch->z[start] - found.level / found.slope : (double)NAN;
}

/* Sums over the first points, x = z - z of the first of them. */
typedef struct hinge_sums {
    double count, x, xx, force, product;
} hinge_sums;

/* Drop of the sum of squares by F = max(0, s (x0 - x)) of the points before x0. */
static double hinge_gain(const hinge_sums *s, double x0)
{
    const double product = fmax(x0 * s->force - s->product, 0.0);
    const double squares = fmax((x0 * s->count - 2.0 * s->x) * x0 + s->xx, 0.0);
    return product * product / fmax(squares, 1e-300);
}

/* Through the lower half of the load and as far beyond. */
static double hinge(const outward *branch)
{
    const long start = load_start(branch), wanted = start + 2 * (branch->crossing - start) + 8;
    const long stop = wanted < branch->count ? wanted : branch->count;
    const double *z = branch->z, from = z[start];
    double low = 0.0, high = z[stop - 1] - from, best = NAN;
    for (int round = 0; round < ROUNDS; round++) {
        const double step = (high - low) / (CANDIDATES - 1);
        hinge_sums s = {0.0, 0.0, 0.0, 0.0, 0.0};
        double most = -1.0;
        long i = start;
        for (int candidate = 0; candidate < CANDIDATES; candidate++) {
            const double tried = candidate + 1 < CANDIDATES ? low + step * candidate : high;
            for (; i < stop && z[i] - from < tried; i++) { /* z grows */
                const double x = z[i] - from;
                s.count += 1.0;
                s.x += x;
                s.xx += x * x;
                s.force += branch->force[i];
                s.product += x * branch->force[i];
            }
            const double gain = hinge_gain(&s, tried);
            if (gain > most) {
                most = gain;
                best = tried;
            }
        }
        low = best - step;
        high = best + step;
    }
    return from + best;
}

/* From outside, the first block of points that is steeper than the baseline's blocks are. */
static double gradient(const outward *branch, double *slope)
{
    const long size = branch->count / 100 > 8 ? branch->count / 100 : 8, blocks = branch->count / size;
    if (blocks < LEAST_BLOCKS)
        return NAN;
    double count = 0.0, mean = 0.0, squares = 0.0;
    for (long b = 0; b < blocks; b++) {
        slope[b] = -line_through(branch->z + b * size, branch->z[b * size], branch->force + b * size, size).slope;
        if (branch->z[b * size] > branch->z[branch->crossing]) {
            count += 1.0;
            mean += slope[b];
        }
    }
    if (count < 4.0)
        return NAN;
    mean /= count;
    for (long b = 0; b < blocks; b++)
        if (branch->z[b * size] > branch->z[branch->crossing])
            squares += (slope[b] - mean) * (slope[b] - mean);
    for (long b = blocks - 1; b >= 0; b--) {
        if (!(slope[b] > steep * sqrt(squares / count)))
            continue;
        double z = 0.0;
        for (long i = 0; i < size; i++)
            z += branch->z[b * size + i];
        return z / (double)size;
    }
    return NAN;
}

/* With F^(2/3) proportional to the indentation, z = z0 - alpha F^(2/3) - F/k_c: its z0. scratch: 2 crossing. */
static double hertz(const outward *branch, double *scratch)
{
    double *power = scratch, *above = scratch + branch->crossing;
    long count = 0;
    for (long i = 0; i < branch->crossing; i++)
        if (branch->force[i] > branch->visible) {
            const double root = cube_root(branch->force[i]);
            power[count] = root * root;
            above[count++] = branch->z[i] + branch->force[i] / branch->stiffness;
        }
    if (isnan(branch->stiffness) || count < 8)
        return NAN;
    return line_through(power, 0.0, above, count).level;
}

static double within(const outward *branch, double z)
{
    return z > branch->z[0] && z <= branch->z[branch->count - 1] ? z : (double)NAN;
}

/* Steepness of the force about a point [N/m]. */
static double steepness(const nt_curve_branch *branch, long peak, long after, double z)
{
    const long reach = branch->count / 100 > 5 ? branch->count / 100 : 5;
    const long from = after - reach > peak ? after - reach : peak;
    const long to = after + reach < branch->count ? after + reach : branch->count;
    return fabs(line_through(branch->z + from, z, branch->force + from, to - from).slope);
}

/* Median of those that can say, and their standard deviation about their mean. */
static nt_curve_measured spread_of(const double points[NT_CURVE_METHODS])
{
    double found[NT_CURVE_METHODS], mean = 0.0, squares = 0.0;
    int count = 0;
    for (int i = 0; i < NT_CURVE_METHODS; i++)
        if (!isnan(points[i]))
            found[count++] = points[i];
    for (int i = 0; i < count; i++)
        mean += found[i] / count;
    for (int i = 0; i < count; i++)
        squares += (found[i] - mean) * (found[i] - mean);
    return (nt_curve_measured){nt_curve_median(found, count), sqrt(squares / count)};
}

void nt_curve_find_contact(const nt_curve_branch *first, double spring_constant, double *scratch,
                           nt_curve_reading *reading)
{
    const double level = first->dips ? 0.0 : first->visible;
    const long peak = nt_curve_place_of_highest(first->force, first->count);
    for (int i = 0; i < NT_CURVE_METHODS; i++)
        reading->contact_points[i] = NAN;
    reading->contact_point = (nt_curve_measured){NAN, NAN};
    long after = peak;
    while (after < first->count && first->force[after] > level)
        after++;
    if (first->force[peak] <= first->visible || after == first->count)
        return;
    const double *z = first->z, *force = first->force;
    const double part = (force[after - 1] - level) / (force[after - 1] - force[after]);
    const double crossing = z[after - 1] + (z[after] - z[after - 1]) * part;
    const outward branch = {z + peak, force + peak, first->count - peak, after - peak, first->visible, spring_constant};
    double *points = reading->contact_points;
    points[first->dips ? NT_CURVE_CROSSING : NT_CURVE_DEVIATION] = crossing;
    points[NT_CURVE_HERTZ] = within(&branch, hertz(&branch, scratch));
    points[NT_CURVE_TWO_LINES] = within(&branch, first->dips ? line_down(&branch) : hinge(&branch));
    points[NT_CURVE_GRADIENT] = first->dips ? (double)NAN : within(&branch, gradient(&branch, scratch));
    reading->contact_point = spread_of(points);
    const double rise = steepness(first, peak, after, crossing);
    const double statistical = rise > 0.0 ? nt_curve_branch_sigma(first, crossing) / rise : (double)NAN;
    reading->contact_point.sigma = hypotenuse(statistical, reading->contact_point.sigma);
}
