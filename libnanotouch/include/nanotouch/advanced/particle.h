/* SPDX-License-Identifier: BSD-3-Clause
 * A sphere on a flat substrate, pushed by a tip: it sticks, slides, rolls, spins, or comes off with the tip.
 *
 * Two contacts, with the substrate and with the tip. Each has a normal law (contact.h), and three bristles, springs
 * that give way at a limit: against sliding, rolling and spinning. The sphere has six degrees of freedom and no
 * inertia: all its forces and torques balance, at every place of the tip. docs/manipulation.md has the equations. All
 * functions: thread-safe, no state but the caller's. */
#ifndef NANOTOUCH_PARTICLE_H
#define NANOTOUCH_PARTICLE_H

#include "nanotouch/advanced/field.h"
#include "nanotouch/contact.h"
#include "nanotouch/friction.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What one of its contacts is like. G over E of both bodies must be one that Poisson ratios allow: 1/6 .. 1/3. */
typedef struct nt_particle_contact {
    double model;                   /* nt_model: "hertz|dmt|jkr|maugis" */
    double effective_modulus;       /* E* [Pa] */
    double work_of_adhesion;        /* w [J/m^2] */
    double cohesive_stress;         /* sigma0, read by maugis only [Pa] */
    double effective_shear_modulus; /* G*, nt_effective_shear_modulus [Pa] */
    double shear_strength;          /* tau, friction per contact area [Pa] */
    double coefficient;             /* alpha, friction per load inside the contact [-] */
    double rolling_distance;        /* xi, way that the contact rolls before it gives way [m] */
} nt_particle_contact;

enum { NT_AT_SUBSTRATE, NT_AT_TIP, NT_PARTICLE_CONTACTS };

/* A particle, and the tip that pushes it: a sphere that runs into a cone, upright. */
typedef struct nt_particle {
    double radius;         /* R [m] */
    double tip_radius;     /* of the tip where it touches [m] */
    double tip_half_angle; /* psi of its cone [rad] */
    double step;           /* largest step of the tip; longer ways are divided [m] */
    nt_particle_contact contacts[NT_PARTICLE_CONTACTS];
} nt_particle;
/* Polystyrene of 5 um on glass, xi = 42 nm, tau = 12 MPa (Sumer and Sitti 2008); a silicon tip of 100 nm, 2 nm steps.
 */
NT_API nt_particle nt_particle_defaults(void);
/* The table of its fields, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_particle_fields(int *count);

/* One of its contacts made ready. */
typedef struct nt_particle_laws {
    nt_contact_law normal;
    nt_friction friction;
    double torsion_modulus;  /* 1/(1/G1 + 1/G2) [Pa] */
    double reduced_radius;   /* of both bodies [m] */
    double pull_off;         /* F_c [N] */
    double rest_indentation; /* without load [m] */
    double rest_radius;      /* a0, of the contact without load [m] */
    double rest_energy;      /* of the contact without load [J] */
    double rolling_distance; /* xi [m] */
} nt_particle_laws;

/* Immutable after nt_pushing_init; may be shared and copied. */
typedef struct nt_pushing {
    nt_particle particle;
    nt_particle_laws laws[NT_PARTICLE_CONTACTS];
} nt_pushing;
/* NT_OK, or what nt_particle_check refuses. */
NT_API nt_status nt_pushing_init(nt_pushing *pushing, const nt_particle *particle, nt_problem *problem);

/* What holds a contact against a sideways motion. */
enum { NT_SLIDING, NT_ROLLING, NT_SPINNING, NT_BRISTLES };
/* Limit of a contact of the radius a [m] and the load inside it [N]. Sliding: tau pi a^2 + alpha N [N]. Rolling: M = 4
 * F_c (a/a0)^1.5 xi [N m] (Dominik and Tielens 1995). Spinning: 2/3 pi tau a^3 + 3 pi/16 alpha a N [N m], the second
 * for the pressure of Hertz. */
NT_API NT_REALTIME double nt_particle_limit(const nt_particle_laws *laws, int bristle,
                                            const nt_friction_contact *contact);
