/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what dynamics.h does not promise. */
#ifndef NANOTOUCH_DYNAMICS_DYNAMICS_PRIVATE_H
#define NANOTOUCH_DYNAMICS_DYNAMICS_PRIVATE_H

#include "nanotouch/dynamics.h"

/* Prepares one period [s] of the stage's motion. NT_E_RANGE or NT_E_NOT_FINITE for a period that is not above 0. */
nt_status nt_stage_model_init(nt_stage_model *model, const nt_stage *stage, double period);
/* The plays as they stand at this command on the way through the middle of the loop: P[u] = u. */
NT_REALTIME void nt_stage_set_plays(nt_stage_state *state, double command);
/* From now on this hysteresis [-], 0 to 0.4; the stage, last driven to `command` [m], stays where it is. */
NT_REALTIME void nt_stage_set_hysteresis(nt_stage_model *model, nt_stage_state *state, double hysteresis,
                                         double command);
/* One period under a command x_s [m] and what the probe pulls with. */
NT_REALTIME void nt_stage_step(const nt_stage_model *model, nt_stage_state *state, double command,
                               const nt_stage_load *load);
/* Sets a new target from where the hand is now, so that nothing jumps. */
void nt_hand_aim(nt_hand_state *hand, const nt_hand_target *target);
/* Where the hand is now (duration unused): the force is the script's. */
NT_REALTIME nt_hand_target nt_hand_now(const nt_hand_state *hand);
/* The force that the hand means to apply along NT_Z, before its impedance: the script's and the adversary's [N]. */
NT_REALTIME double nt_hand_effort(const nt_hand_state *hand);
/* One period; the master stands at `position` [m]. noise may be NULL where random_force is 0. */
NT_REALTIME void nt_hand_step(nt_hand_state *state, const nt_hand *hand, double position, double period,
                              nt_noise *noise);
/* hand: NULL for a pure force. */
nt_status nt_master_model_init(nt_master_model *model, const nt_master *master, const nt_hand *hand, double period);
/* force: of motor and hand's effort [N]; rest: of the hand's spring [m]. */
NT_REALTIME void nt_master_step(const nt_master_model *model, nt_master_state *state, double force, double rest);
/* f_m, what a force sensor between hand and master reads: effort - m_h x'' - b_h x' - k_h (x - rest) [N]. */
NT_REALTIME double nt_master_grip_force(const nt_master_model *model, const nt_master_state *state, double effort,
                                        double rest);
/* Noise, then steps, then saturation. NaN in, NaN out. noise may be NULL where noise is 0. */
NT_REALTIME double nt_sensor_read(const nt_sensor *sensor, double value, nt_noise *noise);

#endif
