/* SPDX-License-Identifier: BSD-3-Clause
 * White and 1/f (flicker) noise of a record, told apart by its spectrum.
 *
 * The cosine coefficients of equal blocks' means are independent (nearly so of 1/f noise), and that of k half periods
 * has the variance w + a/k (Whittle 1953, "Estimation and information in stationary time series"). The slowest count
 * one by one, the others together. Fast ones are left out: there the electronics have their say. What is told is the
 * mean over all ratios of 1/f to white noise, by their likelihoods: a short record cannot exclude some. */
#include "curves/flicker.h"

#include <math.h>

#include "core/variants.h"
#include "curves/robust.h"
#include "internal/curves.h"

enum {
    SPECTRUM_BLOCKS = 64,
    FINEST = 8,  /* points of a block: what is smeared over fewer counts as white */
    FEWEST = 4,  /* blocks */
    RATIOS = 31, /* of 1/f to white noise that are tried */
    BLOCKS = 20  /* of residuals, whose means show how they hang together */
};
static const double least_ratio = 0.1, most_ratio = 1e4; /* in the slowest wave; all are as likely beforehand, */
static const double odds_of_white = 1.0;                 /* and together this many times less than white noise alone */
static const double of_the_mean =
    0.83; /* variance of a mean over a, per point: 2 ln 2 (Allan's) times 0.6 for a line */
static const double contradiction = 6.0; /* loss in ln L: two records of the same noise lose as much once in 400 */
static const double correlated = 1.2; /* variance of a mean over that of independent points; of white noise 1 +- 0.2 */
static const double hang_together = 2.0;    /* the same of residuals; of white noise 1 +- 0.3 */
static const double all_but_largest = 0.99; /* of the differences, where most are 0 */

static const double pi = 3.14159265358979323846;

/* Sum of b[i] cos((i + 1/2) angle), by Clenshaw's recurrence. */
static double cosine_sum(const double b[], int count, double angle)
{
    const double twice = 2.0 * cos(angle);
    double last = 0.0, before = 0.0;
    for (int i = count - 1; i >= 0; i--) {
        const double next = b[i] + twice * last - before;
        before = last;
        last = next;
    }
    return (last - before) * cos(0.5 * angle);
}

nt_curve_spectrum nt_curve_spectrum_of(const double rest[], long count)
{
    const int blocks = count / FINEST < SPECTRUM_BLOCKS ? (int)(count / FINEST) : SPECTRUM_BLOCKS;
    nt_curve_spectrum found = {.points = (double)count};
    double mean[SPECTRUM_BLOCKS], middle = 0.0, inverse = 0.0;
    if (blocks < FEWEST)
        return found;
    for (int b = 0; b < blocks; b++) {
        const long first = b * count / blocks, end = (b + 1) * count / blocks;
        double sum = 0.0;
        for (long i = first; i < end; i++)
            sum += rest[i];
        mean[b] = sum / (double)(end - first);
        middle += mean[b] / blocks;
    }
    for (int b = 0; b < blocks; b++)
        found.fast += (mean[b] - middle) * (mean[b] - middle);
    const double scale = 2.0 / blocks;
    found.slow = blocks - 2 < NT_CURVE_SLOW ? blocks - 2 : NT_CURVE_SLOW;
    for (int k = 1; k < found.slow + 2; k++) { /* the first is the line's */
        const double sum = cosine_sum(mean, blocks, pi * k / blocks), energy = scale * sum * sum;
        found.fast -= energy;
        if (k > 1)
            found.energy[k - 2] = energy * (double)count / blocks;
    }
    found.fast = fmax(found.fast, 0.0) * (double)count / blocks;
    for (int k = found.slow + 2; k < blocks; k++)
        inverse += 1.0 / k;
    found.many = blocks - 2 - found.slow;
    found.place = found.many / inverse;
    return found;
}

/* Of some records of the same noise: likeliest white variance at a ratio a/w, and its ln L. */
typedef struct likely {
    double white, likelihood;
} likely;

static likely likely_at(const nt_curve_spectrum spectra[], int records, double ratio)
{
    double sum = 0.0, count = 0.0, logarithms = 0.0;
    for (int record = 0; record < records; record++) {
        const nt_curve_spectrum *one = spectra + record;
        double product = 1.0;
        for (int i = 0; i < one->slow; i++) {
            const double shape = 1.0 + ratio * one->points / (i + 2);
            sum += one->energy[i] / shape;
            product *= shape;
        }
        logarithms += log(product);
        count += one->slow + one->many;
        if (one->many == 0)
            continue;
        const double shape = 1.0 + ratio * one->points / one->place;
        sum += one->fast / shape;
        logarithms += one->many * log(shape);
    }
    return (likely){sum / count, -0.5 * (count * log(sum / count) + logarithms)};
}

