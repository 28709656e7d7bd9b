/* SPDX-License-Identifier: BSD-3-Clause
 * The load inside an adhesive contact: the integral of the pressure where it is positive.
 *
 * With s = sqrt(1 - r^2/a^2) the pressure is p0 s - (2 sigma0/pi) arctan(q/s), p0 = 3 K a/(2 pi R), q = sqrt(c^2 -
 * a^2)/a (Maugis 1992, Eq. 6.8: Hertz and a Dugdale zone of radius c). It is positive for s above its root s0, and
 * N_c = 2 pi a^2 times the integral of p s ds from s0 to 1. */
#include <math.h>
#include <stddef.h>

#include "core/roots.h"
#include "nanotouch/friction.h"

/* JKR is q -> 0 with sigma0 q kept: (2 sigma0/pi) arctan(q/s) -> p1/s, p1 = (Hertz load - F)/(2 pi a^2). */
static double jkr_load(double a, double hertz, double force)
{
    const double p0 = 1.5 * hertz, p1 = 0.5 * (hertz - force); /* times pi a^2 */
    if (!(p1 > 0.0))
        return hertz;
    if (!(p1 < p0) || !(a > 0.0))
        return 0.0;
    const double s0 = sqrt(p1 / p0);
    return 2.0 * (p0 * (1.0 - s0 * s0 * s0) / 3.0 - p1 * (1.0 - s0));
}

/* What the zone pulls, in 2 sigma0 a^2: (1 + q^2) arctan(q) + q. Minus what it is. */
static double zone_beyond(double q, const void *context)
{
    const double pull = *(const double *)context;
    return (1.0 + q * q) * atan(q) + q - pull;
}

typedef struct pressure {
    double hertz, zone, q; /* p0, 2 sigma0/pi, q */
} pressure;

static double pressure_at(double s, const void *context)
{
    const pressure *p = context;
    return p->hertz * s - p->zone * atan2(p->q, s);
}

/* The integral of s arctan(q/s) ds up to s. */
static double zone_integral(double s, double q)
{
    return 0.5 * (s * s * atan2(q, s) + q * s - q * q * atan2(s, q));
}

static double maugis_load(const nt_contact *contact, double a, double hertz, double force)
{
    const double pull = (hertz - force) / (2.0 * contact->cohesive_stress * a * a);
    if (!(pull > 0.0))
        return hertz;
    const double most = fmin(pull, 1.0 + 1.2 * sqrt(pull)); /* the pull is at least q, and q^2 pi/4 beyond q = 1 */
    pressure p = {1.5 * hertz / (NT_PI * a * a), 2.0 * contact->cohesive_stress / NT_PI, 0.0};
    double s0;
    if (nt_root_find(zone_beyond, &pull, (double[]){0.0, most}, &p.q, NULL) != NT_OK)
        return (double)NAN;
    if (!(pressure_at(1.0, &p) > 0.0))
        return 0.0;
    if (nt_root_find(pressure_at, &p, (double[]){0.0, 1.0}, &s0, NULL) != NT_OK)
        return (double)NAN;
    const double pressing = p.hertz * (1.0 - s0 * s0 * s0) / 3.0;
    const double rim = p.zone * (zone_integral(1.0, p.q) - zone_integral(s0, p.q));
    return 2.0 * NT_PI * a * a * fmax(pressing - rim, 0.0); /* below 0 by rounding only */
}

double nt_compressive_load(nt_model model, const nt_contact *contact, nt_law_value law)
{
    const double a = law.a;
    if (isnan(a) || isnan(law.F))
        return (double)NAN;
    if (!(a > 0.0))
        return 0.0;
    const double hertz = 4.0 / 3.0 * contact->effective_modulus * a * a * a / contact->radius;
    if (model == NT_JKR)
        return jkr_load(a, hertz, law.F);
    return model == NT_MAUGIS && contact->work_of_adhesion > 0.0 ? maugis_load(contact, a, hertz, law.F) : hertz;
}
