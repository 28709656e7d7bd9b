/* SPDX-License-Identifier: BSD-3-Clause
 * With what the sample is touched: probe, stage, master, sensors. Descriptions only, shared by plant and control. */
#ifndef NANOTOUCH_RIG_H
#define NANOTOUCH_RIG_H

#include "nanotouch/field.h"
#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* AFM cantilever, piezoresistive (paper, Sec. II and IV-C). */
typedef struct nt_probe {
    double spring_constant; /* k_c [N/m] */
    double tilt;            /* alpha, cantilever against the sample plane [rad] */
    double sensitivity;     /* S, deflection per volt of the bridge [m/V] */
    double range;           /* the electronics saturate at +- this [V] */
    double noise;           /* deflection noise, peak to peak (6 sigma) [V] */
    double resolution;      /* ADC step [V] */
} nt_probe;

/* Piezoelectric z stage (paper, Eq. 13 with f_s/k_stage: erratum E15). */
typedef struct nt_stage {
    double resonance;          /* f_n [Hz] */
    double quality;            /* Q [-] */
    double stiffness;          /* k_stage, of the stage against the tip force [N/m] */
    double travel;             /* range of travel [m] */
    double resolution;         /* step of the position read-out [m] */
    double command_resolution; /* step of the position command [m] */
    double max_speed;          /* slew limit of the command [m/s] */
} nt_stage;

/* 1-degree-of-freedom haptic master (paper, Eq. 12). */
typedef struct nt_master {
    double mass;             /* m_m [kg] */
    double damping;          /* b_m [N s/m] */
    double travel;           /* x_m runs over -travel/2 .. +travel/2 [m] */
    double resolution;       /* step of the position sensor [m] */
    double max_force;        /* motor limit, +- [N] */
    double gauge_range;      /* strain gauge, +- [N] */
    double gauge_noise;      /* standard deviation of the strain gauge [N] */
    double gauge_resolution; /* step of the strain gauge [N] */
} nt_master;

typedef struct nt_rig {
    nt_probe probe;
    nt_stage stage;
    nt_master master;
} nt_rig;

/* The paper's rig: k_c = 8 N/m, S = 0.033 um/V, +-10 V, 50 mV peak to peak; stage 450 Hz, Q = 20, 1 nm steps; master
 * 0.1 kg, 100 N s/m, 2 cm, +-5 N, gauge 0.02 N. */
NT_API nt_rig nt_rig_defaults(void);
/* NT_OK, or the first offending field in *problem (NULL allowed). */
NT_API nt_status nt_rig_check(const nt_rig *rig, nt_problem *problem);
/* The table behind the check: every field of nt_rig with unit, range and meaning; *count (NULL allowed) its length. */
NT_API const nt_field *nt_rig_fields(int *count);

/* Largest deflection the probe can report, range x sensitivity [m]. */
NT_API double nt_probe_deflection_range(const nt_probe *probe);
/* Standard deviation of the force read-out: k_c S noise/6 [N]. */
NT_API double nt_probe_force_noise(const nt_probe *probe);

#ifdef __cplusplus
}
#endif
#endif
