/* SPDX-License-Identifier: BSD-3-Clause
 * Scaled bilateral teleoperation (paper, Sec. IV): numbers in, numbers out. The touch step sees neither device nor
 * clock nor scene; it may be called from any loop at a fixed rate. Derivations: docs/control.md. */
#ifndef NANOTOUCH_CONTROL_H
#define NANOTOUCH_CONTROL_H

#include "nanotouch/field.h"
#include "nanotouch/rig.h"
#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- scaling --- */

/* x_s = alpha_p x_m, f_m = alpha_f f_s (Eq. 16). */
typedef struct nt_scaling {
    double alpha_p; /* stage metres per master metre [m/m] */
    double alpha_f; /* operator newtons per tip newton [N/N] */
} nt_scaling;
/* The paper's heuristic rule (Eq. 19, 21 in SI; errata E17): the slave's path (clearance L + indentation and relief)
 * over the master's travel; the gauge's range over the probe's, from -attraction to the saturation of the electronics.
 */
NT_API nt_scaling nt_scaling_heuristic(const nt_rig *rig, double slave_path, double attraction);
/* Goldfarb's rules for l = alpha_p << 1: structure dominated 1/l, surface dominated 1/l^2 (Sec. IV-C). */
NT_API nt_scaling nt_scaling_structure(double alpha_p);
NT_API nt_scaling nt_scaling_surface(double alpha_p);

/* --- settings --- */

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

/* --- stability margins --- */

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

/* --- stage loop: x_s follows the reference: notch on the resonance, integral action on the read-out --- */

typedef struct nt_stage_loop {
    double b[3], a[3]; /* biquad in z^-1, a[0] = 1: zeros on the sampled poles of the stage */
    double integral;   /* integral gain per period [-] */
} nt_stage_loop;
typedef struct nt_stage_loop_state {
    double w[2];       /* filter memory [m] */
    double correction; /* integral of the error [m] */
} nt_stage_loop_state;
NT_API nt_stage_loop nt_stage_loop_make(const nt_stage *stage, const nt_gains *gains);
NT_API NT_REALTIME double nt_stage_loop_step(const nt_stage_loop *loop, nt_stage_loop_state *state, double reference,
                                             double measured);

/* --- passivity: master, controller and stage between hand and tip must swallow what the master's damping is due, at
 *     least in part; when they do not, the force gain backs off --- */

/* What does not change while it runs. */
typedef struct nt_passivity {
    double dead_zone;    /* what quantised positions may seem to release at full force [J] */
    double due;          /* b_m T times the share of the damping that must show [N s^2/m] */
    double force_gain;   /* K_f, which divides the damping that the operator feels [-] */
    double speed_filter; /* of the low-pass of the master's speed, per period [-] */
    double speed_floor;  /* what one step of the master seems to be [m/s] */
    double speed_limit;  /* the master cannot be so fast, a reading is wrong [m/s] */
    double period;       /* T [s] */
} nt_passivity;
/* One side, at the operator's scale. */
typedef struct nt_port {
    double force;    /* [N] */
    double position; /* [m] */
} nt_port;
typedef struct nt_passivity_state {
    double energy; /* swallowed beyond what was due since the last event, at most NT_PASSIVITY_STORE dead zones [J] */
    double gain;   /* factor on K_f, 1 .. 0 [-] */
    double speed;  /* of the master, filtered [m/s] */
    nt_port last_hand, last_tip;
    uint32_t trips;
} nt_passivity_state;
#define NT_PASSIVITY_STORE 10.0
NT_API nt_passivity nt_passivity_make(const nt_rig *rig, const nt_gains *gains);
/* hand: (f_m, x_m), in; tip: (alpha_f f_s, x_s/alpha_p), out. Returns the gain factor. */
NT_API NT_REALTIME double nt_passivity_step(const nt_passivity *passivity, nt_passivity_state *state,
                                            const nt_port *hand, const nt_port *tip);

/* --- supervisor: a pure function of sample, command and limits (the table in docs/safety.md) --- */

