/* SPDX-License-Identifier: BSD-3-Clause
 * What a real probe adds to the sphere: the cone behind its apex and the lever above it, each a conductor at the same
 * potential difference U, to be added to one another.
 *
 * Tip: Hudlet, Saint Jean, Guthmann, Berger, Eur. Phys. J. B 2 (1998) 5: the field on a surface element is that of the
 * infinite body of the same slope that meets the plane; for the cone that is exact,
 * E = U/(x tan(theta) ln cot(theta/2)) at height x. Their integral over the cone is taken here to its finite height
 * without dropping what is small against it, so that an energy exists.
 * Lever: a plate tilted by beta, in the exact field U/(beta r) of the wedge that it makes with the plane; edges
 * neglected. */
#include <math.h>
#include <stddef.h>

#include "forces/forces.h"
#include "forces/law.h"
#include "internal/field.h"
#include "internal/forces.h"
#include "nanotouch/advanced/field.h"
#include "nanotouch/forces.h"
#include "nanotouch/material.h"

#define TIP(member, ...) NT_FIELD(nt_electrostatic_tip, member, __VA_ARGS__)
#define LEVER(member, ...) NT_FIELD(nt_electrostatic_lever, member, __VA_ARGS__)

static const nt_field tip_fields[] = {
    TIP(radius, "m", 1e-10, 1.0, "radius R of the apex"),
    TIP(half_angle, "rad", 0.01, 1.5, "half-angle theta of the cone"),
    TIP(height, "m", 0.0, 1e-2, "height L of the cone above the apex sphere"),
    TIP(potential, "V", -1e4, 1e4, "potential difference U, contact potential and bias"),
    TIP(minimum_gap, "m", 1e-12, 1e-6, "closest approach a0 of the atoms"),
};

static const nt_field lever_fields[] = {
    LEVER(length, "m", 1e-7, 1e-1, "length of the lever"),
    LEVER(width, "m", 1e-7, 1e-1, "width of the lever"),
    LEVER(tilt, "rad", 0.0, 1.5, "tilt beta against the plane"),
    LEVER(tip_height, "m", 1e-9, 1e-2, "height of the lever's lower end above the apex"),
    LEVER(potential, "V", -1e4, 1e4, "potential difference U, contact potential and bias"),
    LEVER(minimum_gap, "m", 1e-12, 1e-6, "closest approach a0 of the apex"),
};

nt_status nt_electrostatic_tip_check(const nt_electrostatic_tip *tip, nt_problem *problem)
{
    return nt_field_check(tip_fields, (int)(sizeof tip_fields / sizeof tip_fields[0]), tip, problem);
}

nt_status nt_electrostatic_lever_check(const nt_electrostatic_lever *lever, nt_problem *problem)
{
    return nt_field_check(lever_fields, (int)(sizeof lever_fields / sizeof lever_fields[0]), lever, problem);
}

/* The cap of the sphere down to the cone, of height c = R (1 - sin theta): F = -R c/(h (h + c)). */
static nt_law_value apex(double R, double c, double h)
{
    const double F = -R / h * (c / (h + c));
    return (nt_law_value){.U = -R * log1p(c / h), .F = F, .k = F * (1.0 / h + 1.0 / (h + c))};
}

/* 1 - ln(1 + t)/t; where t is small by its series. */
static double log_deficit(double t)
{
    if (t > 0.1)
        return 1.0 - log1p(t) / t;
    double sum = 0.0;
    for (int n = 17; n >= 2; n--) /* 0.1^17/18 < 2^-53 of the first term */
        sum = t * (1.0 / n - sum);
    return sum;
}

/* Int (x - x1 + q)/x^2 dx from the cone's lower end x1 to x1 + L, q = R cos(theta)/tan(theta):
 * F = -[ln(1 + t) - t/(1 + t) + q t/(x1 + L)], t = L/x1. */
static nt_law_value cone(double L, double q, double x1)
{
    const double x2 = x1 + L, t = L / x1, rest = L / x2;
    const double deficit = log_deficit(t), swept = t > 0.1 ? log1p(t) - rest : t * (rest - deficit);
    return (nt_law_value){.U = -(L * deficit + q * log1p(t)),
                          .F = -(swept + q * t / x2),
                          .k = -(rest * rest / x1 + q * t / x2 * (1.0 / x1 + 1.0 / x2))};
}

nt_law_value nt_electrostatic_tip_eval_with(const nt_electrostatic_tip *tip, const nt_tip_angle *angle, double gap)
{
    const double R = tip->radius, sine = angle->sine, c = R * (1.0 - sine), h = nt_law_gap(gap, tip->minimum_gap);
    const double strength = NT_PI * NT_VACUUM_PERMITTIVITY * tip->potential * tip->potential;
    const double share = strength / (angle->log_cot * angle->log_cot);
    const nt_law_value sphere = apex(R, c, h), flank = cone(tip->height, R * (1.0 - sine * sine) / sine, h + c);
    const nt_law_value value = {.U = strength * sphere.U + share * flank.U,
                                .F = strength * sphere.F + share * flank.F,
                                .k = strength * sphere.k + share * flank.k};
    return nt_law_hold(value, tip->minimum_gap - gap);
}

nt_law_value nt_electrostatic_tip_eval(const nt_electrostatic_tip *tip, double gap)
{
    const nt_tip_angle angle = nt_tip_angle_of(tip->half_angle);
    return nt_electrostatic_tip_eval_with(tip, &angle, gap);
}

nt_law_value nt_electrostatic_lever_eval(const nt_electrostatic_lever *lever, double gap)
{
    const double tilt = lever->tilt, rise = lever->length * sin(tilt);
    const double wedge = tilt > 0.0 ? sin(tilt) / tilt : 1.0; /* field of the wedge against that of a plate */
    const double strength = 0.5 * NT_VACUUM_PERMITTIVITY * lever->potential * lever->potential * wedge * wedge;
    const double C = strength * lever->width * lever->length * cos(tilt);
    const double near = lever->tip_height + nt_law_gap(gap, lever->minimum_gap), far = near + rise, t = rise / near;
    const double F = -C / near / far, mean = t > 0.0 ? log1p(t) / t : 1.0;
    const nt_law_value value = {.U = -C / near * mean, .F = F, .k = F * (1.0 / near + 1.0 / far)};
    return nt_law_hold(value, lever->minimum_gap - gap);
}

NT_LAW_ARRAY(nt_electrostatic_tip, nt_electrostatic_tip_eval)
NT_LAW_ARRAY(nt_electrostatic_lever, nt_electrostatic_lever_eval)
