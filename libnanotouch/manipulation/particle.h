/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_MANIPULATION_PARTICLE_PRIVATE_H
#define NANOTOUCH_MANIPULATION_PARTICLE_PRIVATE_H

#include "nanotouch/advanced/manipulation.h"

/* Along a path of `count` points; the state after each to states[i]. Stops at the first that is refused. */
nt_status nt_particle_run_n(const nt_pushing *pushing, nt_particle_state *state, const double (*tips)[3],
                            nt_particle_state *states, long count);
/* NT_OK, or NT_E_NOT_FINITE / NT_E_RANGE with the first offending field in *problem (NULL allowed). */
nt_status nt_particle_check(const nt_particle *particle, nt_problem *problem);

#endif
