/* SPDX-License-Identifier: BSD-3-Clause
 * A bank of tables of Maugis-Dugdale over a range of lambda: what making and evaluating it share; private to contact/.
 *
 * In Z and lambda the contact branch is smooth on either side of lambda_0 = 0.9379, and the closer to it the smaller
 * the scale on which it varies: so panels are of equal width in the logarithm of v = lambda/lambda_0 - 1 above it and
 * lambda_0/lambda - 1 below, read off the bits of v as cells are off those of u. In a panel all tables have one Zs, and
 * every coefficient of the cubic of a cell is a cubic in t = (v - low)/(high - low), through the tables at four
 * lambdas: the ends and 1/2 -+ (1/sqrt 2 - 1/2) (Chebyshev points stretched to the ends, so that panels join). Sums,
 * and products with numbers that do not depend on lambda, pass through this interpolation: so U stays the integral of
 * F. */
#ifndef NANOTOUCH_CONTACT_MAUGIS_BANK_H
#define NANOTOUCH_CONTACT_MAUGIS_BANK_H

#include <math.h>

#include "contact/maugis_cells.h"

#define NT_BANK_CENTRE 0.93794745721071121163 /* lambda_0 = (9/(16 (1 - 1/pi)))^(1/3) */

enum { NT_BANK_NODES = 4, NT_BANK_START_NODES = 8 };

static const double nt_bank_nodes[NT_BANK_NODES] = {0.0, 0.29289321881345247560, 0.70710678118654752440, 1.0};
/* (1 - cos((2 i + 1) pi/16))/2 */
static const double nt_bank_start_nodes[NT_BANK_START_NODES] = {
    0.0096073597983847754369, 0.084265193848727381461, 0.22221488349019888763, 0.40245483899193586608,
    0.59754516100806413392,   0.77778511650980111237,  0.91573480615127261854, 0.99039264020161522456};

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

/* Newton's form on divided differences. */
static inline double nt_bank_interpolate(const double *f, const double *x, int count, double t)
{
    double value = f[count - 1];
    for (int i = count - 2; i >= 0; i--)
        value = f[i] + (t - x[i]) * value;
    return value;
}

/* A contact whose units are 1. */
static inline nt_status nt_bank_prepare(double lambda, nt_maugis *maugis)
{
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
    return nt_maugis_init_lambda(maugis, &contact, lambda);
}

#endif
