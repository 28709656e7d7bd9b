/* SPDX-License-Identifier: BSD-3-Clause
 * Derivatives of the force by the parameters of a contact, in closed form.
 *
 * In Maugis' units F = pi w R P(d, lambda) with d = delta/(pi^2 w^2 R/K^2)^(1/3), lambda = 2 sigma0 (R/(pi w
 * K^2))^(1/3). So with k = dF/d(delta) and G = pi w R lambda dP/dlambda (at constant d) every logarithmic derivative is
 * known:
 *
 *     R F_R = F - k delta/3 + G/3                 E* F_E = 2/3 (k delta - G)
 *     w F_w = F - 2/3 k delta - G/3               sigma0 F_sigma = G                                        (scaling)
 *
 * On the contact branch (maugis/branch.c) dP/dlambda follows from (Griffith), whose derivative by b is D:
 *     b_lambda = -b (g1 b/2 + 8/3 lambda g2)/D          dP/dlambda = P_lambda - k d_lambda (reduced k)       (branch)
 */
#include "internal/contact.h"
#include "internal/contact_derivatives.h"

#include <math.h>
#include <stddef.h>

#include "contact/maugis/apart.h"
#include "contact/maugis/functions.h"
#include "contact/maugis/solve.h"

#define SQRT_6 2.44948974278317809820

/* What (scaling) needs beside force and stiffness, reduced. */
typedef struct {
    double by_lambda; /* lambda dP/dlambda at constant d */
    double pull;      /* P - 2/3 dP/dd d */
} parts;

/* On the contact branch. In P d1 - 2/3 P1 d and in P_lambda d1 - P1 d_lambda the terms of Hertz cancel, whatever their
 * size: they are written without. */
static parts contact_parts(double lambda, const nt_maugis_equilibrium *point)
{
    const nt_maugis_functions f = nt_maugis_functions_at(point->y);
    const double linear = 4.0 / 3.0 * lambda * lambda * f.g2, D = sqrt(linear * linear + 2.0 * lambda * f.g1);
    const double b = point->b, a = point->a, y = point->y, b1 = point->b1;
    const double b_l = -b * (0.5 * f.g1 * b + 8.0 / 3.0 * lambda * f.g2) / D;
    const double d_l = -4.0 / 3.0 * (b + lambda * b_l), P_l = -b * f.g3 * (b + 2.0 * lambda * b_l); /* of adhesion */
    const double d1 = -4.0 / 3.0 * lambda * b1, P1 = -lambda * b * (2.0 * b1 * f.g3 + b * f.h3);
    const double slope = a * (3.0 * a * y * b_l * d1 - 2.0 * y * b_l * P1 - 3.0 * b * point->a1 * d_l) +
                         2.0 * b * point->a1 * P_l + P_l * d1 - P1 * d_l;
    const double pull = 4.0 / 3.0 * a * (2.0 * b * b * point->a1 - a * a * b1) - b * b * f.g3 * point->d1 +
                        2.0 / 3.0 * b * (2.0 * b1 * f.g3 + b * f.h3) * point->d;
    return (parts){lambda * slope / point->d1, lambda * pull / point->d1};
}

/* On the non-contact branch, P = -pi/2 lambda c^2 (maugis.c), at a load. */
static parts apart_parts(const nt_maugis *maugis, double P, int stable)
{
    const double lambda = maugis->lambda, c = nt_maugis_apart_radius(maugis, P), fold = nt_maugis_apart_fold(lambda);
    const double size = fmax(fabs(c - fold), NT_FOLD_RESOLUTION * fold), beyond = stable ? size : -size;
    const double c_l = (fold / lambda * c - 2.0 / (NT_PI * lambda * lambda)) / beyond;
    const double k = -NT_PI * lambda * c / beyond, d = nt_maugis_apart_indentation(maugis, c);
    return (parts){-NT_PI * lambda * c * (0.5 * c + lambda * c_l), P - 2.0 / 3.0 * k * d};
}

