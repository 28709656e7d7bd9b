/* SPDX-License-Identifier: BSD-3-Clause
 * Tips of several shapes on an elastic half-space without adhesion: which law is meant, in SI. Pyramids are cones of an
 * equivalent angle: by similarity F = C E* tan(psi) delta^2 exactly, and C is a number that depends on the sides alone.
 * Blunted and truncated pyramids take the same angle; that is exact for the pyramid far from the end, and at the end.
 */
#include <math.h>
#include <stddef.h>

#include "contact/hertz.h"
#include "contact/shapes/profile.h"
#include "core/problem.h"
#include "core/strided.h"
#include "internal/contact.h"
#include "internal/field.h"
#include "internal/geometry.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/advanced/geometry.h"

/* Converged to 1e-4 with the numerical half-space solution that tests/python/test_geometry.py repeats. */
#define PYRAMID_4 0.73762
#define PYRAMID_3 0.87960

/* Lengths as those of contact.h; a tip as blunt as 89.4 degrees or as sharp as 0.6. */
#define RADIUS NT_FIELD(nt_shape, radius, "m", 1e-10, 1.0, "radius R")
#define ANGLE NT_FIELD(nt_shape, half_angle, "rad", 0.01, 1.56, "half angle psi")
static const nt_field shape_fields[] = {RADIUS, ANGLE};

const char *nt_shape_name(nt_shape_kind kind)
{
    static const char *const names[NT_SHAPE_COUNT] = {"paraboloid", "sphere", "cone", "punch", "blunted", "truncated"};
    return (unsigned)kind < NT_SHAPE_COUNT ? names[kind] : "unknown";
}

static int has_flank(nt_shape_kind kind)
{
    return kind == NT_SHAPE_CONE || kind == NT_SHAPE_BLUNTED || kind == NT_SHAPE_TRUNCATED;
}

static int is_known(nt_shape_kind kind)
{
    return (unsigned)kind < NT_SHAPE_COUNT;
}

double nt_pyramid_equivalent_angle(int sides, double half_angle)
{
    switch (sides) {
    case 0:
        return half_angle;
    case 3:
        return atan(0.5 * NT_PI * PYRAMID_3 * tan(half_angle));
    case 4:
        return atan(0.5 * NT_PI * PYRAMID_4 * tan(half_angle));
    default:
        return NAN;
    }
}

static double flank_slope(const nt_shape *shape)
{
    return 1.0 / tan(nt_pyramid_equivalent_angle(shape->sides, shape->half_angle));
}

nt_status nt_shape_check(const nt_shape *shape, nt_problem *problem)
{
    const int flank = has_flank(shape->kind);
    if (!is_known(shape->kind)) {
        if (problem != NULL)
            *problem = nt_problem_of("kind", "", (double)shape->kind, NT_SHAPE_PARABOLOID, NT_SHAPE_COUNT - 1);
        return NT_E_ARGUMENT;
    }
    if (flank && shape->sides != 0 && shape->sides != 3 && shape->sides != 4) {
        if (problem != NULL)
            *problem = nt_problem_of("sides", "", shape->sides, 3.0, 4.0);
        return NT_E_ARGUMENT;
    }
    const int first = shape->kind == NT_SHAPE_CONE ? 1 : 0;
    const nt_status status = nt_field_check(shape_fields + first, (flank ? 2 : 1) - first, shape, problem);
    if (status != NT_OK || shape->kind != NT_SHAPE_BLUNTED)
        return status;
    const double tangent = shape->radius * flank_slope(shape);
    const nt_field transition = NT_FIELD(nt_shape, transition, "m", 0.0, tangent, "b");
    return nt_field_check(&transition, 1, shape, problem);
}

/* Rim of a blunted or truncated shape; its radius is the unit of length. */
static nt_rim rim_of(const nt_shape *shape, double *length)
{
    nt_rim rim = {.cap = 0.0, .flank = flank_slope(shape)};
    *length = shape->radius;
    if (shape->kind == NT_SHAPE_BLUNTED) {
        rim.cap = shape->transition > 0.0 ? shape->transition / shape->radius : rim.flank;
        *length = rim.cap * shape->radius;
    }
    return rim;
}

