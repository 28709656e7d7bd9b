/* SPDX-License-Identifier: BSD-3-Clause
 * Van der Waals attraction of a whole tip, a cone rounded by a sphere that touches it all around, and a half-space:
 * Hamaker's sum over slices, U = -H/6 Int r(z)^2/z^3 dz, F = -H/2 Int r(z)^2/z^4 dz, closed for both parts. */
#include <math.h>
#include <stddef.h>

#include "forces/forces.h"
#include "forces/law.h"
#include "internal/field.h"
#include "internal/forces.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/forces.h"

#define FIELD(member, ...) NT_FIELD(nt_vdw_tip, member, __VA_ARGS__)

static const nt_field tip_fields[] = {
    FIELD(radius, "m", 1e-10, 1.0, "radius R of the apex"),
    FIELD(hamaker_constant, "J", 0.0, 1e-16, "Hamaker constant H"),
    FIELD(half_angle, "rad", 0.0, 1.5, "half-angle theta of the cone"),
    FIELD(height, "m", 0.0, 1e-2, "height L of the cone above the apex sphere"),
    FIELD(roughness, "m", 0.0, 1e-6, "roughness b, peak to peak"),
    FIELD(minimum_gap, "m", 1e-12, 1e-6, "closest approach a0 of the atoms"),
};

nt_status nt_vdw_tip_check(const nt_vdw_tip *tip, nt_problem *problem)
{
    return nt_field_check(tip_fields, (int)(sizeof tip_fields / sizeof tip_fields[0]), tip, problem);
}

/* Int_0^X x^2/(s + x)^3 dx = -ln(1 - u) - u - u^2/2, u = X/(s + X); small u by its series. */
static double cubic_tail(double u, double one_minus_u)
{
    if (u > 0.3)
        return -log(one_minus_u) - u - 0.5 * u * u;
    double sum = 0.0, power = u * u;
    for (int n = 3; n <= 34; n++) { /* 0.3^32 < 2^-53 */
        power *= u;
        sum += power / n;
    }
    return sum;
}

/* The cap of height X of a sphere: integrals with r^2 = 2R x - x^2, x = z - s, without the factors of H. */
static nt_law_value cap(double R, double X, double s)
{
    const double top = s + X, u = X / top, rest = 1.0 / (1.0 + X / s); /* 1 - u */
    const double weight = (3.0 * R - X) * rest + R * u;
    const double F = u * u / (3.0 * s * s) * weight;
    const double slope = 2.0 / s + 3.0 / top - (3.0 * R - X) / top / weight; /* -d ln F/ds */
    return (nt_law_value){.U = R / s * u * u - cubic_tail(u, rest), .F = F, .k = F * slope};
}

/* A cone of radius r1 at z1 that widens by q per length over the length L. With p = r/z,
 * Int r^2/z^4 = (1/z1 - 1/z2) (p1^2 + p1 p2 + p2^2)/3. */
static nt_law_value frustum(double r1, double q, double z1, double L)
{
    const double z2 = z1 + L, p1 = r1 / z1, p2 = (r1 + q * L) / z2, u = L / z2;
    const double span = u / z1, sum = 1.0 / z1 + 1.0 / z2, square = p1 * p1 + p1 * p2 + p2 * p2;
    const double square_slope = (2.0 * p1 + p2) * p1 / z1 + (p1 + 2.0 * p2) * p2 / z2; /* -d square/dz1 */
    return (nt_law_value){.U = 0.5 * r1 * r1 * span * sum + p1 * q * u * u + q * q * cubic_tail(u, z1 / z2),
                          .F = span * square / 3.0,
                          .k = span * (square_slope + square * sum) / 3.0};
}

nt_tip_angle nt_tip_angle_of(double half_angle)
{
    return (nt_tip_angle){sin(half_angle), cos(half_angle), -log(tan(0.5 * half_angle))};
}

nt_law_value nt_vdw_tip_eval_with(const nt_vdw_tip *tip, const nt_tip_angle *angle, double gap)
{
    const double R = tip->radius, H = tip->hamaker_constant, slope = angle->sine / angle->cosine;
    const double s = nt_law_gap(gap, tip->minimum_gap) + 0.5 * tip->roughness, X = R * (1.0 - angle->sine);
    const nt_law_value apex = cap(R, X, s), cone = frustum(R * angle->cosine, slope, s + X, tip->height);
    const nt_law_value value = {
        .U = -H / 6.0 * (apex.U + cone.U), .F = -H / 2.0 * (apex.F + cone.F), .k = -H / 2.0 * (apex.k + cone.k)};
    return nt_law_hold(value, tip->minimum_gap - gap);
}

nt_law_value nt_vdw_tip_eval(const nt_vdw_tip *tip, double gap)
{
    const nt_tip_angle angle = nt_tip_angle_of(tip->half_angle);
    return nt_vdw_tip_eval_with(tip, &angle, gap);
}

NT_LAW_ARRAY(nt_vdw_tip, nt_vdw_tip_eval)