enum {
    NT_REASON_INVALID = 1u << 0,   /* NaN, infinite, beyond any reading of the sensor, or bad frame */
    NT_REASON_SATURATED = 1u << 1, /* deflection at the end of its range */
    NT_REASON_FORCE_LIMIT = 1u << 2,
    NT_REASON_STALE = 1u << 3,    /* sample older than 2 T */
    NT_REASON_STUCK = 1u << 4,    /* the deflection does not change while z moves */
    NT_REASON_FOLLOW = 1u << 5,   /* the stage does not follow */
    NT_REASON_UNSTABLE = 1u << 6, /* the passivity observer has taken all force gain away */
    NT_REASON_EMERGENCY_STOP = 1u << 7,
    NT_REASON_LIMIT_SWITCH = 1u << 8,
    NT_REASON_OPERATOR_CLIPPED = 1u << 9, /* the gauge is at its range: a flag, the state stays RUN */
    NT_REASON_COMMAND_LIMITED = 1u << 10  /* stage speed or travel is at its limit: a flag */
};
/* "force limit", ... of one reason bit; "" for none. */
NT_API const char *nt_reason_name(uint32_t reason);

typedef struct nt_supervisor_state {
    nt_state state;
    uint32_t reasons;
    uint32_t invalid_run;    /* invalid samples in a row */
    uint32_t stuck_run;      /* identical deflections in a row */
    double stuck_deflection; /* [m] */
    double stuck_position;   /* x_s where they began [m] */
    double follow_time;      /* the stage has been off for this long [s] */
} nt_supervisor_state;

struct nt_touch;
/* One tick. reference: where the stage was told to be [m]. Returns the new state, never less severe than RETRACT or
 * LATCHED once reached (nt_touch_arm). */
NT_API NT_REALTIME nt_state nt_supervisor_step(const struct nt_touch *touch, nt_supervisor_state *state,
                                               const nt_sample *sample, double reference, int unstable);

/* --- the touch step --- */

/* All that does not change while it runs. Immutable after nt_touch_make. */
typedef struct nt_touch {
    nt_rig rig;
    nt_settings settings;
    nt_mode mode;
    double period; /* T [s] */
    nt_stage_loop stage_loop;
    double force_filter; /* of the low-pass, per period [-] */
    double speed_filter; /* of the master's speed estimate, per period [-] */
    nt_passivity passivity;
} nt_touch;
typedef struct nt_touch_state {
    nt_supervisor_state supervisor;
    nt_passivity_state passivity;
    nt_stage_loop_state stage_loop;
    double reference;                       /* where the stage shall be [m] */
    double offset;                          /* reference = alpha_p x_m + offset: re-indexed after every stop [m] */
    double engaged;                         /* 0 .. 1, fades the force in and out [-] */
    double filtered_force;                  /* f_m behind its low-pass [N] */
    double speed;                           /* estimate of the master's speed [m/s] */
    double last_position;                   /* x_m of the last valid sample [m] */
    double motor_force;                     /* last command [N] */
    double coupled_force;                   /* what is left of the last command given in RUN [N] */
    double retracted;                       /* lifted so far [m] */
    double target_x, target_y, target_time; /* lateral set-point [m], time left to get there [s] */
    nt_command command;                     /* last command */
    uint64_t ticks;
} nt_touch_state;

/* Checks rig and settings, and that no limit promises more than the rig can keep. */
NT_API nt_status nt_touch_make(nt_touch *touch, const nt_rig *rig, const nt_settings *settings, nt_mode mode,
                               nt_problem *problem);
/* A loop at rest at (x, y), the stage at 0, the master at x_m (both finite), armed. */
NT_API nt_touch_state nt_touch_start(const nt_touch *touch, double master_position, double x, double y);
/* One control period. */
NT_API NT_REALTIME void nt_touch_step(const nt_touch *touch, nt_touch_state *state, const nt_sample *sample,
                                      nt_command *command);
/* Sends the tip to (x, y) on a straight line within `duration` >= 0 [s], no faster than the lateral limit. */
NT_API NT_REALTIME nt_status nt_touch_aim(const nt_touch *touch, nt_touch_state *state, double x, double y,
                                          double duration);
/* Back to RUN after RETRACT; after LATCHED only with confirmed = 1 (a person at the rig). The force fades in again, the
 * tip stays where it is until the next nt_touch_aim. NT_E_STATE if LATCHED and not confirmed. */
NT_API nt_status nt_touch_arm(nt_touch_state *state, int confirmed);

#ifdef __cplusplus
}
#endif
#endif
