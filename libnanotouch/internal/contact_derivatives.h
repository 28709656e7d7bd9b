/* SPDX-License-Identifier: BSD-3-Clause
 * How the force of a contact changes with each of its parameters: for fits, uncertainty and inference. */
#ifndef NANOTOUCH_INTERNAL_CONTACT_DERIVATIVES_H
#define NANOTOUCH_INTERNAL_CONTACT_DERIVATIVES_H

#include "nanotouch/contact.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The force at constant indentation by each parameter, and by the indentation. 0 for what a law does not read. */
typedef struct nt_contact_derivatives {
    double by_indentation;       /* the stiffness k [N/m] */
    double by_radius;            /* [N/m] */
    double by_effective_modulus; /* [N/Pa] */
    double by_work_of_adhesion;  /* [N m^2/J] */
    double by_cohesive_stress;   /* [N/Pa] */
} nt_contact_derivatives;

/* At an indentation [m] on a branch; fails as nt_contact_law_eval. Away from the folds, where they are infinite, each
 * times its parameter is right to 1e-13 of the larger of force and pull-off force. Thread-safe, real-time safe, no
 * state; *derivatives is untouched on failure. */
NT_API nt_status nt_contact_law_derivatives(const nt_contact_law *law, double indentation, nt_branch branch,
                                            nt_contact_derivatives *derivatives);

#ifdef __cplusplus
}
#endif
#endif
