/* SPDX-License-Identifier: BSD-3-Clause
 * The baseline of one branch. The line is a robust one through the far half of the travel, then through all beyond the
 * outermost point that this line cannot explain, so that it is hardly extrapolated to where it is needed. */
#include <math.h>
#include <stdint.h>

#include "core/problem.h"
#include "core/variants.h"
#include "curves/bend.h"
#include "curves/line.h"
#include "curves/parts.h"
#include "curves/robust.h"
#include "internal/curves.h"

static const double far_part = 0.5;   /* of the travel, taken for the first line */
static const double margin = 0.05;    /* of the travel, kept between an event and the baseline that judges it */
static const double of_largest = 0.1; /* deviation: a baseline bends by less */
static const double deep = 8.0;       /* times what is seen: where a cone or sphere reaches that, */
static const double least_deep = 3.0; /* or this where the force does not go on as far, */
static const double of_load = 0.8;    /* of the largest force at most */
static const double of_foot = 1.3;    /* tells where its contact began, a third of the way further out for sureness */
static const double most_foot = 0.25; /* of the travel: what is longer is no foot, but bends */
static const double correlated = 5.0; /* of white noise this ratio is 1 +- 0.45 */

/* Copies the points with z >= far or z > start; how many. Without a branch. */
NT_VARIANTS static long keep(const nt_curve_segment *segment, const double ends[2], double *restrict x,
                             double *restrict force)
{
    const double far = ends[0], start = ends[1], *z = segment->z;
    int64_t is_kept[NT_LANES], kept = 0;
    for (long i = 0; i < segment->count; i += NT_LANES) {
        const int n = nt_lanes_from(i, segment->count);
        for (int j = 0; j < n; j++)
            is_kept[j] = (z[i + j] >= far) | (z[i + j] > start);
        for (int j = 0; j < n; j++) {
            x[kept] = z[i + j];
            force[kept] = segment->force[i + j];
            kept += is_kept[j];
        }
    }
    return (long)kept;
}

/* The points with z >= far or z > start. */
static nt_curve_free outside(const nt_curve_segment *segment, double far, double start, double *work)
{
    const long n = segment->count;
    nt_curve_free free = {work, work + n, work + 2 * n, work + 3 * n, work + 4 * n, work + 5 * n, 0, 0.0, 0.0, 0.0};
    free.count = keep(segment, (double[2]){far, start}, free.x, free.force);
    free.nearest = nt_curve_lowest(free.x, free.count);
    free.z_mean = nt_curve_sum(free.x, free.count) / (double)free.count;
    for (long i = 0; i < free.count; i++)
        free.x[i] -= free.z_mean;
    return free;
}

/* What a line leaves of all points. */
NT_VARIANTS static void leave(const nt_curve_segment *segment, const nt_curve_baseline *line, double *restrict off)
{
    const double level = line->force, slope = line->slope, z_mean = line->z_mean, *z = segment->z,
                 *force = segment->force;
    for (long i = 0; i < segment->count; i++)
        off[i] = force[i] - level - slope * (z[i] - z_mean);
}

/* Largest z at which the size of off is above the first level, and off above the others; -infinity without any. */
NT_VARIANTS static void last_beyond(const nt_curve_segment *segment, const double *off, const double level[3],
                                    double last[3])
{
    double start[NT_LANES], shallow[NT_LANES], strong[NT_LANES];
    const double *z = segment->z, nowhere = -INFINITY;
    const double event = level[0], seen = level[1], deeper = level[2];
    for (int j = 0; j < NT_LANES; j++)
        start[j] = shallow[j] = strong[j] = nowhere;
    for (long i = 0; i < segment->count; i += NT_LANES)
        for (int j = 0, n = nt_lanes_from(i, segment->count); j < n; j++) {
            const double here = z[i + j], at = off[i + j];
            const double a = fabs(at) > event ? here : nowhere, b = at > seen ? here : nowhere,
                         c = at > deeper ? here : nowhere;
            start[j] = a > start[j] ? a : start[j];
            shallow[j] = b > shallow[j] ? b : shallow[j];
            strong[j] = c > strong[j] ? c : strong[j];
        }
    last[0] = nt_lanes_highest(start);
    last[1] = nt_lanes_highest(shallow);
    last[2] = nt_lanes_highest(strong);
}

/* z beyond which the line explains every point, the foot of a soft contact and a margin left out; -infinity if it
 * explains all. Force over depth^2, the slowest of tips, grows from L to r L over (sqrt(r) - 1) of the foot's length.
 * off: count doubles. */
static double free_from(const nt_curve_segment *segment, const nt_curve_baseline *line, double noise, double travel,
                        double *off)
{
    leave(segment, line, off);
    const double highest = nt_curve_highest(off, segment->count), lowest = nt_curve_lowest(off, segment->count);
    const double largest = highest > -lowest ? highest : -lowest;
    const double seen = NT_CURVE_EVENT * fmax(noise, line->scatter); /* smeared noise scatters more than it steps */
    const double ratio = fmin(deep, of_load * largest / seen), deeper = ratio * seen;
    const double event = fmax(NT_CURVE_EVENT * noise, NT_CURVE_SCATTERED * line->scatter) + of_largest * largest;
    double last[3];
    last_beyond(segment, off, (double[3]){event, seen, deeper}, last);
    const double start = last[0], shallow = last[1], strong = last[2];
    const double beyond = start + margin * travel;
    const double foot = shallow + of_foot / (sqrt(fmax(ratio, least_deep)) - 1.0) * (shallow - strong);
    return ratio >= least_deep && foot > beyond && foot < start + most_foot * travel ? foot : beyond;
}

