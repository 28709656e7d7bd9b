/* SPDX-License-Identifier: BSD-3-Clause
 * The simulated rig behind the same contract as real devices: a master (hand, arm, gauge) and a slave (stage, probe,
 * surface), which know nothing of each other. */
#ifndef NANOTOUCH_ADVANCED_SIM_H
#define NANOTOUCH_ADVANCED_SIM_H

#include "nanotouch/advanced/manipulation.h"
#include "nanotouch/advanced/plasticity.h"
#include "nanotouch/advanced/tapping.h"
#include "nanotouch/dynamics.h"
#include "nanotouch/hal.h"
#include "nanotouch/interaction.h"
#include "nanotouch/plan.h"
#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- Faults of the simulated rig, by kind, channel and time: what a test injects where a real rig would fail. The
 * table of docs/safety.md says what has to happen. --- */

typedef enum nt_fault_kind {
    NT_FAULT_NAN,
    NT_FAULT_INFINITE,
    NT_FAULT_SATURATED,
    NT_FAULT_STUCK,
    NT_FAULT_STALE,
    NT_FAULT_DROPOUT,
    NT_FAULT_NOISE,
    NT_FAULT_JUMP,
    NT_FAULT_LATE,
    NT_FAULT_CLOCK,
    NT_FAULT_LIMIT,
    NT_FAULT_GAIN,
    NT_FAULT_DRIFT,
    NT_FAULT_HYSTERESIS,
    NT_FAULT_PUSH,
    NT_FAULT_EMERGENCY_STOP,
    NT_FAULT_LIMIT_SWITCH,
    NT_FAULT_DEVICE_LOST,
    NT_FAULT_POWER,
    NT_FAULT_CLOCK_DRIFT,
    NT_FAULT_SLIP
} nt_fault_kind;

/* Where. The four sensors come first. */
typedef enum nt_channel {
    NT_CHANNEL_DEFLECTION,
    NT_CHANNEL_STAGE_POSITION,
    NT_CHANNEL_MASTER_POSITION,
    NT_CHANNEL_OPERATOR_FORCE,
    NT_CHANNEL_STAGE, /* the actuator itself */
    NT_CHANNEL_MOTOR,
    NT_CHANNEL_RIG /* a fault of no channel: frame, clock, surface, hand, lines */
} nt_channel;

typedef struct nt_fault {
    nt_fault_kind kind;
    nt_channel channel;
    double start;    /* on the rig's clock [s] */
    double duration; /* [s], > 0; below a period: in the one tick nearest to start; infinite: it stays */
    double value;    /* by kind: see the table [unit of the kind] */
} nt_fault;

enum { NT_FAULTS_MAX = 16 };

/* A schedule; caller-owned, may be copied. Zero is none. */
typedef struct nt_faults {
    nt_fault list[NT_FAULTS_MAX];
    int count;
} nt_faults;

/* One kind. */
typedef struct nt_fault_description {
    const char *name;  /* "nan", "stuck", ...; static storage */
    const char *unit;  /* of the value, "" if it has none or takes that of the channel */
    const char *doc;   /* what it does */
    double value;      /* usual [unit of the kind] */
    double minimum;    /* of the value [unit of the kind] */
    double maximum;    /* [unit of the kind] */
    int row;           /* of the fault table in docs/evidence/safety.md */
    unsigned channels; /* bit 1 << nt_channel where it may be */
} nt_fault_description;

/* By kind; *count (NULL allowed) their number. */
NT_API const nt_fault_description *nt_fault_descriptions(int *count);
/* "deflection", ...; "" for none. */
NT_API const char *nt_channel_name(nt_channel channel);
/* Adds one. NT_E_ARGUMENT (no such kind, or not on this channel), NT_E_NOT_FINITE (start, value; duration NaN),
 * NT_E_RANGE (start below 0, duration not above 0, a value out of its range), NT_E_CAPACITY. */
NT_API nt_status nt_faults_add(nt_faults *faults, const nt_fault *fault);

/* How the cantilever is computed. */
typedef enum nt_probe_model {
    NT_PROBE_AUTO,         /* quasi-static where that is good enough: nt_sim_needs_dynamics */
    NT_PROBE_QUASI_STATIC, /* at rest at every tick */
    NT_PROBE_DYNAMIC       /* Eq. 2 */
} nt_probe_model;
#define NT_PROBE_WORDS "auto|quasi-static|dynamic"

/* What a slave that taps has beside the rest. */
typedef struct nt_sim_lock_in {
    nt_drive drive;   /* what it is driven with where it is asked for free_amplitude (tapping.h) */
    double time;      /* constant of the lock-in amplifier [s] */
    nt_sensor sensor; /* of the amplitude; its range is the largest one, too, that the drive can be asked for [m] */
} nt_sim_lock_in;

