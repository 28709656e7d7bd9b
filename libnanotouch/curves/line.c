/* SPDX-License-Identifier: BSD-3-Clause
 * A robust line (Beaton & Tukey 1974) and what its residuals are worth. */
#include "curves/line.h"

#include <math.h>

#include "core/variants.h"
#include "curves/robust.h"
#include "internal/curves.h"

enum {
    ROUNDS = 10,  /* of Tukey's weights at most */
    SAMPLE = 128, /* points that the line is first sought by */
    BLOCKS = 10   /* whose means show the correlation of the residuals */
};
static const double settled = 0.05;                  /* of its standard deviation, by which the slope may still move */
static const double of_sample = 0.25, of_all = 0.05; /* of the scatter: 2.5 of a sample's standard deviations; how far
                                                        the last round moves it */
static const double smallest_spread = 1e-300;

/* Points that a line is moved to. */
typedef struct points {
    const double *x, *force;
    long count;
} points;

/* Sums over the points of their weights, of weight times x, the force left by a line, x x and x times that force. */
typedef struct sums {
    double total, x, rest, squares, product;
} sums;

/* By Tukey's weights of what the line leaves, unit = 1/(4.685 scatter); unit 0: all weigh the same. */
NT_VARIANTS static sums weigh_up(const points *of, const nt_curve_baseline *line, double unit)
{
    const double level = line->force, slope = line->slope, *at = of->x, *force = of->force;
    double total[NT_LANES] = {0.0}, x[NT_LANES] = {0.0}, rest[NT_LANES] = {0.0}, squares[NT_LANES] = {0.0},
           product[NT_LANES] = {0.0};
    for (long i = 0; i < of->count; i += NT_LANES)
        for (int j = 0, n = nt_lanes_from(i, of->count); j < n; j++) {
            const double left = force[i + j] - level - slope * at[i + j];
            const double u = left * unit, inside = 1.0 - u * u, root = inside > 0.0 ? inside : 0.0;
            const double weight = root * root, weighted = weight * at[i + j];
            total[j] += weight;
            x[j] += weighted;
            rest[j] += weight * left;
            squares[j] += weighted * at[i + j];
            product[j] += weighted * left;
        }
    return (sums){nt_lanes_sum(total), nt_lanes_sum(x), nt_lanes_sum(rest), nt_lanes_sum(squares),
                  nt_lanes_sum(product)};
}

/* Weighted least squares; scatter 0, or too small to divide by: all weigh the same. The line's force is that at x = 0.
 */
static void move_line(const points *of, double scatter, nt_curve_baseline *line)
{
    const double unit = 1.0 / (NT_TUKEY * scatter);
    const sums s = weigh_up(of, line, isfinite(unit) ? unit : 0.0);
    const double spread = s.squares - s.x * s.x / s.total;
    const double slope = spread > 0.0 ? (s.product - s.x * s.rest / s.total) / spread : 0.0;
    line->slope += slope;
    line->force += (s.rest - slope * s.x) / s.total;
}

/* What a line leaves, and its size. */
NT_VARIANTS static void leave(const points *of, const nt_curve_baseline *line, double *restrict rest,
                              double *restrict size)
{
    const double level = line->force, slope = line->slope, *x = of->x, *force = of->force;
    for (long i = 0; i < of->count; i++) {
        rest[i] = force[i] - level - slope * x[i];
        size[i] = fabs(rest[i]);
    }
}

/* Residuals in free->rest, and their robust standard deviation, which is the line's within a share of it. */
static double look(const nt_curve_free *free, const points *at, const nt_curve_baseline *line, double doubt)
{
    leave(at, line, free->rest, free->scratch);
    return NT_MAD_SIGMA * nt_curve_median_near(free->scratch, at->count, line->scatter / NT_MAD_SIGMA, doubt);
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
    double x[SAMPLE], force[SAMPLE];
    points some = {x, force, 0};
    for (long i = 0; i < free->count; i += step, some.count++) {
        x[some.count] = free->x[i];
        force[some.count] = free->force[i];
    }
    nt_curve_baseline line = {.z_mean = free->z_mean, .nearest = free->nearest};
    free->travel = nt_curve_highest(free->x, free->count) - nt_curve_lowest(free->x, free->count);
    move_line(&some, 0.0, &line);
    line.scatter = look(free, &some, &line, of_sample);
    for (int round = 0; round < ROUNDS && line.scatter > 0.0; round++) {
        const double before = line.slope;
        move_line(&some, line.scatter, &line);
        line.scatter = look(free, &some, &line, of_sample);
        if (has_settled(free, step, before, &line))
            break;
    }
    return line;
}

void nt_curve_refine_line(nt_curve_free *free, nt_curve_baseline *line)
{
    const points all = {free->x, free->force, free->count};
    line->scatter = look(free, &all, line,
                         of_sample); /* a sample's would do for white noise, not for residuals that hang together */
    for (int round = 0; round < ROUNDS && step_of(free) > 1 && line->scatter > 0.0; round++) {
        const double before = line->slope;
        move_line(&all, line->scatter, line);
        if (has_settled(free, 1, before, line))
            break;
    }
    line->scatter = look(free, &all, line, of_all);
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
    const double spread = nt_curve_square_sum(free->x, free->count);
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
        const double mean = nt_curve_sum(free->rest + block * size, size) / (double)size;
        squares += mean * mean;
    }
    return fmax(1.0, squares / BLOCKS * (double)size / (scatter * scatter));
}
