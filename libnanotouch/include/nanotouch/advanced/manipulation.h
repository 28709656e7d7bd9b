/* SPDX-License-Identifier: BSD-3-Clause
 * What a tip pushes on a flat substrate: one sphere, several, or a rod. docs/manipulation.md has the equations. All
 * functions: thread-safe, no state but the caller's.
 *
 * A sphere sticks, slides, rolls, spins, or comes off with the tip. Two contacts, with the substrate and with the tip.
 * Each has a normal law (contact.h), and three bristles, springs that give way at a limit: against sliding, rolling and
 * spinning. The sphere has six degrees of freedom and no inertia: all its forces and torques balance, at every place of
 * the tip. */
#ifndef NANOTOUCH_ADVANCED_MANIPULATION_H
#define NANOTOUCH_ADVANCED_MANIPULATION_H

#include "nanotouch/advanced/field.h"
#include "nanotouch/contact.h"
#include "nanotouch/friction.h"
#include "nanotouch/status.h"

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

/* --- Several equal particles on one substrate, and a tip on a lever that pushes them: the base is led, the tip follows
 * through three springs, and a particle pushes those that lie in its way.
 *
 * Particles that the tip may reach, and those that these may reach, balance together with the tip, as one particle does
 * (nt_particle). Two of them touch by a contact law with bristles of its own. All functions: thread-safe, no state but
 * the caller's. --- */

enum { NT_PARTICLES = 6, NT_PARTICLE_PAIRS = NT_PARTICLES * (NT_PARTICLES - 1) / 2 };

/* What lies there, and what pushes. */
typedef struct nt_particles_setup {
    nt_particle particle;        /* what each is like, and the tip */
    nt_particle_contact between; /* two of them */
    double lever[3];             /* stiffness between base and tip along x, y, z; 0: the tip is held there [N/m] */
} nt_particles_setup;
/* The defaults of one particle; between them Hertz, tau = 12 MPa, and no adhesion; the tip is held. */
NT_API nt_particles_setup nt_particles_defaults(void);
/* The table of what it has beside the particle's own fields; *count (NULL allowed) its length. */
NT_API const nt_field *nt_particles_fields(int *count);

/* Immutable after nt_particles_init; may be shared and copied. */
typedef struct nt_particles {
    nt_pushing pushing;
    nt_particle_contact between;
    nt_particle_laws pair; /* of two particles */
    double lever[3];       /* [N/m] */
} nt_particles;
/* NT_OK, or what nt_particles_check refuses. */
NT_API nt_status nt_particles_init(nt_particles *particles, const nt_particles_setup *setup, nt_problem *problem);

/* Contact of the particles i < j, in the order (0, 1), (0, 2), ... of all NT_PARTICLES. */
typedef struct nt_particle_pair {
    nt_bristle bristles[NT_BRISTLES];
    nt_law_value contact;
    double normal[3]; /* from the middle of i to that of j [-] */
    int attached;     /* 1: pulls or presses */
} nt_particle_pair;

/* Where all of them are, and what they remember. Copyable. Always stored + dissipated = work. Of each particle `stored`
 * and `dissipated` are those of its contacts with substrate and tip; `work` is 0. */
typedef struct nt_particles_state {
    int count;
    double base[3];    /* where the tip's apex would be without a force [m] */
    double tip[3];     /* apex of the tip [m] */
    double force[3];   /* of all particles on the tip: what the lever shows [N] */
    double resistance; /* -dF_z by the tip's way along z, where it is held there [N/m] */
    double stored;     /* in contacts, bristles and lever, 0 at rest [J] */
    double dissipated; /* heat so far, grows only [J] */
    double work;       /* done on the base so far [J] */
    nt_particle_state particles[NT_PARTICLES];
    nt_particle_pair pairs[NT_PARTICLE_PAIRS];
} nt_particles_state;

/* --- A straight round rod on a flat, pushed by a tip: it slides and turns in the plane (docs/manipulation.md).
 *
 * It adheres as a cylinder (Chaudhury, Weaver, Hui, Kramer 1996): F/L = pi E* b^2/(4 R) - sqrt(2 pi E* b w), b half of
 * the width of the contact. Friction is spread along the line of contact: each piece is a spring that gives way at a
 * limit. It does not roll about its axis, and does not bend. The tip is a sphere that runs into an upright cone, seen
 * from the rod's axis a wedge; it presses along the normal of what it touches with, without adhesion and friction. All
 * functions: thread-safe, no state but the caller's. --- */

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

/* --- What a tip moves on a flat: spheres or a rod. One interface to both, for who holds a tip and
 * need not know which it is, as a session. All functions: thread-safe, no state but the caller's. --- */

typedef enum nt_pushed_kind { NT_PUSHED_NOTHING, NT_PUSHED_PARTICLES, NT_PUSHED_ROD } nt_pushed_kind;

/* What may lie there, checked and made ready. Immutable; may be shared and copied. */
typedef struct nt_pushed {
    nt_pushed_kind kind;
    union {
        nt_particles particles;
        nt_rod rod;
    } of;
} nt_pushed;
/* Spheres, as nt_particles_init made them. */
NT_API nt_pushed nt_pushed_particles(const nt_particles *particles);
/* A rod that nt_rod_check has found good. */
NT_API nt_pushed nt_pushed_rod(const nt_rod *rod);
/* The same, under a tip that hangs on a lever of this stiffness along x and y, and is held along z [N/m]. */
NT_API nt_pushed nt_pushed_under(const nt_pushed *pushed, double lever);

/* One of them. */
typedef struct nt_pushed_body {
    double place[3]; /* x, y, z of its middle [m] */
    double angle;    /* of a rod's axis from x; 0 of a sphere [rad] */
    double force[3]; /* on the tip [N] */
    int touched;     /* 1: the tip touches it */
} nt_pushed_body;

/* Where they are, and what they remember. Copyable. */
typedef struct nt_pushed_state {
    int count;         /* that lie there */
    double force[3];   /* of all on the tip [N] */
    double resistance; /* -dF_z by the tip's way along z [N/m] */
    double stored;     /* in contacts, springs and lever, 0 at rest [J] */
    double dissipated; /* heat so far, grows only [J] */
    nt_pushed_body bodies[NT_PARTICLES];
    union {
        nt_particles_state particles;
        nt_rod_state rod;
    } memory;
} nt_pushed_state;
/* Nothing lies there. NT_E_NOT_FINITE; NT_E_RANGE: the base is below the substrate. */
NT_API nt_status nt_pushed_begin(const nt_pushed *pushed, const double base[3], nt_pushed_state *state);
/* Lays number 0 .. count at rest at x, y [m], a rod with its angle [rad]; one that lies there already is taken away
 * from where it was, and what its springs stored becomes heat. NT_E_NOT_FINITE; NT_E_CAPACITY: no such number, a rod
 * has one; NT_E_STATE: the tip or another one touches it, here or there. Left alone unless NT_OK. */
NT_API nt_status nt_pushed_lay(const nt_pushed *pushed, nt_pushed_state *state, int number, const double pose[3]);
/* The state when the tip's base, at `from`, is led to `base` [m] along a straight line: in *to. Fails as
 * nt_particles_advance, nt_rod_advance; *to is of no use then. */
NT_API NT_REALTIME nt_status nt_pushed_advance(const nt_pushed *pushed, const nt_pushed_state *from,
                                               const double base[3], nt_pushed_state *to);
/* Copies as much as there is. */
NT_API NT_REALTIME void nt_pushed_copy(const nt_pushed *pushed, nt_pushed_state *to, const nt_pushed_state *from);

#ifdef __cplusplus
}
#endif
#endif
