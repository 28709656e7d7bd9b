/* SPDX-License-Identifier: BSD-3-Clause
 * Non-contact forces between a tip and a flat, at gap h of the undeformed bodies (paper, Eq. 1, corrected:
 * docs/evidence/errata.md; in liquid: docs/forces.md). Each law returns {U, F, k, a = 0}: U is 0 at infinite gap, F =
 * -dU/dh, k = -dF/dh. Below minimum_gap F stays at its value there and U goes on linearly. nt_x_eval_n is nt_x_eval
 * over arrays. All functions: thread-safe, real-time safe; NaN in, NaN out; an infinite gap gives 0. Parameters are
 * checked once by nt_x_check(). What adds, is added by the caller; erratum E5b says what may be added to a contact law.
 */
#ifndef NANOTOUCH_FORCES_H
#define NANOTOUCH_FORCES_H

#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- Van der Waals --- */

typedef struct nt_vdw {
    double radius;           /* R of the tip [m] */
    double hamaker_constant; /* H [J], >= 0 */
    double roughness;        /* b, peak to peak [m], >= 0: the effective gap is h + b/2 (erratum E2) */
    double minimum_gap;      /* a0, the closest approach of the atoms [m], > 0 (E1) */
} nt_vdw;
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_vdw_check(const nt_vdw *vdw, nt_problem *problem);
/* Exact Hamaker sphere: F = -2 H R^3/(3 s^2 (s + 2R)^2), s = max(h, a0) + b/2. */
NT_API nt_law_value nt_vdw_eval(const nt_vdw *vdw, double gap);
/* The paper's Derjaguin form -H R/(6 s^2), valid for s << R: +36 % at h = 10 nm for R = 30 nm (erratum E1). */
NT_API nt_law_value nt_vdw_derjaguin_eval(const nt_vdw *vdw, double gap);

/* What the half-angle theta of a tip's cone comes to, once for many evaluations (`_eval_with`). */
typedef struct nt_tip_angle {
    double sine, cosine; /* [-] */
    double log_cot;      /* ln cot(theta/2); infinite for theta = 0 [-] */
} nt_tip_angle;

/* The same of a whole tip: a cone rounded by a sphere that touches it all around (Hamaker's sum, exact). */
typedef struct nt_vdw_tip {
    double radius;           /* R of the apex [m] */
    double hamaker_constant; /* H [J], >= 0 */
    double half_angle;       /* theta of the cone [rad], 0 .. 1.5 */
    double height;           /* L of the cone, above the apex sphere [m], >= 0 */
    double roughness;        /* b, peak to peak [m], >= 0 */
    double minimum_gap;      /* a0 [m], > 0 */
} nt_vdw_tip;
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_vdw_tip_check(const nt_vdw_tip *tip, nt_problem *problem);
/* {U, F, k} of the whole tip at a gap [m]; a cone of height 0 is nt_vdw_eval. */
NT_API nt_law_value nt_vdw_tip_eval(const nt_vdw_tip *tip, double gap);

/* --- Capillary meniscus of a water film --- */

typedef struct nt_capillary {
    double radius;          /* R of the tip [m] */
    double surface_tension; /* gamma_L [N/m], >= 0 */
    double meniscus_radius; /* r1 of the meniscus [m], > 0 */
    double film_thickness;  /* e of the film on each surface [m], >= 0 */
} nt_capillary;
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_capillary_check(const nt_capillary *capillary, nt_problem *problem);
/* The force of a standing bridge, F = -4 pi gamma_L R [1 - (h - 2e)/(2 r1)], the bracket clamped to [0, 1] (erratum
 * E3): constant below 2e, 0 beyond 2e + 2 r1. */
NT_API nt_law_value nt_capillary_eval(const nt_capillary *capillary, double gap);

/* Whether there is a bridge is history: it forms on approach where the films touch, at 2e [m], ... */
NT_API double nt_capillary_forms_at(const nt_capillary *capillary);
/* ... and ruptures on retraction at 2e + 2 r1 [m]. */
NT_API double nt_capillary_ruptures_at(const nt_capillary *capillary);
/* Whether a bridge stands (1) or not (0) at a gap, after it did or did not before; NaN changes nothing. */
NT_API int nt_capillary_advance(const nt_capillary *capillary, int bridged, double gap);

