/* SPDX-License-Identifier: BSD-3-Clause
 * What a tip moves on a flat: spheres (particles.h) or a rod (rod.h). One interface to both, for who holds a tip and
 * need not know which it is, as a session. All functions: thread-safe, no state but the caller's. */
#ifndef NANOTOUCH_PUSHED_H
#define NANOTOUCH_PUSHED_H

#include "nanotouch/advanced/particles.h"
#include "nanotouch/advanced/rod.h"

#ifdef __cplusplus
extern "C" {
#endif

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

/* What all of them may do to a tip that presses with a load at most. */
typedef struct nt_pushed_bound {
    double resistance; /* sideways, before all gives way; what the tip pulls off comes on top [N] */
    double stiffness;  /* of the tip's contact, along its normal or across [N/m] */
    double pull_off;   /* of all that the tip may touch at once [N] */
} nt_pushed_bound;
/* Spheres: each slides at most; or each rolls, and they rub. A rod slides: q L. load >= 0 [N]. */
NT_API nt_pushed_bound nt_pushed_bound_of(const nt_pushed *pushed, double load);

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
