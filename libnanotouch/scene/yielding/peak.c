/* SPDX-License-Identifier: BSD-3-Clause
 * The largest pressure on a sample that yields, which is under the apex: of each equilibrium, and over the load. */
#include <math.h>

#include "scene/yielding/yield.h"

#define OF_MEAN 1.5 /* Hertz' peak over his mean */

/* Under the apex: that of the laws; in contact Hertz' 2 E* a/(pi R), of a layer 1.5 times the mean if that is more, on
 * that of the laws where the bodies touch. */
double nt_yield_peak_of(const nt_yield_sample *sample, const nt_yield_point *point)
{
    if (!(point->a > 0.0))
        return sample->law(sample->context, fmax(point->centre, 0.0)).pressure;
    const double hertz = 2.0 * sample->modulus * point->a / (NT_PI * sample->radius);
    const double mean = sample->thickness > 0.0 ? point->F / (NT_PI * point->a * point->a) : 0.0;
    return fmax(hertz, OF_MEAN * mean) + fmax(sample->law(sample->context, 0.0).pressure, 0.0);
}

double nt_yield_table_load(const nt_yield_table *table, double peak)
{
    const nt_yield_node *node = table->node;
    int i = 1;
    while (i < table->count && !(node[i].peak > peak))
        ++i;
    if (i == table->count)
        return INFINITY;
    if (!(node[i - 1].F > 0.0 && node[i - 1].peak > 0.0))
        return fmax(node[i - 1].F, 0.0);
    const double power = log(node[i].F / node[i - 1].F) / log(node[i].peak / node[i - 1].peak);
    return node[i - 1].F * pow(peak / node[i - 1].peak, power);
}

double nt_yield_table_peak(const nt_yield_table *table, double load)
{
    const nt_yield_node *node = table->node;
    int i = 1;
    while (i < table->count - 1 && node[i].F < load)
        ++i;
    if (!(node[i - 1].F > 0.0 && node[i - 1].peak > 0.0))
        return node[i].peak;
    const double power = log(node[i].peak / node[i - 1].peak) / log(node[i].F / node[i - 1].F);
    return node[i - 1].peak * pow(fmin(load, node[i].F) / node[i - 1].F, power);
}
