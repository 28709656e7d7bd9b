/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis' units of adhesive contact: see reduced.h. */
#include "contact/reduced.h"

#include <math.h>

#include "core/same_bits.h"
#include "nanotouch/material.h"

nt_reduced_units nt_reduced_units_of(const nt_contact *contact)
{
    const double energy = NT_PI * contact->work_of_adhesion;
    const double R = contact->radius, ratio = cube_root(energy / (4.0 / 3.0 * contact->effective_modulus) / R);
    return (nt_reduced_units){.load = energy * R, .radius = ratio * R, .indentation = ratio * ratio * R};
}
