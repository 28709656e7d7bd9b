/* SPDX-License-Identifier: BSD-3-Clause
 * The contact branch of Maugis-Dugdale as an explicit function of one parameter.
 *
 * Maugis (1992) gives the branch by two equations in the contact radius a and m = c/a (paper, Eq. 11). The double m is
 * useless for large lambda (m - 1 ~ 1/lambda^2) and infinite at a = 0. With y = 1/sqrt(m^2 - 1) = a/b, b^2 = c^2 - a^2,
 * t = acot(y), the first of them is a quadratic equation in b,
 *
 *     lambda g1/2 b^2 + 4/3 lambda^2 g2 b = 1                                                    (Griffith)
 *     g1 = y + (1 - y^2) t       g2 = t - sqrt(1 + y^2) + y       g3 = y + (1 + y^2) t
 *
 * and everything else is explicit:
 *
 *     a = b y                    d = a^2 - 4/3 lambda b                P = a^3 - lambda b^2 g3
 *
 * y runs from 0 (a = 0) to infinity; a, b and c grow with it and no fold is singular in it. The energy is that of the
 * elastic half-spaces and of the Dugdale zone, integrated in closed form:
 *
 *     U = 2/5 a^5 - 4/3 lambda b a^3 + 4/3 lambda^2 b^3 e2 + lambda b^4 e1 - c^2                     (energy)
 *     e1 = 3/4 (y^3 - y^4 t) - y^2 t/2 + y/4 + t/4
 *     e2 = (1 + y^2) t - rho^2 (2 sqrt(1 + y^2) + y)/3            rho = (c - a)/b = 1/(y + sqrt(1 + y^2))
 *
 * None of the g, e is evaluated as written where that cancels: for y > 1 they are written in s = 1/y, z = s^2 and
 * A(z) = (s - atan s)/s^3, a smooth function. */
#include "contact/maugis_branch.h"

#include <math.h>

#include "nanotouch/material.h"

/* The functions of y alone. h_ is a derivative divided by y. */
typedef struct {
    double g1, g2, g3, h1, h2, h3, e1, e2;
} shape;

/* A(z) = (sqrt z - atan sqrt z)/z^1.5 for 0 <= z <= 1: rational, relative error 2e-18 (tools/atan_remainder.py);
 * all coefficients are positive, so no digit is lost. */
static double atan_remainder(double z)
{
    static const double p[] = {0.33333333333333333269, 0.89753142249164606048, 0.90255503950262442214,
                               0.41962484723364303455, 0.090347769522929705136, 0.0078225122517582919307,
                               0.00017783239716051294998};
    static const double q[] = {1.0, 3.2925942674749374172, 4.2546502504214592304, 2.7338861963678550326,
                               0.91275764028099955614, 0.15046233412860960892, 0.010394739130883634284,
                               0.00019430015082409358464};
    const double numerator = p[0] + z * (p[1] + z * (p[2] + z * (p[3] + z * (p[4] + z * (p[5] + z * p[6])))));
    const double denominator =
        q[0] + z * (q[1] + z * (q[2] + z * (q[3] + z * (q[4] + z * (q[5] + z * (q[6] + z * q[7]))))));
    return numerator / denominator;
}

static shape shape_below_one(double y)
{
    const double z = y * y, r = sqrt(1.0 + z), remainder = atan_remainder(z);
    const double t = 0.5 * NT_PI - y * (1.0 - z * remainder);
    const double rho = 1.0 / (y + r);
    return (shape){
        .g1 = y + (1.0 - z) * t,
        .g2 = t - rho,
        .g3 = y + (1.0 + z) * t,
        .h1 = -2.0 * (t - y / (1.0 + z)),
        .h2 = -rho / (1.0 + z),
        .h3 = 2.0 * t,
        .e1 = 0.75 * z * (y - z * t) - 0.5 * z * t + 0.25 * (y + t),
        .e2 = (1.0 + z) * t - rho * rho * (2.0 * r + y) / 3.0,
    };
}

