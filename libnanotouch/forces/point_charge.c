/* SPDX-License-Identifier: BSD-3-Clause
 * A point charge under a grounded conducting sphere: Thomson's image charge, exact (Jackson, Classical Electrodynamics,
 * Sec. 2.2). With the charge at the distance d = R + h from the centre, d^2 - R^2 = h (h + 2R):
 *     U = -q^2 R/(8 pi eps0 (d^2 - R^2)),     F = -dU/dh = -q^2 R d/(4 pi eps0 (d^2 - R^2)^2). */
#include <math.h>
#include <stddef.h>

#include "forces/law.h"
#include "internal/field.h"
#include "internal/forces.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

#define FIELD(member, ...) NT_FIELD(nt_point_charge, member, __VA_ARGS__)

static const nt_field fields[] = {
    FIELD(radius, "m", 1e-10, 1.0, "radius R of the tip"),
    FIELD(charge, "C", -1e-6, 1e-6, "charge q on the surface under the tip"),
    FIELD(minimum_gap, "m", 1e-12, 1e-6, "closest approach of tip and charge"),
};

nt_status nt_point_charge_check(const nt_point_charge *charge, nt_problem *problem)
{
    return nt_field_check(fields, (int)(sizeof fields / sizeof fields[0]), charge, problem);
}

nt_law_value nt_point_charge_eval(const nt_point_charge *charge, double gap)
{
    const double R = charge->radius, h = nt_law_gap(gap, charge->minimum_gap);
    const double d = R + h, g = h * (h + 2.0 * R); /* d^2 - R^2 without cancellation */
    const double U = -charge->charge * charge->charge / (8.0 * NT_PI * NT_VACUUM_PERMITTIVITY) * (R / g);
    const double F = U * (2.0 * (d / g));
    const nt_law_value value = {.U = U, .F = F, .k = F * (4.0 * (d / g) - 1.0 / d)};
    return nt_law_hold(value, charge->minimum_gap - gap);
}

NT_LAW_ARRAY(nt_point_charge, nt_point_charge_eval)
