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
 * Before (Griffith) is used, U is stationary in b at constant d; so at constant d only what stands beside b counts:
 *
 *     dU/dlambda = b^3 (b e1 + 4/3 lambda e3)         e3 = 2 e2 - g3                                 (energy slope)
 *
 * None of the g, e is evaluated as written where that cancels: for y > 1 they are written in s = 1/y, z = s^2 and
 * A(z) = (s - atan s)/s^3, a smooth function. */
#include "contact/maugis/branch.h"

#include <math.h>

#include "contact/maugis/functions.h"
#include "core/same_bits.h"
#include "internal/contact.h"

void nt_maugis_equilibrium_at(double lambda, double y, nt_maugis_equilibrium *point)
{
    *point = nt_maugis_equilibrium_of(lambda, nt_maugis_functions_at(y));
}

/* With N = lambda/2 h1 b + 4/3 lambda^2 h2, so that b1 = -b N/D, and D D' = B B' + lambda g1'. */
double nt_maugis_equilibrium_curvature(double lambda, const nt_maugis_equilibrium *point)
{
    const nt_maugis_functions f = nt_maugis_functions_at(point->y);
    const double linear = 4.0 / 3.0 * lambda * lambda, y = f.y, b = point->b, b1 = point->b1, w = 1.0 + y * y;
    const double root = sqrt(w), rho = 1.0 / (y + root);
    const double h1_y = 4.0 / (w * w), h2_y = rho / w * (1.0 / root + 2.0 * y / w);
    const double B = linear * f.g2, D = sqrt(B * B + 2.0 * lambda * f.g1);
    const double N = 0.5 * lambda * f.h1 * b + linear * f.h2;
    const double b_y = y * b1, D_y = y * (B * linear * f.h2 + lambda * f.h1) / D;
    const double N_y = 0.5 * lambda * (h1_y * b + f.h1 * b_y) + linear * h2_y;
    const double b1_y = (-b_y * N - b * N_y + b * N * D_y / D) / D;
    return 2.0 * b_y * point->a1 + 2.0 * b * (3.0 * b_y + y * y * b1_y) - 4.0 / 3.0 * lambda * b1_y;
}

typedef struct {
    double e1, e3;
} energy_shape;

static energy_shape energy_shape_at(double y)
{
    const nt_maugis_functions f = nt_maugis_functions_at(y);
    const double s = f.s, z = f.z, r = f.r, A = f.A, t = 0.5 * f.h3;
    if (y <= 1.0) {
        const double rho = 1.0 / (y + r);
        return (energy_shape){
            .e1 = 0.75 * z * (y - z * t) - 0.5 * z * t + 0.25 * (y + t),
            .e3 = (1.0 + z) * t - y - 2.0 / 3.0 * rho * rho * (2.0 * r + y),
        };
    }
    return (energy_shape){
        .e1 = 0.25 * (y * (3.0 * A - 1.0) + s * (1.0 + 2.0 * A - z * A)),
        .e3 = s * (1.0 - A * (1.0 + z) - 2.0 / 3.0 * (2.0 * r + 1.0) / ((1.0 + r) * (1.0 + r))),
    };
}

double nt_maugis_equilibrium_energy(double lambda, const nt_maugis_equilibrium *point)
{
    return nt_maugis_energy_of(lambda, point, nt_maugis_functions_at(point->y));
}

double nt_maugis_equilibrium_energy_slope(double lambda, const nt_maugis_equilibrium *point)
{
    const energy_shape f = energy_shape_at(point->y);
    const double b = point->b;
    return b * b * b * (b * f.e1 + 4.0 / 3.0 * lambda * f.e3);
}

double nt_maugis_parameter_guess(double lambda, double a)
{
    /* (Griffith) with g1 ~ 4/(3 (y + 0.85)), g2 ~ 1/(2 (y + 0.85)), right at both ends: y^3 + 0.85 y^2 = 2 p y + 3 q */
    const double p = lambda * lambda * a / 3.0, q = 2.0 / 9.0 * lambda * a * a;
    double y =
        4.0 * p / (0.85 + sqrt(0.7225 + 8.0 * p)) + fmin(cube_root(3.0 * q), sqrt(3.0 * q / 0.85)); /* not below it */
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
