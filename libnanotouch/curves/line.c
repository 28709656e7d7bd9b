/* SPDX-License-Identifier: BSD-3-Clause
 * A robust line (Beaton & Tukey 1974) and what its residuals are worth. */
#include "curves/line.h"

#include <math.h>

#include "curves/robust.h"

enum {
    ROUNDS = 10, /* of Tukey's weights at most */
    BLOCKS = 10  /* whose means show the correlation of the residuals */
};
static const double settled = 1e-3; /* of the scatter, by which the line may still move */
static const double smallest_spread = 1e-300;

/* Weighted least squares; the line's force is that at x = 0. */
static void weighted_line(const nt_curve_free *free, nt_curve_baseline *line)
{
    double total = 0.0, x = 0.0, force = 0.0, spread = 0.0, product = 0.0;
    for (long i = 0; i < free->count; i++) {
        total += free->weight[i];
        x += free->weight[i] * free->x[i];
        force += free->weight[i] * free->force[i];
    }
    x /= total;
    force /= total;
    for (long i = 0; i < free->count; i++) {
        spread += free->weight[i] * (free->x[i] - x) * (free->x[i] - x);
        product += free->weight[i] * (free->x[i] - x) * (free->force[i] - force);
    }
    line->slope = spread > 0.0 ? product / spread : 0.0;
    line->force = force - line->slope * x;
}

nt_curve_baseline nt_curve_robust_line(nt_curve_free *free)
{
    const double travel = nt_curve_highest(free->x, free->count) - nt_curve_lowest(free->x, free->count);
    nt_curve_baseline line = {.z_mean = free->z_mean};
    for (long i = 0; i < free->count; i++)
        free->weight[i] = 1.0;
    for (int round = 0; round < ROUNDS; round++) {
        const double before = line.slope;
        weighted_line(free, &line);
        for (long i = 0; i < free->count; i++)
            free->rest[i] = free->force[i] - line.force - line.slope * free->x[i];
        line.scatter = NT_MAD_SIGMA * nt_curve_median_size(free->rest, free->count, free->scratch);
        if (line.scatter == 0.0 || fabs(line.slope - before) * travel < settled * line.scatter)
            break;
        nt_curve_weigh(free->rest, free->count, line.scatter, free->weight);
    }
    return line;
}

nt_curve_baseline nt_curve_line(nt_curve_free *free)
{
    nt_curve_baseline line = nt_curve_robust_line(free);
    nt_curve_judge(free, &line);
    return line;
}

void nt_curve_judge(nt_curve_free *free, nt_curve_baseline *baseline)
{
    const double count = (double)free->count;
    double spread = 0.0;
    for (long i = 0; i < free->count; i++)
        spread += free->x[i] * free->x[i];
    baseline->noise = nt_curve_split_noise(free->rest, free->count, baseline->scatter, free->scratch);
    const double worth = baseline->noise.white + count * baseline->noise.flicker;
    baseline->force_variance = worth / count;
    baseline->slope_variance = worth / fmax(spread, smallest_spread);
}

double nt_curve_correlation(const nt_curve_free *free, double scatter)
{
    const long size = free->count / BLOCKS;
    if (scatter == 0.0 || size < 2)
        return 1.0;
    double squares = 0.0;
    for (long block = 0; block < BLOCKS; block++) {
        double sum = 0.0;
        for (long i = block * size; i < (block + 1) * size; i++)
            sum += free->rest[i];
        squares += (sum / (double)size) * (sum / (double)size);
    }
    return fmax(1.0, squares / BLOCKS * (double)size / (scatter * scatter));
}
