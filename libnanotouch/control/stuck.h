/* SPDX-License-Identifier: BSD-3-Clause
 * Private to control/: is a sensor dead? */
#ifndef NANOTOUCH_CONTROL_STUCK_H
#define NANOTOUCH_CONTROL_STUCK_H

#include "nanotouch/control.h"

/* Of a valid reading at a place of the stage. NT_HOLD for a sensor that seems dead, NT_LATCHED where a step away has
 * not helped. shows_none: the reading is one that shows no noise anyway. */
nt_state nt_stuck_judge(const nt_stuck_limits *limits, nt_stuck *stuck, double reading, const double position[NT_AXES],
                        int shows_none);

#endif
