/* SPDX-License-Identifier: BSD-3-Clause
 * Hertz, DMT: s = delta. JKR: s = sqrt(a), P = s^6 - sqrt(6) s^3, d = s^4 - 4 s/sqrt(6) (contact/jkr.c), load fold at
 * s^3 = sqrt(6)/2. Maugis-Dugdale: s = y^2 (contact/maugis_branch.c), because load and indentation leave the end of the
 * branch, y = 0, quadratically. */
#include "fit/branch.h"

#include <math.h>

#include "contact/maugis_shape.h"
#include "nanotouch/material.h"

#define SQRT_6 2.44948974278317809820

static nt_fit_state paraboloid_at(const nt_fit_branch *branch, double s)
{
    const double root = sqrt(s);
    return (nt_fit_state){
        .F = branch->hertz * s * root - branch->pull_off,
        .indentation = s,
        .F1 = 1.5 * branch->hertz * root,
        .indentation1 = 1.0,
    };
}

static nt_fit_state jkr_at(const nt_fit_branch *branch, double s)
{
    const double s2 = s * s, s3 = s2 * s;
    return (nt_fit_state){
        .F = branch->load * (s3 * s3 - SQRT_6 * s3),
        .indentation = branch->indentation * (s * s3 - 4.0 / SQRT_6 * s),
        .F1 = branch->load * (6.0 * s3 * s2 - 3.0 * SQRT_6 * s2),
        .indentation1 = branch->indentation * (4.0 * s3 - 4.0 / SQRT_6),
    };
}

static nt_fit_state maugis_at(const nt_fit_branch *branch, double s)
{
    const double lambda = branch->lambda;
    const nt_maugis_shape shape = nt_maugis_shape_at(sqrt(s));
    const nt_maugis_equilibrium at = nt_maugis_equilibrium_of(lambda, shape);
    const double q = fmin(4.0 / 3.0 * lambda * lambda * shape.g2 * at.b, 1.0); /* rounding only */
    const double r = (1.0 + q) / (2.0 - q), a2 = at.a * at.a;
    const double load =
        at.P * (1.0 - 2.0 * r) - a2 * at.a * (1.0 + r); /* lambda dP/dlambda, dd/dlambda at constant y */
    const double depth = at.d * (1.0 - r) - a2 * (1.0 + r);
    return (nt_fit_state){
        .F = branch->load * at.P,
        .indentation = branch->indentation * at.d,
        .F1 = branch->load * 0.5 * at.P1,
        .indentation1 = branch->indentation * 0.5 * at.d1,
        .range = branch->load * (load - at.P1 / at.d1 * depth),
    };
}

nt_fit_branch nt_fit_branch_of(const nt_contact_law *law)
{
    const nt_maugis *maugis = &law->maugis;
    const nt_contact *contact = &maugis->contact;
    const double E = contact->effective_modulus, R = contact->radius;
    const double length = cbrt(0.75 * NT_PI * contact->work_of_adhesion / E); /* (pi w/K)^(1/3) [m^(1/3)] */
    nt_fit_branch branch = {.model = law->model, .unit = 1.0};
    switch (law->model) {
    case NT_HERTZ:
    case NT_DMT:
        branch.pull_off = nt_contact_law_pull_off_force(law);
        branch.hertz = 4.0 / 3.0 * E * sqrt(R);
        branch.unit = R;
        break;
    case NT_JKR:
        branch.load = NT_PI * contact->work_of_adhesion * R;
        branch.indentation = length * length * cbrt(R);
        branch.start = cbrt(0.5 * SQRT_6);
        break;
    case NT_MAUGIS:
        branch.lambda = maugis->lambda;
        branch.load = maugis->load_scale;
        branch.indentation = maugis->indentation_scale;
        branch.start = maugis->load_fold_y * maugis->load_fold_y;
        break;
    }
    return branch;
}

nt_fit_state nt_fit_branch_at(const nt_fit_branch *branch, double s)
{
    switch (branch->model) {
    case NT_MAUGIS:
        return maugis_at(branch, s);
    case NT_JKR:
        return jkr_at(branch, s);
    default:
        return paraboloid_at(branch, s);
    }
}
