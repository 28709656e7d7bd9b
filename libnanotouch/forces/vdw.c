/* SPDX-License-Identifier: BSD-3-Clause
 * Van der Waals attraction of a sphere and a half-space (Hamaker 1937; paper, Eq. 1): pairwise additive, not retarded.
 * The paper's H R/(6 s^2) is its limit for s << R (erratum E1); its roughness factor (s0/(s0 + b/2))^2 with s0 the gap
 * is the shift s = s0 + b/2, which stays finite at contact (erratum E2). */
#include <math.h>
#include <stddef.h>

#include "forces/law.h"
#include "internal/field.h"
#include "internal/forces.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/forces.h"

#define FIELD(member, ...) NT_FIELD(nt_vdw, member, __VA_ARGS__)

static const nt_field vdw_fields[] = {
    FIELD(radius, "m", 1e-10, 1.0, "radius R of the tip"),
    FIELD(hamaker_constant, "J", 0.0, 1e-16, "Hamaker constant H"),
    FIELD(roughness, "m", 0.0, 1e-6, "roughness b, peak to peak"),
    FIELD(minimum_gap, "m", 1e-12, 1e-6, "closest approach a0 of the atoms"),
};

nt_status nt_vdw_check(const nt_vdw *vdw, nt_problem *problem)
{
    return nt_field_check(vdw_fields, (int)(sizeof vdw_fields / sizeof vdw_fields[0]), vdw, problem);
}

/* R/s + R/(s + 2R) + ln(s/(s + 2R)): minus 6/H times the energy. For s >> R its terms cancel to third order; with
 * u = R/(s + R) it is 2u/(1 - u^2) - 2 atanh u, whose series is used there. */
static double energy_factor(double R, double s)
{
    const double u = R / (s + R);
    if (u > 0.3)
        return R / s + R / (s + 2.0 * R) + log(s / (s + 2.0 * R));
    const double u2 = u * u;
    double sum = 0.0, power = u;
    for (int k = 1; k <= 17; k++) { /* 0.3^34 < 2^-53 */
        power *= u2;
        sum += power * (4.0 * k / (2.0 * k + 1.0));
    }
    return sum;
}

static nt_law_value sphere(const nt_vdw *vdw, double s)
{
    const double R = vdw->radius, H = vdw->hamaker_constant, far = s + 2.0 * R;
    const double ratio = R / s / (far / R);
    const double F = -2.0 / 3.0 * H / R * ratio * ratio;
    return (nt_law_value){.U = -H / 6.0 * energy_factor(R, s), .F = F, .k = 2.0 * F * (1.0 / s + 1.0 / far)};
}

static nt_law_value derjaguin(const nt_vdw *vdw, double s)
{
    const double U = -vdw->hamaker_constant / 6.0 * (vdw->radius / s);
    return (nt_law_value){.U = U, .F = U / s, .k = 2.0 * U / s / s};
}

static double separation(const nt_vdw *vdw, double gap)
{
    return nt_law_gap(gap, vdw->minimum_gap) + 0.5 * vdw->roughness;
}

nt_law_value nt_vdw_eval(const nt_vdw *vdw, double gap)
{
    return nt_law_hold(sphere(vdw, separation(vdw, gap)), vdw->minimum_gap - gap);
}

nt_law_value nt_vdw_derjaguin_eval(const nt_vdw *vdw, double gap)
{
    return nt_law_hold(derjaguin(vdw, separation(vdw, gap)), vdw->minimum_gap - gap);
}

NT_LAW_ARRAY(nt_vdw, nt_vdw_eval)
NT_LAW_ARRAY(nt_vdw, nt_vdw_derjaguin_eval)
