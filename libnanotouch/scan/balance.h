/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_SCAN_BALANCE_PRIVATE_H
#define NANOTOUCH_SCAN_BALANCE_PRIVATE_H

#include "internal/balance.h"

/* The motion of the target nearest to *state. NT_E_ARGUMENT; NT_E_NO_CONVERGENCE: there is none near, the contact never
 * lets go, or the harmonics do not converge. *state and *value only on NT_OK. */
nt_status nt_balance_solve(const nt_balance *balance, const nt_balance_target *target, nt_balance_state *state,
                           nt_balance_value *value);
/* Where the lever of a motion is at w t = 0, to go on from in the time domain. */
nt_tapping_state nt_balance_moment(const nt_balance *balance, const nt_balance_state *state,
                                   const nt_balance_value *value);
/* The motion that a lever comes to which is lowered from far, or lifted from the surface, until it meets the target. At
 * folds of the curve it goes over to the other branch. value->harmonics are fewer than asked for where more do not
 * converge. NT_E_NO_CONVERGENCE: no such motion repeats. */
nt_status nt_balance_find(const nt_balance *balance, const nt_balance_curve *curve, const nt_balance_target *target,
                          nt_balance_state *state, nt_balance_value *value);

#endif
