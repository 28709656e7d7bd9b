/* SPDX-License-Identifier: BSD-3-Clause
 * Contact of tips that are not paraboloids, sphere on sphere, and what a contact law is worth where it is used.
 *
 * A rigid shape on an elastic half-space without adhesion obeys Galin's and Sneddon's integrals
 *     delta = a Int_0^a f'(r)/sqrt(a^2 - r^2) dr,     F = 2 E* Int_0^a r^2 f'(r)/sqrt(a^2 - r^2) dr
 * for its profile f(r); here in closed form for every shape, with the energy. Everywhere F = dU/d(delta) and k = 2 E*
 * a. All functions: thread-safe, real-time safe, no state. NaN in gives NaN out, or NT_E_NOT_FINITE where a status is
 * returned. */
#ifndef NANOTOUCH_GEOMETRY_H
#define NANOTOUCH_GEOMETRY_H

#include "nanotouch/contact.h"
#include "nanotouch/material.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum nt_shape_kind {
    NT_SHAPE_PARABOLOID, /* radius R at the apex: Hertz */
    NT_SHAPE_SPHERE,     /* radius R, the whole sphere: a may come close to R (Sneddon 1965) */
    NT_SHAPE_CONE,       /* half angle psi (Sneddon 1965) */
    NT_SHAPE_PUNCH,      /* flat end of a radius, straight wall (Boussinesq) */
    NT_SHAPE_BLUNTED,    /* cone that ends in a cap of radius R (Briscoe, Sebastian, Adams 1994; Rico et al. 2005) */
    NT_SHAPE_TRUNCATED   /* cone that ends in a flat of a radius (Briscoe, Sebastian, Adams 1994) */
} nt_shape_kind;
enum { NT_SHAPE_COUNT = NT_SHAPE_TRUNCATED + 1 }; /* the last one */

/* A tip. Fields that its kind does not name are not read. */
typedef struct nt_shape {
    nt_shape_kind kind;
    int sides;         /* CONE, BLUNTED, TRUNCATED: 0 round, 3 or 4 a regular pyramid */
    double radius;     /* R of PARABOLOID, SPHERE, BLUNTED; of the flat for PUNCH, TRUNCATED [m] */
    double half_angle; /* psi between axis and flank (round) or axis and face (pyramid) [rad] */
    double transition; /* BLUNTED: radius b where the cap meets the flank; 0: where they are tangent, R cot psi [m] */
} nt_shape;

/* "paraboloid", "sphere", "cone", "punch", "blunted", "truncated". */
NT_API const char *nt_shape_name(nt_shape_kind kind);
/* NT_OK; NT_E_ARGUMENT (kind unknown, or sides not 0, 3, 4), NT_E_NOT_FINITE, NT_E_RANGE, with the offending field in
 * *problem (NULL allowed). b may be at most R cot psi: a larger one would make the flank retreat behind the cap. */
NT_API nt_status nt_shape_check(const nt_shape *shape, nt_problem *problem);

/* A pyramid's law is that of the cone of this half angle [rad]: F = C E* tan(psi) delta^2 with C = 0.73762 (4 sides)
 * and 0.87960 (3 sides), from our own numerical solution, to 1e-4 (docs/geometry.md; the published approximations of
 * Bilodeau 1992 are 0.7453 and 0.887, 1 % above). NaN unless sides is 0 (the angle itself), 3 or 4. */
NT_API double nt_pyramid_equivalent_angle(int sides, double half_angle);

/* {U, F, k, a} of a checked shape at an indentation [m]; all 0 for delta <= 0; all NaN for delta = +inf.
 * effective_modulus E* [Pa], > 0. For a pyramid a is the radius of the round contact of the same stiffness, k/(2 E*): 8
 * % (4 sides) and 17 % (3 sides) larger than that of the circle of the contact's own area. */
NT_API nt_law_value nt_shape_eval(const nt_shape *shape, double effective_modulus, double indentation);
/* delta(F) [m] for F >= 0; NaN for F < 0 or infinite. */
NT_API double nt_shape_indentation(const nt_shape *shape, double effective_modulus, double force);

/* --- JKR for other shapes: adhesion of zero range on PARABOLOID, CONE (round) and PUNCH (Maugis and Barquins 1983;
 *     Kendall 1971). With s = sqrt(2 pi w a/E*):
 *         delta = delta_0(a) - s,     F = F_0(a) - 2 E* a s
 *     where 0 marks the law without adhesion. Other shapes: NT_E_UNSUPPORTED. --- */
typedef struct nt_jkr_shape {
    nt_shape shape;
    double effective_modulus; /* E* [Pa], > 0 */
    double work_of_adhesion;  /* w [J/m^2], >= 0 */
} nt_jkr_shape;

/* --- Sphere on sphere --- */

