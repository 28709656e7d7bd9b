/* SPDX-License-Identifier: BSD-3-Clause
 * Tables of fields, and many steps at once. */
#ifndef NANOTOUCH_INTERNAL_FRICTION_H
#define NANOTOUCH_INTERNAL_FRICTION_H

#include "nanotouch/friction.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Many steps: contacts[i] and ways[i][0..1] in; the state after each step to states[i]. Stops at the first step that
 * is refused; the states from there on are left alone. */
typedef struct nt_friction_path {
    const nt_friction_contact *contacts;
    const double (*ways)[2]; /* [m] */
    nt_friction_state *states;
    long count;
} nt_friction_path;

/* Silicon on silicon (G* = 15.2 GPa), rigid lever, tau0 = 100 MPa, alpha = 0.1. */
NT_API nt_friction nt_friction_defaults(void);
/* The table of its fields, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_friction_fields(int *count);
/* From *state, which is left where the last step ended. */
NT_API nt_status nt_friction_run_n(const nt_friction *friction, nt_friction_state *state, const nt_friction_path *path);

#ifdef __cplusplus
}
#endif
#endif
