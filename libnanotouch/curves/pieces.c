/* SPDX-License-Identifier: BSD-3-Clause
 * Optimal partition (Jackson et al. 2005, "An algorithm for optimal partitioning of data on an interval") of the means
 * of equal blocks: of all ways to cut them, by dynamic programming with prefix sums. */
#include "curves/pieces.h"

#include <math.h>

#include "curves/robust.h"

enum { LEAST_BLOCK = 4, FEWEST = 8, GROUP = 8 }; /* points of a block; blocks of a record; of those looked at at once */
static const double price = 30.0; /* of a piece: false ones are rarer than one in 1000 records of white noise */
static const double exact = 1e-6; /* of the span: least noise that is believed */

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

/* What a line leaves of the blocks from .. to - 1. */
static double left_of(const sums *s, int from, int to)
{
    const double inverse = 1.0 / (to - from);
    const double x = s->x[to] - s->x[from], y = s->y[to] - s->y[from];
    const double xx = s->xx[to] - s->xx[from] - x * x * inverse, xy = s->xy[to] - s->xy[from] - x * y * inverse;
    const double yy = s->yy[to] - s->yy[from] - y * y * inverse, left = xx > 0.0 ? yy - xy / xx * xy : yy;
    return left > 0.0 ? left : 0.0;
}

/* Cost of the best cut before each block, and with a last piece from i on: what it was when it was last looked at, and
 * it only grows with the piece's length. least_of: the least of each group. */
typedef struct costs {
    double best[NT_PIECE_BLOCKS + 1], least[NT_PIECE_BLOCKS + GROUP], least_of[NT_PIECE_BLOCKS / GROUP + 1];
} costs;

static void set_least(costs *c, int i, double value)
{
    c->least[i] = value;
    c->least_of[i / GROUP] = value < c->least_of[i / GROUP] ? value : c->least_of[i / GROUP];
}

/* The best cut of the first j blocks with a last piece from this group on, if it is better. */
static void try_group(const sums *s, int group, int j, double variance, costs *c, int *from)
{
    const int end = (group + 1) * GROUP < j - 1 ? (group + 1) * GROUP : j - 1;
    for (int i = group * GROUP; i < end; i++) {
        if (!(c->least[i] < c->best[j]))
            continue;
        c->least[i] = c->best[i] + price + left_of(s, i, j) / variance;
        if (c->least[i] < c->best[j]) {
            c->best[j] = c->least[i];
            *from = i;
        }
    }
    const double *least = c->least + group * GROUP;
    double lowest = least[0];
    for (int k = 1; k < GROUP; k++)
        lowest = least[k] < lowest ? least[k] : lowest;
    c->least_of[group] = lowest;
}

/* from[j]: where the last piece of the best cut of the first j blocks begins. */
static void cut(const sums *s, int blocks, double variance, int from[NT_PIECE_BLOCKS + 1])
{
    costs c;
    for (int i = 0; i < NT_PIECE_BLOCKS + GROUP; i++)
        c.least[i] = INFINITY;
    for (int group = 0; group <= NT_PIECE_BLOCKS / GROUP; group++)
        c.least_of[group] = INFINITY;
    c.best[0] = 0.0;
    c.best[1] = INFINITY;
    set_least(&c, 0, price);
    from[1] = 0;
    for (int j = 2; j <= blocks; j++) {
        c.best[j] = INFINITY;
        for (int group = 0; group * GROUP + 2 <= j; group++)
            if (c.least_of[group] < c.best[j])
                try_group(s, group, j, variance, &c, from + j);
        set_least(&c, j, c.best[j] + price);
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
