/* SPDX-License-Identifier: BSD-3-Clause
 * Roots of a scalar function in a bracket; private to the library. */
#ifndef NANOTOUCH_CORE_ROOTS_H
#define NANOTOUCH_CORE_ROOTS_H

#include "nanotouch/types.h"

typedef double nt_scalar_function(double x, const void *context);

/* The root of f in a bracket where f changes sign, to the last bits of x (Chandrupatla 1997: inverse quadratic steps
 * where they are safe, bisection where not). NT_E_NOT_FINITE if f is not finite there, NT_E_RANGE if the signs agree,
 * NT_E_NO_CONVERGENCE after 200 evaluations. info may be NULL. Real-time safe. */
nt_status nt_root_find(nt_scalar_function *f, const void *context, const double bracket[2], double *root,
                       nt_solve_info *info);

#endif