/* What is simulated. */
typedef struct nt_sim_setup {
    const nt_plan *plan;    /* borrowed, must outlive the rig */
    const nt_rig *rig;      /* copied */
    double period;          /* T [s] */
    double x, y;            /* where it starts [m] */
    double clearance;       /* L, height of the tip above the surface there [m] */
    double master_position; /* x_m at the start [m] */
    uint64_t seed;          /* of all that is random */
    double
        delay; /* between write and effect, 0 .. NT_SIM_DELAY_MAX with the converters' own [periods]; may be a part */
    nt_probe_model probe_model;
    double substep;                /* of the dynamic cantilever, 0: 0.25 [rad] */
    const nt_faults *faults;       /* copied; NULL: none */
    const nt_sim_lock_in *lock_in; /* copied; NULL: the lever is not driven */
    const nt_pushed *pushed;       /* what can be laid on a flat at z = 0; copied, NULL: nothing. The lever is that of
                                      the rig, quasi-static, and not driven */
} nt_sim_setup;

enum { NT_SIM_DELAY_MAX = 254, NT_SIM_SLOTS = NT_SIM_DELAY_MAX + 2, NT_SIM_LOST_MAX = 1000, NT_SIM_CHANNELS = 13 };

/* Where everything really is; a real rig has no such thing. */
typedef struct nt_truth {
    double gap;                /* h between tip and (dilated) surface [m] */
    double tip_force[NT_AXES]; /* F in the world frame, with friction [N] */
    double peak_force;         /* the largest |F| of the period; of a quasi-static probe |F| at its end [N] */
    double deepest_gap;        /* the smallest h of the period, likewise [m] */
    double contact_radius;     /* a [m] */
    double surface_height;     /* z_s under the tip [m] */
    double tip_height;         /* z_t [m] */
    double energy;             /* U of the interaction [J] */
    double friction_stored;    /* by friction, in contact, tip and lever [J] */
    double friction_heat;      /* that friction has made so far [J] */
    double dent_heat;          /* that a sample with dents has made so far [J] */
} nt_truth;

/* What is random, a stream each (random.h): no half draws from the other's. The four sensors come first, in the order
 * of nt_channel, then what a fault adds to each. */
typedef enum nt_sim_noise {
    NT_SIM_NOISE_FAULT = NT_CHANNEL_OPERATOR_FORCE + 1,
    NT_SIM_NOISE_HAND = 2 * NT_SIM_NOISE_FAULT,
    NT_SIM_NOISE_TIP, /* thermal motion of the cantilever */
    NT_SIM_NOISE_LOCK_IN,
    NT_SIM_NOISES
} nt_sim_noise;

/* What a lasting fault goes back to, along NT_Z. */
typedef struct nt_sim_memory {
    double position, felt; /* [m]; force [N] of the master, deflection [m] of the slave */
    double age;            /* [s] */
    uint64_t sequence, tick;
} nt_sim_memory;

/* What both halves have: their clock, converters, delay and faults. */
typedef struct nt_sim_link {
    nt_rig rig;
    double period; /* [s] */
    uint64_t tick;
    double per_tick; /* measurements in a period, 0: one [-] */
    int delay;       /* whole periods until a command acts ... */
    double fraction; /* ... and the part of one [periods] */
    nt_noise noise[NT_SIM_NOISES];
    uint64_t converted; /* the tick of the newest conversion */
    double lateness;    /* of this tick [s] */
    nt_faults faults;
    nt_sim_memory last;  /* as it was given away */
    nt_sim_memory fresh; /* the last one of a living link */
    const nt_host *host; /* whose clock stamps the readings; NULL: ticks times period */
    nt_channel_row channels[NT_SIM_CHANNELS];
    int channel_count;
    uint32_t valid; /* bits of the channels that it reads */
} nt_sim_link;

/* --- the master: hand, arm, gauge --- */

typedef struct nt_sim_master {
    nt_sim_link link;
    nt_master_model models[2]; /* before and after a command begins to act within a period; length 0: none */
    nt_sensor position_sensor, gauge;
    double motor_step; /* of its converter, 0: none [N] */
    nt_hand_state hand;
    nt_master_state arm[NT_AXES];
    double pending[NT_SIM_SLOTS][NT_AXES]; /* motor forces [N] */
    double moments[NT_SIM_SLOTS][2];       /* position [m] and grip force [N] along NT_Z */
    nt_reading converted;                  /* the newest, before faults */
} nt_sim_master;

