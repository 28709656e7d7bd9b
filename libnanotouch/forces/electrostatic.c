/* SPDX-License-Identifier: BSD-3-Clause
 * Electrostatic attraction of a conducting sphere and plane at a potential difference (Hudlet et al., Eur. Phys. J. B 2
 * (1998) 5), in place of the paper's plate law with S = 4 pi R r1 (erratum E5). */
#include <math.h>
#include <stddef.h>

#include "forces/hold.h"
#include "nanotouch/field.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

#define FIELD(path, unit, minimum, maximum, doc) \
    {#path, unit, minimum, maximum, (unsigned)offsetof(nt_electrostatic, path), doc}

static const nt_field electrostatic_fields[] = {
    FIELD(radius, "m", 1e-10, 1.0, "radius R of the tip"),
    FIELD(potential, "V", -1e4, 1e4, "potential difference U, contact potential and bias"),
    FIELD(minimum_gap, "m", 1e-12, 1e-6, "closest approach a0 of the atoms"),
};

nt_status nt_electrostatic_check(const nt_electrostatic *electrostatic, nt_problem *problem)
{
    return nt_field_check(electrostatic_fields, (int)(sizeof electrostatic_fields / sizeof electrostatic_fields[0]),
                          electrostatic, problem);
}

nt_law_value nt_electrostatic_eval(const nt_electrostatic *electrostatic, double gap)
{
    const double R = electrostatic->radius, minimum = electrostatic->minimum_gap;
    const double strength = NT_PI * NT_VACUUM_PERMITTIVITY * electrostatic->potential * electrostatic->potential;
    const double h = gap < minimum ? minimum : gap;
    const double F = -strength * (R / h) * (R / (h + R));
    const nt_law_value value = {.U = -strength * R * log1p(R / h), .F = F, .k = F * (1.0 / h + 1.0 / (h + R))};
    return gap < minimum ? nt_law_hold(value, minimum - gap) : value;
}