/* R of 1/R = 1/R1 + 1/R2 [m]. A flat is INFINITY; a hollow has a negative radius, larger in magnitude than the ball's.
 */
NT_API double nt_effective_radius(double radius, double other_radius);
typedef struct nt_ball {
    double radius; /* [m] */
    nt_material material;
} nt_ball;
/* The contact of two balls: effective radius and modulus; adhesion as given [J/m^2], [Pa]. */
NT_API nt_contact nt_contact_between(nt_ball tip, nt_ball sample, double work_of_adhesion, double cohesive_stress);

/* --- Which theory: Maugis' lambda and Tabor's mu. lambda = 1.157 mu, because sigma0 = 16 w/(9 sqrt(3) z0) in
 *     lambda = 2 sigma0 (R/(pi w K^2))^(1/3), K = 4/3 E*, leaves 32/(9 sqrt(3)) (9/(16 pi))^(1/3). --- */
#define NT_LAMBDA_PER_TABOR 1.157011634850799349
/* Stress of an attraction that reaches a gap h0: w/h0 [Pa]. */
NT_API double nt_cohesive_stress_of_range(double work_of_adhesion, double range);
/* Laplace pressure gamma/r1 of a water bridge [Pa]: with w = 2 gamma its range is 2 r1 (erratum E12). */
NT_API double nt_cohesive_stress_laplace(double surface_tension, double meniscus_radius);
/* mu = (R w^2/(E*^2 z0^3))^(1/3) from the contact's R, E*, w and the distance z0 [m]; cohesive_stress is not read. */
NT_API double nt_tabor_mu(const nt_contact *contact, double equilibrium_distance);

/* --- Is the law inside its range? --- */

/* Ranges, with where they come from (docs/geometry.md). */
#define NT_VALID_RADIUS_RATIO 0.3    /* a/R of a paraboloid: the sphere's force is then 0.9 % lower */
#define NT_VALID_SLOPE 0.5           /* of the tip's surface at the edge: small-strain theory within some 10 % */
#define NT_VALID_STRAIN 0.1          /* representative strain: linear elasticity */
#define NT_VALID_THICKNESS_RATIO 0.1 /* a/t: a bonded incompressible layer is then 13 % stiffer (Dimitriadis 2002) */
enum {
    NT_OUTSIDE_RADIUS_RATIO = 1u << 0,
    NT_OUTSIDE_SLOPE = 1u << 1,
    NT_OUTSIDE_STRAIN = 1u << 2,
    NT_OUTSIDE_THICKNESS = 1u << 3
};

typedef struct nt_contact_validity {
    double radius_ratio;    /* a/R, for BLUNTED of the part on the cap; 0 for shapes without R [-] */
    double slope;           /* of the tip's surface at the edge of contact; 0 for PUNCH, whose edge is sharp [-] */
    double strain;          /* representative: 0.2 slope (Tabor; 0.2 a/R for spheres), PUNCH 0.3 |delta|/a [-] */
    double thickness_ratio; /* a/t [-] */
    unsigned outside;       /* NT_OUTSIDE_* bits; 0: all within range */
} nt_contact_validity;

/* Judges a contact of a checked shape, with or without adhesion, by the radius a >= 0 [m] and indentation [m] that its
 * law gave. thickness t of the sample [m], > 0, INFINITY for a half-space. */
NT_API nt_status nt_contact_validity_of(const nt_shape *shape, double contact_radius, double indentation,
                                        double thickness, nt_contact_validity *validity);

/* --- Indentation at a given stage displacement (paper, Eq. 5-8) --- */

typedef struct nt_lever {
    double spring_constant; /* k_c [N/m], > 0 */
    double angle;           /* alpha between lever and sample [rad], 0 <= alpha < pi/2 */
} nt_lever;

typedef struct nt_stage_displacement {
    double indentation; /* delta [m] */
    double deflection;  /* zeta = P/k_c [m] */
    nt_law_value value; /* of the tip at that indentation */
} nt_stage_displacement;

/* Solves Delta = delta + cos(alpha) P(delta)/k_c (Eq. 5 with P = k_c zeta) for a checked shape without adhesion. For a
 * paraboloid this is Eq. 6; for a cone Eq. 7 corrected (errata E6, E7):
 *     Delta = delta + cos(alpha) 2 E* tan(psi) delta^2/(pi k_c).
 * displacement Delta beyond first touch [m]; all 0 for Delta <= 0. NT_E_NOT_FINITE; NT_E_RANGE (lever, modulus,
 * 0 < Delta < 1e-100). */
NT_API nt_status nt_stage_displacement_solve(const nt_shape *shape, double effective_modulus, const nt_lever *lever,
                                             double displacement, nt_stage_displacement *solved);

#ifdef __cplusplus
}
#endif
#endif