static shape shape_above_one(double y)
{
    const double s = 1.0 / y, z = s * s, r = sqrt(1.0 + z), A = atan_remainder(z);
    const double t = s * (1.0 - z * A);
    const double rho = s / (1.0 + r);
    return (shape){
        .g1 = s * (1.0 + A * (1.0 - z)),
        .g2 = s * (r / (1.0 + r) - z * A),
        .g3 = y + (t + (y - s * A)),
        .h1 = -2.0 * s * z * (1.0 / (1.0 + z) - A),
        .h2 = -z * s / (r * r * (1.0 + r)),
        .h3 = 2.0 * t,
        .e1 = 0.25 * (y * (3.0 * A - 1.0) + s * (1.0 + 2.0 * A - z * A)),
        .e2 = y * (1.0 + z) * (1.0 - z * A) - rho * rho * (2.0 * r + 1.0) * y / 3.0,
    };
}

static shape shape_at(double y)
{
    return y <= 1.0 ? shape_below_one(y) : shape_above_one(y);
}

void nt_maugis_equilibrium_at(double lambda, double y, nt_maugis_equilibrium *point)
{
    const shape f = shape_at(y);
    const double linear = 4.0 / 3.0 * lambda * lambda;
    const double B = linear * f.g2, D = sqrt(B * B + 2.0 * lambda * f.g1);
    const double b = 2.0 / (B + D), a = b * y;
    const double b1 = -b * (0.5 * lambda * f.h1 * b + linear * f.h2) / D; /* (db/dy)/y, by differentiating (Griffith) */
    const double da = b + y * y * b1;
    *point = (nt_maugis_equilibrium){
        .y = y,
        .a = a,
        .b = b,
        .P = a * a * a - lambda * b * b * f.g3,
        .d = a * a - 4.0 / 3.0 * lambda * b,
        .P1 = 3.0 * b * a * da - lambda * b * (2.0 * b1 * f.g3 + b * f.h3),
        .d1 = 2.0 * b * da - 4.0 / 3.0 * lambda * b1,
    };
}

double nt_maugis_equilibrium_energy(double lambda, const nt_maugis_equilibrium *point)
{
    const shape f = shape_at(point->y);
    const double a = point->a, b = point->b, a2 = a * a, b2 = b * b;
    return 0.4 * a2 * a2 * a - 4.0 / 3.0 * lambda * b * a2 * a + 4.0 / 3.0 * lambda * lambda * b2 * b * f.e2 +
           lambda * b2 * b2 * f.e1 - (a2 + b2);
}

double nt_maugis_parameter_guess(double lambda, double a)
{
    /* (Griffith) with g1 ~ 4/(3 (y + 0.85)), g2 ~ 1/(2 (y + 0.85)), right at both ends: y^3 + 0.85 y^2 = 2 p y + 3 q */
    const double p = lambda * lambda * a / 3.0, q = 2.0 / 9.0 * lambda * a * a;
    double y = 4.0 * p / (0.85 + sqrt(0.7225 + 8.0 * p)) + fmin(cbrt(3.0 * q), sqrt(3.0 * q / 0.85)); /* not below it */
    for (int i = 0; i < 2; i++) /* Newton from above, convex: it stays above */
        y = (2.0 * y * y * y + 0.85 * y * y + 3.0 * q) / (3.0 * y * y + 1.7 * y - 2.0 * p);
    return y;
}

nt_status nt_maugis_at(double lambda, double y, nt_maugis_point *point)
{
    if (!isfinite(lambda) || !isfinite(y))
        return NT_E_NOT_FINITE;
    if (lambda <= 0.0 || y < 0.0)
        return NT_E_RANGE;
    nt_maugis_equilibrium state;
    nt_maugis_equilibrium_at(lambda, y, &state);
    *point = (nt_maugis_point){
        .a = state.a,
        .P = state.P,
        .d = state.d,
        .U = nt_maugis_equilibrium_energy(lambda, &state),
        .dP_dy = state.P1 * y,
        .dd_dy = state.d1 * y,
    };
    return NT_OK;
}
