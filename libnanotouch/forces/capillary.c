/* SPDX-License-Identifier: BSD-3-Clause
 * A water meniscus between a sphere and a flat (paper, Eq. 1; Israelachvili): the Laplace pressure gamma_L/r1 over the
 * wetted cap pi 2R (2 r1 - (h - 2e)). As printed the law turns repulsive beyond 2e + 2 r1 and exceeds the force of a
 * bridge in contact below 2e (erratum E3): outside 0 <= h - 2e <= 2 r1 it is held at its ends. */
#include <math.h>
#include <stddef.h>

#include "forces/law.h"
#include "internal/field.h"
#include "internal/forces.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

#define FIELD(member, ...) NT_FIELD(nt_capillary, member, __VA_ARGS__)

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
    const double length = 2.0 * capillary->meniscus_radius, s = gap - nt_capillary_forms_at(capillary);
    if (isnan(s))
        return (nt_law_value){.U = s, .F = s, .k = s};
    if (s >= length)
        return (nt_law_value){0};
    const double rest = fmin((length - s) / length, 1.0);
    const nt_law_value value = {.U = -0.5 * full * length * rest * rest, .F = -full * rest, .k = -full / length};
    return nt_law_hold(value, -s);
}

NT_LAW_ARRAY(nt_capillary, nt_capillary_eval)

double nt_capillary_forms_at(const nt_capillary *capillary)
{
    return 2.0 * capillary->film_thickness;
}

double nt_capillary_ruptures_at(const nt_capillary *capillary)
{
    return nt_capillary_forms_at(capillary) + 2.0 * capillary->meniscus_radius;
}

int nt_capillary_advance(const nt_capillary *capillary, int bridged, double gap)
{
    if (gap <= nt_capillary_forms_at(capillary))
        return 1;
    return bridged && !(gap > nt_capillary_ruptures_at(capillary));
}

void nt_capillary_trace_n(const nt_capillary *capillary, int *bridged, const nt_strided *arrays)
{
    for (long i = 0; i < arrays->count; i++) {
        const double gap = arrays->in[i * arrays->in_stride];
        *bridged = nt_capillary_advance(capillary, *bridged, gap);
        const nt_law_value none = {0};
        nt_strided_store(arrays, i, *bridged || isnan(gap) ? nt_capillary_eval(capillary, gap) : none);
    }
}

double nt_kelvin_radius(double surface_tension, double molar_volume, double temperature, double relative_humidity)
{
    if (!(relative_humidity > 0.0 && relative_humidity < 1.0))
        return NAN;
    return -surface_tension * molar_volume / (NT_GAS_CONSTANT * temperature * log(relative_humidity));
}
