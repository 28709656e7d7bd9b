/* SPDX-License-Identifier: BSD-3-Clause
 * The tip on its lever is moved by Delta after first touch: how much goes into the sample, how much bends the lever?
 * (paper, Sec. III-B, Eq. 5-8). delta = Delta - zeta cos(alpha) and P = k_c zeta give
 *
 *     Delta = delta + q P(delta),     q = cos(alpha)/k_c,                                                  (balance)
 *
 * which grows with delta and so has one solution. One of the two terms is at least Delta/2, neither more than Delta:
 * that brackets delta within a small factor whatever the stiffnesses. */
#include <math.h>
#include <stddef.h>

#include "core/roots.h"
#include "internal/geometry.h"
#include "nanotouch/advanced/geometry.h"

#define SMALLEST 1e-100 /* [m]; below it the terms of (balance) lose digits to denormals */

typedef struct {
    const nt_shape *shape;
    double effective_modulus, q, displacement;
} balance;

static double residual(double indentation, const void *context)
{
    const balance *b = context;
    const double F = nt_shape_eval(b->shape, b->effective_modulus, indentation).F;
    return indentation + b->q * F - b->displacement;
}

/* The lesser of Delta and the indentation at which the lever alone takes Delta. */
static double end_of_bracket(const balance *b, double displacement)
{
    return fmin(displacement, nt_shape_indentation(b->shape, b->effective_modulus, displacement / b->q));
}

nt_status nt_stage_displacement_solve(const nt_shape *shape, double effective_modulus, const nt_lever *lever,
                                      double displacement, nt_stage_displacement *solved)
{
    if (!isfinite(displacement) || !isfinite(effective_modulus) || !isfinite(lever->spring_constant) ||
        !isfinite(lever->angle))
        return NT_E_NOT_FINITE;
    if (!(effective_modulus > 0.0 && lever->spring_constant > 0.0 && lever->angle >= 0.0 && lever->angle < 0.5 * NT_PI))
        return NT_E_RANGE;
    if (displacement <= 0.0) {
        *solved = (nt_stage_displacement){0};
        return NT_OK;
    }
    if (displacement < SMALLEST)
        return NT_E_RANGE;
    const balance b = {shape, effective_modulus, cos(lever->angle) / lever->spring_constant, displacement};
    const double bracket[2] = {(1.0 - 1e-9) * end_of_bracket(&b, 0.5 * displacement),
                               (1.0 + 1e-9) * end_of_bracket(&b, displacement)};
    double indentation;
    const nt_status status = nt_root_find(residual, &b, bracket, &indentation, NULL);
    if (status != NT_OK)
        return status;
    const nt_law_value value = nt_shape_eval(shape, effective_modulus, indentation);
    *solved = (nt_stage_displacement){indentation, value.F / lever->spring_constant, value};
    return NT_OK;
}

double nt_stage_displacement_approximate(const nt_contact *contact, const nt_lever *lever, double displacement)
{
    if (displacement <= 0.0)
        return 0.0;
    const double radius = sqrt(2.0 * displacement) * sqrt(contact->radius);
    const double stiffness = 4.0 / 3.0 * contact->effective_modulus * cos(lever->angle) * radius;
    return lever->spring_constant / (lever->spring_constant + stiffness) * displacement;
}
