/* SPDX-License-Identifier: BSD-3-Clause
 * The lever's rest under a force. */
#ifndef NANOTOUCH_INTERNAL_DYNAMICS_H
#define NANOTOUCH_INTERNAL_DYNAMICS_H

#include "nanotouch/dynamics.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Moves the base to base_height [m] and lets the tip settle: downhill from where it is to the next stable equilibrium,
 * through jump-in and snap-off. At most about 400 evaluations, usually 2 to 4. NT_OK; NT_E_ARGUMENT (spring constant or
 * field length not positive, state untouched); NT_E_NO_CONVERGENCE, or NT_E_NOT_FINITE where the field is, with the
 * state left at the last place the tip passed. Residual in info: the force out of balance, over K length. */
NT_API NT_REALTIME nt_status nt_cantilever_settle(nt_cantilever_state *state, const nt_probe *probe,
                                                  const nt_force_field *field, double base_height, nt_solve_info *info);

#ifdef __cplusplus
}
#endif
#endif
