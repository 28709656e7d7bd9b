/* SPDX-License-Identifier: BSD-3-Clause
 * Private: Hertz' law inline, for what evaluates it several times in each period. */
#ifndef NANOTOUCH_CONTACT_HERTZ_H
#define NANOTOUCH_CONTACT_HERTZ_H

#include <math.h>

#include "nanotouch/advanced/geometry.h"
#include "nanotouch/contact.h"

static inline nt_law_value nt_hertz_law(double radius, double effective_modulus, double indentation)
{
    if (indentation <= 0.0)
        return (nt_law_value){0};
    const double a = sqrt(radius) * sqrt(indentation);
    const double k = 2.0 * effective_modulus * a;
    const double F = 2.0 / 3.0 * k * indentation;
    return (nt_law_value){.U = 0.4 * F * indentation, .F = F, .k = k, .a = a};
}

/* nt_shape_eval, without a call where the shape is a paraboloid. */
static inline nt_law_value nt_shape_law(const nt_shape *shape, double effective_modulus, double indentation)
{
    if (shape->kind == NT_SHAPE_PARABOLOID && indentation < HUGE_VAL)
        return nt_hertz_law(shape->radius, effective_modulus, indentation);
    return nt_shape_eval(shape, effective_modulus, indentation);
}

#endif
