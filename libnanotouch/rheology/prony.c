/* SPDX-License-Identifier: BSD-3-Clause
 * E(t) = E_inf + Sum E_k exp(-r_k t), r_k = 1/tau_k. Its creep compliance follows from s Q(s) J(s) = 1/s, Q(s) = E_inf
 * + Sum E_k s/(s + r_k): Q has one root s = -q between each two neighbouring -r_k, and one between 0 and the slowest
 * where E_inf > 0, and J(t) = 1/E_inf - Sum exp(-q t)/(q Q'(-q)) (Tschoegl 1989, Sec. 4.1). A fluid (E_inf = 0) flows
 * on: t/eta in place of the first. */
#include "rheology/prony.h"

#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "core/roots.h"
#include "internal/rheology.h"

nt_status nt_prony_check(const nt_rheology *rheology, int arms, nt_problem *problem)
{
    static const struct {
        const char *name, *unit;
        double minimum, maximum;
    } of[2] = {{"rheology.arm_moduli", "Pa", 1e-3, 1e13}, {"rheology.relaxation_times", "s", 1e-9, 1e9}};
    for (int k = 0; k < 2 * arms; k++) {
        const double value = k % 2 ? rheology->relaxation_times[k / 2] : rheology->arm_moduli[k / 2];
        const double minimum = of[k % 2].minimum, maximum = of[k % 2].maximum;
        if (!(value >= minimum && value <= maximum))
            return nt_problem_set(problem, of[k % 2].name, of[k % 2].unit, value, minimum, maximum);
    }
    return NT_OK;
}

double nt_prony_relaxation(const nt_rheology *rheology, int arms, double time)
{
    double sum = rheology->equilibrium_modulus;
    for (int k = 0; k < arms; k++)
        sum += rheology->arm_moduli[k] * exp(-time / rheology->relaxation_times[k]);
    return sum;
}

double nt_prony_integral(const nt_rheology *rheology, int arms, double time)
{
    double sum = rheology->equilibrium_modulus * time;
    for (int k = 0; k < arms; k++) {
        const double tau = rheology->relaxation_times[k];
        sum -= rheology->arm_moduli[k] * tau * expm1(-time / tau);
    }
    return sum;
}

/* Arms by rising rate, those of one rate together. */
typedef struct arms {
    int count;
    double equilibrium, modulus[NT_RHEOLOGY_ARMS], rate[NT_RHEOLOGY_ARMS];
} arms_by_rate;

static arms_by_rate by_rate(const nt_rheology *rheology, int arms)
{
    arms_by_rate sorted = {0, rheology->equilibrium_modulus, {0.0}, {0.0}};
    for (int k = 0; k < arms; k++) {
        const double rate = 1.0 / rheology->relaxation_times[k];
        int i = sorted.count;
        while (i > 0 && sorted.rate[i - 1] > rate)
            i--;
        if (i > 0 && sorted.rate[i - 1] == rate) {
            sorted.modulus[i - 1] += rheology->arm_moduli[k];
            continue;
        }
        for (int j = sorted.count++; j > i; j--) {
            sorted.rate[j] = sorted.rate[j - 1];
            sorted.modulus[j] = sorted.modulus[j - 1];
        }
        sorted.rate[i] = rate;
        sorted.modulus[i] = rheology->arm_moduli[k];
    }
    return sorted;
}

/* Q(-q) between two poles, times the distances to both, so that it is finite at the ends of the bracket. */
typedef struct between {
    const arms_by_rate *of;
    int lower; /* pole below; -1: none, the bracket begins at 0 */
} between;

static double multiplied(double q, const void *context)
{
    const between *gap = context;
    const arms_by_rate *of = gap->of;
    const double below = gap->lower < 0 ? 1.0 : (q - of->rate[gap->lower]) / of->rate[gap->lower];
    const double above = (of->rate[gap->lower + 1] - q) / of->rate[gap->lower + 1];
    double sum = of->equilibrium * below * above;
    for (int k = 0; k < of->count; k++) {
        const double factor = k == gap->lower       ? above * q / of->rate[k]
                              : k == gap->lower + 1 ? -below * q / of->rate[k]
                                                    : below * above * q / (q - of->rate[k]);
        sum += of->modulus[k] * factor;
    }
    return sum;
}

