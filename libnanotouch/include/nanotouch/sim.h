/* SPDX-License-Identifier: BSD-3-Clause
 * The simulated rig: hand, master, stage, probe, surface and sensors behind the same contract as real devices. */
#ifndef NANOTOUCH_SIM_H
#define NANOTOUCH_SIM_H

#include "nanotouch/dynamics.h"
#include "nanotouch/hal.h"
#include "nanotouch/plan.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is simulated. */
typedef struct nt_sim_setup {
    const nt_plan *plan;    /* borrowed, must outlive the rig */
    const nt_rig *rig;      /* copied */
    double period;          /* T [s] */
    double x, y;            /* where it starts [m] */
    double clearance;       /* L, height of the tip above the surface there [m] */
    double master_position; /* x_m at the start [m] */
    uint64_t seed;          /* of the sensors' noise */
    int delay;              /* periods between write and effect, 0 .. NT_SIM_DELAY_MAX */
} nt_sim_setup;

enum { NT_SIM_DELAY_MAX = 15 };

/* Where everything really is; a real rig has no such thing. */
typedef struct nt_truth {
    double gap;            /* h between tip and (dilated) surface [m] */
    double tip_force;      /* F [N] */
    double contact_radius; /* a [m] */
    double surface_height; /* z_s under the tip [m] */
    double tip_height;     /* z_t [m] */
    double energy;         /* U of the interaction [J] */
} nt_truth;

typedef struct nt_sim {
    const nt_plan *plan;
    nt_rig rig;
    nt_stage_model stage_model;
    nt_master_model master_model;
    nt_sensor deflection_sensor, stage_sensor, master_sensor, gauge;
    double period, start_height; /* z_b at x_s = 0 [m] */
    int delay;
    nt_command pending[NT_SIM_DELAY_MAX + 1];
    /* state */
    uint64_t tick;
    nt_random random;
    nt_hand_state hand;
    nt_stage_state stage;
    double stage_drive; /* the command as far as the driver has slewed [m] */
    nt_master_state master;
    nt_cantilever_state cantilever;
    nt_interaction_state interaction;
    double x, y;
    uint32_t flags; /* NT_SAMPLE_* put into every sample: faults and buttons */
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

#ifdef __cplusplus
}
#endif
#endif
