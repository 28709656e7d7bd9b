/* SPDX-License-Identifier: BSD-3-Clause
 * Sneddon 1965: a rigid sphere of radius R on an elastic half-space, for any a < R. His
 *
 *     delta = a/2 ln((R + a)/(R - a))     F = E* ((a^2 + R^2)/2 ln((R + a)/(R - a)) - a R)
 *
 * are, with a = R tanh(u), t = tanh(u), in units of R and E*,
 *
 *     delta = u t     F = (u - t) + u t^2     U = t g^2 - 2 g G1 + G2                                      (sphere)
 *     g = u t         G1 = Int_0^t g dx = (t^2 u - (u - t))/2         G2 = Int_0^t g^2 dx
 *
 * where only u - t and G2 need care. For a -> 0: Hertz times 1 - delta/(10 R). */
#include "contact/shapes/profile.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "core/roots.h"
#include "nanotouch/material.h"

#define SMALL 1e-9 /* its square is below the last bit */

enum { FRACTION_DEPTH = 11, MAX_TERMS = 60 };

/* u - tanh(u) without cancellation: for u <= 1 from Lambert's fraction tanh(u) = u/(1 + q), q = u^2/(3 + u^2/(5 +
 * ...)), of which 11 levels give the last bit. */
static double above_tanh(double u)
{
    if (u > 1.0)
        return u - tanh(u);
    double q = 0.0;
    for (int i = FRACTION_DEPTH; i > 0; i--)
        q = u * u / (2 * i + 1 + q);
    return u * q / (1.0 + q);
}

/* Int_0^u v tanh(v) dv = u^2/2 - Int_0^u 2 v/(exp(2 v) + 1) dv, by the dilogarithm of -exp(-2 u), for u > 0.5. */
static double integral_of_v_tanh(double u)
{
    const double z = exp(-2.0 * u);
    double dilogarithm = 0.0, power = -z;
    for (int n = 1; n <= MAX_TERMS && fabs(power) > 0.1 * DBL_EPSILON; n++, power *= -z)
        dilogarithm += power / (n * n);
    return 0.5 * u * u - (NT_PI * NT_PI / 24.0 - u * log1p(z) + 0.5 * dilogarithm);
}

/* G2 = Int_0^t x^2 artanh(x)^2 dx; small t: artanh(x)^2 = Sum_n (1 + 1/3 + .. + 1/(2n - 1)) x^(2n)/n. */
static double second_moment(double u, double t, double first_moment)
{
    if (t > 0.5)
        return t * t * t * u * u / 3.0 + 2.0 / 3.0 * (first_moment - integral_of_v_tanh(u));
    double sum = 0.0, harmonic = 0.0, power = t * t * t;
    for (int n = 1; n <= MAX_TERMS; n++) {
        power *= t * t;
        harmonic += 1.0 / (2 * n - 1);
        const double term = harmonic / n * power / (2 * n + 3);
        sum += term;
        if (term <= 0.1 * DBL_EPSILON * sum)
            break;
    }
    return sum;
}

static double reduced_force(double u)
{
    const double t = tanh(u);
    return above_tanh(u) + u * t * t; /* F/(E* R^2) */
}

nt_profile_point nt_sphere_point(double u)
{
    const double t = tanh(u), g = u * t;
    const double first = 0.5 * (t * g - above_tanh(u)), second = second_moment(u, t, first);
    return (nt_profile_point){
        .radius = t,
        .depth = g,
        .force = 0.5 * reduced_force(u),
        .energy = t * g * g - 2.0 * g * first + second,
    };
}

static double depth_residual(double u, const void *depth)
{
    return u * tanh(u) - *(const double *)depth;
}

static double force_residual(double u, const void *force)
{
    return reduced_force(u) - *(const double *)force;
}

/* lo is the root of the leading term; below SMALL that is all there is, and the residual would be lost in denormals.
 * The bracket is widened by more than rounding can move its ends. */
static double root_between(nt_scalar_function *f, double value, double lo, double hi)
{
    double u = NAN;
    if (lo < SMALL)
        return lo;
    const double bracket[2] = {lo * (1.0 - 1e-12), hi * (1.0 + 1e-12)};
    return nt_root_find(f, &value, bracket, &u, NULL) == NT_OK ? u : (double)NAN;
}

/* u tanh(u) <= min(u, u^2), and >= u^2/(1 + u). */
double nt_sphere_find_depth(double depth)
{
    const double root = sqrt(depth);
    return root_between(depth_residual, depth, fmax(root, depth), 0.5 * (depth + root * sqrt(depth + 4.0)));
}

/* F/(E* R^2) <= min(2 u, 4/3 u^3), and > u tanh(u)^2 >= min(u, u^3)/1.8. */
double nt_sphere_find_force(double force)
{
    const double F = 2.0 * force;
    return root_between(force_residual, F, fmax(cbrt(0.75 * F), 0.5 * F), fmax(cbrt(1.8 * F), 1.8 * F));
}
