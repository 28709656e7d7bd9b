/* SPDX-License-Identifier: BSD-3-Clause
 * Private: names what is wrong with a value, and returns the status for it. */
#ifndef NANOTOUCH_CORE_PROBLEM_H
#define NANOTOUCH_CORE_PROBLEM_H

#include <math.h>
#include <stddef.h>

#include "nanotouch/status.h"

/* Of a value out of its range. */
static inline nt_problem nt_problem_of(const char *field, const char *unit, double value, double minimum,
                                       double maximum)
{
    const nt_problem problem = {
        field, unit, value, minimum, maximum, NT_PROBLEM_RANGE, NULL, {NULL, NULL, 0.0}}; /* as C++ reads it, too */
    return problem;
}

/* And of what a code says beside. */
static inline nt_problem nt_problem_coded(nt_problem_code code, nt_problem range)
{
    range.code = code;
    return range;
}

/* problem may be NULL. */
static inline nt_status nt_problem_refuse(nt_problem *problem, nt_problem reason)
{
    if (problem != NULL)
        *problem = reason;
    return NT_E_RANGE;
}

static inline nt_status nt_problem_set(nt_problem *problem, const char *field, const char *unit, double value,
                                       double minimum, double maximum)
{
    if (problem != NULL)
        *problem = nt_problem_of(field, unit, value, minimum, maximum);
    return isfinite(value) ? NT_E_RANGE : NT_E_NOT_FINITE;
}

#endif
