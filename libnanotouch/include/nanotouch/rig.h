/* SPDX-License-Identifier: BSD-3-Clause
 * With what the sample is touched: probe, stage, master, sensors. Descriptions only, shared by plant and control. */
#ifndef NANOTOUCH_RIG_H
#define NANOTOUCH_RIG_H

#include "nanotouch/advanced/field.h"
#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* AFM cantilever, piezoresistive (paper, Eq. 2, Sec. II and IV-C). */
typedef struct nt_probe {
    double spring_constant;       /* k_c [N/m] */
    double tilt;                  /* alpha, cantilever against the sample plane [rad] */
    double sensitivity;           /* S, deflection per volt of the bridge [m/V] */
    double range;                 /* the electronics saturate at +- this [V] */
    double noise;                 /* deflection noise, peak to peak (6 sigma) [V] */
    double resolution;            /* ADC step [V] */
    double resonance;             /* f_0, free; the effective mass is 0.24 m_c = k_c/(2 pi f_0)^2 [Hz] */
    double quality;               /* Q, free [-] */
    double temperature;           /* of the thermal motion of the dynamic model, 0 for none [K] */
    double contact_viscosity;     /* eta: the contact of radius a damps with 2 m b_i = 2 eta a (Eq. 2) [Pa s] */
    double spring_constant_sigma; /* standard deviation of k_c's calibration over k_c [-] */
    double sensitivity_sigma;     /* the same of S [-] */
    double drift;                 /* of the deflection's zero, at most [m/s] */
    double lateral_stiffness;     /* k_l of the lever (torsion, bending in the plane) at the apex; 0: rigid [N/m] */
} nt_probe;

/* Piezoelectric z stage (paper, Eq. 13 with f_s/k_stage: erratum E15). */
typedef struct nt_stage {
    double resonance;          /* f_n [Hz] */
    double quality;            /* Q [-] */
    double stiffness;          /* k_stage, of the stage against the tip force [N/m] */
    double travel;             /* range of travel [m] */
    double resolution;         /* step of the position read-out (LVDT) [m] */
    double command_resolution; /* step of the position command [m] */
    double max_speed;          /* slew limit of the command [m/s] */
    double noise;              /* standard deviation of the read-out [m] */
    double hysteresis;         /* opening of the loop at full stroke over that stroke, open loop [-] */
    double creep;              /* drift after a step over the step, per decade of time, open loop [-] */
    double axes;               /* that it has: 1 (z: x and y stay where a session starts), or 3 [-] */
    double drift;              /* of the frame, tip against sample, at most [m/s] */
    double slip;               /* largest jump of the surface that is reckoned with [m] */
    double travel_sigma;       /* standard deviation of the calibration of what is driven, over it [-] */
    double position_sigma;     /* the same of the read-out [-] */
} nt_stage;

/* 1-degree-of-freedom haptic master (paper, Eq. 12). */
typedef struct nt_master {
    double mass;        /* m_m [kg] */
    double damping;     /* b_m [N s/m] */
    double friction;    /* Coulomb friction, sliding and sticking alike [N] */
    double travel;      /* x_m runs over -travel/2 .. +travel/2 [m] */
    double resolution;  /* step of the position sensor [m] */
    double max_force;   /* motor limit, +- [N] */
    double max_speed;   /* of the hand that holds it: the force fades fast enough for this (nt_motor_bound) [m/s] */
    int gauge;          /* "no|yes": an operator force sensor (strain gauge); without, f_m is not measured */
    double gauge_range; /* strain gauge, +- [N] */
    double gauge_noise; /* standard deviation of the strain gauge [N] */
    double gauge_resolution; /* step of the strain gauge [N] */
    int motor;               /* "no|yes": it can push back; without, it is a position device, as a mouse is */
    double rate;             /* of its own measurements, 0: that of the loop [Hz] */
    double axes;             /* that it has: 1 (it presses), or 3 (it moves the tip sideways, too) [-] */
} nt_master;

/* What holds the master, beside the force that it means to apply: f_m = force - m x'' - b x' - k (x - rest), moving
 * with the master. All zero: a pure force. A finger pad is b and k, a rigid finger is m. */
typedef struct nt_hand {
    double mass;         /* m_h [kg] */
    double damping;      /* b_h [N s/m] */
    double stiffness;    /* k_h [N/m] */
    double relaxation;   /* the rest position follows the master with this time constant, 0: it stays [s] */
    double random_force; /* adversary: a force anywhere within +- this is added [N] */
    double random_rate;  /* and changes this often, at random [1/s] */
} nt_hand;

/* Between sensors, computer and actuators. 0 stands for one that adds nothing of its own. */
typedef struct nt_converters {
    double adc_bits;    /* over the range of each sensor [-] */
    double adc_rate;    /* conversions per second [Hz] */
    double adc_latency; /* from the measured moment to the sample, the sample's age [s] */
    double dac_bits;    /* over the range of motor and stage [-] */
    double dac_latency; /* from the command to its effect [s] */
} nt_converters;

typedef struct nt_rig {
    nt_probe probe;
    nt_stage stage;
    nt_master master;
    nt_hand hand;
    nt_converters converters;
} nt_rig;

/* The paper's rig: k_c = 8 N/m, S = 0.033 um/V, +-10 V, 50 mV peak to peak; stage 450 Hz, Q = 20, 1 nm steps; master
 * 0.1 kg, 100 N s/m, 2 cm, +-5 N, gauge 0.02 N. */
NT_API nt_rig nt_rig_defaults(void);
/* NT_OK, or the first offending field in *problem (NULL allowed). */
NT_API nt_status nt_rig_check(const nt_rig *rig, nt_problem *problem);
/* The table behind the check: every field of nt_rig with unit, range and meaning; *count (NULL allowed) its length. */
NT_API const nt_field *nt_rig_fields(int *count);

/* The stage without its own servo: steps of 1 nm, hysteresis 15 %, creep 1 % per decade (usual for PZT, not in the
 * paper); and behind its servo: steps of 10 nm, neither (Sec. IV-C). */
NT_API nt_stage nt_stage_open_loop(void);
/* The same stage behind its own servo: steps of 10 nm, no hysteresis, no creep (Sec. IV-C). */
NT_API nt_stage nt_stage_closed_loop(void);

#ifdef __cplusplus
}
#endif
#endif
