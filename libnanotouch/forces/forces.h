/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what forces.h does not promise. */
#ifndef NANOTOUCH_FORCES_FORCES_PRIVATE_H
#define NANOTOUCH_FORCES_FORCES_PRIVATE_H

#include "nanotouch/forces.h"

/* Of a half-angle theta [rad], 0 .. 1.5. */
nt_tip_angle nt_tip_angle_of(double half_angle);
/* The same with the angle prepared, where one tip is evaluated often. */
nt_law_value nt_vdw_tip_eval_with(const nt_vdw_tip *tip, const nt_tip_angle *angle, double gap);
nt_law_value nt_electrostatic_tip_eval_with(const nt_electrostatic_tip *tip, const nt_tip_angle *angle, double gap);

#endif
