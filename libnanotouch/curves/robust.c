/* SPDX-License-Identifier: BSD-3-Clause
 * Quickselect (Hoare 1961) with a pivot that no order of the values can foresee, and a merge sort that leaves ordered
 * pieces alone. */
#include "curves/robust.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { SAMPLE = 63, MIDDLE = 10, MANY = 256 }; /* MIDDLE: 2.5 standard deviations of the rank of a sample's median */

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
            if (k < below)
                return pivot;
        }
        values += below;
        count -= below;
        k -= below;
    }
    return values[0];
}

double nt_curve_highest(const double values[], long count)
{
    double highest[4] = {values[0], values[0], values[0], values[0]};
    long i = 0;
    for (; i + 4 <= count; i += 4) /* side by side */
        for (int j = 0; j < 4; j++)
            highest[j] = values[i + j] > highest[j] ? values[i + j] : highest[j];
    for (; i < count; i++)
        highest[0] = values[i] > highest[0] ? values[i] : highest[0];
    for (int j = 1; j < 4; j++)
        highest[0] = highest[j] > highest[0] ? highest[j] : highest[0];
    return highest[0];
}

double nt_curve_lowest(const double values[], long count)
{
    double lowest[4] = {values[0], values[0], values[0], values[0]};
    long i = 0;
    for (; i + 4 <= count; i += 4)
        for (int j = 0; j < 4; j++)
            lowest[j] = values[i + j] < lowest[j] ? values[i + j] : lowest[j];
    for (; i < count; i++)
        lowest[0] = values[i] < lowest[0] ? values[i] : lowest[0];
    for (int j = 1; j < 4; j++)
        lowest[0] = lowest[j] < lowest[0] ? lowest[j] : lowest[0];
    return lowest[0];
}

/* Those from low to high come first; returns how many, and how many lie below. Without a branch. */
static long gather(double values[], long count, const double ends[2], long *below)
{
    const double low = ends[0], high = ends[1];
    long inside = 0, lower = 0;
    for (long i = 0; i < count; i++) {
        const double value = values[i];
        values[i] = values[inside];
        values[inside] = value;
        inside += (value >= low) & (value <= high);
        lower += value < low;
    }
    *below = lower;
    return inside;
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

static double median_of(double values[], long count)
{
    const double upper = select(values, count, count / 2);
    return count % 2 ? upper : 0.5 * (nt_curve_highest(values, count / 2) + upper);
}

/* Of those between two ends, or of all where it does not lie there. */
static double median_between(double values[], long count, const double ends[2])
{
    long below;
    const long inside = gather(values, count, ends, &below), rank = count / 2 - below;
    if (rank < 1 || rank >= inside)
        return median_of(values, count);
    const double upper = select(values, inside, rank);
    return count % 2 ? upper : 0.5 * (nt_curve_highest(values, rank) + upper);
}

double nt_curve_median(double values[], long count)
{
    double ends[2];
    if (count < MANY)
        return median_of(values, count);
    sample_ends(values, count, ends);
    return median_between(values, count, ends);
}

double nt_curve_median_near(double values[], long count, double expected, double doubt)
{
    if (count < MANY || !(expected > 0.0))
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
