/* SPDX-License-Identifier: BSD-3-Clause
 * JKR adhesion of a cone (Maugis, Barquins, J. Phys. D 16 (1983) 1843) and of a flat punch (Kendall, J. Phys. D 4
 * (1971) 1186); the paraboloid is jkr.c. At the edge, G = w gives delta = delta_0(a) - s, s = sqrt(2 pi w a/E*).
 *
 * Cone: with a = a_f r^2, a_f = 2 w tan(psi)^2/(pi E*) the radius of the displacement fold,
 *
 *     delta = delta_f (r^2 - 2 r)     delta_f = w tan(psi)/E*
 *     F     = F_f (r^4 - 4 r^3)       F_f     = 2 w^2 tan(psi)^3/(pi E*)                                    (cone)
 *     U     = F_f delta_f (r^6/3 - 2 r^5 + 2 r^4)
 *
 * Displacement fold at r = 1, load fold at r = 3, F = -27 F_f. Contact exists down to r = 0.
 *
 * Punch: F = 2 E* a delta down to delta = -s, where the whole face lets go; U = E* a delta^2 - pi a^2 w. */
#include <float.h>
#include <math.h>
#include <stddef.h>

#include "contact/reduced.h"
#include "core/problem.h"
#include "core/roots.h"
#include "internal/contact.h"
#include "internal/field.h"
#include "internal/geometry.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/advanced/geometry.h"

#define FIELD(path, ...) NT_FIELD(nt_jkr_shape, path, __VA_ARGS__)

static const nt_field jkr_fields[] = {
    FIELD(effective_modulus, "Pa", 0.1, 1e15, "effective modulus E*"),
    FIELD(work_of_adhesion, "J/m^2", 0.0, 1e3, "work of adhesion w"),
};

typedef struct {
    double indentation, force, radius; /* delta_f [m], F_f [N], a_f [m] */
} cone_units;

static cone_units units_of(const nt_jkr_shape *contact)
{
    const double t = tan(contact->shape.half_angle), length = contact->work_of_adhesion / contact->effective_modulus;
    const double radius = 2.0 / NT_PI * length * t * t;
    return (cone_units){.indentation = length * t, .force = contact->work_of_adhesion * radius * t, .radius = radius};
}

static nt_contact paraboloid_of(const nt_jkr_shape *contact)
{
    return (nt_contact){contact->shape.radius, contact->effective_modulus, contact->work_of_adhesion, 0.0};
}

static double punch_reach(const nt_jkr_shape *contact)
{
    return sqrt(2.0 * NT_PI * contact->work_of_adhesion / contact->effective_modulus * contact->shape.radius);
}

nt_status nt_jkr_shape_check(const nt_jkr_shape *contact, nt_problem *problem)
{
    const nt_status status = nt_shape_check(&contact->shape, problem);
    if (status != NT_OK)
        return status;
    const nt_shape_kind kind = contact->shape.kind;
    const int round_cone = kind == NT_SHAPE_CONE && contact->shape.sides == 0;
    if (!round_cone && kind != NT_SHAPE_PUNCH && kind != NT_SHAPE_PARABOLOID) {
        if (problem != NULL)
            *problem = nt_problem_of("shape", "", (double)kind, NT_SHAPE_PARABOLOID, NT_SHAPE_PUNCH);
        return NT_E_UNSUPPORTED;
    }
    return nt_field_check(jkr_fields, 2, contact, problem);
}

/* w so small against delta that r^2 would overflow or the correction is below the last bit: no adhesion. */
static int is_without_adhesion(double value, double unit)
{
    return !(value < 1e34 * unit);
}

static nt_status eval_cone(const nt_jkr_shape *contact, double indentation, nt_branch branch, nt_law_value *value)
{
    const cone_units units = units_of(contact);
    const int unstable = branch == NT_BRANCH_UNSTABLE;
    if (unstable && !(indentation >= -units.indentation && indentation < 0.0))
        return NT_E_NO_SOLUTION;
    if (indentation < (branch == NT_BRANCH_APPROACH ? 0.0 : -units.indentation)) {
        *value = (nt_law_value){0};
        return NT_OK;
    }
    if (is_without_adhesion(indentation, units.indentation)) {
        *value = nt_cone_eval(contact->effective_modulus, contact->shape.half_angle, indentation);
        return NT_OK;
    }
    const double d = indentation / units.indentation, root = sqrt(fmax(1.0 + d, 0.0));
    const double r = unstable ? -d / (1.0 + root) : 1.0 + root; /* the two roots multiply to -d */
    const double off_fold = copysign(fmax(root, NT_FOLD_RESOLUTION), unstable ? -1.0 : 1.0);
    const double r2 = r * r;
    *value = (nt_law_value){
        .U = units.force * units.indentation * r2 * r2 * (r2 / 3.0 - 2.0 * r + 2.0),
        .F = units.force * r2 * r * (r - 4.0),
        .k = units.force / units.indentation * 2.0 * r2 * (r - 3.0) / off_fold,
        .a = units.radius * r2,
    };
    return NT_OK;
}