static nt_curve_baseline straight(const nt_curve_segment *segment, double noise, double *work, nt_curve_free *free)
{
    const double highest = nt_curve_highest(segment->z, segment->count);
    const double travel = highest - nt_curve_lowest(segment->z, segment->count), far = highest - far_part * travel;
    *free = outside(segment, far, INFINITY, work);
    nt_curve_baseline first = nt_curve_rough_line(free);
    nt_curve_refine_line(free, &first);
    const double start = free_from(segment, &first, noise, travel, free->weight);
    if (!isfinite(start)) {
        nt_curve_judge(free, &first);
        return first;
    }
    *free = outside(segment, far, start, work);
    return nt_curve_line(free);
}

static nt_curve_baseline constant(const nt_curve_segment *segment, double *work)
{
    const double highest = nt_curve_highest(segment->z, segment->count);
    const double travel = highest - nt_curve_lowest(segment->z, segment->count);
    nt_curve_free free = outside(segment, highest - far_part * travel, INFINITY, work);
    for (long i = 0; i < free.count; i++)
        free.scratch[i] = free.force[i];
    nt_curve_baseline found = {.force = nt_curve_median(free.scratch, free.count), .z_mean = free.z_mean};
    found.nearest = free.nearest;
    for (long i = 0; i < free.count; i++)
        free.rest[i] = free.force[i] - found.force;
    found.scatter = NT_MAD_SIGMA * nt_curve_median_size(free.rest, free.count, free.scratch);
    nt_curve_judge(&free, &found);
    found.slope_variance = 0.0;
    return found;
}

static nt_status between(const nt_curve_segment *segment, const nt_curve_choice *choice, double *work,
                         nt_curve_baseline *baseline, nt_problem *problem)
{
    long count = 0;
    double *z = work, *force = work + segment->count;
    for (long i = 0; i < segment->count; i++) {
        if (!(segment->z[i] >= choice->lowest && segment->z[i] <= choice->highest))
            continue;
        z[count] = segment->z[i];
        force[count++] = segment->force[i];
    }
    if (count < NT_CURVE_FEWEST) {
        *problem = nt_problem_of("baseline (points between its ends)", "", (double)count, NT_CURVE_FEWEST, 1e9);
        return NT_E_RANGE;
    }
    const nt_curve_segment part = {z, force, count};
    nt_curve_free free = outside(&part, choice->lowest, INFINITY, work + 2 * segment->count);
    *baseline = nt_curve_line(&free);
    return NT_OK;
}

nt_status nt_curve_fit_baseline(const nt_curve_segment *segment, const nt_curve_choice *choice, double *work,
                                nt_curve_baseline *baseline, nt_problem *problem)
{
    const double noise = nt_curve_point_noise(segment->force, segment->count, work);
    return nt_curve_baseline_over(segment, choice, noise, work, baseline, problem);
}

nt_status nt_curve_baseline_over(const nt_curve_segment *segment, const nt_curve_choice *choice, double noise,
                                 double *work, nt_curve_baseline *baseline, nt_problem *problem)
{
    nt_problem ignored;
    nt_curve_free free;
    switch (choice->kind) {
    case NT_CURVE_BETWEEN:
        return between(segment, choice, work, baseline, problem ? problem : &ignored);
    case NT_CURVE_CONSTANT:
        *baseline = constant(segment, work);
        return NT_OK;
    case NT_CURVE_AUTO:
    case NT_CURVE_LINE:
    case NT_CURVE_WAVE:
        *baseline = straight(segment, noise, work, &free);
        if (choice->kind == NT_CURVE_WAVE ||
            (choice->kind == NT_CURVE_AUTO && nt_curve_correlation(&free, baseline->scatter) >= correlated))
            *baseline = nt_curve_with_wave(&free, baseline, choice->kind == NT_CURVE_WAVE);
        return NT_OK;
    }
    return NT_E_ARGUMENT;
}

double nt_curve_baseline_at(const nt_curve_baseline *baseline, double z)
{
    const double x = z - baseline->z_mean;
    return baseline->force + baseline->slope * x + nt_curve_wave_at(&baseline->wave, x) +
           nt_curve_bend_at(&baseline->bend, z, x);
}

NT_VARIANTS static void straight_of(const nt_curve_baseline *baseline, const double z[], long count,
                                    double *restrict force)
{
    const double level = baseline->force, slope = baseline->slope, z_mean = baseline->z_mean;
    for (long i = 0; i < count; i++)
        force[i] = level + slope * (z[i] - z_mean);
}

void nt_curve_baseline_of(const nt_curve_baseline *baseline, const double z[], long count, double force[])
{
    const int straight = baseline->wave.cosine == 0.0 && baseline->wave.sine == 0.0 && baseline->bend.film == 0.0 &&
                         baseline->bend.bow == 0.0;
    if (straight) {
        straight_of(baseline, z, count, force);
        return;
    }
    for (long i = 0; i < count; i++)
        force[i] = nt_curve_baseline_at(baseline, z[i]);
}

double nt_curve_baseline_sigma(const nt_curve_baseline *baseline, double z)
{
    const double x = z - baseline->z_mean;
    return sqrt(baseline->force_variance + baseline->slope_variance * x * x);
}
