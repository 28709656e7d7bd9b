/* SPDX-License-Identifier: BSD-3-Clause
 * Scaling factors between hand and tip (paper, Sec. IV-C), and how they change while the loop runs. */
#ifndef NANOTOUCH_SCALING_H
#define NANOTOUCH_SCALING_H

#include "nanotouch/settings.h"
#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* x_s = alpha_p x_m, f_m = alpha_f f_s (Eq. 16). */
typedef struct nt_scaling {
    double alpha_p; /* stage metres per master metre [m/m] */
    double alpha_f; /* operator newtons per tip newton [N/N] */
} nt_scaling;
/* The paper's heuristic rule (Eq. 19, 21 in SI; errata E17): the slave's path (clearance L + indentation and relief)
 * over the master's travel; the gauge's range over the probe's, from -attraction to the saturation of the electronics.
 */
NT_API nt_scaling nt_scaling_heuristic(const nt_rig *rig, double slave_path, double attraction);

/* --- changes while running. At the operator's scale the contact holds the energy (alpha_f/alpha_p) S, S the work that
 *     the tip has done on it. A fall of alpha_f/alpha_p takes energy away and is always allowed; a rise would give the
 *     operator energy that nobody has put in, so it has to be paid for: by what the hand has lost in the master's
 *     damping, kept in a tank --- */

typedef enum nt_region { NT_REGION_APPROACH, NT_REGION_INDENT, NT_REGION_RETRACT } nt_region;

typedef struct nt_rescale {
    double share;           /* of its value by which a scale may change in a period [-] */
    double threshold;       /* forces below this are free air [N] */
    double spring_constant; /* k_c [N/m] */
    double income;          /* half of what the damping takes from the hand in a period, over v^2 [N s^2/m] */
    double capacity;        /* of the tank [J] */
    double factors[3];      /* on alpha_f, by nt_region [-] */
} nt_rescale;
typedef struct nt_rescale_state {
    nt_scaling now;    /* in force */
    nt_scaling wanted; /* by the operator, in contact */
    nt_region region;
    double work;          /* of the tip on the contact, since it was free [J] */
    nt_sum tank;          /* [J] */
    double last_position; /* x_s [m] */
} nt_rescale_state;
/* What scales may change by on this rig, from its damping and rate; both have been checked. */
NT_API nt_rescale nt_rescale_make(const nt_rig *rig, const nt_settings *settings);
/* At these scales, free of contact, with an empty tank. */
NT_API nt_rescale_state nt_rescale_start(const nt_rescale *rescale, const nt_scaling *scaling);
/* One period: the tip's force [N], the stage [m], the master's speed [m/s]. Moves `now` towards `wanted` and region. */
NT_API NT_REALTIME void nt_rescale_step(const nt_rescale *rescale, nt_rescale_state *state, double slave_force,
                                        double stage_position, double master_speed);

#ifdef __cplusplus
}
#endif
#endif
