/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_SESSION_HAZARD_PRIVATE_H
#define NANOTOUCH_SESSION_HAZARD_PRIVATE_H

#include "internal/margins.h"
#include "nanotouch/margins.h"
#include "nanotouch/plan.h"

/* slope: of the surface where it is steepest, dilated by the tip [-]; clearance: of the tip above it where the tare is
 * taken [m], infinite where none is. Rig and settings have been checked, the plan is
 * for loads up to limits.force. Some milliseconds. */
nt_hazard nt_hazard_of(const nt_plan *plan, const nt_rig *rig, const nt_settings *settings, double slope,
                       double clearance);

#endif
