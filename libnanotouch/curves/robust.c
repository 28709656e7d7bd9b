/* SPDX-License-Identifier: BSD-3-Clause
 * Quickselect (Hoare 1961) with a pivot that no order of the values can foresee, and a merge sort that leaves ordered
 * pieces alone. */
#include "curves/robust.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/variants.h"

enum { SAMPLE = 63, MIDDLE = 10, MANY = 256 }; /* MIDDLE: 2.5 standard deviations of the rank of a sample's median */
enum { FEW = 24, DRAWN = 4 }; /* values that are sorted out at once; times that ends are drawn closer */

static const double closer = 1.5; /* times sqrt(n)/n of the values: three standard deviations of a middle rank */

/* Those below the pivot, or equal to it, come first; returns how many. Without a branch, which noise makes a processor
 * mistake half of the time. */
static long part(double values[], long count, double pivot, int equal)
{
    long below = 0;
    for (long i = 0; i < count; i++) {
        const double value = values[i];
        values[i] = values[below];
        values[below] = value;
        below += (value < pivot) | (equal & (value == pivot));
    }
    return below;
}

/* Puts the value of rank k at its place; smaller ones before it. */
static double select(double values[], long count, long k)
{
    uint64_t state = 0x9e3779b97f4a7c15u;
    while (count > 1) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        const double pivot = values[(long)((state >> 32) * (uint64_t)count >> 32)];
        long below = part(values, count, pivot, 0);
        if (k < below) {
            count = below;
            continue;
        }
        if (below == 0) { /* none is smaller: all that are equal at once */
            below = part(values, count, pivot, 1);
            if (k < below || below == 0) /* NaN is not even itself */
                return pivot;
        }
        values += below;
        count -= below;
        k -= below;
    }
    return values[0];
}

NT_VARIANTS double nt_curve_highest(const double values[], long count)
{
    double highest[NT_LANES];
    for (int j = 0; j < NT_LANES; j++)
        highest[j] = values[0];
    for (long i = 0; i < count; i += NT_LANES)
        for (int j = 0, n = nt_lanes_from(i, count); j < n; j++)
            highest[j] = values[i + j] > highest[j] ? values[i + j] : highest[j];
    return nt_lanes_highest(highest);
}

NT_VARIANTS double nt_curve_lowest(const double values[], long count)
{
    double highest[NT_LANES]; /* of -values */
    for (int j = 0; j < NT_LANES; j++)
        highest[j] = -values[0];
    for (long i = 0; i < count; i += NT_LANES)
        for (int j = 0, n = nt_lanes_from(i, count); j < n; j++)
            highest[j] = -values[i + j] > highest[j] ? -values[i + j] : highest[j];
    return -nt_lanes_highest(highest);
}

/* The first place of the highest of sign * values. */
NT_VARIANTS static long place_of(const double values[], long count, double sign)
{
    double highest[NT_LANES];
    int64_t place[NT_LANES];
    for (int j = 0; j < NT_LANES; j++) {
        highest[j] = -INFINITY;
        place[j] = 0;
    }
    for (long i = 0; i < count; i += NT_LANES)
        for (int j = 0, n = nt_lanes_from(i, count); j < n; j++) {
            const double value = sign * values[i + j];
            place[j] = value > highest[j] ? i + j : place[j];
            highest[j] = value > highest[j] ? value : highest[j];
        }
    int best = 0;
    for (int j = 1; j < NT_LANES; j++)
        best = highest[j] > highest[best] || (highest[j] == highest[best] && place[j] < place[best]) ? j : best;
    return (long)place[best];
}

long nt_curve_place_of_highest(const double values[], long count)
{
    return place_of(values, count, 1.0);
}

long nt_curve_place_of_lowest(const double values[], long count)
{
    return place_of(values, count, -1.0);
}

NT_VARIANTS int nt_curve_all_within(const double values[], long count, double limit)
{
    int64_t beyond = 0;
    for (long i = 0; i < count; i++)
        beyond |= !(fabs(values[i]) <= limit);
    return !beyond;
}

NT_VARIANTS double nt_curve_sum(const double values[], long count)
{
    double sum[NT_LANES] = {0.0};
    for (long i = 0; i < count; i += NT_LANES)
        for (int j = 0, n = nt_lanes_from(i, count); j < n; j++)
            sum[j] += values[i + j];
    return nt_lanes_sum(sum);
}

NT_VARIANTS double nt_curve_square_sum(const double values[], long count)
{
    double sum[NT_LANES] = {0.0};
    for (long i = 0; i < count; i += NT_LANES)
        for (int j = 0, n = nt_lanes_from(i, count); j < n; j++)
            sum[j] += values[i + j] * values[i + j];
    return nt_lanes_sum(sum);
}

long nt_curve_last_above(const double values[], long count, double level)
{
    long end = count;
    while (end > 0) {
        const long first = end > NT_LANES ? end - NT_LANES : 0;
        if (nt_curve_highest(values + first, end - first) > level)
            break;
        end = first;
    }
    while (end > 0 && !(values[end - 1] > level))
        end--;
    return end - 1;
}

/* How many lie from low to high, and how many below. */
NT_VARIANTS static long count_between(const double values[], long count, const double ends[2], long *below)
{
    const double low = ends[0], high = ends[1];
    int64_t lower[NT_LANES] = {0}, higher[NT_LANES] = {0};
    for (long i = 0; i < count; i += NT_LANES)
        for (int j = 0, n = nt_lanes_from(i, count); j < n; j++) {
            lower[j] += values[i + j] < low;
            higher[j] += values[i + j] > high;
        }
    for (int j = 1; j < NT_LANES; j++) {
        lower[0] += lower[j];
        higher[0] += higher[j];
    }
    *below = (long)lower[0];
    return count - (long)(lower[0] + higher[0]);
}

