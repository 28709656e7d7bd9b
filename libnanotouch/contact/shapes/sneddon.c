/* SPDX-License-Identifier: BSD-3-Clause
 * Sneddon 1965: rigid axisymmetric punches on an elastic half-space without adhesion. */
#include "internal/contact.h"
#include "nanotouch/contact.h"
#include "nanotouch/material.h"

#include <math.h>

nt_law_value nt_cone_eval(double effective_modulus, double half_angle, double indentation)
{
    if (indentation <= 0.0)
        return (nt_law_value){0};
    const double a = 2.0 / NT_PI * tan(half_angle) * indentation;
    const double k = 2.0 * effective_modulus * a;
    const double F = 0.5 * k * indentation;
    return (nt_law_value){.U = F * indentation / 3.0, .F = F, .k = k, .a = a};
}

nt_law_value nt_punch_eval(double effective_modulus, double radius, double indentation)
{
    if (indentation <= 0.0)
        return (nt_law_value){0};
    const double k = 2.0 * effective_modulus * radius;
    const double F = k * indentation;
    return (nt_law_value){.U = 0.5 * F * indentation, .F = F, .k = k, .a = radius};
}
