/* SPDX-License-Identifier: BSD-3-Clause
 * Ringing of lever and stage after the turn. It goes as far above the free level as below, whereas adhesion only pulls
 * below: the excursions above the level, right after the lowest point, tell what those below it are worth. */
#include "curves/ringing.h"

#include <math.h>

#include "core/same_bits.h"

enum { FEWEST = 6, MOST = 96 };      /* points above the level, after the lowest, that are asked for ringing */
static const double clear = 4.0;     /* standard deviations of their mean square that noise alone may show */
static const double decay = 0.3;     /* least trough over the peak before it: less is noise */
static const double held = 2.0;      /* times longer down than up: a free lever takes as long for both */
static const double shoulder = 0.25; /* of the depth, where a dip begins and ends */
static const double arcsine = 0.70710678118654752440; /* standard deviation of a sine at any phase over its amplitude */

/* Whether the points above the level scatter more than the noise of the baseline does. */
static int rings(const nt_curve_branch *branch)
{
    const double sigma = fmax(branch->noise, branch->baseline.scatter);
    double squares = 0.0;
    long count = 0, asked = FEWEST;
    for (long i = branch->lowest + 1; i < branch->count && asked <= MOST; i++) {
        if (!(branch->force[i] > 0.0))
            continue;
        squares += branch->force[i] * branch->force[i];
        if (++count < asked)
            continue;
        if (squares / (double)count > sigma * sigma * (1.0 + clear * sqrt(2.0 / (double)count)))
            return 1;
        asked *= 2;
    }
    return 0;
}

/* Of the ringing at the lowest point [N]: the highest point after it, and what decays from there to the next trough. */
static double amplitude(const nt_curve_branch *branch)
{
    long top = branch->lowest;
    for (long i = top + 1; i < branch->count; i++)
        top = branch->force[i] > branch->force[top] ? i : top;
    const double peak = branch->force[top];
    double trough = 0.0;
    for (long i = top + 1; i < branch->count; i++)
        trough = fmax(trough, -branch->force[i]);
    return peak > 0.0 ? peak / fmin(fmax(trough / peak, decay), 1.0) : 0.0;
}

/* Whether the force takes longer down to the lowest point than back: the tip was held there, and then torn off. */
static int is_held(const nt_curve_branch *branch)
{
    const double edge = shoulder * branch->force[branch->lowest];
    long first = branch->lowest, last = branch->lowest;
    while (first > 0 && branch->force[first] < edge)
        first--;
    while (last + 1 < branch->count && branch->force[last] < edge)
        last++;
    return (double)(branch->lowest - first) > held * (double)(last - branch->lowest);
}

/* By how much the force rises before the lowest point at most [N]: what rang before it was torn off. */
static double rise_before(const nt_curve_branch *branch)
{
    double low = branch->force[0], rise = 0.0;
    for (long i = 1; i < branch->lowest; i++) {
        low = fmin(low, branch->force[i]);
        rise = fmax(rise, branch->force[i] - low);
    }
    return rise;
}

void nt_curve_doubt_ringing(nt_curve_reading *reading)
{
    nt_curve_branch *retract = &reading->retract;
    if (!rings(retract))
        return;
    double size = amplitude(retract);
    if (is_held(retract)) /* a lever that is torn off rings too, but only afterwards */
        size = fmin(size, rise_before(retract));
    reading->ringing = size;
    reading->pull_off_least = fmax(reading->pull_off_least - size, 0.0);
    reading->pull_off_most = fmax(reading->pull_off_most, -retract->force[retract->lowest]) + size;
    retract->dip.sigma = hypotenuse(retract->dip.sigma, arcsine * fmin(size, retract->dip.value));
}
