/* SPDX-License-Identifier: BSD-3-Clause
 * What the touch step (touch.h) is made of: scales between hand and tip, control laws, and the supervisor. */
#ifndef NANOTOUCH_CONTROL_H
#define NANOTOUCH_CONTROL_H

#include "nanotouch/settings.h"
#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- Scales between hand and tip (paper, Sec. IV-C) --- */

/* x_s = alpha_p x_m, f_m = alpha_f f_s (Eq. 16). */
typedef struct nt_scaling {
    double alpha_p; /* stage metres per master metre [m/m] */
    double alpha_f; /* operator newtons per tip newton [N/N] */
} nt_scaling;
/* The paper's heuristic rule (Eq. 19, 21 in SI; errata E17): the slave's path (clearance L + indentation and relief)
 * over the master's travel; the gauge's range over the probe's, from -attraction to the saturation of the electronics.
 */
NT_API nt_scaling nt_scaling_heuristic(const nt_rig *rig, double slave_path, double attraction);

/* --- Changes of scale while running. At the operator's scale the contact holds the energy (alpha_f/alpha_p) S, S the
 * work that the tip has done on it. A fall of alpha_f/alpha_p takes energy away and is always allowed; a rise would
 * give the operator energy that nobody has put in, so it has to be paid for: by what the hand has lost in the master's
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

/* --- Control laws: from what is measured to the motor force and to where the stage shall be, once per period. Three
 * are here, and anybody's own may take their place under the same supervisor and limits. --- */

/* What a law is given. All numbers are finite. */
typedef struct nt_signals {
    double period;          /* T [s] */
    double master_position; /* x_m [m] */
    double master_speed;    /* of x_m, by differences [m/s] */
    double smooth_speed;    /* the same behind a low-pass of 20 Hz: positions come in steps [m/s] */
    double operator_force;  /* f_m, 0 where there is no gauge [N] */
    double smooth_force;    /* the same behind gains.force_filter [N] */
    double slave_force;     /* f_s = k_c zeta [N] */
    double felt_force;      /* the same, or what a virtual coupling makes of it: to be reflected [N] */
    double stage_position;  /* x_s [m] */
    double stage_speed;     /* of x_s, by differences [m/s] */
    double target;          /* alpha_p x_m from where it was last indexed: x_s by Eq. 16 [m] */
    nt_scaling scaling;     /* in force now */
    double master_damping;  /* b_m [N s/m] */
    double gain_factor;     /* 1, less when the passivity observer has backed off: on K_f [-] */
} nt_signals;

/* What a law wants; limits come after it. */
typedef struct nt_effort {
    double motor_force; /* tau_m, + towards the sample [N] */
    double stage;       /* where the stage shall be [m] */
} nt_effort;

/* Must be real-time safe where the loop is. A number that is not finite stops the coupling (NT_REASON_LAW). */
typedef nt_effort (*nt_control_law)(void *context, const nt_gains *gains, const nt_signals *signals);

/* What stability rules and observer have to put into their formulas for a law (docs/control.md): K_f is 0 for the
 * impedance law, the damping of the master is what feed-forward leaves of it, the paper's law and samples too few for a
 * notch leave the stage's resonance bare, alpha_f is that of the region with the largest, and a virtual coupling
 * softens the contact, as it is felt. The margins of a loop are those of nt_margins_compute for this rig, these gains
 * and the contact's own stiffness. */
typedef struct nt_servo_equivalent {
    nt_rig rig;
    nt_gains gains;
    double contact_stiffness; /* [N/m] */
} nt_servo_equivalent;
/* For a contact of this stiffness [N/m], >= 0, by the law that the settings choose. */
NT_API nt_servo_equivalent nt_servo_equivalent_of(const nt_rig *rig, const nt_settings *settings,
                                                  double contact_stiffness);
/* By what K_p and K_v of the paper's law may be multiplied until the stage oscillates by itself; infinite for the other
 * laws. Some milliseconds. */
NT_API double nt_servo_stage_margin(const nt_rig *rig, const nt_settings *settings);

/* --- RUN, HOLD, RETRACT, LATCHED: a pure function of sample, command and limits (the table in
 * docs/evidence/safety.md). --- */

