/* SPDX-License-Identifier: BSD-3-Clause
 * What the operator chooses: mode, gains and limits of the loop. */
#ifndef NANOTOUCH_SETTINGS_H
#define NANOTOUCH_SETTINGS_H

#include "nanotouch/field.h"
#include "nanotouch/rig.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum nt_mode {
    NT_MODE_TOUCH,     /* the operator moves z and feels the force (point touch, tactile scan) */
    NT_MODE_TOPOGRAPHY /* z is servoed to a constant force, the operator feels the height only */
} nt_mode;

typedef struct nt_gains {
    double rate;             /* force loop, 1/T [Hz] */
    double alpha_p;          /* [m/m] */
    double alpha_f;          /* [N/N] */
    double force_gain;       /* K_f of Eq. 17 [-] */
    double force_filter;     /* low-pass of f_m [Hz] */
    double stage_damping;    /* zeta that the notch leaves to the stage's resonance [-] */
    double stage_integral;   /* integral gain of the stage loop [1/s] */
    double ramp_time;        /* force fades in over this on engagement [s] */
    double set_point;        /* force held in topography mode [N] */
    double height_gain;      /* integral gain of the height servo [1/s] */
    double height_stiffness; /* how hard the master is drawn to the height [N/m] */
    double delay;            /* conversion and computing delay of the rig [periods] */
} nt_gains;

typedef struct nt_limits {
    double force;            /* on the sample, either sign [N] */
    double stage_speed;      /* [m/s] */
    double lateral_speed;    /* [m/s] */
    double motor_force;      /* [N] */
    double motor_rate;       /* [N/s] */
    double retract_distance; /* RETRACT lifts by this [m] */
    double retract_speed;    /* at this [m/s] */
    double follow_error;     /* the stage may be this far from its command [m] ... */
    double follow_time;      /* ... for this long [s] */
} nt_limits;

typedef struct nt_settings {
    nt_gains gains;
    nt_limits limits;
} nt_settings;
/* 10 kHz, K_f = 2, scaling by the heuristic rule for a slave path of 0.4 um, limits inside the rig's ranges. */
NT_API nt_settings nt_settings_defaults(const nt_rig *rig);
NT_API const nt_field *nt_settings_fields(int *count);
NT_API nt_status nt_settings_check(const nt_settings *settings, nt_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
