/* SPDX-License-Identifier: BSD-3-Clause
 * Electric double layers of a sphere and a flat in an electrolyte (Hogg, Healy, Fuerstenau, Trans. Faraday Soc. 62
 * (1966) 1638, at constant potential; Wiese, Healy, Trans. Faraday Soc. 66 (1970) 490, at constant charge): linear
 * Poisson-Boltzmann, |psi| below some 25 mV; Derjaguin, R >> debye_length.
 * With x = h/debye_length, S = (psi_1 + psi_2)^2, D = (psi_1 - psi_2)^2 both read U = C [A ln(1 + e^-x) + B ln(1 -
 * e^-x)], C = pi eps R: A = S, B = D at constant potential, A = -D, B = -S at constant charge. */
#include <math.h>
#include <stddef.h>

#include "forces/law.h"
#include "internal/field.h"
#include "internal/forces.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

#define FIELD(member, ...) NT_FIELD(nt_double_layer, member, __VA_ARGS__)

static const nt_field double_layer_fields[] = {
    FIELD(radius, "m", 1e-10, 1.0, "radius R of the tip"),
    FIELD(debye_length, "m", 1e-11, 1e-4, "Debye length 1/kappa of the liquid"),
    FIELD(relative_permittivity, "", 1.0, 1e4, "relative permittivity of the liquid"),
    FIELD(tip_potential, "V", -1.0, 1.0, "surface potential psi_1 of the tip alone"),
    FIELD(sample_potential, "V", -1.0, 1.0, "surface potential psi_2 of the sample alone"),
    FIELD(minimum_gap, "m", 1e-12, 1e-6, "gap below which the force stays"),
};

nt_status nt_double_layer_check(const nt_double_layer *layer, nt_problem *problem)
{
    return nt_field_check(double_layer_fields, (int)(sizeof double_layer_fields / sizeof double_layer_fields[0]), layer,
                          problem);
}

static double square(double x)
{
    return x * x;
}

/* U = C [A ln(1 + e) + B ln(1 - e)], e = exp(-x), and its derivatives. */
static nt_law_value sum(const nt_double_layer *layer, double gap, double A, double B)
{
    const double x = nt_law_gap(gap, layer->minimum_gap) / layer->debye_length, kappa = 1.0 / layer->debye_length;
    const double C = NT_PI * NT_VACUUM_PERMITTIVITY * layer->relative_permittivity * layer->radius;
    const int near = x < 0.7; /* of two ways the one that keeps its digits */
    const double e = near ? 1.0 + expm1(-x) : exp(-x), more = 1.0 + e, less = near ? -expm1(-x) : 1.0 - e;
    const double log_less = near ? log(less) : log1p(-e);
    const nt_law_value value = {.U = C * (A * log1p(e) + B * log_less),
                                .F = C * kappa * e * (A / more - B / less),
                                .k = C * square(kappa) * e * (A / square(more) - B / square(less))};
    return nt_law_hold(value, layer->minimum_gap - gap);
}

nt_law_value nt_double_layer_potential_eval(const nt_double_layer *layer, double gap)
{
    return sum(layer, gap, square(layer->tip_potential + layer->sample_potential),
               square(layer->tip_potential - layer->sample_potential));
}

nt_law_value nt_double_layer_charge_eval(const nt_double_layer *layer, double gap)
{
    return sum(layer, gap, -square(layer->tip_potential - layer->sample_potential),
               -square(layer->tip_potential + layer->sample_potential));
}

NT_LAW_ARRAY(nt_double_layer, nt_double_layer_potential_eval)
NT_LAW_ARRAY(nt_double_layer, nt_double_layer_charge_eval)

double nt_debye_length(double ionic_strength, double relative_permittivity, double temperature)
{
    if (!(ionic_strength > 0.0 && relative_permittivity > 0.0 && temperature > 0.0))
        return NAN;
    const double stored = NT_VACUUM_PERMITTIVITY * relative_permittivity * NT_BOLTZMANN * temperature;
    return sqrt(stored / (2.0 * NT_AVOGADRO * ionic_strength)) / NT_ELEMENTARY_CHARGE;
}