/* Below the limit. Sliding: 8 a G* [N/m]. Rolling: 4 F_c (a/a0)^1.5 R [N m/rad], R reduced. Spinning: 16/3 a^3 G [N
 * m/rad] (Johnson 1985, Eq. 7.37 and 7.39). */
NT_API NT_REALTIME double nt_particle_stiffness(const nt_particle_laws *laws, int bristle, double radius);

/* A spring and how far it is stretched. Rolling and spinning are in metres of the particle's surface: R times an angle,
 * and torque over R. */
typedef struct nt_bristle {
    double pull[3];   /* k times the stretch [N] */
    double stiffness; /* k [N/m] */
    double given;     /* way that it has given so far, grows only [m] */
} nt_bristle;

/* Bits of nt_particle_state.modes: what happened on the last way. */
enum {
    NT_PARTICLE_SLID = 1u << NT_SLIDING,                       /* on the substrate, beyond the limit */
    NT_PARTICLE_ROLLED = 1u << NT_ROLLING,                     /* on the substrate */
    NT_PARTICLE_SPUN = 1u << NT_SPINNING,                      /* on the substrate, about the vertical */
    NT_PARTICLE_TIP_SLID = 1u << (NT_BRISTLES + NT_SLIDING),   /* at the tip */
    NT_PARTICLE_TIP_ROLLED = 1u << (NT_BRISTLES + NT_ROLLING), /* at the tip */
    NT_PARTICLE_TIP_SPUN = 1u << (NT_BRISTLES + NT_SPINNING),  /* at the tip, about the line of centres */
    NT_PARTICLE_LIFTED = 1u << 6,                              /* at its end: on the tip, off the substrate */
    NT_PARTICLE_APART = 1u << 7                                /* at its end: the tip does not touch it */
};

/* Where a particle is and what it remembers. Copyable. Always stored + dissipated = work. */
typedef struct nt_particle_state {
    double position[3]; /* of its centre; the substrate is z = 0 [m] */
    double turned[3];   /* sum of its turns about x, y, z [rad] */
    double tip[3];      /* apex of the tip [m] */
    double normal[3];   /* from the tip's point of contact to the centre of the particle [-] */
    nt_bristle bristles[NT_PARTICLE_CONTACTS][NT_BRISTLES];
    nt_law_value contacts[NT_PARTICLE_CONTACTS]; /* energy, force, stiffness and radius of each contact */
    int attached[NT_PARTICLE_CONTACTS];          /* 1: pulls or presses */
    double force[3];                             /* on the tip [N] */
    double stored;                               /* in contacts and bristles, 0 at rest on the substrate [J] */
    double dissipated;                           /* heat so far, grows only [J] */
    double work;                                 /* done by the hand so far [J] */
    unsigned modes;                              /* NT_PARTICLE_* of the last way */
} nt_particle_state;
/* At rest on the substrate at (x, y), unstrained; the apex of the tip at `tip`, where it must not touch or attract.
 * NT_OK; NT_E_NOT_FINITE; NT_E_RANGE: the tip touches it, or is below the substrate. */
NT_API nt_status nt_particle_place(const nt_pushing *pushing, double x, double y, const double tip[3],
                                   nt_particle_state *state);

/* Moves the apex of the tip to `tip` [m] along a straight line. A step is particle.step at most, and a tenth of the
 * contact's reach where the tip recedes and pulls; after each all forces and torques balance. It lets the sphere find
 * the nearest minimum of its energy, and what its bristles take for giving way; what a jump sets free becomes heat. The
 * error falls with the step (docs/manipulation.md). NT_OK; NT_E_NOT_FINITE; NT_E_RANGE below the substrate or farther
 * than 1e7 steps; NT_E_NO_CONVERGENCE. Left alone unless NT_OK. */
NT_API nt_status nt_particle_advance(const nt_pushing *pushing, nt_particle_state *state, const double tip[3]);

#ifdef __cplusplus
}
#endif
#endif
