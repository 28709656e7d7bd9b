/* SPDX-License-Identifier: BSD-3-Clause
 * The parts of the simulated rig. Private. */
#ifndef NANOTOUCH_HAL_SIM_PARTS_H
#define NANOTOUCH_HAL_SIM_PARTS_H

#include "nanotouch/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The stream of a channel at the beginning of this tick. */
static inline nt_noise *nt_sim_noise_now(nt_sim *sim, int stream)
{
    nt_noise_seek(&sim->noise[stream], sim->tick);
    return &sim->noise[stream];
}

/* --- probe.c: one period of the cantilever, base and surface where they are now --- */

double nt_sim_surface_height(const nt_sim *sim);
nt_status nt_sim_move_probe(nt_sim *sim);

/* --- faults.c: what each fault does, where it acts --- */

/* What becomes of a sample on its way. */
void nt_sim_spoil(nt_sim *sim, nt_sample *sample);
/* Periods that are lost before this command arrives. */
int nt_sim_lost_periods(const nt_sim *sim);
/* What stage and motor make of what they are told [m], [N]. */
double nt_sim_spoil_stage(nt_sim *sim, double drive);
double nt_sim_spoil_motor(const nt_sim *sim, double force);
double nt_sim_stage_hysteresis(const nt_sim *sim);
/* Of the whole frame, unseen by the read-out [m]. */
double nt_sim_stage_drift(const nt_sim *sim);
/* By how much the surface has risen [m]. */
double nt_sim_surface_jump(const nt_sim *sim);
/* The operator's own [N]. */
double nt_sim_push(const nt_sim *sim);

#ifdef __cplusplus
}
#endif
#endif
