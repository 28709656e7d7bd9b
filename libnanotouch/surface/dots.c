/* SPDX-License-Identifier: BSD-3-Clause
 * Quantum dots: spherical caps on a flat (the paper's Fig. 19). */
#include "core/same_bits.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/surface.h"

#include <math.h>

enum { TRIES = 1000 }; /* per dot, before the area counts as full */

static int overlaps(const nt_dots *dots, double x, double y, double diameter)
{
    for (int k = 0; k < dots->count; k++) {
        const double distance = hypotenuse(dots->dot[k].x - x, dots->dot[k].y - y);
        if (distance < (dots->dot[k].diameter + diameter) / 2.0)
            return 1;
    }
    return 0;
}

/* 1 if a free place was found. */
static int scatter_one(nt_dots *dots, double width, nt_random *random)
{
    const double diameter = 10e-9 + 20e-9 * nt_random_uniform(random);
    if (diameter > width)
        return 0;
    for (int k = 0; k < TRIES; k++) {
        const double x = diameter / 2.0 + (width - diameter) * nt_random_uniform(random);
        const double y = diameter / 2.0 + (width - diameter) * nt_random_uniform(random);
        if (overlaps(dots, x, y, diameter))
            continue;
        const int n = dots->count++;
        dots->dot[n].x = x;
        dots->dot[n].y = y;
        dots->dot[n].diameter = diameter;
        dots->dot[n].height = diameter / 3.0;
        return 1;
    }
    return 0;
}

nt_status nt_dots_scatter(nt_dots *dots, int count, double width, uint64_t seed)
{
    if (!isfinite(width))
        return NT_E_NOT_FINITE;
    if (count < 1 || count > NT_DOTS_MAX || width <= 0.0)
        return NT_E_RANGE;
    nt_random random = nt_random_seed(seed);
    nt_dots made = {.count = 0};
    while (made.count < count)
        if (!scatter_one(&made, width, &random))
            return NT_E_CAPACITY;
    *dots = made;
    return NT_OK;
}

double nt_dots_height(const nt_dots *dots, double x, double y)
{
    double height = 0.0;
    if (isnan(x) || isnan(y))
        return x + y;
    for (int k = 0; k < dots->count; k++) {
        const double r = hypotenuse(x - dots->dot[k].x, y - dots->dot[k].y);
        const double top = dots->dot[k].height, edge = dots->dot[k].diameter / 2.0;
        if (r >= edge)
            continue;
        const double radius = (edge * edge + top * top) / (2.0 * top); /* of the sphere that the cap is cut from */
        height = fmax(height, top - r * r / (radius + sqrt(radius * radius - r * r)));
    }
    return height;
}
