/* SPDX-License-Identifier: BSD-3-Clause
 * A measured curve that was dropped on the page: what it shows before any model (nanotouch/curves.h). */
#include <math.h>
#include <stdlib.h>

#include "page.h"

static nt_curve_reading reading;
static double *work;

/* Branches of `count` points each, z and force; in_count or out_count 0: there is none. The result stays until the
 * next call. */
PAGE_API(page_read_curve)
int page_read_curve(const double *z, const double *force, int in_count, int out_count, double spring_constant)
{
    const nt_curve curve = {
        .approach = {z, force, in_count},
        .retract = {z + in_count, force + in_count, out_count},
        .spring_constant = spring_constant,
    };
    const nt_curve_choice choice = {.kind = NT_CURVE_AUTO};
    page_world *world = page_the_world();
    world->problem = (nt_problem){0};
    free(work);
    work = malloc(sizeof(double) * (size_t)nt_curve_work_size(in_count + out_count));
    if (!work)
        return NT_E_NO_MEMORY;
    return (int)nt_curve_read(&curve, &choice, work, &reading, &world->problem);
}

/* Names with values in SI; NaN where the curve does not show it, "" beyond the last one. */
static const char *const NAMES[] = {
    "contact point", "its uncertainty", "pull-off force", "its uncertainty", "work of adhesion area",
    "noise",         "contact slope",   "baseline slope", "ruptures",        "visible from"};
enum { NUMBERS = sizeof NAMES / sizeof NAMES[0] };

PAGE_API(page_reading_name) const char *page_reading_name(int number)
{
    return number >= 0 && number < NUMBERS ? NAMES[number] : "";
}

PAGE_API(page_reading) double page_reading(int number)
{
    const nt_curve_branch *out = reading.retract.count ? &reading.retract : &reading.approach;
    const nt_curve_branch *in = reading.approach.count ? &reading.approach : &reading.retract;
    const double values[NUMBERS] = {reading.contact_point.value,
                                    reading.contact_point.sigma,
                                    out->dip.value,
                                    out->dip.sigma,
                                    out->adhesion_work.value,
                                    in->noise,
                                    in->contact_slope.value,
                                    in->baseline.slope,
                                    reading.ruptures,
                                    in->visible};
    return number >= 0 && number < NUMBERS ? values[number] : (double)NAN;
}

/* The branch that is read for elasticity, baseline off, from the deepest point outwards: how many, and its columns. */
PAGE_API(page_branch) int page_branch(int retract, const double **z, const double **force)
{
    const nt_curve_branch *branch = retract ? &reading.retract : &reading.approach;
    *z = branch->z;
    *force = branch->force;
    return (int)branch->count;
}

/* E* [Pa] of Hertz' sphere of a radius [m] on the branch that is read (the approach where there is one): a line through
 * F^(2/3) over the indentation, from a tenth of the largest force on; NaN where fewer than eight points press. */
PAGE_API(page_hertz) double page_hertz(double radius, double spring_constant)
{
    const nt_curve_branch *branch = reading.approach.count ? &reading.approach : &reading.retract;
    const double foot = reading.contact_point.value;
    double most = 0.0, n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (long i = 0; i < branch->count; ++i)
        if (branch->force[i] > most)
            most = branch->force[i];
    for (long i = 0; i < branch->count; ++i) {
        const double force = branch->force[i], depth = foot - branch->z[i] - force / spring_constant;
        if (force < 0.1 * most || force < branch->visible)
            continue;
        const double y = pow(force, 2.0 / 3.0);
        n += 1.0;
        sx += depth;
        sy += y;
        sxx += depth * depth;
        sxy += depth * y;
    }
    const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    return n < 8.0 || !(slope > 0.0) ? (double)NAN : 0.75 * pow(slope, 1.5) / sqrt(radius);
}
