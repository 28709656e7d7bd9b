/* SPDX-License-Identifier: BSD-3-Clause
 * Johnson, Kendall and Roberts, Proc. R. Soc. Lond. A 324 (1971) 301: s = sqrt(a), P = s^6 - sqrt(6) s^3,
 * d = s^4 - 4 s/sqrt(6) (contact/jkr.c), load fold at s^3 = sqrt(6)/2, displacement fold at s^3 = 1/sqrt(6). */
#include "fit/models/paraboloid.h"
#include "internal/contact.h"
#include "nanotouch/material.h"

#define SQRT_6 2.44948974278317809820

static nt_status prepare(const nt_fit_options *options, const double *value, nt_fit_branch *branch)
{
    const nt_contact contact = {options->radius, value[NT_FIT_EFFECTIVE_MODULUS], value[NT_FIT_WORK_OF_ADHESION], 0.0};
    const nt_status status = nt_fit_paraboloid(NT_JKR, &contact, branch);
    const double R = contact.radius, w = contact.work_of_adhesion;
    const double length = cbrt(0.75 * NT_PI * w / contact.effective_modulus); /* (pi w/K)^(1/3) [m^(1/3)] */
    branch->load = NT_PI * w * R;
    branch->indentation = length * length * cbrt(R);
    branch->load_fold = cbrt(0.5 * SQRT_6);
    branch->grip_fold = cbrt(1.0 / SQRT_6);
    return status;
}

static nt_fit_state at(const nt_fit_branch *branch, double s)
{
    const double s2 = s * s, s3 = s2 * s;
    return (nt_fit_state){
        .F = branch->load * (s3 * s3 - SQRT_6 * s3),
        .indentation = branch->indentation * (s * s3 - 4.0 / SQRT_6 * s),
        .F1 = branch->load * (6.0 * s3 * s2 - 3.0 * SQRT_6 * s2),
        .indentation1 = branch->indentation * (4.0 * s3 - 4.0 / SQRT_6),
    };
}

NT_VARIANTS static void many(const nt_fit_branch *branch, nt_fit_block *at)
{
    const double load = branch->load, unit = branch->indentation;
    const int count = at->count;
    for (int i = 0; i < count; i++) {
        const double s = at->s[i], s2 = s * s, s3 = s2 * s;
        at->F[i] = load * (s3 * s3 - SQRT_6 * s3);
        at->indentation[i] = unit * (s * s3 - 4.0 / SQRT_6 * s);
        at->F1[i] = load * (6.0 * s3 * s2 - 3.0 * SQRT_6 * s2);
        at->indentation1[i] = unit * (4.0 * s3 - 4.0 / SQRT_6);
    }
}

static nt_status indentation_at(const nt_fit_branch *branch, double force, double *indentation)
{
    return nt_jkr_indentation(&branch->law.maugis.contact, force, NT_BRANCH_STABLE, indentation);
}

static const nt_fit_quantity parameters[NT_FIT_OWN] = {NT_FIT_MODULUS, NT_FIT_ADHESION};
NT_FIT_ROW(jkr, .words.name = "jkr", .words.title = "JKR",
           .words.law = "K a^3/R - sqrt(6 pi w K a^3), delta = a^2/R - 2/3 sqrt(6 pi w a/K), K = 4/3 E*",
           .words.valid = "paraboloid, soft with a short range of adhesion (lambda above 5), " NT_FIT_SMALL,
           .words.scaling = "E* goes as 1/sqrt(R), w as 1/R", .words.tip = "paraboloid", .words.sides = -1,
           .words.exponent = 1.5, .words.pull_off = 1.5, .words.lambda = 20.0, .parameter = parameters, .held = 0U,
           .prepare = prepare, .at = at, .many = many, .derive = nt_fit_derive_adhesive, .indentation = indentation_at,
           .contact = nt_fit_paraboloid_contact, .shape = NULL, .doubts = nt_fit_paraboloid_doubts);
