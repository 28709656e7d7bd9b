/* SPDX-License-Identifier: BSD-3-Clause
 * E(t) = E_1 (t/t_0)^-beta, a spring-pot: J(t) = (t/t_0)^beta/(E_1 Gamma(1 - beta) Gamma(1 + beta)).
 *
 * As exponentials: t^-beta = 1/Gamma(beta) Int rate^beta exp(-rate t) d(ln rate), summed in steps of D in ln(rate). The
 * sum errs by 2 |Gamma(beta + 2 pi i/D)|/Gamma(beta), about exp(-pi^2/D) (Beylkin and Monzon 2010). The slow end, rates
 * below r_0, is taken by five fixed nodes (one is E_inf) that keep its first five moments; all above r_M by one arm
 * that keeps the integral of E. So the rates depend on the times alone, and the weights are smooth in beta. */
#include <math.h>
#include <stddef.h>

#include "internal/rheology.h"
#include "nanotouch/material.h"
#include "rheology/kernel.h"

enum { SLOW = 4 };                                                  /* nodes of the slow end besides rate 0 */
static const double slow[SLOW + 1] = {0.0, 0.12, 0.35, 0.65, 0.92}; /* over r_0; weights are positive for any beta */
#define FASTEST 2.2         /* rate of the last arm over r_M: keeps the second moment, too, at beta = 0.5 */
#define SPACING_SAFETY 14.0 /* times the error demanded, in exp(-pi^2/D) */
#define WIDEST 0.85         /* [ln(rate)]: beyond, a slow node would get a weight below 0 */
#define SLOW_ERROR 1.5e-5   /* of the slow end at r_0 times the longest time = 1, at most; goes with its 5th power */

enum { TIMES = 24 }; /* at which the error is measured */

static nt_status check(const nt_rheology *rheology, nt_problem *problem)
{
    (void)rheology, (void)problem;
    return NT_OK;
}

static double relaxation(const nt_rheology *rheology, double time)
{
    return rheology->modulus * pow(time / rheology->reference_time, -rheology->exponent);
}

static double integral(const nt_rheology *rheology, double time)
{
    const double beta = rheology->exponent;
    return rheology->modulus * rheology->reference_time * pow(time / rheology->reference_time, 1.0 - beta) /
           (1.0 - beta);
}

static double creep(const nt_rheology *rheology, double time)
{
    const double beta = rheology->exponent, angle = NT_PI * beta;
    /* 1/(Gamma(1 - beta) Gamma(1 + beta)) */
    const double reflected = angle > 0.0 ? sin(angle) / angle : 1.0;
    return pow(time / rheology->reference_time, beta) * reflected / rheology->modulus;
}

/* Gamma at x >= 1, to 3e-15, by Stirling's series. Not tgamma, whose last bit is another on another machine. */
static double gamma_at(double x)
{
    double product = 1.0;
    for (; x < 12.0; x += 1.0)
        product *= x;
    const double y = 1.0 / (x * x), tail = y * (1.0 / 1680.0 - y * (1.0 / 1188.0 - y * 691.0 / 360360.0));
    const double series = (1.0 / 12.0 - y * (1.0 / 360.0 - y * (1.0 / 1260.0 - tail))) / x;
    return sqrt(2.0 * NT_PI) * pow(x, x - 0.5) * exp(series - x) / product;
}

/* Of Gamma's logarithm, at x >= 1, to 1e-12. */
static double digamma(double x)
{
    double sum = 0.0;
    for (; x < 9.0; x += 1.0)
        sum -= 1.0 / x;
    const double y = 1.0 / (x * x);
    return sum + log(x) - 0.5 / x - y * (1.0 / 12.0 - y * (1.0 / 120.0 - y * (1.0 / 252.0 - y / 240.0)));
}

/* A sum over part of the grid, and its derivative by beta. */
typedef struct part {
    double value, slope;
} part;

/* beta D/Gamma(1 + beta)/(2 sinh(D |beta - power|/2)): the grid's sum of (rate/r)^(beta - power) D/Gamma(beta) below
 * r (power <= 0) or above it (power = 1). */
static part moment(double beta, double spacing, double power)
{
    const double gamma = gamma_at(1.0 + beta), psi = digamma(1.0 + beta), x = beta * spacing;
    if (power == 0.0 && x < 1e-3) { /* x/(2 sinh(x/2)) */
        const double s = 1.0 - x * x / 24.0;
        return (part){s / gamma, (-x / 12.0 * spacing - s * psi) / gamma};
    }
    const double away = beta - power, half = 0.5 * spacing * fabs(away), value = 1.0 / (2.0 * sinh(half));
    const double steeper = -0.5 * spacing / tanh(half) * (away > 0.0 ? 1.0 : -1.0);
    const double slope = spacing / gamma * (1.0 - beta * psi + beta * steeper) * value;
    return (part){beta * spacing / gamma * value, slope};
}

