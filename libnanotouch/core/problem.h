/* SPDX-License-Identifier: BSD-3-Clause
 * Private: names what is wrong with a value, and returns the status for it. */
#ifndef NANOTOUCH_CORE_PROBLEM_H
#define NANOTOUCH_CORE_PROBLEM_H

#include <math.h>
#include <stddef.h>

#include "nanotouch/status.h"

/* problem may be NULL. */
static inline nt_status nt_problem_set(nt_problem *problem, const char *field, const char *unit, double value,
                                       double minimum, double maximum)
{
    if (problem != NULL)
        *problem = (nt_problem){field, unit, value, minimum, maximum};
    return isfinite(value) ? NT_E_RANGE : NT_E_NOT_FINITE;
}

#endif