static nt_status eval_punch(const nt_jkr_shape *contact, double indentation, nt_branch branch, nt_law_value *value)
{
    const double a = contact->shape.radius, k = 2.0 * contact->effective_modulus * a;
    if (branch == NT_BRANCH_UNSTABLE)
        return NT_E_NO_SOLUTION;
    const double last = branch == NT_BRANCH_APPROACH ? 0.0 : -punch_reach(contact);
    if (indentation < last || (contact->work_of_adhesion == 0.0 && indentation <= 0.0)) {
        *value = (nt_law_value){0};
        return NT_OK;
    }
    const double F = k * indentation;
    *value = (nt_law_value){0.5 * F * indentation - NT_PI * a * a * contact->work_of_adhesion, F, k, a};
    return NT_OK;
}

nt_status nt_jkr_shape_eval(const nt_jkr_shape *contact, double indentation, nt_branch branch, nt_law_value *value)
{
    if (!nt_branch_is_known(branch))
        return NT_E_ARGUMENT;
    if (!isfinite(indentation))
        return NT_E_NOT_FINITE;
    const nt_contact paraboloid = paraboloid_of(contact);
    switch (contact->shape.kind) {
    case NT_SHAPE_PARABOLOID:
        return nt_jkr_eval(&paraboloid, indentation, branch, value);
    case NT_SHAPE_CONE:
        return contact->shape.sides == 0 ? eval_cone(contact, indentation, branch, value) : NT_E_UNSUPPORTED;
    case NT_SHAPE_PUNCH:
        return eval_punch(contact, indentation, branch, value);
    default:
        return NT_E_UNSUPPORTED;
    }
}

static double cone_load(double r, const void *load)
{
    return r * r * r * (r - 4.0) - *(const double *)load;
}

/* r at F/F_f >= -27: above the load fold r = 3, or below it. */
static nt_status cone_indentation(const nt_jkr_shape *contact, double force, int unstable, double *indentation)
{
    const cone_units units = units_of(contact);
    if (force < -27.0 * units.force || (unstable && force >= 0.0))
        return NT_E_NO_SOLUTION;
    if (is_without_adhesion(force, units.force)) {
        *indentation = nt_shape_indentation(&contact->shape, contact->effective_modulus, force);
        return NT_OK;
    }
    const double load = fmax(force / units.force, -27.0), top = 4.0 + sqrt(sqrt(fmax(load, 0.0)));
    const double bracket[2] = {unstable ? 0.0 : 3.0, unstable ? 3.0 : top};
    double r = 3.0;
    const nt_status status = load > -27.0 ? nt_root_find(cone_load, &load, bracket, &r, NULL) : NT_OK;
    if (status == NT_OK)
        *indentation = units.indentation * r * (r - 2.0);
    return status;
}

nt_status nt_jkr_shape_indentation(const nt_jkr_shape *contact, double force, nt_branch branch, double *indentation)
{
    if (!nt_branch_is_known(branch))
        return NT_E_ARGUMENT;
    if (!isfinite(force))
        return NT_E_NOT_FINITE;
    const nt_shape *shape = &contact->shape;
    const int unstable = branch == NT_BRANCH_UNSTABLE;
    const nt_contact paraboloid = paraboloid_of(contact);
    if (shape->kind == NT_SHAPE_PARABOLOID)
        return nt_jkr_indentation(&paraboloid, force, branch, indentation);
    if (shape->kind == NT_SHAPE_CONE && shape->sides == 0)
        return cone_indentation(contact, force, unstable, indentation);
    if (shape->kind != NT_SHAPE_PUNCH)
        return NT_E_UNSUPPORTED;
    if (unstable || force < -nt_jkr_shape_pull_off_force(contact))
        return NT_E_NO_SOLUTION;
    const double delta = force / (2.0 * contact->effective_modulus) / shape->radius;
    *indentation = fmax(delta, -punch_reach(contact)); /* at pull-off the two differ by a rounding */
    return NT_OK;
}

double nt_jkr_shape_pull_off_force(const nt_jkr_shape *contact)
{
    const nt_contact paraboloid = paraboloid_of(contact);
    switch (contact->shape.kind) {
    case NT_SHAPE_PARABOLOID:
        return nt_jkr_pull_off_force(&paraboloid);
    case NT_SHAPE_CONE:
        return contact->shape.sides == 0 ? 27.0 * units_of(contact).force : (double)NAN;
    case NT_SHAPE_PUNCH:
        return 2.0 * contact->effective_modulus * contact->shape.radius * punch_reach(contact);
    default:
        return NAN;
    }
}

double nt_jkr_shape_pull_off_indentation(const nt_jkr_shape *contact)
{
    const nt_contact paraboloid = paraboloid_of(contact);
    switch (contact->shape.kind) {
    case NT_SHAPE_PARABOLOID:
        return nt_jkr_pull_off_indentation(&paraboloid);
    case NT_SHAPE_CONE:
        return contact->shape.sides == 0 ? -units_of(contact).indentation : (double)NAN;
    case NT_SHAPE_PUNCH:
        return -punch_reach(contact);
    default:
        return NAN;
    }
}