/* Leaves those from low to high at the beginning, the others nowhere. Without a branch. */
NT_VARIANTS static void gather(double values[], long count, const double ends[2])
{
    const double low = ends[0], high = ends[1];
    int64_t is_inside[NT_LANES], inside = 0;
    for (long i = 0; i < count; i += NT_LANES) {
        const int n = nt_lanes_from(i, count);
        for (int j = 0; j < n; j++)
            is_inside[j] = (values[i + j] >= low) & (values[i + j] <= high);
        for (int j = 0; j < n; j++) {
            values[inside] = values[i + j];
            inside += is_inside[j];
        }
    }
}

/* Two of a sample's ranks, between which the median of many values lies nearly always. */
static void sample_ends(const double values[], long count, double ends[2])
{
    double sample[SAMPLE];
    for (long i = 0; i < SAMPLE; i++)
        sample[i] = values[i * (count / SAMPLE)];
    ends[1] = select(sample, SAMPLE, SAMPLE / 2 + MIDDLE);
    ends[0] = select(sample, SAMPLE / 2 + MIDDLE, SAMPLE / 2 - MIDDLE);
}

/* As long as it lies between the ends, which are drawn closer: where values are even, rank k of n is known to sqrt(n).
 */
static double median_between(double values[], long count, const double ends[2])
{
    double low = ends[0], high = ends[1];
    long left = count, rank = count / 2;
    for (int i = 0; i < DRAWN && left >= FEW; i++) {
        long below;
        const double window[2] = {low, high};
        const long inside = count_between(values, left, window, &below);
        if (rank - below < 1 || rank - below >= inside)
            break;
        gather(values, left, window);
        left = inside;
        rank -= below;
        const double width = high - low, middle = low + width * ((double)rank / (double)left);
        const double half = width * closer / sqrt((double)left);
        low = middle - half > low ? middle - half : low;
        high = middle + half < high ? middle + half : high;
    }
    const double upper = select(values, left, rank);
    return count % 2 ? upper : 0.5 * (nt_curve_highest(values, rank) + upper);
}

double nt_curve_median(double values[], long count)
{
    double ends[2];
    if (count < MANY) {
        const double upper = select(values, count, count / 2);
        return count % 2 ? upper : 0.5 * (nt_curve_highest(values, count / 2) + upper);
    }
    sample_ends(values, count, ends);
    return median_between(values, count, ends);
}

double nt_curve_median_near(double values[], long count, double expected, double doubt)
{
    if (count < FEW || !(expected > 0.0))
        return nt_curve_median(values, count);
    const double ends[2] = {expected * (1.0 - doubt), expected * (1.0 + doubt)};
    return median_between(values, count, ends);
}

double nt_curve_median_size(const double values[], long count, double scratch[])
{
    for (long i = 0; i < count; i++)
        scratch[i] = fabs(values[i]);
    return nt_curve_median(scratch, count);
}

void nt_curve_weigh(const double rest[], long count, double scatter, double weight[])
{
    const double unit = 1.0 / (NT_TUKEY * scatter);
    for (long i = 0; i < count; i++) {
        const double u = rest[i] * unit, inside = 1.0 - u * u;
        weight[i] = inside > 0.0 ? inside * inside : 0.0;
    }
}

static void reverse_if_falling(nt_curve_point points[], long count)
{
    for (long i = 1; i < count; i++)
        if (!(points[i].z < points[i - 1].z))
            return;
    for (long i = 0, j = count - 1; i < j; i++, j--) {
        const nt_curve_point kept = points[i];
        points[i] = points[j];
        points[j] = kept;
    }
}

/* Two ordered pieces, [from, middle) and [middle, to), become one. */
static void merge(nt_curve_point points[], long from, long middle, long to, nt_curve_point scratch[])
{
    if (points[middle - 1].z <= points[middle].z)
        return;
    const long left = middle - from;
    memcpy(scratch, points + from, (size_t)left * sizeof *points);
    long i = 0, j = middle, out = from;
    while (i < left && j < to)
        points[out++] = points[j].z < scratch[i].z ? points[j++] : scratch[i++];
    while (i < left)
        points[out++] = scratch[i++];
}

void nt_curve_sort(nt_curve_point points[], long count, nt_curve_point scratch[])
{
    reverse_if_falling(points, count);
    for (long width = 1; width < count; width *= 2)
        for (long from = 0; from + width < count; from += 2 * width) {
            const long to = from + 2 * width < count ? from + 2 * width : count;
            merge(points, from, from + width, to, scratch);
        }
}

void nt_curve_sort_values(double values[], long count)
{
    for (long gap = count / 2; gap > 0; gap /= 2) /* Shell 1959 */
        for (long i = gap; i < count; i++) {
            const double value = values[i];
            long j = i;
            for (; j >= gap && values[j - gap] > value; j -= gap)
                values[j] = values[j - gap];
            values[j] = value;
        }
}

int nt_curve_solve(double a[], double b[], int n)
{
    for (int j = 0; j < n; j++) {
        for (int i = j; i < n; i++) {
            double sum = a[i * n + j];
            for (int k = 0; k < j; k++)
                sum -= a[i * n + k] * a[j * n + k];
            if (i == j && !(sum > 1e-14 * fabs(a[j * n + j])))
                return 0;
            a[i * n + j] = i == j ? sqrt(sum) : sum / a[j * n + j];
        }
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++)
            b[i] -= a[i * n + k] * b[k];
        b[i] /= a[i * n + i];
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++)
            b[i] -= a[k * n + i] * b[k];
        b[i] /= a[i * n + i];
    }
    return 1;
}
