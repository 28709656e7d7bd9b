/* SPDX-License-Identifier: BSD-3-Clause
 * How the force grows sideways. */
#ifndef NANOTOUCH_INTERNAL_HAZARD_H
#define NANOTOUCH_INTERNAL_HAZARD_H

#include "nanotouch/margins.h"
#include "nanotouch/plan.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How the forces on the tip grow with its way, on a surface of this slope [-] under loads up to `load` [N], > 0. */
NT_API nt_sideways_contact nt_grip_of(const nt_plan *plan, double slope, double load);

#ifdef __cplusplus
}
#endif
#endif
