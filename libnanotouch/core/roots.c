/* SPDX-License-Identifier: BSD-3-Clause
 * Bracketed roots: T. R. Chandrupatla, Adv. Eng. Software 28 (1997) 145. */
#include "core/roots.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

enum { MAX_EVALUATIONS = 200 };

/* Newest point, the other end of the bracket, and the point that was dropped last. */
typedef struct {
    double x1, f1, x2, f2, x3, f3;
} triple;

/* Where in the bracket (0 at x1, 1 at x2) to look next: inverse quadratic interpolation where it is monotone. */
static double next_fraction(const triple *p)
{
    const double xi = (p->x1 - p->x2) / (p->x3 - p->x2);
    const double phi = (p->f1 - p->f2) / (p->f3 - p->f2);
    if (!(phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi))
        return 0.5;
    return p->f1 / (p->f2 - p->f1) * p->f3 / (p->f2 - p->f3) +
           (p->x3 - p->x1) / (p->x2 - p->x1) * p->f1 / (p->f3 - p->f1) * p->f2 / (p->f3 - p->f2);
}

nt_status nt_root_find(nt_scalar_function *f, const void *context, const double bracket[2], double *root,
                       nt_solve_info *info)
{
    triple p = {.x1 = bracket[0], .x2 = bracket[1]};
    p.f1 = f(p.x1, context);
    p.f2 = f(p.x2, context);
    if (!isfinite(p.f1) || !isfinite(p.f2))
        return NT_E_NOT_FINITE;
    if ((p.f1 > 0.0) == (p.f2 > 0.0) && p.f1 != 0.0 && p.f2 != 0.0)
        return NT_E_RANGE;
    double fraction = 0.5;
    for (int i = 2; i < MAX_EVALUATIONS; i++) {
        const int first = fabs(p.f1) < fabs(p.f2);
        const double best = first ? p.x1 : p.x2, residual = first ? p.f1 : p.f2;
        const double tolerance = 0.5 * DBL_EPSILON * fabs(best) / fabs(p.x2 - p.x1);
        if (tolerance >= 0.5 || residual == 0.0) {
            *root = best;
            if (info != NULL)
                *info = (nt_solve_info){i, residual};
            return NT_OK;
        }
        fraction = fmin(fmax(fraction, tolerance), 1.0 - tolerance);
        const double x = p.x1 + fraction * (p.x2 - p.x1);
        const double fx = f(x, context);
        p.x3 = p.x1;
        p.f3 = p.f1;
        if ((fx > 0.0) != (p.f1 > 0.0)) {
            p.x3 = p.x2;
            p.f3 = p.f2;
            p.x2 = p.x1;
            p.f2 = p.f1;
        }
        p.x1 = x;
        p.f1 = fx;
        fraction = next_fraction(&p);
    }
    return NT_E_NO_CONVERGENCE;
}
