/* SPDX-License-Identifier: BSD-3-Clause
 * The functions of the branch parameter y alone of which the contact branch of Maugis-Dugdale is made (maugis/branch.c
 * has the derivation); private to contact/. With s = y for y <= 1 and 1/y above, z = s^2, t = acot(y) and
 * A(z) = (s - atan s)/s^3 no form cancels. Written without a jump, so that a loop over it can be vectorised. */
#ifndef NANOTOUCH_CONTACT_MAUGIS_FUNCTIONS_H
#define NANOTOUCH_CONTACT_MAUGIS_FUNCTIONS_H

#include <math.h>

#include "contact/maugis/branch.h"
#include "nanotouch/material.h"

/* h_ is a derivative divided by y. */
typedef struct nt_maugis_functions {
    double y, s, z, r, A; /* r = sqrt(1 + z) */
    double g1, g2, g3, h1, h2, h3;
} nt_maugis_functions;

/* A(z) = (sqrt z - atan sqrt z)/z^1.5 for 0 <= z <= 1: rational, relative error 2e-18 (tools/atan_remainder.py);
 * all coefficients are positive, so no digit is lost. */
static inline double nt_maugis_atan_remainder(double z)
{
    const double z2 = z * z, z4 = z2 * z2; /* in pairs: shorter chains than Horner's */
    const double numerator =
        (0.33333333333333333269 + z * 0.89753142249164606048) +
        z2 * (0.90255503950262442214 + z * 0.41962484723364303455) +
        z4 * ((0.090347769522929705136 + z * 0.0078225122517582919307) + z2 * 0.00017783239716051294998);
    const double denominator = (1.0 + z * 3.2925942674749374172) +
                               z2 * (4.2546502504214592304 + z * 2.7338861963678550326) +
                               z4 * ((0.91275764028099955614 + z * 0.15046233412860960892) +
                                     z2 * (0.010394739130883634284 + z * 0.00019430015082409358464));
    return numerator / denominator;
}

static inline nt_maugis_functions nt_maugis_functions_at(double y)
{
    const int low = y <= 1.0;
    const double s = low ? y : 1.0 / y, z = s * s, w = 1.0 + z, r = sqrt(w), A = nt_maugis_atan_remainder(z);
    const double arc = s * (1.0 - z * A); /* atan(s) */
    const double t = low ? 0.5 * NT_PI - arc : arc;
    const double quotient = 1.0 / (w * (1.0 + r)); /* one division for two */
    const double inverse = (1.0 + r) * quotient, half = w * quotient;
    const double rho = r - s; /* = 1/(r + s) for y <= 1: the difference does not cancel */
    return (nt_maugis_functions){
        .y = y,
        .s = s,
        .z = z,
        .r = r,
        .A = A,
        .g1 = low ? y + (1.0 - z) * t : s * (1.0 + A * (1.0 - z)),
        .g2 = low ? t - rho : s * (r * half - z * A),
        .g3 = low ? y + w * t : y + (t + (y - s * A)),
        .h1 = low ? -2.0 * (t - y * inverse) : -2.0 * s * z * (inverse - A),
        .h2 = low ? -rho * inverse : -z * s * quotient,
        .h3 = 2.0 * t,
    };
}

/* The equilibrium that belongs to it: an explicit root of (Griffith), then the rest. */
static inline nt_maugis_equilibrium nt_maugis_equilibrium_of(double lambda, nt_maugis_functions f)
{
    const double linear = 4.0 / 3.0 * lambda * lambda, y = f.y;
    const double B = linear * f.g2, D = sqrt(B * B + 2.0 * lambda * f.g1);
    const double b = 2.0 / (B + D), a = b * y;
    const double b1 = -b * (0.5 * lambda * f.h1 * b + linear * f.h2) / D; /* (db/dy)/y, by differentiating (Griffith) */
    const double a1 = b + y * y * b1;
    return (nt_maugis_equilibrium){
        .y = y,
        .a = a,
        .b = b,
        .P = a * a * a - lambda * b * b * f.g3,
        .d = a * a - 4.0 / 3.0 * lambda * b,
        .P1 = 3.0 * b * a * a1 - lambda * b * (2.0 * b1 * f.g3 + b * f.h3),
        .d1 = 2.0 * b * a1 - 4.0 / 3.0 * lambda * b1,
        .a1 = a1,
        .b1 = b1,
    };
}

/* Its energy: (energy) in branch.c. `f` is of the same y. */
static inline double nt_maugis_energy_of(double lambda, const nt_maugis_equilibrium *point, nt_maugis_functions f)
{
    const int low = f.y <= 1.0;
    const double y = f.y, s = f.s, z = f.z, r = f.r, A = f.A, t = 0.5 * f.h3;
    const double rho = (low ? 1.0 : s) / ((low ? y : 1.0) + r);
    const double e1 = low ? 0.75 * z * (y - z * t) - 0.5 * z * t + 0.25 * (y + t)
                          : 0.25 * (y * (3.0 * A - 1.0) + s * (1.0 + 2.0 * A - z * A));
    const double e2 = low ? (1.0 + z) * t - rho * rho * (2.0 * r + y) / 3.0
                          : y * (1.0 + z) * (1.0 - z * A) - rho * rho * (2.0 * r + 1.0) * y / 3.0;
    const double a = point->a, b = point->b, a2 = a * a, b2 = b * b;
    return 0.4 * a2 * a2 * a - 4.0 / 3.0 * lambda * b * a2 * a + 4.0 / 3.0 * lambda * lambda * b2 * b * e2 +
           lambda * b2 * b2 * e1 - (a2 + b2);
}

#endif