/* Weight of a slow node: Lagrange's polynomial of the node over the moments. */
static part slow_weight(int node, const part moments[SLOW + 1])
{
    double polynomial[SLOW + 1] = {1.0}, scale = 1.0;
    for (int i = 0, degree = 0; i <= SLOW; i++) {
        if (i == node)
            continue;
        scale *= slow[node] - slow[i];
        for (int j = ++degree; j >= 0; j--)
            polynomial[j] = (j > 0 ? polynomial[j - 1] : 0.0) - slow[i] * (j < degree ? polynomial[j] : 0.0);
    }
    part sum = {0.0, 0.0};
    for (int j = 0; j <= SLOW; j++) {
        sum.value += polynomial[j] / scale * moments[j].value;
        sum.slope += polynomial[j] / scale * moments[j].slope;
    }
    return sum;
}

/* The weight, over E_1, of an arm that stands for rates around `rate`: (rate t_0)^beta times the part. */
static part scaled(part of, double ratio, double beta)
{
    const double power = pow(ratio, beta);
    return (part){power * of.value, power * (of.slope + log(ratio) * of.value)};
}

/* Weights over E_1 of the equilibrium modulus (index -1) and the arms of a grid with its rates. */
static part weight(const nt_rheology *rheology, const nt_spectrum *spectrum, double spacing, int arm)
{
    const double beta = rheology->exponent, t0 = rheology->reference_time;
    const double first = spectrum->rates[SLOW] * exp(-0.5 * spacing);
    if (arm < SLOW) {
        part moments[SLOW + 1];
        for (int i = 0; i <= SLOW; i++)
            moments[i] = moment(beta, spacing, -(double)i);
        return scaled(slow_weight(arm + 1, moments), first * t0, beta);
    }
    if (arm == spectrum->count - 1) {
        part above = moment(beta, spacing, 1.0);
        above = (part){FASTEST * above.value, FASTEST * above.slope};
        return scaled(above, spectrum->rates[arm] / FASTEST * t0, beta);
    }
    const double gamma = gamma_at(1.0 + beta);
    const part of = {beta * spacing / gamma, spacing / gamma * (1.0 - beta * digamma(1.0 + beta))};
    return scaled(of, spectrum->rates[arm] * t0, beta);
}

static double sum_at(const nt_spectrum *spectrum, double time)
{
    double sum = spectrum->equilibrium_modulus;
    for (int k = 0; k < spectrum->count; k++)
        sum += spectrum->moduli[k] * exp(-spectrum->rates[k] * time);
    return sum;
}

static nt_status discretize(const nt_rheology *rheology, const nt_time_range *range, double error,
                            nt_spectrum *spectrum)
{
    const int most = NT_SPECTRUM_ARMS - SLOW - 1;
    const double first = fmin(3.0, pow(error / SLOW_ERROR, 0.2)) / range->longest;
    const double span = log((log(1.0 / error) + 0.5) / range->shortest / first);
    const double wished = fmin(WIDEST, NT_PI * NT_PI / log(SPACING_SAFETY / error));
    const int needed = (int)fmin(fmax(2.0, ceil(span / wished)), 1e6), count = needed < most ? needed : most;
    const double spacing = needed <= most ? fmin(wished, span / 2.0) : span / count;
    for (int k = 0; k < SLOW; k++)
        spectrum->rates[k] = slow[k + 1] * first;
    for (int k = 0; k < count; k++)
        spectrum->rates[SLOW + k] = first * exp(spacing * (k + 0.5));
    spectrum->rates[SLOW + count] = FASTEST * first * exp(spacing * count);
    spectrum->count = SLOW + count + 1;
    spectrum->equilibrium_modulus = rheology->modulus * weight(rheology, spectrum, spacing, -1).value;
    for (int k = 0; k < spectrum->count; k++)
        spectrum->moduli[k] = rheology->modulus * weight(rheology, spectrum, spacing, k).value;
    spectrum->error = 0.0;
    for (int i = 0; i < TIMES; i++) {
        const double time = range->shortest * pow(range->longest / range->shortest, (double)i / (TIMES - 1));
        spectrum->error = fmax(spectrum->error, fabs(sum_at(spectrum, time) / relaxation(rheology, time) - 1.0));
    }
    return needed <= most ? NT_OK : NT_E_CAPACITY;
}

static int parameter_count(const nt_rheology *rheology)
{
    (void)rheology;
    return 2;
}

static void derive(const nt_rheology *rheology, const nt_spectrum *spectrum, int parameter, nt_spectrum_slope *slope)
{
    const double spacing = log(spectrum->rates[SLOW + 1] / spectrum->rates[SLOW]);
    const double scale = parameter == 0 ? 1.0 : rheology->modulus;
    slope->arm = -1;
    slope->rate = 0.0;
    for (int k = -1; k < spectrum->count; k++) {
        const part of = weight(rheology, spectrum, spacing, k);
        *(k < 0 ? &slope->equilibrium_modulus : &slope->moduli[k]) = scale * (parameter == 0 ? of.value : of.slope);
    }
}

const nt_kernel nt_kernel_power_law = {check, relaxation, integral, creep, discretize, parameter_count, derive};
