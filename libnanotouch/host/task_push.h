/* SPDX-License-Identifier: BSD-3-Clause
 * Private to host/: what pushing a particle and pushing a rod have in common. */
#ifndef NANOTOUCH_HOST_TASK_PUSH_H
#define NANOTOUCH_HOST_TASK_PUSH_H

#include "host/state.h"

/* Final error of each [m]. */
#define NT_PUSH_ALLOWED 100e-9

/* task_push_solve.c: operators. */
void nt_push_solve(nt_operator *op);
void nt_wire_solve(nt_operator *op);

#endif
