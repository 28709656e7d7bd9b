/* SPDX-License-Identifier: BSD-3-Clause
 * A cone whose apex is cut off flat or rounded by a paraboloid, both at the radius b of the rim; contact beyond the
 * rim, a >= b (Briscoe, Sebastian, Adams, J. Phys. D 27 (1994) 1156). Theirs
 *
 *     delta = (a/R)(a - s) + cot(psi) a phi,     s = sqrt(a^2 - b^2), phi = arccos(b/a)
 *
 * and the force become free of cancellation with a = b cosh(w): s = b sinh(w), phi = gd(w), a - s = b e, e = exp(-w).
 * In units of b, with slopes rho = b/R of the cap and theta = cot(psi) of the flank, c = cosh(w), s = sinh(w):
 *
 *     delta       = rho c e + theta phi c
 *     F/(2 E*)    = rho e^2 (c - e/3) + theta (phi c^2 + s)/2
 *     U/E*        = rho^2 (2/15 + e^3/3 + e^5/15)
 *                 + rho theta (J/4 + phi (5/16 + 5 e^2/12 + 5 e^4/48) - (1 - e)/8 + 5 (1 - e^3)/24)
 *                 + theta^2/3 (phi^2 c^3 + 2 phi c s + (c - 1) - J),            J = Int_0^w gd(v) dv           (energy)
 *
 * where U is 8/15 rho^2, Hertz, at w = 0, and then Int F ddelta. */
#include "contact/shapes/profile.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

#include "core/roots.h"
#include "nanotouch/material.h"

#define CATALAN 0.91596559417721901505

#define SMALL 1e-9 /* its square is below the last bit */

enum { MAX_TERMS = 60 };

/* gd(w) = 2 arctan(tanh(w/2)) */
static double gudermann(double w)
{
    return 2.0 * atan(tanh(0.5 * w));
}

/* Int_0^w gd(v) dv: with q = tanh(w/2), 4 Sum_n (1 - 1/3 + .. +- 1/(2n+1)) q^(2n+2)/(2n+2); for q > sqrt(2) - 1 from
 * the other end, pi/2 w - 2 (Ti2(1) - Ti2(e)), Ti2(e) = e - e^3/9 + e^5/25 - ..., Ti2(1) Catalan's constant. */
static double gudermann_integral(double w)
{
    const double q = tanh(0.5 * w), e = exp(-w);
    double sum = 0.0;
    if (q > 0.41421356) {
        double power = e;
        for (int n = 0; n < MAX_TERMS && fabs(power) > 0.1 * DBL_EPSILON; n++, power *= -e * e)
            sum += power / ((2 * n + 1) * (2 * n + 1));
        return 0.5 * NT_PI * w - 2.0 * (CATALAN - sum);
    }
    double power = 1.0, leibniz = 0.0, sign = 1.0;
    for (int n = 0; n < MAX_TERMS; n++, sign = -sign) {
        power *= q * q;
        leibniz += sign / (2 * n + 1);
        const double term = 4.0 * leibniz * power / (2 * n + 2);
        sum += term;
        if (term <= 0.1 * DBL_EPSILON * sum)
            break;
    }
    return sum;
}

static double depth_at(const nt_rim *rim, double w)
{
    return 0.5 * rim->cap * (1.0 + exp(-2.0 * w)) + rim->flank * gudermann(w) * cosh(w);
}

static double force_at(const nt_rim *rim, double w)
{
    const double c = cosh(w), e = exp(-w);
    return rim->cap * e * e * (c - e / 3.0) + 0.5 * rim->flank * (gudermann(w) * c * c + sinh(w));
}

static double energy_at(const nt_rim *rim, double w)
{
    const double c = cosh(w), s = sinh(w), half = sinh(0.5 * w), e = exp(-w), e2 = e * e, e3 = e2 * e;
    const double phi = gudermann(w), J = gudermann_integral(w);
    const double cap = 2.0 / 15.0 + e3 / 3.0 + e2 * e3 / 15.0;
    const double mixed = 0.25 * J + phi * (0.3125 + e2 / 2.4 + e2 * e2 / 9.6) + expm1(-w) / 8.0 - expm1(-3.0 * w) / 4.8;
    const double flank = (phi * phi * c * c * c + 2.0 * phi * c * s + (2.0 * half * half - J)) / 3.0;
    return rim->cap * rim->cap * cap + rim->cap * rim->flank * mixed + rim->flank * rim->flank * flank;
}

nt_profile_point nt_rim_point(const nt_rim *rim, double w)
{
    return (nt_profile_point){cosh(w), depth_at(rim, w), force_at(rim, w), energy_at(rim, w)};
}

typedef struct {
    const nt_rim *rim;
    double value;
} target;

static double depth_residual(double w, const void *context)
{
    const target *t = context;
    return depth_at(t->rim, w) - t->value;
}

static double force_residual(double w, const void *context)
{
    const target *t = context;
    return force_at(t->rim, w) - t->value;
}

/* Both depth and force grow from w = 0 on and are at least theta sinh(w), because gd(w) >= tanh(w). The end is widened
 * by more than rounding can move it. */
static double root_of(nt_scalar_function *f, const nt_rim *rim, double value)
{
    const target context = {rim, value};
    const double end = asinh(value / rim->flank), bracket[2] = {0.0, (1.0 + 1e-12) * end};
    double w = NAN;
    if (f(0.0, &context) >= 0.0)
        return 0.0; /* the rim itself, within rounding */
    if (rim->cap == 0.0 && end < SMALL)
        return end; /* the next term is of the order w^2 */
    return nt_root_find(f, &context, bracket, &w, NULL) == NT_OK ? w : (double)NAN;
}

double nt_rim_find_depth(const nt_rim *rim, double depth)
{
    return root_of(depth_residual, rim, depth);
}

double nt_rim_find_force(const nt_rim *rim, double force)
{
    return root_of(force_residual, rim, force);
}
