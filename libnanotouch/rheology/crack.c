/* SPDX-License-Identifier: BSD-3-Clause
 * Persson and Brener (Phys. Rev. E 71 (2005) 036123): with w_eff = w ratio, a process zone of length a = a_0 ratio and
 * a speed v,
 *   1/ratio = 1 - (2/pi) E_inf Int_0^wc sqrt(1 - (w/wc)^2) Im(1/E(-iw)) dw/w,   wc = 2 pi v/a.
 * For a compliance of arms the integral is closed: each contributes E_inf J_j (sqrt(1 + b^2) - 1)/b, b = wc/q_j. */
#include "rheology/crack.h"

#include <math.h>

#include "core/roots.h"
#include "core/same_bits.h"

#define PI 3.14159265358979323846
#define SLOWEST 1e-9 /* times the slowest rate of the compliance: from there down the ratio is linear */
#define FASTEST 1e9  /* times the fastest */

nt_status nt_crack_make(const nt_rheology *rheology, double length, nt_crack *crack)
{
    const int arms = rheology->kind == NT_RHEOLOGY_STANDARD_LINEAR_SOLID ? 1 : rheology->arm_count;
    nt_retardation late;
    const nt_status status = nt_prony_retard(rheology, arms, &late);
    double instant = rheology->equilibrium_modulus, viscosity = 0.0;
    for (int k = 0; k < arms; k++) {
        instant += rheology->arm_moduli[k];
        viscosity += rheology->arm_moduli[k] * rheology->relaxation_times[k];
    }
    *crack = (nt_crack){.count = late.count,
                        .length = length,
                        .max_ratio = instant / rheology->equilibrium_modulus,
                        .viscosity = viscosity};
    for (int j = 0; j < late.count && status == NT_OK; j++) {
        crack->shares[j] = rheology->equilibrium_modulus * late.compliances[j];
        crack->times[j] = 1.0 / late.rates[j];
    }
    return status;
}

double nt_crack_ratio(const nt_crack *crack, double s)
{
    double rest = 1.0;
    for (int j = 0; j < crack->count; j++) {
        const double b = 2.0 * PI * s * crack->times[j];
        rest -= crack->shares[j] * (b / (1.0 + hypotenuse(1.0, b)));
    }
    return 1.0 / rest;
}

typedef struct wanted {
    const nt_crack *crack;
    double value; /* a ratio, or a speed [m/s] */
} wanted;

static double beyond(double log_s, const void *context)
{
    const wanted *of = context;
    return nt_crack_ratio(of->crack, exp(log_s)) - of->value;
}

double nt_crack_crossings(const nt_crack *crack, double ratio)
{
    const wanted of = {crack, ratio};
    double slope = 0.0, slowest = 0.0, fastest = (double)INFINITY, log_s;
    for (int j = 0; j < crack->count; j++) {
        slope += PI * crack->shares[j] * crack->times[j];
        slowest = fmax(slowest, crack->times[j]);
        fastest = fmin(fastest, crack->times[j]);
    }
    if (!(ratio > 1.0))
        return 0.0;
    const double bracket[2] = {log(SLOWEST / slowest), log(FASTEST / fastest)};
    if (nt_crack_ratio(crack, exp(bracket[0])) >= ratio)
        return (ratio - 1.0) / slope;
    return nt_root_find(beyond, &of, bracket, &log_s, NULL) == NT_OK ? exp(log_s) : (double)INFINITY;
}

static double too_fast(double log_s, const void *context)
{
    const wanted *of = context;
    return of->crack->length * nt_crack_ratio(of->crack, exp(log_s)) * exp(log_s) - of->value;
}

nt_status nt_crack_log_crossings_at(const nt_crack *crack, double speed, double *log_s)
{
    const wanted of = {crack, speed};
    const double fastest = log(speed / crack->length); /* the ratio is 1 at least */
    const double bracket[2] = {fastest - log(crack->max_ratio) - 1e-6, fastest + 1e-6};
    return nt_root_find(too_fast, &of, bracket, log_s, NULL);
}
