/* SPDX-License-Identifier: BSD-3-Clause
 * The hard guarantee, to be read before arming: whatever the operator does, force and indentation stay below a limit
 * and a bound on how far it can be overshot before the reaction shows. */
#ifndef NANOTOUCH_GUARANTEE_H
#define NANOTOUCH_GUARANTEE_H

#include "nanotouch/settings.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the surface may do meanwhile. */
typedef struct nt_hazard {
    double slope;         /* of the surface where it is steepest, dilated by the tip [-] */
    double snap_in_force; /* largest attraction that can pull the tip in, positive [N] */
    double stiffness;     /* of the stiffest contact [N/m] */
    double unseen;        /* indentation at which the force leaves the noise of the reading [m] */
} nt_hazard;

typedef struct nt_guarantee {
    double reaction_time; /* from the sample that shows it until the stage turns [s] */
    double motion;        /* stage and surface come closer meanwhile, times stiffness [N] */
    double ringing;       /* the stage's resonance, excited by its own commands [N] */
    double snap_in;       /* the tip arrives with the energy of the attraction [N] */
    double noise;         /* 6 sigma and a step of the reading [N] */
    double force;         /* limit and all four: never more than this on the sample, either sign [N] */
    double with_faults;   /* the same whatever fails at once: a stage that turns its sign while nothing is read of it is
                             lifted into the sample, by all of retract_distance [N] */
    double indentation;   /* never more than this past first touch, at rest sideways [m] */
    int moves_sideways;   /* 0: the stage has one axis, and all this holds at the place where the session starts */
} nt_guarantee;
NT_API nt_guarantee nt_guarantee_compute(const nt_rig *rig, const nt_settings *settings, const nt_hazard *hazard);

#ifdef __cplusplus
}
#endif
#endif
