/* SPDX-License-Identifier: BSD-3-Clause
 * Hertz 1881: a paraboloid of radius R on an elastic half-space without adhesion (paper, Eq. 4-6). Valid for a << R. */
#include "contact/hertz.h"

#include <math.h>

#include "core/same_bits.h"
#include "internal/contact.h"

nt_law_value nt_hertz_eval(const nt_contact *contact, double indentation)
{
    return nt_hertz_law(contact->radius, contact->effective_modulus, indentation);
}

double nt_hertz_force(const nt_contact *contact, double indentation)
{
    return nt_hertz_eval(contact, indentation).F;
}

double nt_hertz_indentation(const nt_contact *contact, double force)
{
    if (force < 0.0)
        return NAN;
    /* a^3 = R F/K, delta = a^2/R; cube roots taken one by one, so that no product leaves the range of a double */
    const double scale = cube_root(force) / cube_root(4.0 / 3.0 * contact->effective_modulus);
    return scale * scale / cube_root(contact->radius);
}
