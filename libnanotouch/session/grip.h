/* SPDX-License-Identifier: BSD-3-Clause
 * Private to session/: friction for the hazard. */
#ifndef NANOTOUCH_SESSION_GRIP_H
#define NANOTOUCH_SESSION_GRIP_H

#include "nanotouch/plan.h"

/* The largest friction of any place of a plan under a load [N], whether the plan computes friction or not. */
double nt_grip_friction(const nt_plan *plan, double load);
/* What radius and material that change from place to place push sideways at most, under loads up to one [N]: where a
 * tip stands (x, y [m]), or, NULL, anywhere. */
double nt_grip_uneven(const nt_plan *plan, double load, const double *place);
/* hazard.c: how far the surface of a plan can rise under the tip; infinite where that is not known [m]. */
double nt_hazard_relief(const nt_plan *plan);

#endif
