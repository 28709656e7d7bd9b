/* SPDX-License-Identifier: BSD-3-Clause
 * Polymer brushes that are pressed together (Alexander, J. Phys. France 38 (1977) 983; de Gennes, Adv. Colloid
 * Interface Sci. 27 (1987) 189): the pressure between plates is p = kT/s^3 [(T/h)^(9/4) - (h/T)^(3/4)] for h < T, with
 * s the distance of grafted chains and T the thickness at which the brushes meet (2L where both bodies bear one, L
 * where one does). Sphere and flat by Derjaguin, R >> T: F = 2 pi R Int_h^T p. Beyond T nothing. Scaling law: its
 * factor is of order one. */
#include <math.h>
#include <stddef.h>

#include "forces/law.h"
#include "nanotouch/field.h"
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

/* Sum of weight exp(rate t) of two or three terms, without its powers of t below `first`, which cancel. */
typedef struct exponentials {
    double weight[3], rate[3];
    int first; /* the lowest power of t that is left */
} exponentials;

static double exponentials_at(const exponentials *sum, double t)
{
    double value = 0.0;
    for (int i = 0; i < 3; i++) {
        const double x = sum->rate[i] * t;
        if (t > 0.5) {
            value += sum->weight[i] * expm1(x);
            continue;
        }
        double power = sum->weight[i];
        for (int n = 1; n < 24; n++) { /* (2.75 * 0.5)^24/24! < 2^-53 */
            power *= x / n;
            value += n >= sum->first ? power : 0.0;
        }
    }
    return value;
}

/* With h = T exp(-t): p = scale [exp(9t/4) - exp(-3t/4)]; its integral from T to h, T scale 4/35 [7 exp(5t/4) + 5
 * exp(-7t/4) - 12], is of second order in t, that of it again of third. */
nt_law_value nt_steric_eval(const nt_steric *steric, double gap)
{
    static const exponentials pressure = {{1.0, -1.0, 0.0}, {2.25, -0.75, 0.0}, 1};
    static const exponentials force = {{7.0, 5.0, 0.0}, {1.25, -1.75, 0.0}, 2};
    static const exponentials energy = {{28.0, -20.0 / 11.0, 12.0}, {0.25, -2.75, -1.0}, 3};
    const double T = steric->thickness, floor = fmin(steric->minimum_gap, T), h = nt_law_gap(gap, floor);
    if (h >= T)
        return (nt_law_value){0};
    const double t = h > 0.5 * T ? -log1p((h - T) / T) : -log(h / T);
    const double scale = 2.0 * NT_PI * steric->radius * pressure_scale(steric);
    const nt_law_value value = {.U = 4.0 / 35.0 * scale * T * T * exponentials_at(&energy, t),
                                .F = 4.0 / 35.0 * scale * T * exponentials_at(&force, t),
                                .k = scale * exponentials_at(&pressure, t)};
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
