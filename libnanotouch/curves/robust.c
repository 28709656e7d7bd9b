/* SPDX-License-Identifier: BSD-3-Clause
 * Quickselect (Hoare 1961) with a pivot that no order of the values can foresee, and a merge sort that leaves ordered
 * pieces alone. */
#include "curves/robust.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { SAMPLE = 63, MIDDLE = 10, MANY = 256 }; /* MIDDLE: 2.5 standard deviations of the rank of a sample's median */

static void swap(double *a, double *b)
{
    const double kept = *a;
    *a = *b;
    *b = kept;
}

/* Puts the value of rank k at its place; smaller ones before it. */
static double select(double values[], long count, long k)
{
    uint64_t state = 0x9e3779b97f4a7c15u;
    long low = 0, high = count - 1;
    while (low < high) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        const double pivot = values[low + (long)((state >> 33) % (uint64_t)(high - low + 1))];
        long i = low, j = high;
        while (i <= j) {
            while (values[i] < pivot)
                i++;
            while (values[j] > pivot)
                j--;
            if (i <= j)
                swap(&values[i++], &values[j--]);
        }
        if (k <= j)
            high = j;
        else if (k >= i)
            low = i;
        else
            break;
    }
    return values[k];
}

double nt_curve_highest(const double values[], long count)
{
    double highest = values[0];
    for (long i = 1; i < count; i++)
        highest = values[i] > highest ? values[i] : highest;
    return highest;
}

double nt_curve_lowest(const double values[], long count)
{
    double lowest = values[0];
    for (long i = 1; i < count; i++)
        lowest = values[i] < lowest ? values[i] : lowest;
    return lowest;
}

/* Of many values: those between two of a sample's ranks come first, and the median is looked for among them. */
static long gather_middle(double values[], long count, long *below)
{
    double sample[SAMPLE];
    for (long i = 0; i < SAMPLE; i++)
        sample[i] = values[i * (count / SAMPLE)];
    nt_curve_sort_values(sample, SAMPLE);
    const double low = sample[SAMPLE / 2 - MIDDLE], high = sample[SAMPLE / 2 + MIDDLE];
    long inside = 0;
    *below = 0;
    for (long i = 0; i < count; i++) { /* without a branch */
        const double value = values[i];
        values[i] = values[inside];
        values[inside] = value;
        inside += (value >= low) & (value <= high);
        *below += value < low;
    }
    return inside;
}

double nt_curve_median(double values[], long count)
{
    if (count >= MANY) {
        long below;
        const long inside = gather_middle(values, count, &below), rank = count / 2 - below;
        if (rank >= 1 && rank < inside) {
            const double upper = select(values, inside, rank);
            return count % 2 ? upper : 0.5 * (nt_curve_highest(values, rank) + upper);
        }
    }
    const double upper = select(values, count, count / 2);
    return count % 2 ? upper : 0.5 * (nt_curve_highest(values, count / 2) + upper);
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
