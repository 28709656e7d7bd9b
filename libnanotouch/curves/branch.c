/* SPDX-License-Identifier: BSD-3-Clause
 * What happens on one branch: snap-in or pull-off, the tearing-off, the work of adhesion, the slope in contact. */
#include <float.h>
#include <math.h>
#include <stdint.h>

#include "core/same_bits.h"
#include "core/variants.h"
#include "curves/curves.h"
#include "curves/parts.h"
#include "curves/robust.h"
#include "internal/curves.h"

enum { NEIGHBOURS = 5 };
static const double end_part = 0.1; /* of the travel, beyond which no baseline is left to judge a point by */
static const double before_tear = 0.5, after_tear = 0.25; /* of the depth: a tear leads past both within two points */
static const double beyond_contact = 1.5;                 /* of the loaded travel, seen where nothing attracts */
static const double in_contact = 0.5;                     /* of the load: from there on contact is firm */

long nt_curve_first_from(const nt_curve_branch *branch, double limit)
{
    long low = 0, high = branch->count;
    while (low < high) {
        const long middle = low + (high - low) / 2;
        if (branch->z[middle] < limit)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static long lowest(const nt_curve_branch *branch)
{
    const double last = branch->z[branch->count - 1];
    const long inner = nt_curve_first_from(branch, last - end_part * (last - branch->z[0]));
    return nt_curve_place_of_lowest(branch->force, inner);
}

/* Least sum of NEIGHBOURS of count forces [N]; 0 where none is negative. */
NT_VARIANTS static double lowest_sum(const double force[], long count)
{
    double deepest[NT_LANES] = {0.0};
    const long sums = count - NEIGHBOURS + 1;
    for (long i = 0; i < sums; i += NT_LANES)
        for (int j = 0, n = nt_lanes_from(i, sums); j < n; j++) {
            const double *f = force + i + j;
            const double depth = -(f[0] + f[1] + f[2] + f[3] + f[4]);
            deepest[j] = depth > deepest[j] ? depth : deepest[j];
        }
    return -nt_lanes_highest(deepest);
}

static int dips(const nt_curve_branch *branch)
{
    if (-branch->force[branch->lowest] > branch->visible)
        return 1;
    const long end = branch->lowest + NEIGHBOURS < branch->count ? branch->lowest + NEIGHBOURS : branch->count;
    const double smallest = lowest_sum(branch->force, end) / NEIGHBOURS;
    return -smallest > fmax(NT_CURVE_EVENT / sqrt((double)NEIGHBOURS) * branch->noise,
                            NT_CURVE_SCATTERED * branch->baseline.scatter);
}

static long torn(const nt_curve_branch *branch)
{
    if (!branch->dips)
        return -1;
    const double depth = -branch->force[branch->lowest];
    long after = branch->lowest;
    while (after < branch->count && !(branch->force[after] > -before_tear * depth))
        after++;
    if (after == branch->count)
        return -1;
    const long next = after + 1 < branch->count ? after + 1 : after;
    return fmax(branch->force[after], branch->force[next]) > -after_tear * depth ? after - 1 : -1;
}

static long repulsive(const nt_curve_branch *branch)
{
    long zero = nt_curve_place_of_highest(branch->force, branch->count);
    while (zero < branch->count && branch->force[zero] > 0.0)
        zero++;
    if (branch->dips)
        return zero;
    const double end = branch->z[zero < branch->count ? zero : branch->count - 1];
    const long beyond = nt_curve_first_from(branch, branch->z[0] + beyond_contact * (end - branch->z[0]));
    return beyond > zero ? beyond : zero;
}

/* From where the force crosses the baseline to its last visible dip. */
static nt_curve_measured adhesion_work(const nt_curve_branch *branch)
{
    if (!branch->dips)
        return (nt_curve_measured){0.0, NAN};
    const double limit = fmax(-branch->visible, branch->force[branch->lowest]);
    long first = branch->lowest, last = branch->count - 1;
    while (first > 0 && branch->force[first - 1] < 0.0)
        first--;
    while (!(branch->force[last] <= limit))
        last--;
    last += last + 1 < branch->count;
    double area = 0.0, squares = 0.0;
    for (long i = first; i < last; i++) {
        const double step = branch->z[i + 1] - branch->z[i];
        area -= 0.5 * (branch->force[i] + branch->force[i + 1]) * step;
        squares += step * step;
    }
    const double level = nt_curve_baseline_sigma(&branch->baseline, branch->z[branch->lowest]);
    return (nt_curve_measured){area,
                               hypotenuse(level * (branch->z[last] - branch->z[first]), branch->noise * sqrt(squares))};
}

static nt_curve_measured contact_slope(const nt_curve_branch *branch)
{
    const double load = nt_curve_highest(branch->force, branch->count), least = in_contact * load;
    double count = 0.0, z_mean = 0.0, mean = 0.0, spread = 0.0, product = 0.0, squares = 0.0;
    const long end = nt_curve_last_above(branch->force, branch->count, least) + 1;
    for (long i = 0; i < end; i++) {
        const double firm = branch->force[i] > least;
        count += firm;
        z_mean += firm * branch->z[i];
        mean += firm * branch->force[i];
    }
    if (load <= branch->visible || count < 4.0)
        return (nt_curve_measured){NAN, NAN};
    z_mean /= count;
    mean /= count;
    for (long i = 0; i < end; i++) {
        const double x = branch->z[i] - z_mean, firm = branch->force[i] > least;
        spread += firm * x * x;
        product += firm * x * (branch->force[i] - mean);
    }
    const double slope = product / spread, rounding = 8.0 * DBL_EPSILON * z_mean;
    if (!(spread > count * rounding * rounding) || !isfinite(slope)) /* the base did not move in contact */
        return (nt_curve_measured){NAN, NAN};
    for (long i = 0; i < end; i++) {
        const double rest = branch->force[i] - mean - slope * (branch->z[i] - z_mean);
        squares += branch->force[i] > least ? rest * rest : 0.0;
    }
    return (nt_curve_measured){-slope, sqrt(squares / (count - 2.0) / spread)};
}

/* 1: z grows, -1: it falls, 0: neither. */
NT_VARIANTS static int order_of(const double z[], long count)
{
    int64_t grows = 1, falls = 1;
    for (long i = 1; i < count; i++) {
        grows &= z[i - 1] <= z[i];
        falls &= z[i] < z[i - 1];
    }
    return (int)(grows - falls);
}

/* The force of a branch over its baseline, which was put behind the room of both, from its last point to its first. */
NT_VARIANTS static void reverse(const nt_curve_segment *segment, double *restrict work)
{
    const long n = segment->count;
    const double *z = segment->z, *force = segment->force;
    for (long i = 0; i < n; i++) {
        work[i] = z[n - 1 - i];
        work[n + i] = force[n - 1 - i] - work[2 * n + (n - 1 - i)];
    }
}

NT_VARIANTS static void copy(const nt_curve_segment *segment, double *restrict work)
{
    const long n = segment->count;
    const double *z = segment->z, *force = segment->force;
    for (long i = 0; i < n; i++) {
        work[i] = z[i];
        work[n + i] = force[i] - work[2 * n + i];
    }
}

void nt_curve_order(const nt_curve_segment *segment, const nt_curve_baseline *baseline, double *work)
{
    const long n = segment->count;
    double *level = work + 2 * n;
    const int order = order_of(segment->z, n);
    nt_curve_baseline_of(baseline, segment->z, n, order ? level : work);
    if (order) {
        (order > 0 ? copy : reverse)(segment, work);
        return;
    }
    nt_curve_point *points = (nt_curve_point *)(void *)level;
    for (long i = 0; i < n; i++)
        points[i] = (nt_curve_point){segment->z[i], segment->force[i] - work[i]};
    nt_curve_sort(points, n, points + n);
    for (long i = 0; i < n; i++) {
        work[i] = points[i].z;
        work[n + i] = points[i].force;
    }
}

double nt_curve_branch_sigma(const nt_curve_branch *branch, double z)
{
    return hypotenuse(branch->noise, nt_curve_baseline_sigma(&branch->baseline, z));
}

void nt_curve_know_events(nt_curve_branch *branch)
{
    branch->dip.sigma = nt_curve_branch_sigma(branch, branch->z[branch->lowest]);
    branch->adhesion_work = adhesion_work(branch);
}

void nt_curve_read_events(const nt_curve_segment *segment, const nt_curve_baseline *baseline, double noise,
                          double *work, nt_curve_branch *branch)
{
    nt_curve_order(segment, baseline, work);
    *branch = (nt_curve_branch){
        .z = work,
        .force = work + segment->count,
        .count = segment->count,
        .baseline = *baseline,
        .noise = noise,
        .visible = fmax(NT_CURVE_EVENT * noise, NT_CURVE_SCATTERED * baseline->scatter),
    };
    branch->lowest = lowest(branch);
    branch->dips = dips(branch);
    branch->torn = torn(branch);
    branch->repulsive = repulsive(branch);
    branch->dip.value = branch->dips ? -branch->force[branch->lowest] : 0.0;
    branch->dip_z = branch->dips ? branch->z[branch->lowest] : (double)NAN;
    branch->contact_slope = contact_slope(branch);
    nt_curve_know_events(branch);
}

nt_status nt_curve_read_branch(const nt_curve_segment *segment, const nt_curve_choice *choice, double *work,
                               nt_curve_branch *branch, nt_problem *problem)
{
    nt_curve_baseline baseline;
    const double noise = nt_curve_point_noise(segment->force, segment->count, work);
    const nt_status status = nt_curve_baseline_over(segment, choice, noise, work, &baseline, problem);
    if (status == NT_OK)
        nt_curve_read_events(segment, &baseline, noise, work, branch);
    return status;
}
