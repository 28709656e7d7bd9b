/* SPDX-License-Identifier: BSD-3-Clause
 * Tables of fields: see field.h. */
#include "internal/field.h"
#include "nanotouch/advanced/field.h"

#include <math.h>
#include <string.h>

#include "core/problem.h"

#define NO_CHOICE 127 /* fits every enum, and no list of words is as long */

/* An enum has the size of an int, but for compilers that take the least that holds its values. */
typedef union number {
    double real;
    int choice;
    short small;
    signed char least;
} number;

double nt_field_get(const nt_field *field, const void *object)
{
    number n;
    memcpy(&n, (const char *)object + field->offset, field->size);
    switch (field->size) {
    case sizeof n.real:
        return n.real;
    case sizeof n.choice:
        return n.choice;
    case sizeof n.small:
        return n.small;
    default:
        return n.least;
    }
}

void nt_field_set(const nt_field *field, void *object, double value)
{
    number n;
    const int choice = value >= 0.0 && value < NO_CHOICE && value == floor(value) ? (int)value : NO_CHOICE;
    switch (field->size) {
    case sizeof n.real:
        n.real = value;
        break;
    case sizeof n.choice:
        n.choice = choice;
        break;
    case sizeof n.small:
        n.small = (short)choice;
        break;
    default:
        n.least = (signed char)choice;
    }
    memcpy((char *)object + field->offset, &n, field->size);
}

nt_status nt_field_check(const nt_field *fields, int count, const void *object, nt_problem *problem)
{
    if (fields == NULL || object == NULL)
        return NT_E_ARGUMENT;
    for (int i = 0; i < count; i++) {
        const nt_field *field = &fields[i];
        const double value = nt_field_get(field, object);
        const int is_choice = strchr(field->unit, '|') != NULL;
        if (value >= field->minimum && value <= field->maximum && !(is_choice && value != floor(value)))
            continue;
        if (problem != NULL)
            *problem = nt_problem_of(field->name, field->unit, value, field->minimum, field->maximum);
        return isfinite(value) ? NT_E_RANGE : NT_E_NOT_FINITE;
    }
    return NT_OK;
}
