/* SPDX-License-Identifier: BSD-3-Clause
 * Can what a half says of itself be? Each rule is one line here and one in docs/hal.md. */
#include "hal/capabilities.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/problem.h"

#define LONGEST_PERIOD 1.0 /* between the measurements of a half [s] */
#define ALL_BITS (2u * NT_CAN_TAP - 1u)

static nt_status broken(nt_problem *problem, const char *rule, double value, double minimum, double maximum)
{
    (void)nt_problem_set(problem, rule, "", value, minimum, maximum);
    return NT_E_RANGE;
}

/* Above 0, or 0 where nothing is known of it. */
static int is_amount(double value)
{
    return value >= 0.0 && isfinite(value);
}

static nt_status check_numbers(const nt_channel_row *row, nt_problem *problem)
{
    if (row->axis < NT_X || row->axis > NT_AXES)
        return broken(problem, "axis of a channel", row->axis, NT_X, NT_AXES);
    if (!(row->minimum < row->maximum))
        return broken(problem, "minimum of a channel", row->minimum, -HUGE_VAL, row->maximum);
    const struct {
        const char *rule;
        double value;
    } amounts[] = {{"step of a channel", row->step},
                   {"noise of a channel", row->noise},
                   {"latency of a channel [s]", row->latency}};
    for (size_t i = 0; i < sizeof amounts / sizeof *amounts; ++i)
        if (!is_amount(amounts[i].value))
            return broken(problem, amounts[i].rule, amounts[i].value, 0.0, 1.7e308);
    return NT_OK;
}

static int is_one_of(const char *unit, const char *a, const char *b)
{
    return strcmp(unit, a) == 0 || strcmp(unit, b) == 0;
}

static nt_status check_row(const nt_channel_row *row, nt_problem *problem)
{
    if (!row->name || !row->name[0])
        return broken(problem, "channels without a name", 1.0, 0.0, 0.0);
    if (!row->unit || !(is_one_of(row->unit, "m", "N") || is_one_of(row->unit, "rad", "Hz")))
        return broken(problem, "channels with a unit other than m, N, rad and Hz", 1.0, 0.0, 0.0);
    const nt_status status = check_numbers(row, problem);
    if (status != NT_OK)
        return status;
    const int may_stay = isnan(row->safe) && is_one_of(row->unit, "m", "Hz");
    if (row->driven && !may_stay && !(row->safe >= row->minimum && row->safe <= row->maximum))
        return broken(problem, "safe value of a driven channel", row->safe, row->minimum, row->maximum);
    if (!row->driven && !isnan(row->safe))
        return broken(problem, "safe values of channels that are read", 1.0, 0.0, 0.0);
    return NT_OK;
}

nt_status nt_capabilities_check(const nt_capabilities *found, nt_problem *problem)
{
    if (found->size != sizeof *found)
        return broken(problem, "capabilities.size", found->size, sizeof *found, sizeof *found);
    if (found->can & ~ALL_BITS)
        return broken(problem, "unknown bits of capabilities.can", found->can & ~ALL_BITS, 0.0, 0.0);
    if (found->axes < 1 || found->axes > NT_AXES)
        return nt_problem_set(problem, "capabilities.axes", "", found->axes, 1.0, NT_AXES);
    if (!(found->period >= 0.0 && found->period <= LONGEST_PERIOD))
        return nt_problem_set(problem, "capabilities.period", "s", found->period, 0.0, LONGEST_PERIOD);
    if (found->rows < 0 || (found->rows > 0 && !found->channels))
        return nt_problem_set(problem, "capabilities.rows", "", found->rows, 0.0, found->channels ? HUGE_VAL : 0.0);
    nt_status status = NT_OK;
    for (int i = 0; i < found->rows && status == NT_OK; ++i)
        status = check_row(&found->channels[i], problem);
    return status;
}
