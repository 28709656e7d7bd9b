/* SPDX-License-Identifier: BSD-3-Clause
 * Equilibria of Maugis-Dugdale by itself, and slow ramps of the base. */
#ifndef NANOTOUCH_INTERNAL_CONTACT_EQUILIBRIUM_H
#define NANOTOUCH_INTERNAL_CONTACT_EQUILIBRIUM_H

#include "nanotouch/advanced/contact_equilibrium.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One slow movement of the base, and the force at each of its places. */
typedef struct nt_ramp {
    double spring;       /* k_c [N/m], > 0 */
    nt_branch branch;    /* APPROACH: free until the jump-in; STABLE: a retraction, in contact until the pull-off */
    const double *stage; /* stage indentations D [m], in any order; monotonic ones are found soonest */
    double *force;       /* out [N]; 0 where the tip is free */
    long count;
} nt_ramp;

/* {U, F, k, a} and the indentation at a force [N], as nt_maugis_indentation: STABLE is the branch above the load fold,
 * UNSTABLE the one below it, which grips can still hold in part. */
NT_API nt_status nt_maugis_at_load(const nt_maugis *maugis, double force, nt_branch branch, nt_contact_state *state);
/* At a contact radius >= 0 [m]: every radius occurs once on the contact branch. */
NT_API nt_status nt_maugis_at_radius(const nt_maugis *maugis, double radius, nt_contact_state *state);
/* The stable equilibrium under the spring at each D: a quasi-static force curve. Within 1e-9 of the largest force of
 * the branch of D = delta + F(delta)/k_c, except where the tip is about to be pulled off, where F is a square root of
 * the distance and a rounding of D counts as its square root. NT_E_NOT_FINITE for a place that is not finite,
 * NT_E_RANGE for a spring, NT_E_ARGUMENT for another branch; `force` is then undefined. */
NT_API nt_status nt_contact_law_ramp(const nt_contact_law *law, const nt_ramp *ramp);

#ifdef __cplusplus
}
#endif
#endif
