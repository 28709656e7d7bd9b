/* SPDX-License-Identifier: BSD-3-Clause
 * A robust line (Beaton & Tukey 1974) and what its residuals are worth. */
#include "curves/line.h"

#include <math.h>

#include "curves/robust.h"

enum {
    ROUNDS = 10,  /* of Tukey's weights at most */
    SAMPLE = 128, /* points that the line is first sought by */
    BLOCKS = 10   /* whose means show the correlation of the residuals */
};
static const double settled = 0.05;                  /* of its standard deviation, by which the slope may still move */
static const double of_sample = 0.25, of_all = 0.05; /* of the scatter: 2.5 of a sample's standard deviations; how far
                                                        the last round moves it */
static const double smallest_spread = 1e-300;

/* Weighted least squares over every step-th point, by Tukey's weights of what the line leaves; scatter 0: all weigh the
 * same. The line's force is that at x = 0. */
static void move_line(const nt_curve_free *free, long step, double scatter, nt_curve_baseline *line)
{
    const double unit = scatter > 0.0 ? 1.0 / (NT_TUKEY * scatter) : 0.0;
    double total = 0.0, x = 0.0, rest = 0.0, squares = 0.0, product = 0.0;
    for (long i = 0; i < free->count; i += step) {
        const double left = free->force[i] - line->force - line->slope * free->x[i];
        const double u = left * unit, inside = 1.0 - u * u, root = inside > 0.0 ? inside : 0.0;
        const double weight = root * root, weighted = weight * free->x[i];
        total += weight;
        x += weighted;
        rest += weight * left;
        squares += weighted * free->x[i];
        product += weighted * left;
    }
    const double spread = squares - x * x / total;
    const double slope = spread > 0.0 ? (product - x * rest / total) / spread : 0.0;
    line->slope += slope;
    line->force += (rest - slope * x) / total;
}

/* Residuals of every step-th point, and their robust standard deviation, which is the line's within a share of it. */
static double look(nt_curve_free *free, long step, const nt_curve_baseline *line, double doubt)
{
    long found = 0;
    for (long i = 0; i < free->count; i += step) {
        free->rest[i] = free->force[i] - line->force - line->slope * free->x[i];
        free->scratch[found++] = fabs(free->rest[i]);
    }
    return NT_MAD_SIGMA * nt_curve_median_near(free->scratch, found, line->scatter / NT_MAD_SIGMA, doubt);
}

static long step_of(const nt_curve_free *free)
{
    return (free->count + SAMPLE - 1) / SAMPLE;
}

/* Whether the slope moved by less than matters. */
static int has_settled(const nt_curve_free *free, long step, double before, const nt_curve_baseline *line)
{
    const double count = (double)free->count / (double)step;
    return fabs(line->slope - before) * free->travel < settled * sqrt(12.0 / count) * line->scatter;
}

nt_curve_baseline nt_curve_rough_line(nt_curve_free *free)
{
    const long step = step_of(free);
    const double nearest = nt_curve_lowest(free->x, free->count);
    nt_curve_baseline line = {.z_mean = free->z_mean, .nearest = free->z_mean + nearest};
    free->travel = nt_curve_highest(free->x, free->count) - nearest;
    move_line(free, step, 0.0, &line);
    line.scatter = look(free, step, &line, of_sample);
    for (int round = 0; round < ROUNDS && line.scatter > 0.0; round++) {
        const double before = line.slope;
        move_line(free, step, line.scatter, &line);
        line.scatter = look(free, step, &line, of_sample);
        if (has_settled(free, step, before, &line))
            break;
    }
    return line;
}

void nt_curve_refine_line(nt_curve_free *free, nt_curve_baseline *line)
{
    line->scatter =
        look(free, 1, line, of_sample); /* a sample's would do for white noise, not for residuals that hang together */
    for (int round = 0; round < ROUNDS && step_of(free) > 1 && line->scatter > 0.0; round++) {
        const double before = line->slope;
        move_line(free, 1, line->scatter, line);
        if (has_settled(free, 1, before, line))
            break;
    }
    line->scatter = look(free, 1, line, of_all);
}

nt_curve_baseline nt_curve_line(nt_curve_free *free)
{
    nt_curve_baseline line = nt_curve_rough_line(free);
    nt_curve_refine_line(free, &line);
    nt_curve_judge(free, &line);
    return line;
}

void nt_curve_judge(nt_curve_free *free, nt_curve_baseline *baseline)
{
    const double count = (double)free->count;
    double spread = 0.0;
    for (long i = 0; i < free->count; i++)
        spread += free->x[i] * free->x[i];
    baseline->noise = nt_curve_split_noise(free->rest, free->count, baseline->scatter);
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
