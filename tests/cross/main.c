/* SPDX-License-Identifier: BSD-3-Clause
 * Ends with 0 if the core computes here what it must: the forces of Hertz and DMT differ by 2 pi R w. */
#include "internal/contact.h"
#include "nanotouch/contact.h"
#include "nanotouch/material.h"

int main(void)
{
    const nt_contact contact = nt_contact_defaults();
    const double indentation = 1e-9;
    const double adhesion = nt_hertz_force(&contact, indentation) - nt_dmt_force(&contact, indentation);
    const double expected = 2.0 * NT_PI * contact.radius * contact.work_of_adhesion;
    const double error = adhesion / expected - 1.0;
    return error < 1e-14 && error > -1e-14 ? 0 : 1; /* a few roundings of 2^-53 */
}
