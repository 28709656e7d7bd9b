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

#include <math.h>
#include <stddef.h>

#include "core/roots.h"
#include "core/same_bits.h"
#include "nanotouch/material.h"

#define SMALL 1e-9 /* its square is below the last bit */

enum { FRACTION_DEPTH = 11, MOMENT_TERMS = 25, DILOGARITHM_TERMS = 30 };

/* (1 + 1/3 + .. + 1/(2n - 1))/(n (2n + 3)) and (-1)^n/n^2, n = 1, 2, ..: as many as reach the last bit at t = 0.5, so
 * that all depths cost the same. */
static const double moment[MOMENT_TERMS] = {0.2,
                                            0.09523809523809523,
                                            0.056790123456790124,
                                            0.0380952380952381,
                                            0.027496947496947498,
                                            0.0208690075356742,
                                            0.01642969542129206,
                                            0.01330131856447646,
                                            0.011008592334456013,
                                            0.009275024044171978,
                                            0.007930453010104008,
                                            0.006865286539037555,
                                            0.0060062409513214,
                                            0.00530274164904425,
                                            0.0047189346147593824,
                                            0.004228804819325042,
                                            0.003813090189388003,
                                            0.0034572723044109435,
                                            0.0031502338699916682,
                                            0.002883340942284343,
                                            0.002649802597107909,
                                            0.002444215926712246,
                                            0.002262237347331575,
                                            0.002100341573682488,
                                            0.0019556424524171108};
static const double dilogarithm[DILOGARITHM_TERMS] = {-1.0,
                                                      0.25,
                                                      -0.1111111111111111,
                                                      0.0625,
                                                      -0.04,
                                                      0.027777777777777776,
                                                      -0.02040816326530612,
                                                      0.015625,
                                                      -0.012345679012345678,
                                                      0.01,
                                                      -0.008264462809917356,
                                                      0.006944444444444444,
                                                      -0.005917159763313609,
                                                      0.00510204081632653,
                                                      -0.0044444444444444444,
                                                      0.00390625,
                                                      -0.0034602076124567475,
                                                      0.0030864197530864196,
                                                      -0.002770083102493075,
                                                      0.0025,
                                                      -0.0022675736961451248,
                                                      0.002066115702479339,
                                                      -0.001890359168241966,
                                                      0.001736111111111111,
                                                      -0.0016,
                                                      0.0014792899408284023,
                                                      -0.0013717421124828531,
                                                      0.0012755102040816326,
                                                      -0.0011890606420927466,
                                                      0.0011111111111111111};

/* Sum_n c_n x^n, n = 1 .. count */
static double series(const double *c, int count, double x)
{
    double sum = 0.0;
    for (int n = count - 1; n >= 0; n--)
        sum = (sum + c[n]) * x;
    return sum;
}

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

/* Int_0^u v tanh(v) dv = u^2/2 - Int_0^u 2 v/(exp(2 v) + 1) dv, by the dilogarithm of -exp(-2 u), for tanh(u) > 0.5. */
static double integral_of_v_tanh(double u)
{
    const double z = exp(-2.0 * u);
    return 0.5 * u * u - (NT_PI * NT_PI / 24.0 - u * log1p(z) + 0.5 * series(dilogarithm, DILOGARITHM_TERMS, z));
}

/* G2 = Int_0^t x^2 artanh(x)^2 dx; small t: artanh(x)^2 = Sum_n (1 + 1/3 + .. + 1/(2n - 1)) x^(2n)/n. */
static double second_moment(double u, double t, double first_moment)
{
    if (t > 0.5)
        return t * t * t * u * u / 3.0 + 2.0 / 3.0 * (first_moment - integral_of_v_tanh(u));
    return t * t * t * series(moment, MOMENT_TERMS, t * t);
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

/* u^2 = d + d^2/3 + 4/45 d^3 + .., and d^2 for large d: a start within 11 %, from which three of Halley's steps reach
 * the last bit. */
double nt_sphere_find_depth(double depth)
{
    double u = sqrt(depth) * sqrt(depth + (15.0 - 8.0 * depth) / (15.0 + 2.0 * depth));
    for (int i = 0; i < 3 && u >= SMALL; i++) {
        const double t = tanh(u), s = 1.0 - t * t, f = u * t - depth, slope = t + u * s;
        u -= f * slope / (slope * slope - f * s * (1.0 - u * t));
    }
    return u;
}

/* F/(E* R^2) <= min(2 u, 4/3 u^3), and > u tanh(u)^2 >= min(u, u^3)/1.8. */
double nt_sphere_find_force(double force)
{
    const double F = 2.0 * force;
    return root_between(force_residual, F, fmax(cube_root(0.75 * F), 0.5 * F), fmax(cube_root(1.8 * F), 1.8 * F));
}
