/* SPDX-License-Identifier: BSD-3-Clause
 * Optimal partition (Jackson et al. 2005, "An algorithm for optimal partitioning of data on an interval") of the means
 * of equal blocks: of all ways to cut them, by dynamic programming with prefix sums. */
#include "curves/pieces.h"

#include <math.h>

#include "curves/robust.h"

enum { LEAST_BLOCK = 4, FEWEST = 8 }; /* points of a block; blocks of a record */
static const double price = 30.0;     /* of a piece: false ones are rarer than one in 1000 records of white noise */
static const double exact = 1e-6;     /* of the span: least noise that is believed */

/* Sums over the blocks before each: of x, y, xx, xy, yy. */
typedef struct sums {
    double x[NT_PIECE_BLOCKS + 1], y[NT_PIECE_BLOCKS + 1], xx[NT_PIECE_BLOCKS + 1], xy[NT_PIECE_BLOCKS + 1],
        yy[NT_PIECE_BLOCKS + 1];
} sums;

typedef struct fitted {
    double slope, level, squares;
} fitted;

static fitted line_of(const sums *s, int from, int to)
{
    const double n = to - from, x = (s->x[to] - s->x[from]) / n, y = (s->y[to] - s->y[from]) / n;
    const double xx = s->xx[to] - s->xx[from] - n * x * x, xy = s->xy[to] - s->xy[from] - n * x * y;
    const double slope = xx > 0.0 ? xy / xx : 0.0;
    return (fitted){slope, y - slope * x, fmax(s->yy[to] - s->yy[from] - n * y * y - slope * xy, 0.0)};
}

/* Standard deviation of a block's mean, insensitive to slopes [N]. */
static double noise_of(const double y[], int blocks)
{
    double bent[NT_PIECE_BLOCKS];
    for (int i = 1; i + 1 < blocks; i++)
        bent[i - 1] = fabs(y[i - 1] - 2.0 * y[i] + y[i + 1]);
    const double span = nt_curve_highest(y, blocks) - nt_curve_lowest(y, blocks);
    return fmax(NT_MAD_SIGMA / sqrt(6.0) * nt_curve_median(bent, blocks - 2), exact * span);
}

static void sum_up(const double x[], const double y[], int blocks, sums *s)
{
    s->x[0] = s->y[0] = s->xx[0] = s->xy[0] = s->yy[0] = 0.0;
    for (int i = 0; i < blocks; i++) {
        s->x[i + 1] = s->x[i] + x[i];
        s->y[i + 1] = s->y[i] + y[i];
        s->xx[i + 1] = s->xx[i] + x[i] * x[i];
        s->xy[i + 1] = s->xy[i] + x[i] * y[i];
        s->yy[i + 1] = s->yy[i] + y[i] * y[i];
    }
}

/* from[j]: where the last piece of the best cut of the first j blocks begins. */
static void cut(const sums *s, int blocks, double variance, int from[NT_PIECE_BLOCKS + 1])
{
    double cost[NT_PIECE_BLOCKS + 1] = {0.0}, least[NT_PIECE_BLOCKS + 1] = {price}; /* least: cost with a last piece
                                                                      from i on, which only grows with its length */
    cost[1] = least[1] = INFINITY;
    from[1] = 0;
    for (int j = 2; j <= blocks; j++) {
        double best = INFINITY;
        for (int i = 0; i + 2 <= j; i++) {
            if (!(least[i] < best))
                continue;
            least[i] = cost[i] + price + line_of(s, i, j).squares / variance;
            if (least[i] < best) {
                best = least[i];
                from[j] = i;
            }
        }
        cost[j] = best;
        least[j] = best + price;
    }
}

int nt_curve_cut(const double z[], const double force[], long count, nt_curve_piece pieces[NT_PIECE_BLOCKS])
{
    const int blocks = count / LEAST_BLOCK < NT_PIECE_BLOCKS ? (int)(count / LEAST_BLOCK) : NT_PIECE_BLOCKS;
    if (blocks < FEWEST || !(z[count - 1] > z[0]))
        return 0;
    double x[NT_PIECE_BLOCKS], y[NT_PIECE_BLOCKS];
    const double travel = z[count - 1] - z[0];
    for (int b = 0; b < blocks; b++) {
        const long first = b * count / blocks, end = (b + 1) * count / blocks;
        double height = 0.0, sum = 0.0;
        for (long i = first; i < end; i++) {
            height += z[i] - z[0];
            sum += force[i];
        }
        x[b] = height / (travel * (double)(end - first));
        y[b] = sum / (double)(end - first);
    }
    sums s;
    int from[NT_PIECE_BLOCKS + 1], found = 0;
    const double noise = noise_of(y, blocks);
    sum_up(x, y, blocks, &s);
    if (!(noise > 0.0)) {
        pieces[0] = (nt_curve_piece){0, count, 0.0, y[0]};
        return 1;
    }
    cut(&s, blocks, noise * noise, from);
    for (int j = blocks; j > 0; j = from[j])
        found++;
    for (int j = blocks, k = found - 1; j > 0; j = from[j], k--) {
        const fitted line = line_of(&s, from[j], j);
        const long first = from[j] * count / blocks;
        pieces[k] = (nt_curve_piece){first, j * count / blocks, line.slope / travel,
                                     line.level + line.slope * (z[first] - z[0]) / travel};
    }
    return found;
}

double nt_curve_step_at(const double force[], long i, long width)
{
    double before = 0.0, after = 0.0;
    for (long k = 0; k < width; k++) {
        before += force[i - 1 - k];
        after += force[i + k];
    }
    return (after - before) / (double)width;
}
