/* SPDX-License-Identifier: BSD-3-Clause
 * Tables of fields: see field.h. */
#include "nanotouch/field.h"

#include <math.h>
#include <string.h>

double nt_field_get(const nt_field *field, const void *object)
{
    double value;
    memcpy(&value, (const char *)object + field->offset, sizeof value);
    return value;
}

void nt_field_set(const nt_field *field, void *object, double value)
{
    memcpy((char *)object + field->offset, &value, sizeof value);
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
            *problem = (nt_problem){field->name, field->unit, value, field->minimum, field->maximum};
        return isfinite(value) ? NT_E_RANGE : NT_E_NOT_FINITE;
    }
    return NT_OK;
}
