/* SPDX-License-Identifier: BSD-3-Clause
 * A bank of tables of Maugis-Dugdale over a range of lambda: what making and evaluating it share; private to contact/.
 *
 * In Z and lambda the contact branch is smooth on either side of lambda_0 = 0.9379, and the closer to it the smaller
 * the scale on which it varies: so panels are of equal width in the logarithm of v = lambda/lambda_0 - 1 above it and
 * lambda_0/lambda - 1 below, read off the bits of v as cells are off those of u. All tables of a side have one Zs, and
 * every coefficient of the cubic of a cell is a cubic in t = (v - low)/(high - low) that takes value and slope at the
 * ends of the panel: so panels join smoothly. Sums, and products with numbers that do not depend on lambda, pass
 * through this interpolation: so U stays the integral of F. Below lambda_0 the branch starts at a = 0, which is
 * explicit in lambda; there U and F are counted from what they are at a = 0 (F going on as a constant), so that both go
 * over into the attracted state without a step. */
#ifndef NANOTOUCH_CONTACT_MAUGIS_BANK_H
#define NANOTOUCH_CONTACT_MAUGIS_BANK_H

#include <math.h>

#include "contact/maugis/apart.h"
#include "contact/maugis/cells.h"
#include "internal/contact.h"
#include "nanotouch/advanced/maugis.h"

#define NT_BANK_CENTRE 0.93794745721071221163 /* lambda_0 = (9/(16 (1 - 1/pi)))^(1/3) */
#define NT_BANK_DEEP 1.1                      /* largest indentations: from 1 to this the exact law takes over */

enum { NT_BANK_START_NODES = 8 };

/* Value and slope at both ends, four points between: (1 - cos(k pi/5))/2. */
static const double nt_bank_start_nodes[NT_BANK_START_NODES] = {
    0.0, 0.0, 0.095491502812526287949, 0.34549150281252628795, 0.65450849718747371205, 0.90450849718747371205,
    1.0, 1.0};

/* The bit of the mantissa below which cells or panels are not told apart; 0 for an invalid number per octave. */
static inline int nt_bank_shift(int per_octave)
{
    for (int k = 0; k <= 6; k++)
        if (1 << k == per_octave)
            return 52 - k;
    return 0;
}

static inline double nt_bank_distance(double lambda, int above)
{
    return (above ? lambda / NT_BANK_CENTRE : NT_BANK_CENTRE / lambda) - 1.0;
}

/* Newton's form on divided differences; *slope its derivative. */
static inline double nt_bank_interpolate(const double *f, double t, double *slope)
{
    double value = f[NT_BANK_START_NODES - 1];
    *slope = 0.0;
    for (int i = NT_BANK_START_NODES - 2; i >= 0; i--) {
        *slope = value + (t - nt_bank_start_nodes[i]) * *slope;
        value = f[i] + (t - nt_bank_start_nodes[i]) * value;
    }
    return value;
}

static inline double nt_cubic_slope(const double c[4], double t)
{
    return c[1] + t * (2.0 * c[2] + t * 3.0 * c[3]);
}

/* A contact whose units are 1. */
static inline nt_status nt_bank_prepare(double lambda, nt_maugis *maugis)
{
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
    return nt_maugis_init_lambda(maugis, &contact, lambda);
}

/* The end of the contact branch at a = 0 below lambda_0: where it is, its load, how both change with lambda, and what
 * the energy does there. (Griffith) of maugis/branch.c at y = 0. */
typedef struct nt_bank_touch {
    double d, P, U;
    double d_lambda, P_lambda;
    double U_lambda; /* at constant d */
} nt_bank_touch;

static inline nt_bank_touch nt_bank_touch_at(double lambda)
{
    const double linear = 4.0 / 3.0 * lambda * (0.5 * NT_PI - 1.0), B = linear * lambda;
    const double D = sqrt(B * B + NT_PI * lambda), b = 2.0 / (B + D);
    const double b_lambda = -b * (0.25 * NT_PI * b + 2.0 * linear) / D;
    return (nt_bank_touch){
        .d = -4.0 / 3.0 * lambda * b,
        .P = -0.5 * NT_PI * lambda * b * b,
        .U = lambda * b * b * b * (4.0 / 9.0 * lambda - NT_PI / 8.0 * b),
        .d_lambda = -4.0 / 3.0 * (b + lambda * b_lambda),
        .P_lambda = -0.5 * NT_PI * b * (b + 2.0 * lambda * b_lambda),
        .U_lambda = nt_maugis_apart_slope(lambda, b),
    };
}

/* Reduced {U, F, k, a}; slope is dU/dlambda at constant d. */
typedef struct nt_bank_state {
    nt_law_value value;
    double slope;
} nt_bank_state;

/* nt_maugis_bank_eval with the slope, which is left out for sloped = 0. */
nt_status nt_bank_state_find(const nt_maugis_bank *bank, const double at[2], nt_branch branch, int sloped,
                             nt_bank_state *state);

/* Where the stable branch ends under grips, reduced. */
nt_status nt_bank_grip_find(const nt_maugis_bank *bank, double lambda, double *d);

#endif
