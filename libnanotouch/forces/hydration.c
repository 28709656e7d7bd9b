/* SPDX-License-Identifier: BSD-3-Clause
 * Short-range solvation in water, empirical (Israelachvili, Intermolecular and Surface Forces, 3rd ed. 2011, ch. 15):
 * the energy of plates is W(h) = W_1 exp(-h/l_1) + W_2 exp(-h/l_2), hydration where W > 0 (3..30 mJ/m^2, 0.6..1.1 nm
 * between mica), hydrophobic where W < 0 (W = -2 gamma, gamma = 10..50 mJ/m^2, 1..2 nm). Sphere and flat by Derjaguin,
 * R >> l: F = 2 pi R W(h). Finite at h = 0. */
#include <math.h>
#include <stddef.h>

#include "forces/law.h"
#include "internal/field.h"
#include "internal/forces.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

#define FIELD(member, ...) NT_FIELD(nt_hydration, member, __VA_ARGS__)

static const nt_field hydration_fields[] = {
    FIELD(radius, "m", 1e-10, 1.0, "radius R of the tip"),
    FIELD(amplitude, "J/m^2", -10.0, 10.0, "energy W_1 of plates at gap 0"),
    FIELD(decay_length, "m", 1e-11, 1e-6, "decay length l_1"),
    FIELD(second_amplitude, "J/m^2", -10.0, 10.0, "energy W_2 of plates at gap 0"),
    FIELD(second_decay_length, "m", 1e-11, 1e-6, "decay length l_2"),
    FIELD(minimum_gap, "m", 0.0, 1e-6, "gap below which the force stays"),
};

nt_status nt_hydration_check(const nt_hydration *hydration, nt_problem *problem)
{
    return nt_field_check(hydration_fields, (int)(sizeof hydration_fields / sizeof hydration_fields[0]), hydration,
                          problem);
}

nt_law_value nt_hydration_eval(const nt_hydration *hydration, double gap)
{
    const double l_1 = hydration->decay_length, l_2 = hydration->second_decay_length;
    const double h = nt_law_gap(gap, hydration->minimum_gap), per_area = 2.0 * NT_PI * hydration->radius;
    const double F_1 = per_area * hydration->amplitude * exp(-h / l_1);
    const double W_2 = hydration->second_amplitude, F_2 = W_2 == 0.0 ? 0.0 : per_area * W_2 * exp(-h / l_2);
    const nt_law_value value = {.U = F_1 * l_1 + F_2 * l_2, .F = F_1 + F_2, .k = F_1 / l_1 + F_2 / l_2};
    return nt_law_hold(value, hydration->minimum_gap - gap);
}

NT_LAW_ARRAY(nt_hydration, nt_hydration_eval)
