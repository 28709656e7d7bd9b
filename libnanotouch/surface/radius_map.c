/* SPDX-License-Identifier: BSD-3-Clause
 * The effective radius of a spherical tip on a curved surface.
 *
 * The dilated surface D is the one that the centre of the tip moves on, lowered by R: parallel to the body at a
 * distance R. So a principal curvature kappa of the body (> 0 convex) is k = kappa/(1 + R kappa) on D, and the gap
 * between tip and body curves by 1/R + kappa = 1/(R (1 - R k)). Of the two directions the contact takes the geometric
 * mean (to second order in their difference, Johnson 1985): R_eff = R sqrt((1 - R k1)(1 - R k2)) = R sqrt(1 - 2 R H +
 * R^2 K), H mean, K Gaussian curvature of D. On the sphere of a sharp edge k = 1/R and R_eff = 0. */
#include "internal/field.h"
#include "internal/surface.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/surface.h"

#include <math.h>
#include <stddef.h>

/* R_eff/R; 0 where either curvature is that of the tip or beyond. */
static double ratio_of(const nt_surface_value *s, double radius)
{
    const double w = 1.0 + s->zx * s->zx + s->zy * s->zy, root = sqrt(w);
    const double twice_H =
        -((1.0 + s->zy * s->zy) * s->zxx - 2.0 * s->zx * s->zy * s->zxy + (1.0 + s->zx * s->zx) * s->zyy) / (w * root);
    const double K = (s->zxx * s->zyy - s->zxy * s->zxy) / (w * w);
    const double product = 1.0 - radius * twice_H + radius * radius * K, sum = 2.0 - radius * twice_H;
    return product > 0.0 && sum > 0.0 ? sqrt(product) : 0.0;
}

static nt_status inputs_check(const nt_surface *dilated, double tip_radius, const nt_radius_limits *limits,
                              const double *coefficients)
{
    static const nt_field fields[] = {
        NT_FIELD_NAMED("limits.minimum", nt_radius_limits, minimum, "", 1e-3, 1.0,
                       "least ratio of the effective radius"),
        NT_FIELD_NAMED("limits.maximum", nt_radius_limits, maximum, "", 1.0, 1e3,
                       "largest ratio of the effective radius"),
    };
    if (!isfinite(tip_radius))
        return NT_E_NOT_FINITE;
    if (tip_radius < 1e-10 || tip_radius > 1e-3)
        return NT_E_RANGE;
    if (dilated->coefficients != NULL && coefficients == NULL)
        return NT_E_ARGUMENT;
    return nt_field_check(fields, 2, limits, NULL);
}

nt_radius_limits nt_radius_limits_defaults(void)
{
    return (nt_radius_limits){.minimum = 0.1, .maximum = 3.0};
}

nt_status nt_radius_map_init(nt_radius_map *map, const nt_surface *dilated, double tip_radius,
                             const nt_radius_limits *limits, double *coefficients)
{
    const nt_radius_limits defaults = nt_radius_limits_defaults();
    if (limits == NULL)
        limits = &defaults;
    const nt_status status = inputs_check(dilated, tip_radius, limits, coefficients);
    if (status != NT_OK)
        return status;
    nt_radius_map made = {.ratio = *dilated, .tip_radius = tip_radius, .minimum = tip_radius, .maximum = tip_radius};
    if (dilated->coefficients != NULL) {
        double least = HUGE_VAL, most = 0.0;
        for (long j = 0; j < dilated->ny; j++)
            for (long i = 0; i < dilated->nx; i++) {
                const nt_surface_value at = nt_surface_eval(dilated, (double)i * dilated->dx, (double)j * dilated->dy);
                const double ratio = ratio_of(&at, tip_radius);
                const double kept = fmin(fmax(ratio, limits->minimum), limits->maximum);
                coefficients[j * dilated->nx + i] = kept;
                made.limited += kept != ratio;
                least = fmin(least, kept);
                most = fmax(most, kept);
            }
        made.ratio.coefficients = coefficients;
        made.ratio.height_minimum = least;
        made.ratio.height_maximum = most;
        made.minimum = least * tip_radius;
        made.maximum = most * tip_radius;
    }
    *map = made;
    return NT_OK;
}

nt_radius_value nt_radius_map_eval(const nt_radius_map *map, double x, double y)
{
    if (map->ratio.coefficients == NULL)
        return (nt_radius_value){.radius = isnan(x) || isnan(y) ? x + y : map->tip_radius};
    const nt_height_value ratio = nt_surface_height(&map->ratio, x, y);
    const double R = map->tip_radius;
    return (nt_radius_value){.radius = R * ratio.z, .dx = R * ratio.zx, .dy = R * ratio.zy};
}
