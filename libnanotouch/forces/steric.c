/* SPDX-License-Identifier: BSD-3-Clause
 * Polymer brushes that are pressed together (Alexander, J. Phys. France 38 (1977) 983; de Gennes, Adv. Colloid
 * Interface Sci. 27 (1987) 189): the pressure between plates is p = kT/s^3 [(T/h)^(9/4) - (h/T)^(3/4)] for h < T, with
 * s the distance of grafted chains and T the thickness at which the brushes meet (2L where both bodies bear one, L
 * where one does). Sphere and flat by Derjaguin, R >> T: F = 2 pi R Int_h^T p. Beyond T nothing. Scaling law: its
 * factor is of order one. */
#include <math.h>
#include <stddef.h>

#include "forces/law.h"
#include "internal/field.h"
#include "internal/forces.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

#define FIELD(member, ...) NT_FIELD(nt_steric, member, __VA_ARGS__)

static const nt_field steric_fields[] = {
    FIELD(radius, "m", 1e-10, 1.0, "radius R of the tip"),
    FIELD(thickness, "m", 1e-10, 1e-5, "thickness T of the free brushes, of both bodies together"),
    FIELD(spacing, "m", 1e-10, 1e-6, "distance s of grafted chains"),
    FIELD(temperature, "K", 1.0, 1e4, "temperature"),
    FIELD(minimum_gap, "m", 1e-12, 1e-6, "gap below which the force stays"),
};

nt_status nt_steric_check(const nt_steric *steric, nt_problem *problem)
{
    return nt_field_check(steric_fields, (int)(sizeof steric_fields / sizeof steric_fields[0]), steric, problem);
}

/* kT/s^3 [Pa]. */
static double pressure_scale(const nt_steric *steric)
{
    return NT_BOLTZMANN * steric->temperature / steric->spacing / steric->spacing / steric->spacing;
}

/* With q = (h/T)^(1/4), in units of 2 pi R kT/s^3, T and T^2: the pressure, its integral from T to h and that of it
 * again, k = q^-9 - q^3        F = 4/35 [7 q^-5 + 5 q^7 - 12]        U = 16/385 [77 q^-1 - 105 + 33 q^4 - 5 q^11],
 * vanish at q = 1 in first, second and third order: these powers of 1 - q are divided out, which leaves polynomials
 * whose coefficients are all above 0. */
nt_law_value nt_steric_eval(const nt_steric *steric, double gap)
{
    const double T = steric->thickness, floor = fmin(steric->minimum_gap, T), h = nt_law_gap(gap, floor);
    if (h >= T)
        return (nt_law_value){0};
    const double x = h / T, rest = (T - h) / T, q2 = sqrt(x), q = sqrt(q2); /* x = q^4 */
    const double less = rest / ((1.0 + q) * (1.0 + q2));                    /* 1 - q */
    const double second = (7.0 + 14.0 * q + q2 * (21.0 + 28.0 * q)) +
                          x * ((35.0 + 30.0 * q + q2 * (25.0 + 20.0 * q)) + x * (15.0 + 10.0 * q + 5.0 * q2));
    const double third = (77.0 + 126.0 * q + q2 * (147.0 + 140.0 * q)) +
                         x * ((105.0 + 75.0 * q + q2 * (50.0 + 30.0 * q)) + x * (15.0 + 5.0 * q));
    const double scale = 2.0 * NT_PI * steric->radius * pressure_scale(steric), per_q = scale / q, per_x = 1.0 / x;
    const nt_law_value value = {.U = 16.0 / 385.0 * T * T * per_q * less * less * less * third,
                                .F = 4.0 / 35.0 * T * per_q * per_x * less * less * second,
                                .k = per_q * per_x * per_x * rest * (1.0 + x + x * x)};
    return nt_law_hold(value, floor - gap);
}

/* p = 100 kT/s^3 exp(-2 pi h/T) (Israelachvili, Intermolecular and Surface Forces, 2nd ed. 1992, ch. 14),
 * within 24 % of the full law for 0.2 < h/T < 0.9. */
nt_law_value nt_steric_exponential_eval(const nt_steric *steric, double gap)
{
    const double decay_length = steric->thickness / (2.0 * NT_PI), h = nt_law_gap(gap, steric->minimum_gap);
    const double k = 200.0 * NT_PI * steric->radius * pressure_scale(steric) * exp(-h / decay_length);
    const double F = k * decay_length;
    return nt_law_hold((nt_law_value){.U = F * decay_length, .F = F, .k = k}, steric->minimum_gap - gap);
}

NT_LAW_ARRAY(nt_steric, nt_steric_eval)
NT_LAW_ARRAY(nt_steric, nt_steric_exponential_eval)
