/* SPDX-License-Identifier: BSD-3-Clause
 * Messages of the statuses, and problems in words: see status.h. */
#include "nanotouch/status.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *nt_status_message(nt_status status)
{
    switch (status) {
#define NT_STATUS_CASE(code, message)                                                                                  \
    case code:                                                                                                         \
        return message;
        NT_STATUS_LIST(NT_STATUS_CASE)
#undef NT_STATUS_CASE
    }
    return "unknown status";
}

/* A limit that is still valid once %g has rounded it to six digits; `up` is 1 for a minimum, -1 for a maximum. */
static double inside(double limit, double up)
{
    const double digits = limit / pow(10.0, floor(log10(fabs(limit))) - 5.0); /* the sixth is that of the units */
    const double lost = up * (digits - rint(digits));                         /* NaN for 0 and infinity */
    return lost > 1e-9 ? limit + up * 5.1e-6 * fabs(limit) : limit; /* less is the rounding of this division */
}

const char *nt_problem_print(const nt_problem *problem, char *text, unsigned size)
{
    if (problem == NULL || text == NULL || size == 0)
        return text;
    const char *field = problem->field == NULL ? "?" : problem->field;
    const char *unit = problem->unit == NULL ? "" : problem->unit;
    if (strcmp(unit, NT_UNIT_REASON) == 0) {
        (void)snprintf(text, size, "%s", field);
        return text;
    }
    if (strcmp(unit, NT_UNIT_ERROR) == 0) { /* no field, but a reason */
        if (isfinite(problem->value))
            (void)snprintf(text, size, "%s: error %.2g where %.2g is demanded", field, problem->value,
                           problem->maximum);
        else
            (void)snprintf(text, size, "%s: no bound of the error is known", field);
        return text;
    }
    if (strchr(unit, '|') != NULL) { /* a choice: its unit are the names */
        (void)snprintf(text, size, "%s = %g: valid is %g .. %g (%s)", field, problem->value, problem->minimum,
                       problem->maximum, unit);
        return text;
    }
    const char *space = unit[0] == '\0' ? "" : " ";
    (void)snprintf(text, size, "%s = %g%s%s: valid is %g .. %g%s%s", field, problem->value, space, unit,
                   inside(problem->minimum, 1.0), inside(problem->maximum, -1.0), space, unit);
    return text;
}