static nt_status parts_find(const nt_maugis *maugis, double indentation, nt_branch branch, const nt_law_value *value,
                            parts *found)
{
    const int stable = branch != NT_BRANCH_UNSTABLE;
    const double d = indentation / maugis->indentation_scale;
    if (value->a == 0.0) {
        *found = apart_parts(maugis, value->F / maugis->load_scale, stable);
        return NT_OK;
    }
    nt_maugis_equilibrium point;
    const nt_status status =
        nt_maugis_contact_find(maugis, fmax(d, maugis->folds.grip_indentation), stable, &point, NULL);
    if (status == NT_OK)
        *found = contact_parts(maugis->lambda, &point);
    return status;
}

/* Force by the work of adhesion over -pi R of Hertz, DMT, and JKR at w = 0, which Maugis-Dugdale is there, too. */
static double pull_of(nt_model model, double indentation)
{
    if (model == NT_HERTZ || indentation < 0.0)
        return 0.0;
    if (model == NT_DMT)
        return 2.0;
    return indentation > 0.0 ? 1.0 : 4.0 / 3.0;
}

static nt_contact_derivatives closed_form(const nt_contact_law *law, double indentation)
{
    const nt_contact *contact = &law->maugis.contact;
    const nt_law_value hertz = nt_hertz_eval(contact, indentation);
    const double pull = NT_PI * pull_of(law->model, indentation);
    return (nt_contact_derivatives){
        .by_indentation = hertz.k,
        .by_radius = 0.5 * hertz.F / contact->radius - pull * contact->work_of_adhesion,
        .by_effective_modulus = hertz.F / contact->effective_modulus,
        .by_work_of_adhesion = -pull * contact->radius,
    };
}

/* (scaling), with G and F - 2/3 k delta. */
static nt_contact_derivatives scaled(const nt_contact *contact, double indentation, const nt_law_value *value, parts of)
{
    const double rise = value->k * indentation, G = of.by_lambda;
    return (nt_contact_derivatives){
        .by_indentation = value->k,
        .by_radius = (value->F + (G - rise) / 3.0) / contact->radius,
        .by_effective_modulus = 2.0 / 3.0 * (rise - G) / contact->effective_modulus,
        .by_work_of_adhesion = (of.pull - G / 3.0) / contact->work_of_adhesion,
        .by_cohesive_stress = G / contact->cohesive_stress,
    };
}

/* Of JKR, with s^2 = a reduced, F - 2/3 k delta is -4 pi w R s^3/(4 s^3 - 4/sqrt 6). */
static parts jkr_parts(const nt_contact *contact, const nt_law_value *value)
{
    const nt_reduced_units units = nt_reduced_units_of(contact);
    const double a = value->a / units.radius, s3 = a * sqrt(a);
    return (parts){0.0, -units.load * s3 / (s3 - 1.0 / SQRT_6)};
}

nt_status nt_contact_law_derivatives(const nt_contact_law *law, double indentation, nt_branch branch,
                                     nt_contact_derivatives *derivatives)
{
    const nt_contact *contact = &law->maugis.contact;
    nt_law_value value;
    const nt_status status = nt_contact_law_eval(law, indentation, branch, &value);
    if (status != NT_OK)
        return status;
    if (law->model == NT_HERTZ || law->model == NT_DMT || contact->work_of_adhesion == 0.0) {
        *derivatives = closed_form(law, indentation);
        return NT_OK;
    }
    if (value.F == 0.0 && value.a == 0.0) {
        *derivatives = (nt_contact_derivatives){0};
        return NT_OK;
    }
    if (law->model == NT_JKR) {
        *derivatives = scaled(contact, indentation, &value, jkr_parts(contact, &value));
        derivatives->by_cohesive_stress = 0.0;
        return NT_OK;
    }
    parts of = {0};
    const nt_status found = parts_find(&law->maugis, indentation, branch, &value, &of);
    const double load = law->maugis.load_scale;
    if (found == NT_OK)
        *derivatives = scaled(contact, indentation, &value, (parts){load * of.by_lambda, load * of.pull});
    return found;
}
