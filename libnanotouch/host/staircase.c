/* SPDX-License-Identifier: BSD-3-Clause
 * Two down, one up: a staircase of a ratio above 1 (task.h). */
#include <math.h>
#include <string.h>

#include "host/task.h"

enum { LAST = 6 }; /* reversals whose mean is the threshold */

nt_staircase nt_staircase_begin(double start, double least, double most, int reversals)
{
    return (nt_staircase){.log = log(start), .least = log(least), .most = log(most), .needed = reversals};
}

double nt_staircase_ratio(const nt_staircase *stairs)
{
    return exp(stairs->log);
}

/* Enough reversals; or two pairs of right answers at the least ratio. */
int nt_staircase_done(const nt_staircase *stairs)
{
    return stairs->count >= stairs->needed || stairs->at_the_floor >= 2;
}

static void note_reversal(nt_staircase *stairs)
{
    const int room = (int)(sizeof stairs->reversals / sizeof *stairs->reversals);
    if (stairs->count < room)
        stairs->reversals[stairs->count++] = stairs->log;
}

void nt_staircase_take(nt_staircase *stairs, int right)
{
    ++stairs->trials;
    stairs->right_in_a_row = right ? stairs->right_in_a_row + 1 : 0;
    const int way = !right ? 1 : stairs->right_in_a_row == 2 ? -1 : 0;
    if (!way)
        return;
    stairs->right_in_a_row = 0;
    if (way < 0 && stairs->log <= stairs->least)
        ++stairs->at_the_floor;
    if (stairs->last_way && way != stairs->last_way)
        note_reversal(stairs);
    stairs->last_way = way;
    const double factor = stairs->count ? 0.75 : 0.5; /* of the logarithm */
    stairs->log = fmin(fmax(stairs->log * (way < 0 ? factor : 1.0 / factor), stairs->least), stairs->most);
}

/* The ratio where it settled: geometric mean of the last reversals, or the least one shown. */
double nt_staircase_threshold(const nt_staircase *stairs)
{
    if (stairs->at_the_floor >= 2 || !stairs->count)
        return nt_staircase_ratio(stairs);
    const int first = stairs->count > LAST ? stairs->count - LAST : 0;
    double sum = 0.0;
    for (int i = first; i < stairs->count; ++i)
        sum += stairs->reversals[i];
    return exp(sum / (stairs->count - first));
}
