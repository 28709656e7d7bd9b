/* SPDX-License-Identifier: BSD-3-Clause
 * Parts of what a session reports before it is armed. */
#ifndef NANOTOUCH_INTERNAL_MARGINS_H
#define NANOTOUCH_INTERNAL_MARGINS_H

#include "nanotouch/margins.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How many steps a session has to work with (Eq. 20, 21 in SI). */
typedef struct nt_resolution {
    double slave_step;   /* delta_p: of the stage, command or read-out, the coarser [m] */
    double slave_force;  /* delta_f: of the probe's noise, peak to peak, or of one step of the stage, the coarser [N] */
    double slave_steps;  /* N_p over the path [-] */
    double force_steps;  /* N_f over the probe's range [-] */
    double master_steps; /* N_p of the master [-] */
    double gauge_steps;  /* N_f of the gauge; 0 without one [-] */
    double master_travel; /* what of the master's travel the path needs [m] */
    double master_force;  /* alpha_f delta_f: one step of force at the hand [N] */
} nt_resolution;

/* What sample and surface may do meanwhile. */
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

/* The sums above for a rig, settings and what the path holds ready; nothing is simulated. */
NT_API nt_guarantee nt_guarantee_compute(const nt_rig *rig, const nt_settings *settings, const nt_hazard *hazard);
/* The least of margin, exact limit and coupled margin: "R1 sideways", "exact sideways", "all axes". */
NT_API nt_verdict nt_verdict_sideways(const nt_sideways_margins *margins);
/* By how much more of its force along z a master of one axis feels, by its projection: a factor on alpha_f, >= 1. */
NT_API double nt_margins_projected(const nt_rig *rig, const nt_settings *settings, double contact_stiffness,
                                   const nt_sideways_contact *contact);
/* Where |Z| leaves +-3 dB of alpha_f alpha_p k_eff/w, the contact as it should be felt [Hz]; half the rate if nowhere
 * below; 0 without a contact. */
NT_API double nt_margins_bandwidth(const nt_rig *rig, const nt_gains *gains, double contact_stiffness);
/* slave_path: L + delta_max [m]. */
NT_API nt_resolution nt_resolution_compute(const nt_rig *rig, const nt_gains *gains, double slave_path);

#ifdef __cplusplus
}
#endif
#endif