/* The mean over the ratios by their likelihoods, and the greatest of these; the latter -infinity without any. */
static likely weigh_ratios(const nt_curve_spectrum spectra[], int records, double *flicker)
{
    likely tried[RATIOS + 1];
    double ratio[RATIOS + 1], total = 0.0, best, white = 0.0;
    const double longest = records > 1 ? fmax(spectra[0].points, spectra[1].points) : spectra[0].points;
    const double factor = pow(most_ratio / least_ratio, 1.0 / (RATIOS - 1));
    *flicker = 0.0;
    for (int record = 0; record < records; record++)
        if (spectra[record].slow == 0)
            return (likely){0.0, -INFINITY};
    ratio[0] = 0.0;
    ratio[1] = least_ratio / longest;
    tried[0] = likely_at(spectra, records, 0.0);
    if (!(tried[0].white > 0.0))
        return (likely){0.0, -INFINITY};
    best = tried[0].likelihood;
    for (int i = 1; i <= RATIOS; i++) {
        ratio[i] = i > 1 ? factor * ratio[i - 1] : ratio[i];
        tried[i] = likely_at(spectra, records, ratio[i]);
        best = fmax(best, tried[i].likelihood);
    }
    for (int i = 0; i <= RATIOS; i++) {
        const double weight = (i ? 1.0 : odds_of_white * RATIOS) * exp(tried[i].likelihood - best);
        total += weight;
        white += weight * tried[i].white;
        *flicker += weight * of_the_mean * ratio[i] * tried[i].white;
    }
    *flicker /= total;
    return (likely){white / total, best};
}

nt_curve_noise nt_curve_split_noise(const double rest[], long count, double scatter)
{
    const nt_curve_spectrum spectrum = nt_curve_spectrum_of(rest, count);
    nt_curve_noise noise;
    const likely found = weigh_ratios(&spectrum, 1, &noise.flicker);
    noise.white = fmax(scatter * scatter, found.white);
    return noise;
}

/* The noise of two records together; 0 where they contradict that. */
static int pool(const nt_curve_spectrum spectra[2], nt_curve_noise *noise)
{
    double ignored;
    const likely both = weigh_ratios(spectra, 2, &noise->flicker);
    noise->white = both.white;
    return both.white > 0.0 &&
           !(weigh_ratios(spectra, 1, &ignored).likelihood + weigh_ratios(spectra + 1, 1, &ignored).likelihood >
             both.likelihood + contradiction);
}

/* Of the points that its baseline was fitted to. */
static nt_curve_spectrum free_spectrum(const nt_curve_branch *branch)
{
    long first = 0;
    while (first < branch->count && branch->z[first] < branch->baseline.nearest)
        first++;
    return nt_curve_spectrum_of(branch->force + first, branch->count - first);
}

/* What level and slope are known to follows. */
static void set_noise(nt_curve_branch *branch, const nt_curve_noise *noise, double points)
{
    nt_curve_baseline *baseline = &branch->baseline;
    const double before = baseline->noise.white + points * baseline->noise.flicker;
    baseline->noise = (nt_curve_noise){fmax(baseline->scatter * baseline->scatter, noise->white), noise->flicker};
    const double now = baseline->noise.white + points * baseline->noise.flicker;
    baseline->force_variance *= now / before;
    baseline->slope_variance *= now / before;
    nt_curve_know_events(branch);
}

void nt_curve_share_noise(nt_curve_branch *const branches[2])
{
    const nt_curve_spectrum spectra[2] = {free_spectrum(branches[0]), free_spectrum(branches[1])};
    nt_curve_noise shared;
    if (!pool(spectra, &shared))
        return;
    for (int i = 0; i < 2; i++)
        set_noise(branches[i], &shared, spectra[i].points);
}

void nt_curve_renew_noise(nt_curve_branch *branch)
{
    const nt_curve_spectrum spectrum = free_spectrum(branch);
    nt_curve_noise noise;
    noise.white = weigh_ratios(&spectrum, 1, &noise.flicker).white;
    if (noise.white > 0.0)
        set_noise(branch, &noise, spectrum.points);
}

NT_VARIANTS static void differences(const double force[], long count, double *restrict size)
{
    for (long i = 0; i + 1 < count; i++)
        size[i] = fabs(force[i + 1] - force[i]);
}

double nt_curve_point_noise(const double force[], long count, double *work)
{
    differences(force, count, work);
    double size = NT_MAD_SIGMA * nt_curve_median(work, count - 1);
    if (size == 0.0) {
        differences(force, count, work);
        nt_curve_sort_values(work, count - 1);
        const long kept = (long)(all_but_largest * (double)(count - 1));
        size = sqrt(nt_curve_square_sum(work, kept) / (double)kept);
    }
    return size / sqrt(2.0);
}

double nt_curve_correlated_noise(double point_noise, const nt_curve_noise *free, long count)
{
    const double least = point_noise * point_noise;
    if (free->white + (double)count * free->flicker < correlated * least)
        return 0.0;
    return sqrt(fmax(least, free->white) + (double)count * free->flicker);
}

double nt_curve_residual_correlation(const double rest[], long count)
{
    const long wanted = count / 4 < BLOCKS ? count / 4 : BLOCKS, blocks = wanted > 2 ? wanted : 2,
               size = count / blocks;
    double square = 0.0, squares = 0.0;
    for (long i = 0; i < count; i++)
        square += rest[i] * rest[i] / (double)count;
    if (square == 0.0 || size < 2)
        return 1.0;
    for (long block = 0; block < blocks; block++) {
        double mean = 0.0;
        for (long i = block * size; i < (block + 1) * size; i++)
            mean += rest[i] / (double)size;
        squares += mean * mean;
    }
    const double ratio = squares / (double)blocks * (double)size / square;
    return ratio > hang_together ? ratio : 1.0;
}
