/* SPDX-License-Identifier: BSD-3-Clause
 * The hard guarantee, to be read before arming: whatever the operator does, force and indentation stay below a limit
 * and a bound on how far it can be overshot before the reaction shows; and another bound for when one thing fails. */
#ifndef NANOTOUCH_GUARANTEE_H
#define NANOTOUCH_GUARANTEE_H

#include "nanotouch/settings.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NT_GUARANTEE_SIGMAS 3.0 /* of the calibration */

/* What may fail, one at a time. */
typedef enum nt_failure {
    NT_FAILURE_READ_OUT, /* the deflection is read with a wrong gain, or its zero drifts away */
    NT_FAILURE_SENSOR,   /* the deflection does not change any more */
    NT_FAILURE_SLIP,     /* the stage sticks and then slips, or the surface jumps */
    NT_FAILURE_STAGE,    /* the stage goes too far, too fast or the wrong way */
    NT_FAILURES
} nt_failure;
/* "deflection read wrong", ...; "" for none. */
NT_API const char *nt_failure_name(nt_failure failure);

/* What sample and surface may do meanwhile (hazard.h). */
typedef struct nt_hazard {
    double slope; /* of the surface where it is steepest, dilated by the tip [-] */
    double rise;  /* of a tip that slides from the softest place to the hardest, as deep as it is pressed [m] */
    double pull_off_force; /* the strongest pull, positive [N] */
    double snap_in;        /* what the energy of a jump adds at the peak, pressed with all that can be [N] ... */
    double snap_in_depth;  /* ... and to the indentation [m] */
    double arrival;        /* the same at first touch, before anything presses [N] */
    double thermal;        /* what of snap_in is thermal motion, which never dies away [N] */
    double ring_down;      /* the rest dies away with this time constant, 2 Q/w0 of the lever [s] */
    double stiffness;      /* of the stiffest contact, on the mean from the limit to all that is promised [N/m] ... */
    double failing[NT_FAILURES]; /* ... and on to what a failure adds; 0: no more than that [N/m] */
    double tared;                /* the sample's force where the tare is taken, which nobody reads from then on [N] */
    double unseen;               /* indentation at which the force leaves the noise of the reading [m] */
    double stick;                /* what holds a tip sideways, tip and lever in series [N/m] */
    double friction;             /* largest friction, as all that is promised presses [N] */
    double curvature;            /* of the surface [1/m] */
    double deepest;              /* indentation that no force presses beyond, as all that is promised presses [m] */
} nt_hazard;

typedef struct nt_guarantee {
    double reaction_time;        /* from the sample that shows it until the stage turns [s] */
    double speed;                /* at which tip and surface come closer, at most [m/s] */
    double calibration;          /* of the limit, if k_c and sensitivity are off by 3 sigma [N] */
    double motion;               /* stage and surface come closer meanwhile, times stiffness [N] */
    double ringing;              /* the stage's resonance, excited by its own commands and their steps [N] */
    double snap_in;              /* what is left of the swing of a jump when the force is there [N] */
    double arrival;              /* a snap-in alone presses with this, limit or not [N] */
    double noise;                /* 6 sigma and a step of the reading [N] */
    double tare;                 /* the sample's force at the start, which the tare takes off [N] */
    double force;                /* limit and all six: never more than this on the sample, either sign [N] */
    double zero_drift;           /* and this more for each second since the tare [N/s] */
    double failure[NT_FAILURES]; /* what each adds; infinite where nothing would show it [N] */
    double with_failure;         /* force and the largest of them [N] */
    double indentation;          /* never more than this past first touch, at rest sideways [m] */
    double lateral_force;        /* never more than this on the sample in x and y [N] */
    double help_time;            /* the stage can lift from the drift of the frame for this long [s] ... */
    double frame_drift;          /* ... a stop that cannot lift is pressed by this much more in a second [N/s] */
    int moves_sideways; /* 0: the stage has one axis, and all this holds at the place where the session starts */
} nt_guarantee;
/* The sums above for a rig, settings and what the path holds ready; nothing is simulated. */
NT_API nt_guarantee nt_guarantee_compute(const nt_rig *rig, const nt_settings *settings, const nt_hazard *hazard);

#ifdef __cplusplus
}
#endif
#endif
