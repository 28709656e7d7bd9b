/* SPDX-License-Identifier: BSD-3-Clause
 * E(t) = E_inf + E_1 exp(-t/tau_1) (Zener 1948): the Prony series of one arm, by the name that most papers give it. */
#include "internal/rheology.h"
#include "rheology/prony.h"

enum { ONE = 1 };

static nt_status check(const nt_rheology *rheology, nt_problem *problem)
{
    return nt_prony_check(rheology, ONE, problem);
}

static double relaxation(const nt_rheology *rheology, double time)
{
    return nt_prony_relaxation(rheology, ONE, time);
}

static double integral(const nt_rheology *rheology, double time)
{
    return nt_prony_integral(rheology, ONE, time);
}

static double creep(const nt_rheology *rheology, double time)
{
    return nt_prony_creep(rheology, ONE, time);
}

static nt_status discretize(const nt_rheology *rheology, const nt_time_range *range, double error,
                            nt_spectrum *spectrum)
{
    (void)range, (void)error;
    return nt_prony_spectrum(rheology, ONE, spectrum);
}

static int parameter_count(const nt_rheology *rheology)
{
    (void)rheology;
    return 1 + 2 * ONE;
}

const nt_kernel nt_kernel_standard_linear_solid = {check,      relaxation,      integral,       creep,
                                                   discretize, parameter_count, nt_prony_derive};
