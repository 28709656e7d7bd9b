/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis' units of adhesive contact, private to contact/: with K = 4/3 E*, load is counted in pi w R, radius in
 * (pi w R^2/K)^(1/3), indentation in (pi^2 w^2 R/K^2)^(1/3). */
#ifndef NANOTOUCH_CONTACT_REDUCED_H
#define NANOTOUCH_CONTACT_REDUCED_H

#include "nanotouch/contact.h"

/* Beyond this reduced indentation the adhesive correction to Hertz is below the last bit for every lambda, at most of
 * the order d^(-3/4), JKR's. Hardly reached with w > 0; it is what makes w -> 0 Hertz exactly. */
#define NT_REDUCED_HERTZ 1e26

/* At a displacement fold the stiffness is infinite. It is reported at the distance from it that a double can still
 * tell, sqrt(2^-52) relative in the branch parameter, and so is finite and of the right sign. */
#define NT_FOLD_RESOLUTION 1.5e-8

/* 0 for what is no nt_branch. */
static inline int nt_branch_is_known(nt_branch branch)
{
    return branch == NT_BRANCH_STABLE || branch == NT_BRANCH_APPROACH || branch == NT_BRANCH_UNSTABLE;
}

typedef struct nt_reduced_units {
    double load, radius, indentation; /* [N], [m], [m] */
} nt_reduced_units;

/* By one cube root, (pi w/(K R))^(1/3), so that no intermediate leaves the range of a double. */
nt_reduced_units nt_reduced_units_of(const nt_contact *contact);

/* Maugis' lambda, by the same root: 2 sigma0 R/(K a_s), a_s the unit of radius. */
static inline double nt_reduced_lambda(const nt_contact *contact, const nt_reduced_units *units)
{
    return 2.0 * contact->cohesive_stress / (4.0 / 3.0 * contact->effective_modulus) *
           (contact->radius / units->radius);
}

/* Reduced {U, F, k, a} in SI. */
static inline nt_law_value nt_reduced_to_si(const nt_law_value *reduced, const nt_reduced_units *units)
{
    return (nt_law_value){
        .U = reduced->U * units->load * units->indentation,
        .F = reduced->F * units->load,
        .k = reduced->k * (units->load / units->indentation),
        .a = reduced->a * units->radius,
    };
}

#endif
