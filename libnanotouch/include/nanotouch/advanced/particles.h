/* SPDX-License-Identifier: BSD-3-Clause
 * Several equal particles on one substrate, and a tip on a lever that pushes them: the base is led, the tip follows
 * through three springs, and a particle pushes those that lie in its way.
 *
 * Particles that the tip may reach, and those that these may reach, balance together with the tip, as one particle does
 * (particle.h). Two of them touch by a contact law with bristles of its own. All functions: thread-safe, no state but
 * the caller's. */
#ifndef NANOTOUCH_PARTICLES_H
#define NANOTOUCH_PARTICLES_H

#include "nanotouch/advanced/particle.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { NT_PARTICLES = 6, NT_PARTICLE_PAIRS = NT_PARTICLES * (NT_PARTICLES - 1) / 2 };

/* What lies there, and what pushes. */
typedef struct nt_particles_setup {
    nt_particle particle;        /* what each is like, and the tip */
    nt_particle_contact between; /* two of them */
    double lever[3];             /* stiffness between base and tip along x, y, z; 0: the tip is held there [N/m] */
} nt_particles_setup;
/* The defaults of particle.h; between them Hertz, tau = 12 MPa, and no adhesion; the tip is held. */
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

#ifdef __cplusplus
}
#endif
#endif
