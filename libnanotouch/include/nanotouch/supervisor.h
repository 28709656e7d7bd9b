/* SPDX-License-Identifier: BSD-3-Clause
 * RUN, HOLD, RETRACT, LATCHED: a pure function of sample, command and limits (the table in docs/evidence/safety.md). */
#ifndef NANOTOUCH_SUPERVISOR_H
#define NANOTOUCH_SUPERVISOR_H

#include "nanotouch/settings.h"
#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

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

/* Thresholds of a rig and its settings; both have been checked. */
NT_API nt_supervisor nt_supervisor_make(const nt_rig *rig, const nt_settings *settings);
/* The same of mode tapping: the amplitude is judged, too. */
NT_API nt_amplitude_limits nt_supervisor_amplitude(const nt_rig *rig, const nt_settings *settings);
/* In RUN, nothing seen yet. */
NT_API nt_supervisor_state nt_supervisor_start(void);
/* One tick. Returns the new state, never less severe than RETRACT or LATCHED once reached (nt_supervisor_arm). */
NT_API NT_REALTIME nt_state nt_supervisor_step(const nt_supervisor *supervisor, nt_supervisor_state *state,
                                               const nt_sample *sample, const nt_situation *situation);
/* The law gave no number in this tick: HOLD, the second time in a row RETRACT. */
NT_API NT_REALTIME nt_state nt_supervisor_fail_law(nt_supervisor_state *state);
/* Back to RUN after RETRACT; after LATCHED only with confirmed = 1 (a person at the rig), else NT_E_STATE. */
NT_API nt_status nt_supervisor_arm(nt_supervisor_state *state, int confirmed);

#ifdef __cplusplus
}
#endif
#endif
