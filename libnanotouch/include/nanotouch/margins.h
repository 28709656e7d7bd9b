/* SPDX-License-Identifier: BSD-3-Clause
 * How far the loop is from its stability limit, from numbers alone (docs/control.md, rules R1 to R5). */
#ifndef NANOTOUCH_MARGINS_H
#define NANOTOUCH_MARGINS_H

#include "nanotouch/settings.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nt_margins {
    double loop_stiffness;    /* kappa = (1 + K_f) alpha_f alpha_p k_eff at the stiffest contact [N/m] */
    double loop_delay;        /* D = 2 (T/2 + d T) + tau_stage [s] */
    double stability_limit;   /* R1: b_m/D [N/m] */
    double margin;            /* stability_limit/loop_stiffness [-]; 1 is the limit */
    double height_margin;     /* topography: of the height servo or of the master's spring, the smaller one [-] */
    double quantisation_step; /* R4: motor force of one step of stage or scaled master [N] */
    double force_noise;       /* R5: motor noise that the sensors' noise makes, RMS [N] */
} nt_margins;
/* contact_stiffness: k of the stiffest contact [N/m]; k_eff = k k_c/(k + k_c). Thread-safe. */
NT_API nt_margins nt_margins_compute(const nt_rig *rig, const nt_gains *gains, double contact_stiffness);
/* How far the force on the sample may exceed limits.force before a reaction shows [N]: what stage and surface come
 * closer during the loop's delay, times k_c, and 6 sigma of the reading. slope: of the surface, at its steepest [-]. */
NT_API double nt_margins_force_overshoot(const nt_rig *rig, const nt_settings *settings, double slope);
/* Largest loop stiffness of master and zero-order hold alone, without delay: the exact (Jury) limit [N/m]. */
NT_API double nt_margins_jury_limit(const nt_master *master, double period);

#ifdef __cplusplus
}
#endif
#endif
