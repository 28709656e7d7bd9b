/* SPDX-License-Identifier: BSD-3-Clause
 * White and 1/f (flicker) noise of a record, told apart by how its means scatter.
 *
 * Half the mean squared difference of neighbouring means of m points is the Allan variance, w/m of white noise and a
 * constant of flicker noise, which no number of points averages away. Both are fitted to the octaves of m by maximum
 * likelihood (for Gaussian noise each difference is one draw), coarse ones only: in fine ones the electronics have
 * their say. */
#include <math.h>
#include <string.h>

#include "curves/robust.h"
#include "nanotouch/curves.h"

enum {
    FINEST = 8, /* points of a mean: what is smeared over fewer counts as white */
    FEWEST = 4, /* differences of an octave */
    OCTAVES = 5,
    BLOCKS = 20,  /* of residuals, whose means show how they hang together */
    RATIOS = 121, /* of flicker to white noise in the first octave that are tried, least .. most: */
    COARSE = 8    /* every so many of them, and then all about the best */
};
static const double least_ratio = 1e-3, most_ratio = 1e3;
static const double evident = 1.0;     /* gain in ln L: white noise passes for flicker once in 20 to 30 records */
static const double of_the_mean = 0.6; /* variance of a mean over Allan's, of flicker noise about a line */
static const double correlated = 1.2;  /* variance of a mean over that of independent points; of white noise 1 +- 0.2 */
static const double hang_together = 2.0;    /* the same of residuals; of white noise 1 +- 0.3 */
static const double all_but_largest = 0.99; /* of the differences, where most are 0 */

typedef struct octave {
    double size, count, variance; /* points of a mean, differences, size times the Allan variance [N^2] */
} octave;

/* The coarsest octaves; `means` is used up. Returns how many. */
static int octaves_of(double means[], long count, octave octaves[OCTAVES])
{
    int found = 0;
    for (long size = 1; count >= 2 * FEWEST; size *= 2) {
        double squares = 0.0;
        count /= 2;
        for (long i = 0; i < count; i++) {
            const double one = means[2 * i], other = means[2 * i + 1];
            squares += (one - other) * (one - other);
            means[i] = 0.5 * (one + other);
        }
        if (size < FINEST)
            continue;
        if (found == OCTAVES)
            memmove(octaves, octaves + 1, (size_t)--found * sizeof *octaves);
        octaves[found++] = (octave){(double)size, (double)count, 0.5 * (double)size * squares / (double)count};
    }
    return found;
}

/* The likeliest white variance at a ratio of flicker to white noise in the first octave, and its ln L. */
typedef struct likely {
    double white, likelihood, ratio;
    int place; /* among the ratios */
} likely;

static likely likely_at(const octave octaves[], int count, double ratio)
{
    double sum = 0.0, counts = 0.0, logarithms = 0.0;
    for (int i = 0; i < count; i++) {
        const double shape = 1.0 + ratio * octaves[i].size / octaves[0].size;
        sum += octaves[i].count * octaves[i].variance / shape;
        counts += octaves[i].count;
        logarithms += octaves[i].count * log(shape);
    }
    const double white = sum / counts;
    return (likely){white, -0.5 * (counts * log(white) + logarithms), ratio, 0};
}

/* The likeliest of the ratios from .. to, every so many. */
static likely likeliest(const octave octaves[], int count, likely best, const int range[3])
{
    for (int i = range[0] > 0 ? range[0] : 0; i <= range[1] && i < RATIOS; i += range[2]) {
        const double ratio = least_ratio * pow(most_ratio / least_ratio, (double)i / (RATIOS - 1));
        const likely tried = likely_at(octaves, count, ratio);
        best = tried.likelihood > best.likelihood ? (likely){tried.white, tried.likelihood, ratio, i} : best;
    }
    return best;
}

nt_curve_noise nt_curve_split_noise(const double rest[], long count, double scatter, double *work)
{
    octave octaves[OCTAVES];
    nt_curve_noise noise = {scatter * scatter, 0.0};
    memcpy(work, rest, (size_t)count * sizeof *work);
    const int found = octaves_of(work, count, octaves);
    if (found < 2)
        return noise;
    const likely alone = likely_at(octaves, found, 0.0);
    if (alone.white == 0.0)
        return noise;
    likely best = likeliest(octaves, found, alone, (int[]){0, RATIOS - 1, COARSE});
    best = likeliest(octaves, found, best, (int[]){best.place - COARSE + 1, best.place + COARSE - 1, 1});
    if (!(best.likelihood - alone.likelihood > evident))
        best = alone;
    noise.white = fmax(noise.white, best.white);
    noise.flicker = of_the_mean * best.white * best.ratio / octaves[0].size;
    return noise;
}

double nt_curve_point_noise(const double force[], long count, double *work)
{
    for (long i = 0; i + 1 < count; i++)
        work[i] = fabs(force[i + 1] - force[i]);
    double size = NT_MAD_SIGMA * nt_curve_median(work, count - 1);
    if (size == 0.0) {
        nt_curve_sort_values(work, count - 1);
        const long kept = (long)(all_but_largest * (double)(count - 1));
        double squares = 0.0;
        for (long i = 0; i < kept; i++)
            squares += work[i] * work[i];
        size = sqrt(squares / (double)kept);
    }
    return size / sqrt(2.0);
}

double nt_curve_correlated_noise(double point_noise, const nt_curve_noise *free, long count)
{
    const double least = point_noise * point_noise;
    if (free->flicker == 0.0 && free->white < correlated * least)
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
