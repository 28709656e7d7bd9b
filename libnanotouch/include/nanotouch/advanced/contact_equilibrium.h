/* SPDX-License-Identifier: BSD-3-Clause
 * Contact at a given load, radius or branch parameter instead of an indentation, and where it jumps under dead weight,
 * under a spring and between grips.
 *
 * A tip on a spring k_c whose base stands at the stage indentation D (what delta would be if the spring were not
 * deflected) is at rest where D = delta + F/k_c. The spring is 0 for a dead weight (load control) and infinite for
 * grips (displacement control). On approach an attractive law with a range jumps in where its range begins; on
 * retraction contact is lost at the fold of D, between the load fold and the displacement fold. All functions:
 * thread-safe, real-time safe, no state; results untouched on failure. */
#ifndef NANOTOUCH_CONTACT_EQUILIBRIUM_H
#define NANOTOUCH_CONTACT_EQUILIBRIUM_H

#include "nanotouch/contact.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One equilibrium. */
typedef struct nt_contact_state {
    double indentation; /* delta [m] */
    nt_law_value value;
} nt_contact_state;

/* At a force, of every law. DMT and Hertz have no unstable branch: NT_E_NO_SOLUTION. */
NT_API nt_status nt_contact_law_at_load(const nt_contact_law *law, double force, nt_branch branch,
                                        nt_contact_state *state);

/* Both jumps under a spring. Gaps are those of the stage, -D [m]: what is read off a force curve. */
typedef struct nt_jump {
    double jump_in_gap;      /* where approach jumps; the force is 0 until there [m] */
    nt_contact_state landed; /* just after it */
    double pull_off_gap;     /* where retraction loses the contact; NaN for a dead weight, which has no stage [m] */
    nt_contact_state last;   /* just before it; -last.value.F is the pull-off force */
} nt_jump;
/* Of every law. Hertz does not jump: everything is at its first touch. NT_E_RANGE for a spring < 0. */
NT_API nt_status nt_contact_law_jump(const nt_contact_law *law, double spring, nt_jump *jump);

#ifdef __cplusplus
}
#endif
#endif