nt_status nt_prony_retard(const nt_rheology *rheology, int arms, nt_retardation *made)
{
    const arms_by_rate of = by_rate(rheology, arms);
    const int fluid = of.equilibrium == 0.0;
    made->count = 0;
    for (int lower = fluid ? 0 : -1; lower + 1 < of.count; lower++) {
        const between gap = {&of, lower};
        const double bracket[2] = {lower < 0 ? 0.0 : of.rate[lower], of.rate[lower + 1]};
        double q, slope = 0.0;
        if (nt_root_find(multiplied, &gap, bracket, &q, NULL) != NT_OK)
            return NT_E_NO_CONVERGENCE;
        for (int k = 0; k < of.count; k++)
            slope += of.modulus[k] * of.rate[k] / ((of.rate[k] - q) * (of.rate[k] - q));
        made->rates[made->count] = q;
        made->compliances[made->count++] = 1.0 / (q * slope);
    }
    return NT_OK;
}

double nt_prony_creep(const nt_rheology *rheology, int arms, double time)
{
    nt_retardation late;
    double sum = 1.0 / rheology->equilibrium_modulus;
    if (rheology->equilibrium_modulus == 0.0) {
        double viscosity = 0.0, second = 0.0;
        for (int k = 0; k < arms; k++) {
            const double tau = rheology->relaxation_times[k];
            viscosity += rheology->arm_moduli[k] * tau;
            second += rheology->arm_moduli[k] * tau * tau;
        }
        sum = time / viscosity + second / (viscosity * viscosity);
    }
    if (nt_prony_retard(rheology, arms, &late) != NT_OK)
        return (double)NAN;
    for (int j = 0; j < late.count; j++)
        sum -= late.compliances[j] * exp(-late.rates[j] * time);
    return sum;
}

nt_status nt_prony_spectrum(const nt_rheology *rheology, int arms, nt_spectrum *spectrum)
{
    spectrum->count = arms;
    spectrum->equilibrium_modulus = rheology->equilibrium_modulus;
    spectrum->error = 0.0;
    for (int k = 0; k < arms; k++) {
        spectrum->moduli[k] = rheology->arm_moduli[k];
        spectrum->rates[k] = 1.0 / rheology->relaxation_times[k];
    }
    return NT_OK;
}

void nt_prony_derive(const nt_rheology *rheology, const nt_spectrum *spectrum, int parameter, nt_spectrum_slope *slope)
{
    const int arm = (parameter - 1) / 2, is_time = parameter > 0 && parameter % 2 == 0;
    (void)rheology;
    slope->equilibrium_modulus = parameter == 0 ? 1.0 : 0.0;
    for (int k = 0; k < spectrum->count; k++)
        slope->moduli[k] = parameter > 0 && !is_time && k == arm ? 1.0 : 0.0;
    slope->arm = is_time ? arm : -1;
    slope->rate = is_time ? -spectrum->rates[arm] * spectrum->rates[arm] : 0.0;
}

static nt_status check(const nt_rheology *rheology, nt_problem *problem)
{
    return nt_prony_check(rheology, rheology->arm_count, problem);
}

static double relaxation(const nt_rheology *rheology, double time)
{
    return nt_prony_relaxation(rheology, rheology->arm_count, time);
}

static double integral(const nt_rheology *rheology, double time)
{
    return nt_prony_integral(rheology, rheology->arm_count, time);
}

static double creep(const nt_rheology *rheology, double time)
{
    return nt_prony_creep(rheology, rheology->arm_count, time);
}

static nt_status discretize(const nt_rheology *rheology, const nt_time_range *range, double error,
                            nt_spectrum *spectrum)
{
    (void)range, (void)error; /* exact with the arms that there are */
    return nt_prony_spectrum(rheology, rheology->arm_count, spectrum);
}

static int parameter_count(const nt_rheology *rheology)
{
    return 1 + 2 * rheology->arm_count;
}

const nt_kernel nt_kernel_prony = {check, relaxation, integral, creep, discretize, parameter_count, nt_prony_derive};