enum {
    NT_REASON_INVALID = 1u << 0,   /* NaN, infinite, beyond any reading of the sensor, or bad frame */
    NT_REASON_SATURATED = 1u << 1, /* deflection at the end of its range */
    NT_REASON_FORCE_LIMIT = 1u << 2,
    NT_REASON_STALE = 1u << 3,    /* sample older than 2 T */
    NT_REASON_STUCK = 1u << 4,    /* the deflection does not change while z moves */
    NT_REASON_FOLLOW = 1u << 5,   /* the stage does not follow */
    NT_REASON_UNSTABLE = 1u << 6, /* the passivity observer has used up what it had */
    NT_REASON_EMERGENCY_STOP = 1u << 7,
    NT_REASON_LIMIT_SWITCH = 1u << 8,
    NT_REASON_OPERATOR_CLIPPED = 1u << 9, /* the gauge is at its range: a flag, the state stays RUN */
    NT_REASON_COMMAND_LIMITED = 1u << 10, /* stage speed or travel is at its limit: a flag */
    NT_REASON_LATE = 1u << 11,            /* ticks late by more than T/5, in a row */
    NT_REASON_DEVICE = 1u << 12,          /* a device is gone */
    NT_REASON_INDENTATION = 1u << 13,     /* the indentation is at its limit */
    NT_REASON_LAW = 1u << 14,             /* the control law gave no number */
    NT_REASON_BACKED_OFF = 1u << 15,      /* the passivity observer has taken gain away: a flag */
    NT_REASON_MASTER_STALE = 1u << 16,    /* the master's reading is older than two of its own periods */
    NT_REASON_LATERAL = 1u << 17,         /* the lateral force is at its limit */
    NT_REASON_AMPLITUDE = 1u << 18        /* the amplitude is lost, or beyond what this drive can make at its lag */
};
/* "force limit", ... of one reason bit; "" for none. */
NT_API const char *nt_reason_name(uint32_t reason);

enum { NT_STUCK_SAMPLES = 50 }; /* without noise, in a row, while z moves: the sensor is dead */

/* What a stop does with the stage. */
typedef enum nt_lift {
    NT_LIFT_GOES,    /* it lifts, by retract_distance, and on while force shows or cannot be read */
    NT_LIFT_WAITS,   /* the stage did not follow, or went the wrong way: it stays, until the force grows */
    NT_LIFT_TRIES,   /* it did grow: it lifts, and the force alone tells whether that helps */
    NT_LIFT_GIVEN_UP /* it went the wrong way */
} nt_lift;

/* When a sensor counts as dead. */
typedef struct nt_stuck_limits {
    double distance; /* of the stage, over which readings show no noise; 0: it cannot be told [m] */
    double noise;    /* of a reading, as declared: standard deviation [m] */
} nt_stuck_limits;

/* What is judged of a lever that taps. All 0: it does not. */
typedef struct nt_amplitude_limits {
    double lost, most;     /* below the first one nothing taps; the drive cannot make more than the second [m] */
    uint32_t settling;     /* in which lever and lock-in amplifier follow [periods] */
    nt_stuck_limits stuck; /* of the amplitude */
    double shake;          /* D of a driven base, 0 of a driven tip (tapping.h) [m] */
    double reach;          /* D Q f0/f: the largest amplitude that this drive can make [m] */
    double memory;         /* Q/w0 over the time in which power and loss are averaged [-] */
    double kept;           /* of those averages, per period [-] */
    double share;          /* of the loss that the power is at least, with what A0 may be off [-] */
} nt_amplitude_limits;

/* All that does not change while it runs. */
typedef struct nt_supervisor {
    double master_period;     /* between two readings of the master [s] */
    double period;            /* T [s] */
    double spring_constant;   /* k_c [N/m] */
    double lateral_stiffness; /* k_l: x and y of the deflection are judged; 0: the lever does not show them [N/m] */
    double deflection_range;  /* [m] */
    double free_force;        /* forces below this are the sensor's noise [N] */
    double master_range;      /* readings beyond these cannot be [m] */
    int leads_sideways;       /* a master of three axes: its x and y are judged, too */
    double gauge_range;       /* [N], 0 without a gauge */
    double stage_range;       /* [m] */
    double stuck_distance;    /* deflections without noise over this travel are a dead sensor, 0: cannot be told [m] */
    double noise;             /* of the deflection, as declared: standard deviation [m] */
    double stage_share;       /* of the way to its reference that the stage should go in a period [-] */
    double stage_slack;       /* by which it may be off at rest, or three quarters of the way that it was to go [m] */
    double stage_most;      /* never by more than this: follow_error, and hysteresis that no integral takes away [m] */
    double correction_most; /* that the integral may add to where the stage is told to be [m] */
    double turn_slack;      /* when it should be farther back than this, a lift has begun to show [m] */
    double lift_share;      /* of the way up that declared hysteresis and creep may take, while no integral acts [-] */
    double path_kept;       /* of that way, per period: it fades over follow_time [-] */
    nt_limits limits;
    nt_amplitude_limits amplitude;
} nt_supervisor;

