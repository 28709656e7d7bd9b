/* SPDX-License-Identifier: BSD-3-Clause
 * Parts of what the tip pushes. */
#ifndef NANOTOUCH_INTERNAL_MANIPULATION_H
#define NANOTOUCH_INTERNAL_MANIPULATION_H

#include "nanotouch/advanced/manipulation.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What all of them may do to a tip that presses with a load at most. */
typedef struct nt_pushed_bound {
    double resistance; /* sideways, before all gives way; what the tip pulls off comes on top [N] */
    double stiffness;  /* of the tip's contact, along its normal or across [N/m] */
    double pull_off;   /* of all that the tip may touch at once [N] */
} nt_pushed_bound;

/* Limit of a contact of the radius a [m] and the load inside it [N]. Sliding: tau pi a^2 + alpha N [N]. Rolling: M = 4
 * F_c (a/a0)^1.5 xi [N m] (Dominik and Tielens 1995). Spinning: 2/3 pi tau a^3 + 3 pi/16 alpha a N [N m], the second
 * for the pressure of Hertz. */
NT_API NT_REALTIME double nt_particle_limit(const nt_particle_laws *laws, int bristle,
                                            const nt_friction_contact *contact);
/* Below the limit. Sliding: 8 a G* [N/m]. Rolling: 4 F_c (a/a0)^1.5 R [N m/rad], R reduced. Spinning: 16/3 a^3 G [N
 * m/rad] (Johnson 1985, Eq. 7.37 and 7.39). */
NT_API NT_REALTIME double nt_particle_stiffness(const nt_particle_laws *laws, int bristle, double radius);
/* No particle, and the tip at the base. NT_E_NOT_FINITE; NT_E_RANGE below the substrate. */
NT_API nt_status nt_particles_begin(const nt_particles *particles, const double base[3], nt_particles_state *state);
/* Lays particle `number` of 0 .. count at rest at (x, y) [m], unstrained; it is taken away from where it was. NT_OK;
 * NT_E_NOT_FINITE; NT_E_CAPACITY: no such number; NT_E_STATE: the tip or another one touches it, here or there. What it
 * stored was 0 but for its bristles, whose part becomes heat. Left alone unless NT_OK. */
NT_API nt_status nt_particles_lay(const nt_particles *particles, nt_particles_state *state, int number,
                                  const double place[2]);
/* Leads the base to `base` [m] along a straight line, by steps as nt_particle_advance; after each, all particles and
 * the tip balance. What the tip loses or a particle gives way by is heat. NT_OK; NT_E_NOT_FINITE; NT_E_RANGE: below the
 * substrate, or farther than 1e7 steps; NT_E_NO_CONVERGENCE. Left alone unless NT_OK. */
NT_API NT_REALTIME nt_status nt_particles_advance(const nt_particles *particles, nt_particles_state *state,
                                                  const double base[3]);
/* Spheres: each slides at most; or each rolls, and they rub. A rod slides: q L. load >= 0 [N]. */
NT_API nt_pushed_bound nt_pushed_bound_of(const nt_pushed *pushed, double load);
/* b0 of the contact without load, b0^3 = 32 R^2 w/(pi E*) [m]. */
NT_API double nt_rod_half_width(const nt_rod *rod);
/* q = 2 b0 tau, of a length [N/m]. */
NT_API double nt_rod_friction(const nt_rod *rod);
/* Of a length before it slides, pi G* over ln(L/b0) [N/m^2]: a strip on a half space, in its middle. */
NT_API double nt_rod_stiffness(const nt_rod *rod);
/* Where a rod of even friction turns that is pushed across its axis at an arm of 0 .. L/2 from its middle: distance
 * from the middle on the other side, sqrt(arm^2 + L^2/4) - arm [m]. The push is 2 q times that. */
NT_API double nt_rod_turning_point(double length, double arm);
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
