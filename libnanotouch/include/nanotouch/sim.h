/* SPDX-License-Identifier: BSD-3-Clause
 * The simulated rig: hand, master, stage, probe, surface and sensors behind the same contract as real devices. */
#ifndef NANOTOUCH_SIM_H
#define NANOTOUCH_SIM_H

#include "nanotouch/dynamics.h"
#include "nanotouch/faults.h"
#include "nanotouch/hal.h"
#include "nanotouch/interaction.h"
#include "nanotouch/plan.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How the cantilever is computed. */
typedef enum nt_probe_model {
    NT_PROBE_AUTO,         /* quasi-static where that is good enough: nt_sim_needs_dynamics */
    NT_PROBE_QUASI_STATIC, /* at rest at every tick */
    NT_PROBE_DYNAMIC       /* Eq. 2 */
} nt_probe_model;

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
    double substep;          /* of the dynamic cantilever, 0: 0.25 [rad] */
    const nt_faults *faults; /* copied; NULL: none */
} nt_sim_setup;

enum { NT_SIM_DELAY_MAX = 254, NT_SIM_SLOTS = NT_SIM_DELAY_MAX + 2, NT_SIM_LOST_MAX = 1000 };

/* Where everything really is; a real rig has no such thing. */
typedef struct nt_truth {
    double gap;            /* h between tip and (dilated) surface [m] */
    double tip_force;      /* F [N] */
    double contact_radius; /* a [m] */
    double surface_height; /* z_s under the tip [m] */
    double tip_height;     /* z_t [m] */
    double energy;         /* U of the interaction [J] */
} nt_truth;

/* What the sensors would read without noise, steps and delay. */
typedef struct nt_moment {
    double deflection, stage_position, master_position; /* [m] */
    double operator_force;                              /* [N] */
} nt_moment;

/* What is random, a stream each (random.h): a half of the rig draws nothing from the other's. The sensors come first, in
 * the order of nt_channel, then what a fault adds to each. */
typedef enum nt_sim_noise {
    NT_SIM_NOISE_FAULT = NT_CHANNEL_OPERATOR_FORCE + 1,
    NT_SIM_NOISE_HAND = 2 * NT_SIM_NOISE_FAULT,
    NT_SIM_NOISE_TIP, /* thermal motion of the cantilever */
    NT_SIM_NOISES
} nt_sim_noise;

/* What lasting faults have to remember. */
typedef struct nt_fault_memory {
    nt_sample last;  /* as it was given away */
    nt_sample fresh; /* the last one of a living link */
    double stood;    /* of the stage's drive when its fault began [m] */
    double lateness; /* of this tick [s] */
} nt_fault_memory;

/* A part of a period under one command. */
typedef struct nt_sim_part {
    double length; /* [s], 0 if there is no such part */
    nt_stage_model stage;
    nt_master_model master;
} nt_sim_part;

typedef struct nt_sim {
    const nt_plan *plan;
    nt_rig rig;
    double period, start_height; /* z_b at x_s = 0 [m] */
    int delay;                   /* whole periods until a command acts ... */
    double fraction;             /* ... and the part of one [periods] */
    nt_sim_part parts[2];        /* before and after a command begins to act */
    nt_sensor deflection_sensor, stage_sensor, master_sensor, gauge;
    double command_step; /* of the stage [m] */
    nt_cantilever_model cantilever_model;
    int dynamic; /* the cantilever is */
    /* state */
    uint64_t tick;
    nt_noise noise[NT_SIM_NOISES];
    nt_hand_state hand;
    nt_stage_state stage;
    double stage_drive; /* the command as far as the driver has slewed [m] */
    nt_master_state master;
    nt_cantilever_state cantilever; /* its tip_height counts from the surface under it */
    nt_interaction_state interaction;
    double x, y;
    uint32_t flags; /* NT_SAMPLE_* put into every sample: faults and buttons */
    nt_command pending[NT_SIM_SLOTS];
    nt_moment moments[NT_SIM_SLOTS];
    nt_sample converted; /* the newest, before faults */
    nt_faults faults;
    nt_fault_memory fault_memory;
    nt_truth truth;
    nt_law_value law; /* of the interaction, at truth.gap */
} nt_sim;

/* A rig at rest, clear of the surface. All state is inside *sim: copying it is a snapshot. */
NT_API nt_status nt_sim_init(nt_sim *sim, const nt_sim_setup *setup);
/* The operation table; the context is a nt_sim. */
NT_API const nt_hal_backend *nt_sim_backend(void);
NT_API NT_REALTIME nt_status nt_sim_read(nt_sim *sim, nt_sample *sample);
/* Takes the command and lets one period pass; it acts `delay` periods later, within the motor's force and the stage's
 * travel and speed. NT_E_NOT_FINITE, with no time passed, for a command that is not a number; NT_E_NO_CONVERGENCE if
 * the probe does not come to rest. */
NT_API NT_REALTIME nt_status nt_sim_write(nt_sim *sim, const nt_command *command);
/* What the simulated operator does next. */
NT_API NT_REALTIME void nt_sim_aim_hand(nt_sim *sim, const nt_hand_target *target);
/* Adds a fault, from now on if its start has passed. As nt_faults_add. */
NT_API nt_status nt_sim_inject(nt_sim *sim, const nt_fault *fault);
/* Is the quasi-static cantilever not good enough? Its lag may be what the plan's demand allows of the pull-off force,
 * the demand's floor or the standard deviation of the force read-out, whichever is most; and it has to ring out with a
 * time constant of a millisecond, the quickest that touch perceives, or of a period. */
NT_API int nt_sim_needs_dynamics(const nt_plan *plan, const nt_rig *rig, double period);

#ifdef __cplusplus
}
#endif
#endif
