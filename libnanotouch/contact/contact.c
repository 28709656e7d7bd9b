/* SPDX-License-Identifier: BSD-3-Clause
 * What every contact law takes: its parameters, their defaults, one table of fields, the check. */
#include "nanotouch/contact.h"
#include "internal/field.h"

#include <stddef.h>

#include "nanotouch/advanced/field.h"
#include "nanotouch/material.h"

#define FIELD(path, ...) NT_FIELD(nt_contact, path, __VA_ARGS__)

static const nt_field contact_fields[] = {
    FIELD(radius, "m", 1e-10, 1.0, "radius R of the tip"),
    FIELD(effective_modulus, "Pa", 0.1, 1e15, "effective modulus E*"),
    FIELD(work_of_adhesion, "J/m^2", 0.0, 1e3, "work of adhesion w"),
    FIELD(cohesive_stress, "Pa", 0.0, 1e18, "cohesive stress sigma0 of the Dugdale zone"),
};

enum { CONTACT_FIELDS = (int)(sizeof contact_fields / sizeof contact_fields[0]) };

nt_contact nt_contact_defaults(void)
{
    const double work_of_adhesion = 0.144; /* 2 gamma_L of water */
    return (nt_contact){
        .radius = 20e-9,
        .effective_modulus = 76.9e9,
        .work_of_adhesion = work_of_adhesion,
        .cohesive_stress = nt_cohesive_stress_atomic(work_of_adhesion, 0.2e-9),
    };
}

static int is_within(const nt_field *field, double value)
{
    return value >= field->minimum && value <= field->maximum;
}

static int are_within(const nt_contact *contact)
{
    const nt_field *of = contact_fields; /* in their order */
    return is_within(&of[0], contact->radius) && is_within(&of[1], contact->effective_modulus) &&
           is_within(&of[2], contact->work_of_adhesion) && is_within(&of[3], contact->cohesive_stress);
}

nt_status nt_contact_check(const nt_contact *contact, nt_problem *problem)
{
    if (contact != NULL && are_within(contact)) /* the table is read where there is something to say */
        return NT_OK;
    return nt_field_check(contact_fields, CONTACT_FIELDS, contact, problem);
}
