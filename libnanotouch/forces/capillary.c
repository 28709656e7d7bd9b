/* SPDX-License-Identifier: BSD-3-Clause
 * A water meniscus between a sphere and a flat (paper, Eq. 1; Israelachvili): the Laplace pressure gamma_L/r1 over the
 * wetted cap pi 2R (2 r1 - (h - 2e)). As printed the law turns repulsive beyond 2e + 2 r1 and exceeds the force of a
 * bridge in contact below 2e (erratum E3): outside 0 <= h - 2e <= 2 r1 it is held at its ends. */
#include <math.h>
#include <stddef.h>

#include "nanotouch/field.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

#define FIELD(path, unit, minimum, maximum, doc) \
    {#path, unit, minimum, maximum, (unsigned)offsetof(nt_capillary, path), doc}

static const nt_field capillary_fields[] = {
    FIELD(radius, "m", 1e-10, 1.0, "radius R of the tip"),
    FIELD(surface_tension, "N/m", 0.0, 10.0, "surface tension gamma_L of the liquid"),
    FIELD(meniscus_radius, "m", 1e-11, 1e-3, "radius r1 of the meniscus"),
    FIELD(film_thickness, "m", 0.0, 1e-5, "thickness e of the liquid film on each surface"),
};

nt_status nt_capillary_check(const nt_capillary *capillary, nt_problem *problem)
{
    return nt_field_check(capillary_fields, (int)(sizeof capillary_fields / sizeof capillary_fields[0]), capillary,
                          problem);
}

nt_law_value nt_capillary_eval(const nt_capillary *capillary, double gap)
{
    const double full = 4.0 * NT_PI * capillary->surface_tension * capillary->radius;
    const double length = 2.0 * capillary->meniscus_radius, s = gap - 2.0 * capillary->film_thickness;
    if (s >= length)
        return (nt_law_value){0};
    if (s <= 0.0)
        return (nt_law_value){.U = -full * (0.5 * length - s), .F = -full};
    const double rest = (length - s) / length;
    return (nt_law_value){.U = -0.5 * full * length * rest * rest, .F = -full * rest, .k = -full / length};
}

double nt_kelvin_radius(double surface_tension, double molar_volume, double temperature, double relative_humidity)
{
    if (!(relative_humidity > 0.0 && relative_humidity < 1.0))
        return NAN;
    return -surface_tension * molar_volume / (NT_GAS_CONSTANT * temperature * log(relative_humidity));
}
