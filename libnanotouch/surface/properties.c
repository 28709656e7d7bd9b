/* SPDX-License-Identifier: BSD-3-Clause
 * What the sample is made of at each place: cubic B-splines whose coefficients are the values at the pixels. An
 * interpolating spline would ring where two materials meet, below 0 where they differ by much; this one is a mean of
 * its sixteen pixels, so that it is never outside their range, and bounds of the pixels hold everywhere. */
#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "nanotouch/surface.h"

#define LEAST_SHARE 1e-3 /* of the largest work of adhesion: the bank of tables reaches so far */

/* A property and its valid range. */
typedef struct property {
    const char *field, *unit;
    double minimum, maximum;
} property;

/* The grid with these values for coefficients; no coefficients where there are none. */
static nt_status spline_of(nt_surface *spline, const nt_surface *grid, const double *values, const property *valid,
                           nt_problem *problem)
{
    nt_surface made = {NULL, grid->nx, grid->ny, grid->dx, grid->dy, 0.0, 0.0};
    if (values != NULL) {
        made.coefficients = values;
        made.height_minimum = made.height_maximum = values[0];
    }
    for (long p = 0; values != NULL && p < grid->nx * grid->ny; p++) {
        if (!(values[p] >= valid->minimum && values[p] <= valid->maximum))
            return nt_problem_set(problem, valid->field, valid->unit, values[p], valid->minimum, valid->maximum);
        made.height_minimum = fmin(made.height_minimum, values[p]);
        made.height_maximum = fmax(made.height_maximum, values[p]);
    }
    *spline = made;
    return NT_OK;
}

nt_status nt_properties_init(nt_properties *properties, const nt_surface *grid, const double *youngs_modulus,
                             const double *work_of_adhesion, nt_problem *problem)
{
    const property modulus = {"surface.youngs_modulus", "Pa", 1e2, 1e13};
    const property work = {"surface.work_of_adhesion", "J/m^2", 0.0, 10.0};
    if (properties == NULL || grid == NULL || grid->coefficients == NULL)
        return NT_E_ARGUMENT;
    nt_properties made;
    nt_status status = spline_of(&made.youngs_modulus, grid, youngs_modulus, &modulus, problem);
    if (status == NT_OK)
        status = spline_of(&made.work_of_adhesion, grid, work_of_adhesion, &work, problem);
    if (status != NT_OK)
        return status;
    const double least = made.work_of_adhesion.height_minimum, most = made.work_of_adhesion.height_maximum;
    if (work_of_adhesion != NULL && !(least > 0.0 && least >= LEAST_SHARE * most))
        return nt_problem_set(problem, work.field, work.unit, least, most > 0.0 ? LEAST_SHARE * most : 1e-12,
                              work.maximum);
    *properties = made;
    return NT_OK;
}
