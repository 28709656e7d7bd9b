/* SPDX-License-Identifier: BSD-3-Clause
 * A straight round rod on a flat, pushed by a tip: it slides and turns in the plane (docs/manipulation.md).
 *
 * It adheres as a cylinder (Chaudhury, Weaver, Hui, Kramer 1996): F/L = pi E* b^2/(4 R) - sqrt(2 pi E* b w), b half of
 * the width of the contact. Friction is spread along the line of contact: each piece is a spring that gives way at a
 * limit. It does not roll about its axis, and does not bend. The tip is a sphere that runs into an upright cone, seen
 * from the rod's axis a wedge; it presses along the normal of what it touches with, without adhesion and friction. All
 * functions: thread-safe, no state but the caller's. */
#ifndef NANOTOUCH_ROD_H
#define NANOTOUCH_ROD_H

#include "nanotouch/advanced/field.h"
#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { NT_ROD_ELEMENTS = 400 };

/* The rod, and the tip beside it. */
typedef struct nt_rod {
    double length;                  /* L, 4 R at least [m] */
    double radius;                  /* R [m] */
    double effective_modulus;       /* E* of rod and substrate [Pa] */
    double effective_shear_modulus; /* G* of both [Pa] */
    double work_of_adhesion;        /* w [J/m^2] */
    double shear_strength;          /* tau, friction per contact area [Pa] */
    double tip_radius;              /* r of the tip [m] */
    double tip_half_angle;          /* psi of its cone; 0: it is as wide as its radius all the way up [rad] */
    double tip_stiffness;           /* of its contact with the rod, without adhesion and friction [N/m] */
    double lever;                   /* stiffness between base and tip along x and y; 0: the tip is held there [N/m] */
    double elements;                /* pieces of the line of contact, a whole number [-] */
    double step;                    /* largest step of the tip; longer ways are divided [m] */
} nt_rod;
/* A wire of 2 um and 50 nm radius, E* = 70 GPa, tau = 10 MPa, w = 50 mJ/m^2; a tip of 20 nm that is held, 100 pieces, 1
 * nm steps. */
NT_API nt_rod nt_rod_defaults(void);
/* The table of its fields, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_rod_fields(int *count);
/* NT_OK, or NT_E_NOT_FINITE / NT_E_RANGE with what is wrong in *problem (NULL allowed): a field; a length below 4
 * radii; a contact that is wider than the radius; a tip so soft that it would go through the rod under its friction. */
NT_API nt_status nt_rod_check(const nt_rod *rod, nt_problem *problem);

/* b0 of the contact without load, b0^3 = 32 R^2 w/(pi E*) [m]. */
NT_API double nt_rod_half_width(const nt_rod *rod);
/* q = 2 b0 tau, of a length [N/m]. */
NT_API double nt_rod_friction(const nt_rod *rod);
/* Of a length before it slides, pi G* over ln(L/b0) [N/m^2]: a strip on a half space, in its middle. */
NT_API double nt_rod_stiffness(const nt_rod *rod);
/* Where a rod of even friction turns that is pushed across its axis at an arm of 0 .. L/2 from its middle: distance
 * from the middle on the other side, sqrt(arm^2 + L^2/4) - arm [m]. The push is 2 q times that. */
NT_API double nt_rod_turning_point(double length, double arm);

/* Where a rod is, and what it remembers. Copyable. Always stored + dissipated = work. */
typedef struct nt_rod_state {
    double pose[3];                   /* x and y of its middle [m], angle of its axis from x [rad] */
    double base[3];                   /* where the tip's apex would be without a force; the substrate is z = 0 [m] */
    double tip[3];                    /* apex of the tip [m] */
    double force[3];                  /* on the tip: what the lever shows [N] */
    double resistance;                /* -dF_z by the tip's way along z [N/m] */
    double stored, dissipated, work;  /* in springs, contact and lever; heat, grows only; done by the hand [J] */
    double pulls[NT_ROD_ELEMENTS][2]; /* of each piece [N] */
} nt_rod_state;
/* At rest, unstrained, the tip at its base beside it. NT_E_NOT_FINITE; NT_E_RANGE: the tip is below the substrate, or
 * touches the rod. Left alone unless NT_OK. */
NT_API nt_status nt_rod_place(const nt_rod *rod, const double pose[3], const double base[3], nt_rod_state *state);
/* Leads the base to `base` [m] along a straight line. After each step all forces balance: it is the nearest minimum of
 * what is stored and of what becomes heat; what a jump sets free is heat. NT_E_NOT_FINITE; NT_E_RANGE: farther than 1e7
 * steps, below the substrate, or deeper into the rod than half of the smaller radius; NT_E_NO_CONVERGENCE. Left alone
 * unless NT_OK. The rod has been checked. */
NT_API NT_REALTIME nt_status nt_rod_advance(const nt_rod *rod, nt_rod_state *state, const double base[3]);

#ifdef __cplusplus
}
#endif
#endif
