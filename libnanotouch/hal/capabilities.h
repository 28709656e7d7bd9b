/* SPDX-License-Identifier: BSD-3-Clause
 * Private: what a half says of itself, checked once for sessions and rehearsals. */
#ifndef NANOTOUCH_HAL_CAPABILITIES_H
#define NANOTOUCH_HAL_CAPABILITIES_H

#include "nanotouch/hal_backend.h"

/* NT_E_RANGE with the rule of docs/hal.md that it breaks. */
nt_status nt_capabilities_check(const nt_capabilities *found, nt_problem *problem);

#endif