/* Kelvin radius of a meniscus: -gamma_L V_m/(R_gas T ln(RH)), relative_humidity in (0, 1), temperature [K]. */
NT_API double nt_kelvin_radius(double surface_tension, double molar_volume, double temperature,
                               double relative_humidity);

/* --- Electrostatic force of conductors at a potential difference U --- */

/* Sphere and plane. */
typedef struct nt_electrostatic {
    double radius;      /* R [m] */
    double potential;   /* U: contact potential (phi_1 - phi_2)/e plus any bias [V] */
    double minimum_gap; /* a0 [m], > 0 */
} nt_electrostatic;
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_electrostatic_check(const nt_electrostatic *electrostatic, nt_problem *problem);
/* F = -pi eps0 U^2 R^2/(h (h + R)) (Hudlet 1998; within 5.2 % of the exact image series for 0.2..100 nm, R = 30 nm). */
NT_API nt_law_value nt_electrostatic_eval(const nt_electrostatic *electrostatic, double gap);

/* Parallel plates, the paper's form: F = -eps0 S U^2/(2 h^2). The paper's S = 4 pi R r1 is the area of a meniscus and
 * makes it 10.8 times too large at a0, 0.28 times at 10 nm (erratum E5); it is right for an area S that is flat. */
typedef struct nt_electrostatic_plate {
    double area;        /* S [m^2], >= 0 */
    double potential;   /* U [V] */
    double minimum_gap; /* a0 [m], > 0 */
} nt_electrostatic_plate;
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_electrostatic_plate_check(const nt_electrostatic_plate *plate, nt_problem *problem);
/* {U, F, k} of the plates at a gap [m]. */
NT_API nt_law_value nt_electrostatic_plate_eval(const nt_electrostatic_plate *plate, double gap);

/* Apex sphere and cone of a tip, in place of the sphere (Hudlet 1998, over the finite height of the cone). */
typedef struct nt_electrostatic_tip {
    double radius;      /* R of the apex [m] */
    double half_angle;  /* theta of the cone [rad], 0.01 .. 1.5 */
    double height;      /* L of the cone, above the apex sphere [m], >= 0 */
    double potential;   /* U [V] */
    double minimum_gap; /* a0 [m], > 0 */
} nt_electrostatic_tip;
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_electrostatic_tip_check(const nt_electrostatic_tip *tip, nt_problem *problem);
/* {U, F, k} of sphere and cone at a gap [m]. */
NT_API nt_law_value nt_electrostatic_tip_eval(const nt_electrostatic_tip *tip, double gap);

/* Lever, to be added: a tilted plate in the field of the wedge that it makes with the plane. At gap h of the apex, with
 * D = tip_height + h, F = -eps0 U^2 w l cos(b) (sin(b)/b)^2/(2 D (D + l sin(b))). Edges are neglected. */
typedef struct nt_electrostatic_lever {
    double length;      /* l [m] */
    double width;       /* w [m] */
    double tilt;        /* b against the plane [rad], 0 .. 1.5; the tip's end is the lower */
    double tip_height;  /* of the lever's lower end above the apex [m], > 0 */
    double potential;   /* U [V] */
    double minimum_gap; /* a0 of the apex [m], > 0 */
} nt_electrostatic_lever;
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_electrostatic_lever_check(const nt_electrostatic_lever *lever, nt_problem *problem);
/* {U, F, k} of the lever at a gap of the apex [m]. */
NT_API nt_law_value nt_electrostatic_lever_eval(const nt_electrostatic_lever *lever, double gap);

/* A charge trapped on the sample, under the apex of a grounded tip. */
typedef struct nt_point_charge {
    double radius;      /* R [m] */
    double charge;      /* q [C] */
    double minimum_gap; /* closest approach of tip and charge [m], > 0 */
} nt_point_charge;
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_point_charge_check(const nt_point_charge *charge, nt_problem *problem);
/* Image charge in a sphere (Thomson, exact): F = -q^2 R (R + h)/(4 pi eps0 (h (h + 2R))^2). */
NT_API nt_law_value nt_point_charge_eval(const nt_point_charge *charge, double gap);

