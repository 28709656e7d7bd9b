/* SPDX-License-Identifier: BSD-3-Clause
 * Pressures on a sample that yields, of each equilibrium and over the load: the largest, which is under the apex, and
 * the mean over what is touched. */
#include <math.h>

#include "scene/yielding/yield.h"

#define OF_MEAN 1.5 /* Hertz' peak over his mean */

/* Under the apex: that of the laws; in contact Hertz' 2 E* a/(pi R) and what a layer adds, on that of the laws where
 * the bodies touch. */
double nt_yield_peak_of(const nt_yield_sample *sample, const nt_yield_point *point)
{
    if (!(point->a > 0.0))
        return sample->law(sample->context, fmax(point->centre, 0.0)).pressure;
    const double hertz = 2.0 * sample->modulus * point->a / (NT_PI * sample->radius);
    return hertz + point->layer_peak + fmax(sample->law(sample->context, 0.0).pressure, 0.0);
}

double nt_yield_peak_at(const nt_yield_table *table, const nt_yield_node *node)
{
    (void)table;
    return node->peak;
}

/* Two thirds of the peak, as Hertz has it; on a layer, whose peak is up to three times it, the load over the area. */
double nt_yield_mean_at(const nt_yield_table *table, const nt_yield_node *node)
{
    const double hertz = node->peak / OF_MEAN;
    return table->layered && node->a > 0.0 ? fmin(hertz, node->F / (NT_PI * node->a * node->a)) : hertz;
}

double nt_yield_table_load(const nt_yield_table *table, double pressure, nt_yield_pressure *of)
{
    const nt_yield_node *node = table->node;
    int i = 1;
    while (i < table->count && !(of(table, &node[i]) > pressure))
        ++i;
    if (i == table->count)
        return INFINITY;
    const double before = of(table, &node[i - 1]), after = of(table, &node[i]);
    if (!(node[i - 1].F > 0.0 && before > 0.0))
        return fmax(node[i - 1].F, 0.0);
    const double power = log(node[i].F / node[i - 1].F) / log(after / before);
    return node[i - 1].F * pow(pressure / before, power);
}

double nt_yield_table_pressure(const nt_yield_table *table, double load, nt_yield_pressure *of)
{
    const nt_yield_node *node = table->node;
    int i = 1;
    while (i < table->count - 1 && node[i].F < load)
        ++i;
    const double before = of(table, &node[i - 1]), after = of(table, &node[i]);
    if (!(node[i - 1].F > 0.0 && before > 0.0))
        return after;
    const double power = log(after / before) / log(node[i].F / node[i - 1].F);
    return before * pow(fmin(load, node[i].F) / node[i - 1].F, power);
}