/* --- the slave: stage, probe, surface --- */

/* A lever that taps, by its slow flow (tapping.h), and the lock-in amplifier behind it. */
typedef struct nt_sim_tap {
    int is_there; /* else the slave has neither drive nor lock-in amplifier */
    nt_sim_lock_in lock_in;
    nt_tapping lever; /* with the drive that it has now; no drive: strength 0 */
    double strength;  /* D for the whole free amplitude [m] */
    nt_flow_state flow;
    nt_flow_table table;
    double amplitude, lag;           /* behind the lock-in amplifier [m], [rad] */
    double moments[NT_SIM_SLOTS][2]; /* of both [m], [rad] */
} nt_sim_tap;

/* What lies on the surface. The tip's place is that of the stage, and the lever's lateral stiffness lies between. */
typedef struct nt_sim_pushed {
    nt_pushed laws;
    nt_pushed_state state;
    double rested[NT_PARTICLES][3]; /* where each was laid, or left by the tip for the last time, x, y [m], angle [rad]
                                     */
    double before[NT_PARTICLES][3]; /* and where before that */
    unsigned left;                  /* bits: the tip has left what it had moved in this period */
    uint32_t touches[NT_PARTICLES]; /* how often the tip has touched it ... */
    uint32_t losses[NT_PARTICLES];  /* ... and lost it */
} nt_sim_pushed;

/* A sample that relaxes, under the place where the tip pressed it last. */
typedef struct nt_sim_relaxing {
    nt_viscoelastic_state state;
    double held[NT_LOOP_SPRINGS]; /* by its springs in this period, if they stayed where they are [Pa m] */
    double x, y;                  /* [m] */
} nt_sim_relaxing;

typedef struct nt_sim_slave {
    nt_sim_link link;
    const nt_plan *plan;
    double start_height;      /* z_b at x_s = 0 [m] */
    nt_stage_model models[2]; /* as above */
    nt_sensor deflection_sensor, stage_sensor;
    double command_step; /* of the stage [m] */
    nt_cantilever_model cantilever_model;
    int dynamic; /* the cantilever is */
    nt_stage_state stage;
    double stage_drive;             /* the command as far as the driver has slewed [m] */
    double driven;                  /* the same, as a fault of the stage leaves it [m] */
    double stood;                   /* the command, when a fault of the stage began [m] */
    int was_off;                    /* without power, and not yet back where it is told to be */
    nt_cantilever_state cantilever; /* its tip_height counts from the surface under it */
    nt_interaction_state interaction;
    nt_slide slide; /* friction */
    nt_dents dents; /* of a plan with a sample that keeps them */
    nt_sim_relaxing relaxing;
    nt_sim_pushed pushed;
    double lowered;                        /* by them, where this contact began, or would here [m] */
    int left;                              /* dents that were left in this period; the newest of the list */
    double x, y;                           /* [m] */
    double pending[NT_SIM_SLOTS][NT_AXES]; /* stage commands [m] */
    double moments[NT_SIM_SLOTS][2];       /* deflection and travel [m] */
    nt_reading converted;
    nt_truth truth;
    nt_law_value law; /* of the interaction, the last one that was asked for ... */
    double law_gap;   /* ... and at which gap; NaN: of another plan [m] */
    nt_sim_tap tap;
    nt_place place;          /* what the plan knows of the surface ... */
    double place_x, place_y; /* ... there [m] */
} nt_sim_slave;

/* Both. All state is inside: copying one, or a half, is a snapshot. */
typedef struct nt_sim {
    nt_sim_master master;
    nt_sim_slave slave;
} nt_sim;

/* Both halves from one setup, for loops of one's own. */
NT_API nt_status nt_sim_init(nt_sim *sim, const nt_sim_setup *setup);
/* The operation tables; the context is a nt_sim_master, a nt_sim_slave. */
NT_API const nt_backend *nt_sim_master_backend(void);
/* The slave's table; its context is a nt_sim_slave. */
NT_API const nt_backend *nt_sim_slave_backend(void);
/* Both halves by hand, as one rig: for tests, and for loops of one's own. */
NT_API NT_REALTIME nt_status nt_sim_read(nt_sim *sim, nt_sample *sample);
/* One command to both halves; lets one period pass. NT_E_NOT_FINITE, with no time passed, for what is not a number. */
NT_API NT_REALTIME nt_status nt_sim_write(nt_sim *sim, const nt_command *command);
/* Adds a fault to both halves, from now on if its start has passed. As nt_faults_add. */
NT_API nt_status nt_sim_inject(nt_sim *sim, const nt_fault *fault);

#ifdef __cplusplus
}
#endif
#endif
