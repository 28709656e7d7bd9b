/* SPDX-License-Identifier: BSD-3-Clause
 * How accurate which quantity has to be: the description of a demand. */
#include "internal/field.h"
#include "scene/parts.h"

#define ROW(path, ...) NT_FIELD_NAMED("demand." #path, nt_demand, path, __VA_ARGS__)

static const nt_field demand_fields[] = {
    ROW(relative_accuracy, "", 0.0, 0.5, "largest error of the quantity over max(|it|, its scale)"),
    ROW(force_floor, "N", 0.0, 1.0, "forces below this cannot be felt"),
    ROW(quantity, "force|stiffness|radius|folds", 0.0, 3.0, "what has to be that accurate"),
    ROW(bound, "kept|exact|any", 0.0, 2.0,
        "kept: no more than that; exact: every law in full; any: the least there is, or none"),
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

enum { ACCURACY, FLOOR, QUANTITY, BOUND, BUDGET };

nt_problem nt_demand_accuracy(double demanded, double least)
{
    const nt_field *field = &demand_fields[ACCURACY];
    return nt_problem_coded(NT_PROBLEM_ACCURACY,
                            nt_problem_of(field->name, field->unit, demanded, least, field->maximum));
}

nt_problem nt_demand_budget(double budget, double cost)
{
    const nt_field *field = &demand_fields[BUDGET];
    return nt_problem_coded(NT_PROBLEM_BUDGET, nt_problem_of(field->name, field->unit, budget, cost, field->maximum));
}

nt_status nt_demand_check(const nt_demand *demand, nt_problem *problem)
{
    return nt_field_check(demand_fields, (int)(sizeof demand_fields / sizeof demand_fields[0]), demand, problem);
}
