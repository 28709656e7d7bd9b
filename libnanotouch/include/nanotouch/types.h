/* SPDX-License-Identifier: BSD-3-Clause
 * The few types that every layer shares. Strict SI.
 *
 * Frames and signs (docs/frames.md): z away from the sample; gap h = z_t - z_s(x, y) of the undeformed bodies;
 * indentation delta = -h; force F on the tip: + repulsive, - attractive; cantilever deflection zeta > 0 away from the
 * sample, so that F = k_c zeta at rest; master position, operator and motor force + towards the sample. */
#ifndef NANOTOUCH_TYPES_H
#define NANOTOUCH_TYPES_H

#include <stdint.h>

#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What adds up over a session. A double also where the touch step is made in single precision (tools/single.py), in
 * which a slow approach would stand still. */
typedef double nt_sum;

/* What every law returns. U is a potential of the indentation: F = dU/d(delta), k = dF/d(delta). */
typedef struct nt_law_value {
    double U; /* energy [J] */
    double F; /* force on the tip, + repulsive [N] */
    double k; /* stiffness dF/d(delta) = -dF/dh [N/m]; negative where attraction grows on approach */
    double a; /* contact radius [m]; 0 where the bodies do not touch */
} nt_law_value;

/* Arrays of a law: out[i * out_stride] from in[i * in_stride]; in and out may be the same array. */
typedef struct nt_strided {
    const double *in;      /* of indentations or gaps [m] */
    double *U, *F, *k, *a; /* [J], [N], [N/m], [m]; any may be NULL */
    long count;
    long in_stride, out_stride; /* [elements] */
} nt_strided;

/* Measured error of a law or tier against its reference. */
typedef struct nt_accuracy {
    double force_error; /* max |dF| / max(|F|, |F_pull-off|) away from folds [-] */
    double fold_shift;  /* max shift of a fold in indentation [m] */
    double model_error; /* distance to the next better physical model, same norm as force_error, not part of it [-] */
} nt_accuracy;

/* What an iterative solver did; every solver takes an optional pointer to one. */
typedef struct nt_solve_info {
    int iterations;  /* function evaluations */
    double residual; /* last residual [-] */
} nt_solve_info;

/* A point in the world frame. */
typedef struct nt_pose {
    double x, y, z; /* [m] */
} nt_pose;

/* Components of what has three of them. x and y are the world's; the third one of master and stage presses: + towards
 * the sample. Deflections have the third one upwards, away from the sample. */
enum { NT_X, NT_Y, NT_Z, NT_AXES };

/* Flags of a sample. */
enum {
    NT_SAMPLE_EMERGENCY_STOP = 1u << 0, /* pressed, or its line is lost */
    NT_SAMPLE_LIMIT_SWITCH = 1u << 1,   /* the stage stands at its end switch */
    NT_SAMPLE_INVALID = 1u << 2,        /* the backend itself knows that the frame is bad (CRC, short transfer) */
    NT_SAMPLE_SATURATED = 1u << 3,      /* the deflection stood at the end of its range before the tare was taken off */
    NT_SAMPLE_DEVICE_LOST = 1u << 4,    /* a device is gone */
    /* Of a sample that is INVALID or DEVICE_LOST nothing is a measurement, unless one device alone is to blame: */
    NT_SAMPLE_MASTER_ALONE = 1u << 5, /* the master is; the slave's numbers are measurements */
    NT_SAMPLE_SLAVE_ALONE = 1u << 6   /* the slave is; the master's numbers are measurements */
};

/* What the rig measured in one tick. */
typedef struct nt_sample {
    uint64_t tick;                   /* counts control periods [-] */
    double age;                      /* time since the slave's measurement [s] */
    double master_age;               /* since the master's [s] */
    double lateness;                 /* of this tick against its deadline, 0 where nobody measures it [s] */
    double master_position[NT_AXES]; /* x_m [m] */
    double operator_force[NT_AXES];  /* f_m [N] */
    double stage_position[NT_AXES];  /* x and y of the tip, and x_s, the travel towards the sample [m] */
    double deflection[NT_AXES];      /* of the cantilever: sideways where it is measured, and zeta [m] */
    double amplitude;                /* of a lever that taps, at the drive's frequency; else NaN [m] */
    double lag;                      /* of its deflection behind the drive; else NaN [rad] */
    uint32_t flags;                  /* NT_SAMPLE_* */
} nt_sample;

/* Safety state of the loop, in rising order of severity. */
typedef enum nt_state { NT_RUN, NT_HOLD, NT_RETRACT, NT_LATCHED } nt_state;

/* What the rig is told to do in one tick. */
typedef struct nt_command {
    double motor_force[NT_AXES];    /* tau_m [N] */
    double stage_position[NT_AXES]; /* x and y of the tip, and x_s [m] */
    double drive_amplitude;         /* that a lever shall tap with far from the sample; 0: no drive [m] */
    double drive_frequency;         /* [Hz] */
    uint32_t state;                 /* nt_state after this tick */
    uint32_t reasons;               /* NT_REASON_* bits (control.h) that explain the state */
} nt_command;

#ifdef __cplusplus
}
#endif
#endif
