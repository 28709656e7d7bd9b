/* SPDX-License-Identifier: BSD-3-Clause
 * The description of a sample that relaxes: its fields, and the row of its kernel. */
#include "internal/rheology.h"
#include "internal/field.h"
#include "nanotouch/rheology.h"

#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "rheology/kernel.h"

#define FIELD(path, ...) NT_FIELD_NAMED("rheology." #path, nt_rheology, path, __VA_ARGS__)

static const nt_kernel *const kernels[NT_RHEOLOGY_COUNT] = {
    [NT_RHEOLOGY_POWER_LAW] = &nt_kernel_power_law,
    [NT_RHEOLOGY_STANDARD_LINEAR_SOLID] = &nt_kernel_standard_linear_solid,
    [NT_RHEOLOGY_PRONY] = &nt_kernel_prony,
};

static const nt_field fields[] = {
    FIELD(kind, "elastic|power_law|standard_linear_solid|prony", NT_RHEOLOGY_POWER_LAW, NT_RHEOLOGY_COUNT - 1.0,
          "how the modulus relaxes"),
    FIELD(modulus, "Pa", 1e-3, 1e13, "of a power law, Young's modulus E_1 at the reference time"),
    FIELD(exponent, "", 0.0, 0.85, "of a power law, beta: 0 is elastic"),
    FIELD(reference_time, "s", 1e-9, 1e9, "of a power law, t_0"),
    FIELD(equilibrium_modulus, "Pa", 0.0, 1e13, "of arms, Young's modulus E_inf that is left in the end; 0: a fluid"),
};

nt_rheology nt_rheology_defaults(void)
{
    return (nt_rheology){.kind = NT_RHEOLOGY_POWER_LAW,
                         .arm_count = 1,
                         .modulus = 1e3,
                         .exponent = 0.2,
                         .reference_time = 1.0,
                         .equilibrium_modulus = 1e3,
                         .arm_moduli = {1e3},
                         .relaxation_times = {0.1}};
}

const nt_field *nt_rheology_fields(int *count)
{
    if (count != NULL)
        *count = (int)(sizeof fields / sizeof fields[0]);
    return fields;
}

nt_status nt_rheology_check(const nt_rheology *rheology, nt_problem *problem)
{
    const nt_status status = nt_field_check(fields, (int)(sizeof fields / sizeof fields[0]), rheology, problem);
    if (status != NT_OK)
        return status;
    const int counted = rheology->kind == NT_RHEOLOGY_PRONY;
    if (counted && !(rheology->arm_count >= 1 && rheology->arm_count <= NT_RHEOLOGY_ARMS)) {
        if (problem != NULL)
            *problem = nt_problem_of("rheology.arm_count", "", rheology->arm_count, 1.0, NT_RHEOLOGY_ARMS);
        return NT_E_RANGE;
    }
    return kernels[rheology->kind]->check(rheology, problem);
}

/* NaN for NaN and for times below 0. */
static double from_zero(double time)
{
    return time >= 0.0 ? time : (double)NAN;
}

double nt_rheology_relaxation(const nt_rheology *rheology, double time)
{
    return kernels[rheology->kind]->relaxation(rheology, from_zero(time));
}

double nt_rheology_relaxation_integral(const nt_rheology *rheology, double time)
{
    return kernels[rheology->kind]->integral(rheology, from_zero(time));
}

double nt_rheology_creep(const nt_rheology *rheology, double time)
{
    return kernels[rheology->kind]->creep(rheology, from_zero(time));
}

nt_status nt_rheology_discretize(const nt_rheology *rheology, const nt_time_range *range, double error,
                                 nt_spectrum *spectrum)
{
    if (!isfinite(range->shortest) || !isfinite(range->longest) || !isfinite(error))
        return NT_E_NOT_FINITE;
    if (!(range->shortest > 0.0 && range->longest >= range->shortest && error >= 1e-8 && error <= 0.1))
        return NT_E_RANGE;
    return kernels[rheology->kind]->discretize(rheology, range, error, spectrum);
}

int nt_rheology_parameter_count(const nt_rheology *rheology)
{
    return kernels[rheology->kind]->parameter_count(rheology);
}

void nt_spectrum_derive(const nt_rheology *rheology, const nt_spectrum *spectrum, int parameter,
                        nt_spectrum_slope *slope)
{
    kernels[rheology->kind]->derive(rheology, spectrum, parameter, slope);
}
