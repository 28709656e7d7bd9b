/* SPDX-License-Identifier: BSD-3-Clause
 * A rigid sphere before a rigid half-space whose surfaces attract and repel with the Lennard-Jones 9-3 wall, the
 * traction of two half-spaces at distance z: sigma(z) = 8w/(3 z0) [(z0/z)^9 - (z0/z)^3]. Summed over the paraboloid of
 * the sphere it is 2 pi R times the energy of the walls (Bradley, Phil. Mag. 13 (1932) 853; Derjaguin, Kolloid-Z. 69
 * (1934) 155): R >> z0. Far away it is the van der Waals law with H = 16 pi w z0^2. */
#include <stddef.h>

#include "forces/law.h"
#include "internal/field.h"
#include "internal/forces.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

#define FIELD(member, ...) NT_FIELD(nt_lennard_jones, member, __VA_ARGS__)

static const nt_field lennard_jones_fields[] = {
    FIELD(radius, "m", 1e-10, 1.0, "radius R of the tip"),
    FIELD(work_of_adhesion, "J/m^2", 0.0, 1e3, "work of adhesion w"),
    FIELD(equilibrium_distance, "m", 1e-11, 1e-7, "distance z0 of walls at rest"),
    FIELD(minimum_gap, "m", 1e-12, 1e-7, "distance below which the force stays"),
};

nt_status nt_lennard_jones_check(const nt_lennard_jones *lennard_jones, nt_problem *problem)
{
    return nt_field_check(lennard_jones_fields, (int)(sizeof lennard_jones_fields / sizeof lennard_jones_fields[0]),
                          lennard_jones, problem);
}

nt_law_value nt_lennard_jones_eval(const nt_lennard_jones *lennard_jones, double gap)
{
    const double z0 = lennard_jones->equilibrium_distance;
    const double scale = 2.0 * NT_PI * lennard_jones->radius * lennard_jones->work_of_adhesion / 3.0;
    const double q = z0 / nt_law_gap(gap, lennard_jones->minimum_gap), q2 = q * q, q6 = q2 * q2 * q2;
    const nt_law_value value = {.U = scale * z0 * q * (q6 / 7.0 - 4.0),
                                .F = scale * q2 * (q6 - 4.0),
                                .k = 8.0 * scale / z0 * q2 * q * (q6 - 1.0)};
    return nt_law_hold(value, lennard_jones->minimum_gap - gap);
}

NT_LAW_ARRAY(nt_lennard_jones, nt_lennard_jones_eval)
