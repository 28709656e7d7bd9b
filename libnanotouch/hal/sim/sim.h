/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what sim.h does not promise. */
#ifndef NANOTOUCH_HAL_SIM_SIM_PRIVATE_H
#define NANOTOUCH_HAL_SIM_SIM_PRIVATE_H

#include "nanotouch/advanced/sim.h"

/* Halves at rest, the tip clear of the surface. */
nt_status nt_sim_master_init(nt_sim_master *master, const nt_sim_setup *setup);
/* The slave's half; fails as nt_sim_master_init. */
nt_status nt_sim_slave_init(nt_sim_slave *slave, const nt_sim_setup *setup);
/* What master and gauge read at this tick, with noise and resolution. Real-time safe. */
NT_REALTIME nt_status nt_sim_master_read(nt_sim_master *master, nt_reading *reading);
/* What stage and probe read at this tick, with noise and resolution. Real-time safe. */
NT_REALTIME nt_status nt_sim_slave_read(nt_sim_slave *slave, nt_reading *reading);
/* Takes what it shall do and lets one period pass; it acts `delay` periods later, within the motor's force or the
 * stage's travel and speed. NT_E_NOT_FINITE, with no time passed, for what is not a number; NT_E_NO_CONVERGENCE if the
 * probe does not come to rest. */
NT_REALTIME nt_status nt_sim_master_write(nt_sim_master *master, const nt_action *action);
/* The same of the stage. */
NT_REALTIME nt_status nt_sim_slave_write(nt_sim_slave *slave, const nt_action *action);
/* Another scene from now on; the plan is borrowed as the first one. */
NT_REALTIME void nt_sim_change_plan(nt_sim_slave *slave, const nt_plan *plan);
/* Lays `number` at rest at x, y [m], a rod with its angle [rad]; fails as nt_pushed_lay, NT_E_UNSUPPORTED where nothing
 * can be laid. */
nt_status nt_sim_lay(nt_sim_slave *slave, int number, const double pose[3]);
/* What the simulated operator does next. */
NT_REALTIME void nt_sim_aim_hand(nt_sim_master *master, const nt_hand_target *target);
/* Is the quasi-static cantilever not good enough? Its lag may be what the plan's demand allows of the pull-off force,
 * the demand's floor or the standard deviation of the force read-out, whichever is most; and it has to ring out with a
 * time constant of a millisecond, the quickest that touch perceives, or of a period. */
int nt_sim_needs_dynamics(const nt_plan *plan, const nt_rig *rig, double period);

#endif
