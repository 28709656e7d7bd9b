/* SPDX-License-Identifier: BSD-3-Clause
 * The moments of a step: psi_j = (1 - j psi_(j-1))/x upwards for large x; below 1 the series of psi_3 and downwards. */
#include "rheology/arms.h"

#include <math.h>
#include <string.h>

#include "internal/rheology.h"
#include "rheology/kernel.h"

enum { TERMS = 15 }; /* of the series at x = 1, to the last bit */

void nt_arms_make(nt_arms *arms, const nt_rheology *rheology, const nt_spectrum *spectrum, int with_derivatives)
{
    memset(arms, 0, sizeof *arms);
    arms->width = (1 + spectrum->count + 3) / 4 * 4;
    arms->parameters = with_derivatives ? 1 + nt_rheology_parameter_count(rheology) : 0;
    arms->modulus[0] = spectrum->equilibrium_modulus;
    for (int k = 0; k < spectrum->count; k++) {
        arms->modulus[1 + k] = spectrum->moduli[k];
        arms->rate[1 + k] = spectrum->rates[k];
    }
    for (int p = 0; p < arms->parameters; p++) {
        arms->arm[p] = -1;
        if (p == 0)
            continue;
        nt_spectrum_slope slope;
        nt_spectrum_derive(rheology, spectrum, p - 1, &slope);
        arms->by[p][0] = slope.equilibrium_modulus;
        for (int k = 0; k < spectrum->count; k++)
            arms->by[p][1 + k] = slope.moduli[k];
        arms->arm[p] = slope.arm < 0 ? -1 : 1 + slope.arm;
        arms->rate_by[p] = slope.rate;
    }
}

/* exp(-x) is returned, psi_0 .. psi_3 filled in. */
static double moments(double x, double psi[4])
{
    if (x > 1.0) {
        const double decay = exp(-x);
        psi[0] = (1.0 - decay) / x;
        for (int j = 1; j < 4; j++)
            psi[j] = (1.0 - j * psi[j - 1]) / x;
        return decay;
    }
    double term = 0.25, sum = 0.25; /* 3!/4!, .. */
    for (int n = 1; n < TERMS; n++)
        sum += term *= -x / (n + 4);
    psi[3] = sum;
    for (int j = 3; j > 0; j--)
        psi[j - 1] = (1.0 - x * psi[j]) / j;
    return 1.0 - x * psi[0];
}

/* d(psi_j)/dx = psi_(j+1) - psi_j. */
static void derive(nt_step *step, const nt_arms *arms, int p, double psi3)
{
    const int k = arms->arm[p];
    for (int j = 0; j < 3; j++) {
        step->sum_by[p][j] = nt_arms_sum(arms->width, arms->by[p], step->psi[j]);
        if (k < 0)
            continue;
        const double next = j < 2 ? step->psi[j + 1][k] : psi3;
        step->psi_by[p][j] = (next - step->psi[j][k]) * step->h * arms->rate_by[p];
        step->sum_by[p][j] += arms->modulus[k] * step->psi_by[p][j];
    }
}

void nt_step_to(nt_step *step, const nt_arms *arms, double h)
{
    if (fabs(h - step->h) <= NT_SAME_STEP * h)
        return;
    double psi3[NT_ARMS];
    step->h = h;
    for (int k = 0; k < arms->width; k++) {
        double psi[4];
        step->decay[k] = moments(h * arms->rate[k], psi);
        for (int j = 0; j < 3; j++)
            step->psi[j][k] = psi[j];
        psi3[k] = psi[3];
    }
    for (int j = 0; j < 3; j++)
        step->sum[j] = nt_arms_sum(arms->width, arms->modulus, step->psi[j]);
    for (int p = 0; p < arms->parameters; p++)
        derive(step, arms, p, arms->arm[p] < 0 ? 0.0 : psi3[arms->arm[p]]);
}
