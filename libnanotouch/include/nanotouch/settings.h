/* SPDX-License-Identifier: BSD-3-Clause
 * What the operator chooses: mode, law, gains and limits of the loop. */
#ifndef NANOTOUCH_SETTINGS_H
#define NANOTOUCH_SETTINGS_H

#include "nanotouch/advanced/field.h"
#include "nanotouch/rig.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum nt_mode {
    NT_MODE_TOUCH,      /* the operator moves z and feels the force (point touch, tactile scan) */
    NT_MODE_TOPOGRAPHY, /* z is servoed to a constant force, the operator feels the height only */
    NT_MODE_APPROACH,   /* down at approach_speed until the set-point is felt, then held there */
    NT_MODE_CURVE,      /* down to the set-point, up again by curve_length, at approach_speed */
    NT_MODE_TAPPING     /* z is servoed to a constant amplitude of a driven lever; from opening to closing */
} nt_mode;
#define NT_MODE_WORDS "touch|topography|approach|curve|tapping"

typedef enum nt_control_choice {
    NT_CONTROL_DEFAULT,
    NT_CONTROL_PAPER,
    NT_CONTROL_IMPEDANCE,
    NT_CONTROL_OWN
} nt_control_choice;
#define NT_CONTROL_WORDS "default|paper|impedance|own"

struct nt_signals;
struct nt_effort;
struct nt_gains;

/* Which law (control.h). All zero: the default one. */
typedef struct nt_control {
    nt_control_choice choice;
    struct nt_effort (*law)(void *context, const struct nt_gains *gains, const struct nt_signals *signals); /* OWN */
    void *context;                                                                                          /* OWN */
} nt_control;

typedef struct nt_gains {
    double rate;                 /* force loop, 1/T [Hz] */
    double alpha_p;              /* stage over master [m/m] */
    double alpha_f;              /* operator over tip [N/N] */
    double alpha_f_approach;     /* factor on alpha_f before contact [-] */
    double alpha_f_retract;      /* factor on alpha_f where the tip is held by adhesion [-] */
    double force_gain;           /* K_f of Eq. 17 [-] */
    double force_filter;         /* low-pass of f_m [Hz] */
    double velocity_feedforward; /* beta, share of the master's damping that the motor takes over [-] */
    double stage_damping;        /* zeta that the notch leaves to the stage's resonance [-] */
    double stage_integral;       /* integral gain of the stage loop [1/s] */
    double stage_proportional;   /* K_p of Eq. 17, the paper's law only [-] */
    double stage_derivative;     /* K_v of Eq. 17, the paper's law only [s] */
    double coupling_stiffness;   /* of the spring between master and virtual tool, 0: rigid [N/m] */
    double coupling_damping;     /* of the virtual tool against the ground [N s/m] */
    double projection_x;         /* share of the lateral tip force that a master of one axis feels along z ... */
    double projection_y;         /* ... of x, and of y; 0: z alone [-] */
    double ramp_time;            /* force fades in over this on engagement, a new scale too [s] */
    double set_point;            /* force held in topography mode, sought in approach and curve [N] */
    double height_gain;          /* integral gain of the height servo [1/s] */
    double height_stiffness;     /* how hard the master is drawn to the height [N/m] */
    double approach_speed;       /* of the stage in approach and curve [m/s] */
    double curve_length;         /* a curve draws back by this from where it turned [m] */
    double delay;                /* conversion, computing and link delay of the rig [periods] */
} nt_gains;

typedef struct nt_limits {
    double force;            /* on the sample, either sign [N] */
    double lateral_force;    /* on the sample in x and y, where the lever shows it [N] */
    double indentation;      /* of tip and sample past first touch [m] */
    double stage_speed;      /* [m/s] */
    double lateral_speed;    /* [m/s] */
    double motor_force;      /* [N] */
    double motor_rate;       /* [N/s] */
    double motor_power;      /* that the motor may put into the hand [W] */
    double retract_distance; /* RETRACT lifts by this [m] */
    double retract_speed;    /* at this [m/s] */
    double follow_error;     /* the stage may be this far from its command [m] ... */
    double follow_time;      /* ... for this long [s] */
    double deflection_bias;  /* what the tare may find at the deflection [m] ... */
    double deflection_drift; /* ... and how fast it may change [m/s] */
    double gauge_bias;       /* the same of the hand's gauge [N] ... */
    double gauge_drift;      /* ... [N/s] */
} nt_limits;

/* Drive and lock-in amplifier, of mode tapping alone; K_I is gains.height_gain. */
typedef struct nt_tap {
    int at;                /* "tip|base": where a simulated lever is driven (tapping.h) */
    double frequency;      /* of the drive, 0: at the free resonance [Hz] */
    double free_amplitude; /* A0, of the deflection far from the sample [m] */
    double tolerance;      /* by which the free amplitude may differ from A0 when a session opens, over A0 [-] */
    int hold;              /* "amplitude|phase": what the height servo keeps */
    double set_amplitude;  /* that is held, over A0 [-] */
    double set_phase;      /* lag that is held, of a tip that is repelled [rad] */
    double lock_in;        /* time constant of the lock-in amplifier [s] */
    double noise;          /* of a reading of the amplitude, standard deviation [m] */
    double resolution;     /* step of that reading, 0: none [m] */
} nt_tap;

typedef struct nt_settings {
    nt_gains gains;
    nt_limits limits;
    nt_tap tap;
    nt_control control;
} nt_settings;
/* 10 kHz, K_f = 2, scaling by the heuristic rule for a slave path of 0.4 um, limits inside the rig's ranges; the
 * impedance law if the rig has no gauge. */
NT_API nt_settings nt_settings_defaults(const nt_rig *rig);
/* Lowers what would press harder than a load [N], as the largest one of a scene: the force limit to it, the set-point
 * to half of it. Infinity lowers nothing. */
NT_API void nt_settings_keep_to(nt_settings *settings, double load);
/* The table of gains, limits and tap; *count (NULL allowed) its length. */
NT_API const nt_field *nt_settings_fields(int *count);
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_settings_check(const nt_settings *settings, nt_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
