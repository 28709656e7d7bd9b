/* SPDX-License-Identifier: BSD-3-Clause
 * Private to session/: a tip in the potential of sample and lever, V(z) = U(z) + K (z - z_b)^2/2 with K =
 * k_c/cos(alpha): where it jumps, how it rings, how hard it strikes. Nothing is simulated. */
#ifndef NANOTOUCH_SESSION_WELL_H
#define NANOTOUCH_SESSION_WELL_H

#include "nanotouch/interaction.h"
#include "nanotouch/plan.h"

#define NT_WELL_DEEPEST 10e-6 /* an indentation that nobody reaches [m] */
#define NT_WELL_NEAREST 1e-13 /* gaps are searched in ratios from here [m] */
#define NT_WELL_FARTHEST 1e-4 /* to here [m] */
#define NT_WELL_SEARCHES 400  /* places */
#define NT_WELL_BISECTIONS 60

typedef struct nt_well {
    nt_place place; /* stiffest and most adhesive, where a surface has properties */
    const nt_plan *plan;
    double spring;      /* K [N/m] */
    double rate;        /* w0 of the lever, free [rad/s] */
    double quality;     /* Q of it [-] */
    double stage_rate;  /* w_n of the stage [rad/s] ... */
    double stage_rings; /* ... and how far its own ringing takes it [m] */
    double base;        /* z_b [m] */
    double outside;     /* gap from which the tip falls [m] */
    double taken;       /* what adhesion dissipates when it takes hold [J] */
} nt_well;

/* The sample on the way in. */
nt_law_value nt_well_law(const nt_well *well, double gap);
/* As deep as contact carries `force` [N]: a gap [m], and one that is less deep to begin with. */
double nt_well_gap_of_force(const nt_well *well, double force, double shallow);
/* Energy about the bottom of contact that a jump leaves [J], of a base that comes closer at `speed` [m/s]; stiffness of
 * the sample there [N/m]. Sets outside and base. */
double nt_well_jump(nt_well *well, double speed, double *stiffness);
/* Energy that a lever let go by a pull-off still has where the base is down again [J]. */
double nt_well_freed(const nt_well *well, double speed);
/* Energy about the rest that the base presses to with `force` [N] of a swing that had `energy` about the bottom of
 * contact, where the sample has this stiffness [J], ... */
double nt_well_pressed(const nt_well *well, double force, double energy, double stiffness);
/* ... and of one that had it as a free lever, which strikes and leaves again on the way [J]. */
double nt_well_pressed_from_free(nt_well *well, double force, double energy);
/* What swings of `energy` [J] add to a force at rest [N]; depth [m]. */
double nt_well_peak(nt_well *well, double force, double energy, double *depth);

#endif
