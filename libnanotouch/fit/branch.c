/* SPDX-License-Identifier: BSD-3-Clause
 * Hertz, DMT, cone: s = delta. JKR: s = sqrt(a), P = s^6 - sqrt(6) s^3, d = s^4 - 4 s/sqrt(6) (contact/jkr.c), load
 * fold at s^3 = sqrt(6)/2, displacement fold at s^3 = 1/sqrt(6). Maugis-Dugdale: s = y^2 (contact/maugis/branch.c),
 * because load and indentation leave the end of the contact branch, y = 0, quadratically; below it, where the surfaces
 * are apart but a disc r < c still attracts, s = c/c0 - 1 with c0 the c of y = 0 and
 *
 *     P = -(pi/2) lambda c^2       d = c^2/2 - 8 lambda c/(3 pi) - 2/(pi lambda)                        (apart)
 *
 * whose displacement fold is at c = 8 lambda/(3 pi). */
#include "fit/branch.h"

#include <math.h>

#include "contact/maugis/functions.h"
#include "nanotouch/material.h"

#define SQRT_6 2.44948974278317809820

static nt_fit_state power_at(const nt_fit_branch *branch, double s)
{
    const double slope = branch->prefactor * (branch->exponent == 1.5 ? sqrt(s) : s); /* F/delta */
    return (nt_fit_state){
        .F = slope * s - branch->pull_off,
        .indentation = s,
        .F1 = branch->exponent * slope,
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
    const nt_maugis_functions f = nt_maugis_functions_at(sqrt(s));
    const nt_maugis_equilibrium at = nt_maugis_equilibrium_of(lambda, f);
    const double q = fmin(4.0 / 3.0 * lambda * lambda * f.g2 * at.b, 1.0); /* rounding only */
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

static nt_fit_state maugis_apart_at(const nt_fit_branch *branch, double s)
{
    const double lambda = branch->lambda, c = branch->touch_c * (1.0 + s);
    const double linear = 8.0 * lambda / (3.0 * NT_PI), constant = 2.0 / (NT_PI * lambda);
    const double P = -0.5 * NT_PI * lambda * c * c, dP_dc = -NT_PI * lambda * c, dd_dc = c - linear;
    return (nt_fit_state){
        .F = branch->load * P,
        .indentation = branch->indentation * (0.5 * c * c - linear * c - constant),
        .F1 = branch->load * dP_dc * branch->touch_c,
        .indentation1 = branch->indentation * dd_dc * branch->touch_c,
        .range = branch->load * (P - dP_dc / dd_dc * (constant - linear * c)),
    };
}

static void prepare_maugis(const nt_maugis *maugis, nt_fit_branch *branch)
{
    branch->lambda = maugis->lambda;
    branch->load = maugis->load_scale;
    branch->indentation = maugis->indentation_scale;
    branch->load_fold = maugis->load_fold_y * maugis->load_fold_y;
    const nt_maugis_equilibrium touch = nt_maugis_equilibrium_of(maugis->lambda, nt_maugis_functions_at(0.0));
    branch->touch_c = touch.b;
    branch->grip_fold = maugis->folds.grip_in_contact ? maugis->fold_y * maugis->fold_y
                                                      : 8.0 * maugis->lambda / (3.0 * NT_PI * touch.b) - 1.0;
}

nt_fit_branch nt_fit_branch_of(const nt_contact_law *law)
{
    const nt_contact *contact = &law->maugis.contact;
    const double E = contact->effective_modulus, R = contact->radius;
    const double length = cbrt(0.75 * NT_PI * contact->work_of_adhesion / E); /* (pi w/K)^(1/3) [m^(1/3)] */
    nt_fit_branch branch = {
        .model = (nt_fit_model)law->model,
        .pull_off = nt_contact_law_pull_off_force(law),
        .exponent = 1.5,
        .unit = 1.0,
    };
    switch (law->model) {
    case NT_HERTZ:
    case NT_DMT:
        branch.prefactor = 4.0 / 3.0 * E * sqrt(R);
        branch.unit = R;
        break;
    case NT_JKR:
        branch.load = NT_PI * contact->work_of_adhesion * R;
        branch.indentation = length * length * cbrt(R);
        branch.load_fold = cbrt(0.5 * SQRT_6);
        branch.grip_fold = cbrt(1.0 / SQRT_6);
        break;
    case NT_MAUGIS:
        prepare_maugis(&law->maugis, &branch);
        break;
    }
    return branch;
}

nt_fit_branch nt_fit_branch_of_cone(nt_fit_model model, double effective_modulus, double half_angle)
{
    return (nt_fit_branch){
        .model = model,
        .prefactor = 2.0 / NT_PI * effective_modulus * tan(half_angle),
        .exponent = 2.0,
        .unit = 1e-8, /* of s: where the search begins */
    };
}

nt_fit_state nt_fit_branch_at(const nt_fit_branch *branch, double s)
{
    switch (branch->model) {
    case NT_FIT_MAUGIS:
        return s < 0.0 ? maugis_apart_at(branch, s) : maugis_at(branch, s);
    case NT_FIT_JKR:
        return jkr_at(branch, s);
    default:
        return power_at(branch, s);
    }
}