/* Of a sensor that may be dead: readings without noise while the stage moves. */
typedef struct nt_stuck {
    uint32_t run;             /* readings without noise in a row */
    double value;             /* [m] */
    double band;              /* within which a reading shows no noise [m]; from these: */
    uint32_t noise_samples;   /* that have been looked at */
    double noise_sum;         /* of their differences, in this block [m] */
    double noise;             /* of the quietest block: standard deviation [m] */
    double last;              /* reading [m] */
    double position[NT_AXES]; /* of the stage, where they began [m] */
} nt_stuck;

/* Channels of a sample that are measurements: numbers that their sensor can give, of a device that is not to blame, and
 * fresh. One that is not leaves the others alone. */
enum {
    NT_SEES_MASTER = 1u << 0,   /* its position along z */
    NT_SEES_OPERATOR = 1u << 1, /* the operator's force, where there is a gauge */
    NT_SEES_SIDEWAYS = 1u << 2, /* x and y of a master that leads sideways */
    NT_SEES_STAGE = 1u << 3,    /* its position */
    NT_SEES_DEFLECTION = 1u << 4,
    NT_SEES_LATERAL = 1u << 5, /* x and y of the deflection, where the lever shows them */
    NT_SEES_TAPPING = 1u << 6, /* amplitude and lag, of a lever that taps */
    NT_SEES_ALL = (1u << 7) - 1u
};

typedef struct nt_supervisor_state {
    nt_state state;
    uint32_t reasons;
    uint32_t seen;        /* NT_SEES_* of this sample */
    uint32_t invalid_run; /* invalid samples in a row */
    uint32_t law_run;     /* laws without a number in a row */
    uint32_t late_run;    /* late ticks less punctual ones, at least 0 */
    uint32_t late_ticks;  /* all of them */
    nt_stuck deflection, amplitude;
    uint32_t lost_run;    /* amplitudes in a row that are lost, or cannot be */
    double power, loss;   /* averages of A sin(phi) [m] and of A^2 [m^2], A of the tip's way */
    double expected;      /* where the stage should be by now [m] */
    double path;          /* that this has gone lately, to and fro [m] */
    uint32_t off_run;     /* ticks in a row in which the stage was not there */
    nt_lift lift;         /* of a stop */
    int presses;          /* in a stop: force shows, or cannot be read */
    int lifts;            /* the stage is told to go up */
    nt_sum reference;     /* where it was told to be [m] */
    double turn;          /* where it should have been when the lift began [m] */
    double stopped;       /* where it should have been when the stop began [m] */
    double lift_force;    /* largest force until it should have turned [N] */
    uint32_t growth_run;  /* ticks in a row in which the force has grown since */
    double turn_position; /* where it was read to be when the lift began [m] */
    double top_position;  /* the farthest up that it has been read since [m] */
    double fall_position; /* where it was first read to be well below that [m] */
    uint32_t fall_run;    /* ticks in a row in which it has gone on the wrong way */
    double late;          /* of this tick: a stop lifts by the clock, not by ticks [s] */
    double surface;       /* travel of the tip at first touch [m] */
    double indentation;   /* [m] */
} nt_supervisor_state;
/* What the supervisor has to know beside the sample. */
typedef struct nt_situation {
    nt_sum reference;   /* where the stage was told to be [m] */
    int moves_sideways; /* the surface may rise and fall: the indentation is not followed */
    int unstable;       /* the passivity observer has used up what it had */
} nt_situation;

#ifdef __cplusplus
}
#endif
#endif