/* --- Lennard-Jones: attraction and repulsion of rigid surfaces --- */

typedef struct nt_lennard_jones {
    double radius;               /* R of the tip [m], >> z0 */
    double work_of_adhesion;     /* w [J/m^2], >= 0 */
    double equilibrium_distance; /* z0, where two half-spaces rest [m] */
    double minimum_gap;          /* [m], > 0 */
} nt_lennard_jones;
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_lennard_jones_check(const nt_lennard_jones *lennard_jones, nt_problem *problem);
/* F = 2 pi R w/3 [(z0/h)^8 - 4 (z0/h)^2], h between the surface atoms: -2 pi w R at z0 (Bradley), 0 at 0.794 z0. */
NT_API nt_law_value nt_lennard_jones_eval(const nt_lennard_jones *lennard_jones, double gap);

/* --- In liquid --- */

/* Electric double layers of two different surfaces; potentials below some 25 mV, R >> debye_length. */
typedef struct nt_double_layer {
    double radius;                /* R of the tip [m] */
    double debye_length;          /* 1/kappa [m]: nt_debye_length */
    double relative_permittivity; /* of the liquid [-] */
    double tip_potential;         /* psi_1 of the tip when alone [V] */
    double sample_potential;      /* psi_2 of the sample when alone [V] */
    double minimum_gap;           /* [m], > 0 */
} nt_double_layer;
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_double_layer_check(const nt_double_layer *layer, nt_problem *problem);
/* The surfaces keep their potential (Hogg, Healy, Fuerstenau 1966). */
NT_API nt_law_value nt_double_layer_potential_eval(const nt_double_layer *layer, double gap);
/* The surfaces keep their charge (Wiese, Healy 1970); sigma = eps psi/debye_length. */
NT_API nt_law_value nt_double_layer_charge_eval(const nt_double_layer *layer, double gap);
/* Debye length [m]: sqrt(eps0 eps_r k T/(2 N_A e^2 I)), ionic_strength I [mol/m^3] (1 mM is 1), temperature [K];
 * NaN unless all are above 0. */
NT_API double nt_debye_length(double ionic_strength, double relative_permittivity, double temperature);

/* Hydration (amplitude > 0) and hydrophobic (< 0) forces, two exponentials: F = 2 pi R Sum W_i exp(-h/l_i). */
typedef struct nt_hydration {
    double radius;              /* R of the tip [m], >> l_i */
    double amplitude;           /* W_1, energy of plates at gap 0 [J/m^2] */
    double decay_length;        /* l_1 [m] */
    double second_amplitude;    /* W_2 [J/m^2]; 0: one term */
    double second_decay_length; /* l_2 [m] */
    double minimum_gap;         /* [m], >= 0 */
} nt_hydration;
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_hydration_check(const nt_hydration *hydration, nt_problem *problem);
/* {U, F, k} at a gap [m]. */
NT_API nt_law_value nt_hydration_eval(const nt_hydration *hydration, double gap);

/* Steric force of polymer brushes (Alexander, de Gennes), a scaling law: F = 2 pi R Int_h^T p,
 * p = kT/s^3 [(T/h)^(9/4) - (h/T)^(3/4)]; 0 beyond T. */
typedef struct nt_steric {
    double radius;      /* R of the tip [m], >> T */
    double thickness;   /* T, of the free brushes of both bodies together [m]: 2L, or L where one bears none */
    double spacing;     /* s, distance of grafted chains [m]; s^-2 per area */
    double temperature; /* [K] */
    double minimum_gap; /* [m], > 0 */
} nt_steric;
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_steric_check(const nt_steric *steric, nt_problem *problem);
/* {U, F, k} at a gap [m]; all 0 beyond T. */
NT_API nt_law_value nt_steric_eval(const nt_steric *steric, double gap);
/* Its usual approximation p = 100 kT/s^3 exp(-2 pi h/T): p within 24 % for 0.2 < h/T < 0.9. */
NT_API nt_law_value nt_steric_exponential_eval(const nt_steric *steric, double gap);

#ifdef __cplusplus
}
#endif
#endif
