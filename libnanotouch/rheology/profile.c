/* SPDX-License-Identifier: BSD-3-Clause
 * Paraboloid 4/3 sqrt(R) delta^(3/2), cone 2 tan(psi)/pi delta^2, punch 2 a delta, sphere by Sneddon (contact/shapes);
 * on a layer times a polynomial (contact/bonded_layer.h). */
#include "rheology/profile.h"
#include "internal/geometry.h"

#include <math.h>
#include <stddef.h>

static void add_layer(nt_profile *profile, const double c[NT_LAYER_C], double factor)
{
    profile->terms = NT_LAYER_C;
    double power = 1.0;
    for (int i = 0; i < NT_LAYER_C; i++)
        profile->c[i + 1] = c[i] * (power *= factor);
}

nt_profile nt_profile_make(const nt_shape *shape, double thickness)
{
    static const double paraboloid[] = NT_LAYER_PARABOLOID_C, cone[] = NT_LAYER_CONE_C;
    nt_profile profile = {shape->kind, 0, shape->radius, {1.0}, (double)INFINITY};
    const double slope = tan(nt_pyramid_equivalent_angle(shape->sides, shape->half_angle));
    if (shape->kind == NT_SHAPE_PARABOLOID)
        profile.scale = 4.0 / 3.0 * sqrt(shape->radius);
    else if (shape->kind == NT_SHAPE_PUNCH)
        profile.scale = 2.0 * shape->radius;
    else if (shape->kind == NT_SHAPE_SPHERE)
        profile.deepest = shape->radius;
    else
        profile.scale = 2.0 / NT_PI * slope;
    if (thickness > 0.0 && shape->kind == NT_SHAPE_PARABOLOID) {
        add_layer(&profile, paraboloid, sqrt(shape->radius) / thickness);
        profile.deepest = pow(NT_LAYER_PARABOLOID_LAST * thickness, 2.0) / shape->radius;
    } else if (thickness > 0.0) {
        add_layer(&profile, cone, slope / thickness);
        profile.deepest = NT_LAYER_CONE_LAST * thickness / slope;
    }
    return profile;
}

/* F/E* = g, k/E* = 2 a, and d(2a)/d(delta) from delta = a artanh(a/R). */
static nt_profile_value sphere(double radius, double indentation)
{
    const nt_law_value value = nt_sphere_series_eval(radius, 1.0, indentation);
    const double t = value.a / radius;
    return (nt_profile_value){value.F, value.k, 2.0 / (atanh(t) + t / (1.0 - t * t))};
}

nt_profile_value nt_profile_at(const nt_profile *profile, double indentation)
{
    if (profile->kind == NT_SHAPE_PUNCH)
        return (nt_profile_value){profile->scale * indentation, profile->scale, 0.0};
    if (!(indentation > 0.0))
        return (nt_profile_value){0.0, 0.0, 0.0};
    if (profile->kind == NT_SHAPE_SPHERE)
        return sphere(profile->scale, indentation);
    const int round = profile->kind == NT_SHAPE_PARABOLOID;
    const double s = round ? sqrt(indentation) : indentation;
    double P = 0.0, P1 = 0.0, P2 = 0.0; /* of s, with derivatives; P2 is half of the second */
    for (int i = profile->terms; i >= 0; i--) {
        P2 = P2 * s + P1;
        P1 = P1 * s + P;
        P = P * s + profile->c[i];
    }
    const double k = profile->scale;
    if (!round)
        return (nt_profile_value){k * s * s * P, k * s * (2.0 * P + s * P1),
                                  k * (2.0 * P + s * (4.0 * P1 + 2.0 * s * P2))};
    return (nt_profile_value){k * s * s * s * P, 0.5 * k * s * (3.0 * P + s * P1),
                              0.25 * k * (3.0 * P + s * (5.0 * P1 + 2.0 * s * P2)) / s};
}
