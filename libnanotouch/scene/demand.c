/* SPDX-License-Identifier: BSD-3-Clause
 * How accurate which quantity has to be: the description of a demand. */
#include "nanotouch/plan.h"

#define ROW(path, ...) NT_FIELD_NAMED("demand." #path, nt_demand, path, __VA_ARGS__)

static const nt_field demand_fields[] = {
    ROW(relative_accuracy, "", 0.0, 0.5, "largest error of the quantity over max(|it|, its scale); 0: exact"),
    ROW(force_floor, "N", 0.0, 1.0, "forces below this cannot be felt"),
    ROW(quantity, "force|stiffness|radius|folds", 0.0, 3.0, "what has to be that accurate"),
    ROW(budget, "", 0.0, 1e9, "what one evaluation may cost, in Hertz evaluations; 0: anything"),
};

nt_demand nt_demand_defaults(void)
{
    nt_demand demand = {.relative_accuracy = 0.01};
    return demand;
}

const nt_field *nt_demand_fields(int *count)
{
    if (count != NULL)
        *count = (int)(sizeof demand_fields / sizeof demand_fields[0]);
    return demand_fields;
}

nt_status nt_demand_check(const nt_demand *demand, nt_problem *problem)
{
    return nt_field_check(demand_fields, (int)(sizeof demand_fields / sizeof demand_fields[0]), demand, problem);
}