static nt_law_value to_si(nt_profile_point point, double modulus, double length)
{
    const double F = 2.0 * modulus * length * length;
    return (nt_law_value){
        .U = 0.5 * F * length * point.energy,
        .F = F * point.force,
        .k = 2.0 * modulus * length * point.radius,
        .a = length * point.radius,
    };
}

static nt_contact paraboloid_of(const nt_shape *shape, double modulus)
{
    return (nt_contact){.radius = shape->radius, .effective_modulus = modulus};
}

static nt_law_value eval_rim(const nt_shape *shape, double modulus, double indentation)
{
    double length;
    const nt_rim rim = rim_of(shape, &length);
    const double depth = indentation / length;
    if (depth < rim.cap) /* on the cap */
        return nt_hertz_law(shape->radius, modulus, indentation);
    return to_si(nt_rim_point(&rim, nt_rim_find_depth(&rim, depth)), modulus, length);
}

nt_law_value nt_shape_eval(const nt_shape *shape, double effective_modulus, double indentation)
{
    if (indentation <= 0.0)
        return (nt_law_value){0};
    if (!isfinite(indentation))
        return (nt_law_value){NAN, NAN, NAN, NAN};
    switch (shape->kind) {
    case NT_SHAPE_PARABOLOID:
        return nt_hertz_law(shape->radius, effective_modulus, indentation);
    case NT_SHAPE_SPHERE:
        return to_si(nt_sphere_point(nt_sphere_find_depth(indentation / shape->radius)), effective_modulus,
                     shape->radius);
    case NT_SHAPE_CONE:
        return nt_cone_eval(effective_modulus, nt_pyramid_equivalent_angle(shape->sides, shape->half_angle),
                            indentation);
    case NT_SHAPE_PUNCH:
        return nt_punch_eval(effective_modulus, shape->radius, indentation);
    case NT_SHAPE_BLUNTED:
    case NT_SHAPE_TRUNCATED:
        return eval_rim(shape, effective_modulus, indentation);
    }
    return (nt_law_value){NAN, NAN, NAN, NAN};
}

static double rim_indentation(const nt_shape *shape, double modulus, double force)
{
    double length;
    const nt_rim rim = rim_of(shape, &length);
    const double reduced = force / (2.0 * modulus) / length / length;
    if (reduced < 2.0 / 3.0 * rim.cap) { /* on the cap */
        const nt_contact cap = paraboloid_of(shape, modulus);
        return nt_hertz_indentation(&cap, force);
    }
    return length * nt_rim_point(&rim, nt_rim_find_force(&rim, reduced)).depth;
}

double nt_shape_indentation(const nt_shape *shape, double effective_modulus, double force)
{
    if (force == 0.0)
        return 0.0;
    if (!(force > 0.0) || !isfinite(force))
        return NAN;
    const double F = force / (2.0 * effective_modulus), R = shape->radius;
    const nt_contact paraboloid = paraboloid_of(shape, effective_modulus);
    switch (shape->kind) {
    case NT_SHAPE_PARABOLOID:
        return nt_hertz_indentation(&paraboloid, force);
    case NT_SHAPE_SPHERE:
        return R * nt_sphere_point(nt_sphere_find_force(F / R / R)).depth;
    case NT_SHAPE_CONE:
        return sqrt(NT_PI * F * flank_slope(shape));
    case NT_SHAPE_PUNCH:
        return F / R;
    case NT_SHAPE_BLUNTED:
    case NT_SHAPE_TRUNCATED:
        return rim_indentation(shape, effective_modulus, force);
    }
    return NAN;
}

void nt_shape_eval_n(const nt_shape *shape, double effective_modulus, const nt_strided *arrays)
{
    for (long i = 0; i < arrays->count; i++) {
        const double indentation = arrays->in[i * arrays->in_stride];
        nt_strided_store(arrays, i, nt_shape_eval(shape, effective_modulus, indentation));
    }
}
