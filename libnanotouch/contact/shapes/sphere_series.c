/* SPDX-License-Identifier: BSD-3-Clause
 * A sphere on a half-space without adhesion, cheaply: a power series where it converges, the exact law beyond. */
#include <math.h>

#include "internal/geometry.h"
#include "nanotouch/advanced/geometry.h"

/* delta/R = t^2 (1 + t^2/3 + t^4/5 + ...) inverted: t = sqrt(delta/R) Sum_n c_n (delta/R)^n; F and U are integrals of
 * 2 E* a = 2 E* R t, term by term. */
#define SERIES(C)                                                                                                      \
    {C(0, 1.0),                                                                                                        \
     C(1, -1.0 / 6.0),                                                                                                 \
     C(2, -1.0 / 360.0),                                                                                               \
     C(3, 11.0 / 5040.0),                                                                                              \
     C(4, 1357.0 / 1814400.0),                                                                                         \
     C(5, 2593.0 / 23950080.0),                                                                                        \
     C(6, -2345599.0 / 130767436800.0),                                                                                \
     C(7, -6861887.0 / 435891456000.0)}
#define OF_RADIUS(n, c) (c)
#define OF_FORCE(n, c) ((c) / (n + 1.5))
#define OF_ENERGY(n, c) ((c) / (n + 1.5) / (n + 2.5))

/* In pairs: a shorter chain than Horner's. */
static double polynomial(const double c[8], double x)
{
    const double x2 = x * x;
    return ((c[0] + x * c[1]) + x2 * (c[2] + x * c[3])) + x2 * x2 * ((c[4] + x * c[5]) + x2 * (c[6] + x * c[7]));
}

nt_law_value nt_sphere_series_eval(double radius, double effective_modulus, double indentation)
{
    static const double of_radius[] = SERIES(OF_RADIUS), of_force[] = SERIES(OF_FORCE), of_energy[] = SERIES(OF_ENERGY);
    const double x = indentation / radius;
    if (x <= 0.0)
        return (nt_law_value){0};
    if (x > 1.0) {
        const nt_shape sphere = {.kind = NT_SHAPE_SPHERE, .radius = radius};
        return nt_shape_eval(&sphere, effective_modulus, indentation);
    }
    const double paraboloid = radius * sqrt(x), k = 2.0 * effective_modulus * paraboloid;
    return (nt_law_value){
        .U = k * indentation * indentation * polynomial(of_energy, x),
        .F = k * indentation * polynomial(of_force, x),
        .k = k * polynomial(of_radius, x),
        .a = paraboloid * polynomial(of_radius, x),
    };
}
