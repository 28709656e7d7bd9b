/* SPDX-License-Identifier: BSD-3-Clause
 * The baseline of one branch. The line is a robust one through the far half of the travel, then through all beyond the
 * outermost point that this line cannot explain, so that it is hardly extrapolated to where it is needed. */
#include <math.h>

#include "curves/bend.h"
#include "curves/line.h"
#include "curves/parts.h"
#include "curves/robust.h"

static const double far_part = 0.5;   /* of the travel, taken for the first line */
static const double margin = 0.05;    /* of the travel, kept between an event and the baseline that judges it */
static const double correlated = 5.0; /* of white noise this ratio is 1 +- 0.45 */

/* The points with z >= far or z > start. */
static nt_curve_free outside(const nt_curve_segment *segment, double far, double start, double *work)
{
    const long n = segment->count;
    nt_curve_free free = {work, work + n, work + 2 * n, work + 3 * n, work + 4 * n, work + 5 * n, 0, 0.0, 0.0};
    for (long i = 0; i < n; i++) {
        if (!(segment->z[i] >= far || segment->z[i] > start))
            continue;
        free.x[free.count] = segment->z[i];
        free.force[free.count++] = segment->force[i];
        free.z_mean += segment->z[i];
    }
    free.z_mean /= (double)free.count;
    for (long i = 0; i < free.count; i++)
        free.x[i] -= free.z_mean;
    return free;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

static double off_line(const nt_curve_segment *segment, const nt_curve_baseline *line, long i)
{
    return segment->force[i] - line->force - line->slope * (segment->z[i] - line->z_mean);
}

/* z beyond which the line explains every point; -infinity if it explains all. */
static double outermost_event(const nt_curve_segment *segment, const nt_curve_baseline *line, double noise)
{
    double largest = 0.0, start = -INFINITY;
    for (long i = 0; i < segment->count; i++)
        largest = larger(largest, fabs(off_line(segment, line, i)));
    const double limit = fmax(NT_CURVE_EVENT * noise, NT_CURVE_SCATTERED * line->scatter) + 0.1 * largest;
    for (long i = 0; i < segment->count; i++)
        if (fabs(off_line(segment, line, i)) > limit)
            start = larger(start, segment->z[i]);
    return start;
}

static nt_curve_baseline straight(const nt_curve_segment *segment, double noise, double *work, nt_curve_free *free)
{
    const double highest = nt_curve_highest(segment->z, segment->count);
    const double travel = highest - nt_curve_lowest(segment->z, segment->count), far = highest - far_part * travel;
    *free = outside(segment, far, INFINITY, work);
    nt_curve_baseline first = nt_curve_rough_line(free);
    nt_curve_refine_line(free, &first);
    const double start = outermost_event(segment, &first, noise);
    if (!isfinite(start)) {
        nt_curve_judge(free, &first);
        return first;
    }
    *free = outside(segment, far, start + margin * travel, work);
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
        *problem = (nt_problem){"baseline (points between its ends)", "", (double)count, NT_CURVE_FEWEST, 1e9};
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

void nt_curve_baseline_of(const nt_curve_baseline *baseline, const double z[], long count, double force[])
{
    const int straight = baseline->wave.cosine == 0.0 && baseline->wave.sine == 0.0 && baseline->bend.film == 0.0 &&
                         baseline->bend.bow == 0.0;
    if (straight) {
        for (long i = 0; i < count; i++)
            force[i] = baseline->force + baseline->slope * (z[i] - baseline->z_mean);
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
