/* SPDX-License-Identifier: BSD-3-Clause
 * Derjaguin, Muller, Toporov 1975: Hertz' profile under a constant attraction 2 pi R w from outside the contact (paper,
 * Eq. 9). The limit lambda -> 0 of Maugis-Dugdale: of a(F) to first order in lambda, but of F(delta) only as
 * sqrt(lambda), because the range of the attraction shifts the indentation. */
#include "internal/contact.h"
#include "nanotouch/contact.h"
#include "nanotouch/material.h"

#include <math.h>

nt_law_value nt_dmt_eval(const nt_contact *contact, double indentation)
{
    if (indentation < 0.0)
        return (nt_law_value){0};
    nt_law_value value = nt_hertz_eval(contact, indentation);
    const double adhesion = nt_dmt_pull_off_force(contact);
    value.U -= adhesion * indentation;
    value.F -= adhesion;
    return value;
}

double nt_dmt_force(const nt_contact *contact, double indentation)
{
    return nt_dmt_eval(contact, indentation).F;
}

double nt_dmt_indentation(const nt_contact *contact, double force)
{
    return nt_hertz_indentation(contact, force + nt_dmt_pull_off_force(contact));
}

double nt_dmt_pull_off_force(const nt_contact *contact)
{
    return 2.0 * NT_PI * contact->radius * contact->work_of_adhesion;
}
