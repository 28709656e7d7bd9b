/* SPDX-License-Identifier: BSD-3-Clause
 * A line through a bow, a step or contact leaves more than noise in the means of its parts. Whatever it is may go on as
 * a parabola does, which leaves 0.298 of its size RMS, and is (u^2 - 1/3) times it at u halves from the middle: tilt
 * and level are known to what that makes at the deepest point. */
#include "curves/straight.h"

#include <math.h>

#include "core/same_bits.h"
#include "internal/curves.h"

enum { PARTS = 16, NEAR = 5 };
static const double no_noise = 6.0; /* times the variance of a part's mean */
static const double surely = 3.0;   /* standard deviations of the bend */
static const double of_parabola = 0.298;
static const double outermost = 0.05; /* of the travel: the outer end of a branch */

typedef struct parts {
    double mean[PARTS], variance; /* from the nearest outwards; of one of them */
    double half;                  /* of the length [m] */
    double deepest;               /* u of the deepest point [-] */
} parts;

static int take(const nt_curve_branch *branch, parts *found)
{
    long first = 0;
    while (first < branch->count && branch->z[first] < branch->baseline.nearest)
        first++;
    const long n = branch->count - first;
    if (n < PARTS)
        return 0;
    for (int part = 0; part < PARTS; part++) {
        const long from = first + part * n / PARTS, to = first + (part + 1) * n / PARTS;
        found->mean[part] = 0.0;
        for (long i = from; i < to; i++)
            found->mean[part] += branch->force[i] / (double)(to - from);
    }
    const double white = fmax(branch->baseline.noise.white, branch->noise * branch->noise);
    found->variance = white * PARTS / (double)n + branch->baseline.noise.flicker;
    found->half = 0.5 * (branch->z[branch->count - 1] - branch->z[first]);
    found->deepest = (branch->z[branch->count - 1] - branch->z[0]) / found->half - 1.0;
    return found->half > 0.0;
}

/* Mean square of the parts' means from `first` on [N^2]. */
static double mean_square(const parts *p, int first)
{
    double square = 0.0;
    for (int part = first; part < PARTS; part++)
        square += p->mean[part] * p->mean[part] / (PARTS - first);
    return square;
}

/* 1 where the parts are no line; level and tilt are doubted. What bends the nearest quarter alone is the contact's
 * foot, which does not go on so. */
static int doubt(const parts *p, nt_curve_baseline *baseline)
{
    const double square = mean_square(p, 0), outer = mean_square(p, PARTS / 4);
    if (square < no_noise * p->variance)
        return 0;
    const int goes_on = outer > no_noise * p->variance;
    const double there = (p->deepest * p->deepest - 1.0 / 3.0) / of_parabola, tilt = there / (p->deepest * p->half);
    baseline->force_variance += square;
    baseline->slope_variance += goes_on ? tilt * tilt * outer : 3.0 * square / (p->half * p->half);
    return 1;
}

/* Contact repels the more, the nearer: both ends lie above the middle. */
static int bends_as_contact(const parts *p)
{
    double bend = 0.0;
    for (int i = 0; i < PARTS / 4; i++)
        bend += p->mean[i] + p->mean[PARTS - 1 - i] - p->mean[PARTS / 2 - 1 - i] - p->mean[PARTS / 2 + i];
    return bend > surely * sqrt(PARTS * p->variance);
}

/* Mean force of the outer end of a branch, its baseline put back [N]. */
static double outer_level(const nt_curve_branch *branch)
{
    const double *z = branch->z, highest = z[branch->count - 1], from = highest - outermost * (highest - z[0]);
    double sum = 0.0;
    long n = 0;
    for (long i = branch->count - 1; i >= 0 && z[i] >= from; i--, n++)
        sum += branch->force[i] + nt_curve_baseline_at(&branch->baseline, z[i]);
    return sum / (double)n;
}

/* Smallest mean of NEAR neighbours on a branch, its baseline put back [N], and where that is. */
static double lowest_of(const nt_curve_branch *branch, double *z)
{
    double lowest = INFINITY;
    for (long i = 0; i + NEAR <= branch->count; i++) {
        double mean = 0.0;
        for (long j = i; j < i + NEAR; j++)
            mean += (branch->force[j] + nt_curve_baseline_at(&branch->baseline, branch->z[j])) / NEAR;
        if (mean < lowest) {
            lowest = mean;
            *z = branch->z[i + NEAR / 2];
        }
    }
    return lowest;
}

static void bound_pull_off(nt_curve_reading *reading)
{
    nt_curve_branch *retract = &reading->retract;
    double z = NAN;
    const double lowest = lowest_of(retract, &z), noise = retract->noise;
    const double one = outer_level(&reading->approach) - lowest, other = outer_level(retract) - lowest;
    const double least = fmax(fmin(one, other) - noise, 0.0), most = fmax(fmax(one, other), 0.0) + noise;
    reading->pull_off_least = least;
    reading->pull_off_most = most;
    reading->pull_off_sigma = noise;
    retract->dip.value = fmin(fmax(retract->dip.value, least), most);
    retract->dip.sigma = hypotenuse((most - least) / sqrt(12.0), noise);
    retract->dip_z = z;
}

void nt_curve_doubt_straightness(nt_curve_reading *reading)
{
    parts found;
    nt_curve_branch *approach = &reading->approach;
    if (!approach->count || !take(approach, &found) || !doubt(&found, &approach->baseline))
        return;
    const double far = approach->z[approach->count - 1], near = approach->baseline.nearest;
    const int rises = nt_curve_baseline_at(&approach->baseline, near) > nt_curve_baseline_at(&approach->baseline, far);
    if (reading->retract.count && rises && bends_as_contact(&found))
        bound_pull_off(reading);
}
