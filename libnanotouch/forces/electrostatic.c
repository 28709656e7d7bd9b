/* SPDX-License-Identifier: BSD-3-Clause
 * Electrostatic attraction of a conducting sphere and plane at a potential difference (Hudlet et al., Eur. Phys. J. B 2
 * (1998) 5), in place of the paper's plate law with S = 4 pi R r1 (erratum E5), which is here under its own name. */
#include <math.h>
#include <stddef.h>

#include "forces/law.h"
#include "internal/field.h"
#include "internal/forces.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

#define SPHERE(member, ...) NT_FIELD(nt_electrostatic, member, __VA_ARGS__)
#define PLATE(member, ...) NT_FIELD(nt_electrostatic_plate, member, __VA_ARGS__)

static const nt_field sphere_fields[] = {
    SPHERE(radius, "m", 1e-10, 1.0, "radius R of the tip"),
    SPHERE(potential, "V", -1e4, 1e4, "potential difference U, contact potential and bias"),
    SPHERE(minimum_gap, "m", 1e-12, 1e-6, "closest approach a0 of the atoms"),
};

static const nt_field plate_fields[] = {
    PLATE(area, "m^2", 0.0, 1.0, "area S of the plate"),
    PLATE(potential, "V", -1e4, 1e4, "potential difference U, contact potential and bias"),
    PLATE(minimum_gap, "m", 1e-12, 1e-6, "closest approach a0"),
};

nt_status nt_electrostatic_check(const nt_electrostatic *electrostatic, nt_problem *problem)
{
    return nt_field_check(sphere_fields, (int)(sizeof sphere_fields / sizeof sphere_fields[0]), electrostatic, problem);
}

nt_status nt_electrostatic_plate_check(const nt_electrostatic_plate *plate, nt_problem *problem)
{
    return nt_field_check(plate_fields, (int)(sizeof plate_fields / sizeof plate_fields[0]), plate, problem);
}

nt_law_value nt_electrostatic_eval(const nt_electrostatic *electrostatic, double gap)
{
    const double R = electrostatic->radius, h = nt_law_gap(gap, electrostatic->minimum_gap);
    const double strength = NT_PI * NT_VACUUM_PERMITTIVITY * electrostatic->potential * electrostatic->potential;
    const double F = -strength * (R / h) * (R / (h + R));
    const nt_law_value value = {.U = -strength * R * log1p(R / h), .F = F, .k = F * (1.0 / h + 1.0 / (h + R))};
    return nt_law_hold(value, electrostatic->minimum_gap - gap);
}

nt_law_value nt_electrostatic_plate_eval(const nt_electrostatic_plate *plate, double gap)
{
    const double h = nt_law_gap(gap, plate->minimum_gap);
    const double U = -0.5 * NT_VACUUM_PERMITTIVITY * plate->potential * plate->potential * plate->area / h;
    return nt_law_hold((nt_law_value){.U = U, .F = U / h, .k = 2.0 * U / h / h}, plate->minimum_gap - gap);
}

NT_LAW_ARRAY(nt_electrostatic, nt_electrostatic_eval)
NT_LAW_ARRAY(nt_electrostatic_plate, nt_electrostatic_plate_eval)
